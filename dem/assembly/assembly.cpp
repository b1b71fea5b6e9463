// SPDX-License-Identifier: BSD-3-Clause
// Stepping. What others see of the state is in assembly_views.cpp.
#include "dem/assembly/assembly.hpp"

#include "base/error.hpp"
#include "dem/assembly/contact_forces-inl.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double max_strain_step = 0.01;
/// Of the smallest radius, in one step: from there on a packing counts as exploding. At p' = 10 MPa overlaps reach a
/// tenth of the radius, and a grain that snaps off moves by 1 %; at 66 MPa one has moved by 5.7 %. What really explodes
/// moves by more from step to step.
constexpr double max_grain_step = 0.2;

/// Says which grain moves too fast, or at a velocity that is not a number.
[[noreturn]] void report_explosion(const Packing &packing, std::uint64_t step, double time_step, double speed_limit)
{
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    {
      const double speed = packing.linear_velocity(i).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
      if (!std::isfinite(speed) || !packing.angular_velocity(i).allFinite())
        throw RunFailure(
            fmt::format("step {}: the velocity of grain {} is not a number. A force or the state it started "
                        "from was not one; look at the last checkpoint.",
                        step, packing.id[i]));
      if (speed >= speed_limit)
        throw RunFailure(fmt::format(
            "step {}: grain {} moves at {:.3g} m/s, more than {:.3g} m/s (20 % of the smallest radius per "
            "step of {:.3g} s): the packing explodes. Lower motion.time_step_safety, the strain rate (while a "
            "specimen is prepared: specimen.compaction_rate) or the fixed time step.",
            step, packing.id[i], speed, speed_limit, time_step));
    }
  throw RunFailure(fmt::format("step {}: the packing explodes", step)); // not reached: leapfrog found one
}

/// Gives the list the history of the contacts of a snapshot, both sorted.
void take_history(const std::vector<Contact> &contacts, ContactList &list)
{
  const std::uint32_t idle = list.partition().n_grains;
  std::size_t pair = 0;
  for (const Contact &c : contacts)
    {
      while (pair < list.n_lanes() &&
             (list.first()[pair] == idle ||
              std::pair(list.first()[pair], list.second()[pair]) < std::pair(c.first, c.second)))
        ++pair;
      if (pair < list.n_lanes() && list.first()[pair] == c.first && list.second()[pair] == c.second)
        list.set_history(pair, c.history);
    }
}

MotionReport sum_of(const std::vector<MotionReport> &parts)
{
  MotionReport all;
  for (const MotionReport &part : parts) // in order of chunks
    {
      all.max_speed = std::max(all.max_speed, part.max_speed);
      all.exploded |= part.exploded;
      all.damping_loss += part.damping_loss;
      all.free_loss += part.free_loss;
      all.carried_work += part.carried_work;
    }
  return all;
}
} // namespace

Assembly::Assembly(const Snapshot &initial, const StepSettings &how)
    : settings(how), packing_(initial.grains), domain_(initial.box, initial.cell), law_(initial.law),
      forces_(initial.law->history(), initial.grains.n_grains()), solid_volume_(initial.grains.solid_volume()),
      d50_(initial.grains.d50()), min_radius_(initial.grains.min_radius()),
      max_diameter_(2 * initial.grains.max_radius()), wall_motion_(initial.wall_motion), step_(initial.step),
      time_(initial.time)
{
  verlet_.update(packing_, domain_, 0.0, forces_.list());
  take_history(initial.contacts, forces_.list());
}

void Assembly::set_law(const Law &law)
{
  forces();
  law_ = law;
  forces_.list().set_layout(law->history());
}

const ContactForces &Assembly::forces() const
{
  forces_.evaluate(force_input());
  return forces_;
}

void Assembly::update_list(double max_step)
{
  verlet_.update(packing_, domain_, max_step, forces_.list(), forces_.n_threads(settings));
}

void Assembly::compute_forces()
{
  if (std::exchange(forces_known_, true))
    return;
  update_list(max_step_);
  walls_.begin_step(forces_.list().partition().n_chunks);
  forces_.begin_step(force_input(), [&](std::size_t chunk) {
    if (const RigidBox *box = walls())
      walls_.add_chunk(chunk, law_, packing_, *box, verlet_, forces_.action().data());
  });
  if (walls())
    walls_.sum_chunks();
  if (settings.gravity != Vec3::Zero())
    add_gravity();
  if (settings.measure_energy)
    measure_energy();
}

void Assembly::add_gravity()
{
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    for (int k = 0; k < 3; ++k)
      forces_.action()[8 * i + k] += settings.gravity[k] * packing_.mass(i);
}

void Assembly::measure_energy()
{
  const ContactForces &contacts = forces();
  if (!meter_.started())
    {
      meter_.start(stored_energy(snapshot()), walls_.forces(), contacts.virial().sum());
      return;
    }
  meter_.add_dissipation(contacts.dissipation());
  if (domain_.cell)
    meter_.add_work_of_cell(contacts.virial().sum(), domain_.cell->strain_step);
  else
    meter_.add_work_of_walls(walls_.forces());
}

LeapfrogStep Assembly::leapfrog_step() const
{
  const double dt = settings.time_step;
  return {.dt = dt,
          .damping = settings.damping,
          .speed_limit = max_grain_step * min_radius_ / dt,
          .measure_damping = settings.measure_energy,
          .free = {settings.free_grain_damping}};
}

/// Leapfrog of all grains, each chunk when its forces are there.   @return bound on what a grain has moved, m
double Assembly::move_grains(const LeapfrogStep &how)
{
  const Partition &partition = forces_.list().partition();
  forces_known_ = false;
  motion_reports_.resize(partition.n_chunks);
  forces_.finish_step(force_input(), [&](std::size_t chunk) {
    motion_reports_[chunk] =
        integrate(packing_, partition.begin(chunk), partition.begin(chunk + 1), forces_.action().data(), how);
  });
  const MotionReport report = sum_of(motion_reports_);
  if (report.exploded)
    report_explosion(packing_, step_, how.dt, how.speed_limit);
  meter_.add_motion(report);
  ++step_;
  time_ += how.dt;
  return report.max_speed * how.dt;
}

void Assembly::move(const RigidBox &next_box)
{
  LeapfrogStep how = leapfrog_step();
  CarriedStep carried{wall_motion_, {}};
  if (settings.carry_grains)
    {
      wall_motion_ = carried.now = HomogeneousMotion::of_walls(domain_.box, next_box, settings.time_step);
      how.carried = &carried;
    }
  const double grain_step = move_grains(how);
  RigidBox &box = domain_.box;
  std::array<double, 6> outward;
  double wall_step = 0;
  for (int axis = 0; axis < 3; ++axis)
    {
      outward[2 * axis] = -(next_box.lower[axis] - box.lower[axis]);
      outward[2 * axis + 1] = next_box.upper[axis] - box.upper[axis];
      wall_step = std::max({wall_step, std::abs(outward[2 * axis]), std::abs(outward[2 * axis + 1])});
    }
  meter_.walls_moved(outward);
  max_step_ = grain_step + wall_step;
  box = next_box;
}

void Assembly::deform(const Mat3 &displacement_gradient)
{
  const double size = displacement_gradient.norm();
  if (!(size < max_strain_step))
    throw RunFailure(
        fmt::format("step {}: a displacement gradient of {:.3g} in one time step; at most {:g} is allowed. "
                    "Divide the increment or lower the strain rate.",
                    step_, size, max_strain_step));
  PeriodicCell next = *domain_.cell; // forces that are pending belong to the cell as it still is
  const AffineStep affine(next.deform(displacement_gradient));
  LeapfrogStep how = leapfrog_step();
  how.affine = &affine;
  max_step_ = move_grains(how) + size * max_diameter_;
  domain_.cell = next;
  turn_upright();
  forces_.list().set_cell(domain_.cell->edges);
}

void Assembly::stop_grains()
{
  forces(); // of the motion that was
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      packing_.set_linear_velocity(i, Vec3::Zero());
      packing_.set_angular_velocity(i, Vec3::Zero());
    }
}

void Assembly::set_homogeneous_motion(const Vec3 &rate)
{
  const double *action = forces().action().data();
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    if (std::any_of(action + 8 * i, action + 8 * i + 8, [](double x) { return x != 0; }))
      packing_.set_linear_velocity(i, rate.cwiseProduct(packing_.centre(i) - domain_.box.centre()));
}

void Assembly::set_inverse_inertia(const std::vector<InverseInertia> &inertia)
{
  forces();
  for (std::size_t i = 0; i < inertia.size(); ++i)
    {
      packing_.velocity[4 * i + 3] = inertia[i].mass;
      packing_.spin[4 * i + 3] = inertia[i].moment;
    }
}

void Assembly::turn_upright()
{
  PeriodicCell &cell = *domain_.cell;
  const std::optional<Mat3> upright = cell.upright_edges();
  if (!upright)
    return;
  cell.edges = *upright;
  ++cell.flips;
  const Mat3 to_fraction = upright->inverse();
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      const Vec3 whole = (to_fraction * packing_.centre(i)).array().floor();
      packing_.set_centre(i, packing_.centre(i) - *upright * whole);
    }
  verlet_.invalidate(); // shifts count other edges now
  update_list(0.0);
}
} // namespace isostat
