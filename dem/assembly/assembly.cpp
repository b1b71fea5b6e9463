// SPDX-License-Identifier: BSD-3-Clause
// Stepping: forces, motion, and how threads share them. What others see of the state is in assembly_views.cpp.
#include "dem/assembly/assembly.hpp"

#include "base/error.hpp"
#include "dem/motion/leapfrog.hpp"

#include <chrono>
#include <fmt/format.h>
#include <omp.h>
#include <utility>

namespace isostat
{
namespace
{
// Of the smallest radius, per step. At p' = 10 MPa overlaps reach a tenth of it, and a grain that snaps off takes 0.01.
constexpr double explosion_step = 0.05;
constexpr double max_strain_step = 0.01;

double sign_of_wall(int wall) { return wall % 2 ? 1.0 : -1.0; } // outward direction

/// Threads that pay for themselves: four chunks for each.
int useful_threads(std::uint32_t n_grains)
{
  return std::clamp(static_cast<int>(Partition(n_grains).n_chunks / 4), 1, omp_get_max_threads());
}

MotionReport sum_of(const std::vector<MotionReport> &parts)
{
  MotionReport all;
  for (const MotionReport &part : parts) // in order of chunks
    {
      all.max_speed = std::max(all.max_speed, part.max_speed);
      all.exploded |= part.exploded;
      all.damping_loss += part.damping_loss;
    }
  return all;
}
} // namespace

Assembly::Assembly(const Snapshot &initial)
    : packing_(initial.grains), box_(initial.box), cell_(initial.cell), law_(initial.law),
      contacts_(initial.law->history()), action_(8 * (initial.grains.n_grains() + Packing::n_padding), 0.0),
      solid_volume_(initial.grains.solid_volume()), d50_(initial.grains.d50()),
      min_radius_(initial.grains.min_radius()), d_max_(2 * initial.grains.max_radius()), step_(initial.step),
      time_(initial.time)
{
  if (cell_)
    {
      verlet_.update(packing_, *cell_, 0.0, contacts_);
      contacts_.set_cell(cell_->edges);
    }
  else
    verlet_.update(packing_, box_, 0.0, contacts_);
  threads = default_threads > 0 ? default_threads : useful_threads(contacts_.partition().n_grains);
  const std::uint32_t idle = contacts_.partition().n_grains;
  std::size_t pair = 0;
  for (const Contact &c : initial.contacts)
    {
      while (pair < contacts_.n_lanes() &&
             (contacts_.first()[pair] == idle ||
              std::pair(contacts_.first()[pair], contacts_.second()[pair]) < std::pair(c.first, c.second)))
        ++pair;
      if (pair < contacts_.n_lanes() && contacts_.first()[pair] == c.first && contacts_.second()[pair] == c.second)
        contacts_.set_history(pair, c.history);
    }
}

void Assembly::set_law(const Law &law)
{
  evaluate();
  law_ = law;
  contacts_.set_layout(law->history());
}

void Assembly::compute_forces()
{
  if (std::exchange(forces_known_, true))
    return;
  if (cell_)
    {
      if (verlet_.update(packing_, *cell_, max_step_, contacts_, n_threads()))
        contacts_.set_cell(cell_->edges);
      virial_.start(contacts_.partition().n_chunks, law_->young * cell_->reference_volume);
    }
  else
    verlet_.update(packing_, box_, max_step_, contacts_, n_threads());
  action_.resize(8 * contacts_.n_slots()); // all zero: integrate() clears grains, add_ghosts() ghosts
  wall_sums_.resize(contacts_.partition().n_chunks);
  if (measure_energy)
    dissipation_.resize(contacts_.n_lanes());
  const bool at_once = n_threads() > 1;
  if (at_once || !cell_)
    for_chunks([&](std::size_t chunk) {
      if (!cell_)
        add_wall_forces(chunk);
      if (at_once)
        evaluate_chunk(chunk);
    });
  pending_ = at_once ? Pending::ghosts : Pending::contacts;
  if (!cell_)
    sum_wall_forces();
  if (gravity != Vec3::Zero())
    add_gravity();
  if (measure_energy)
    energy_started_ ? sum_dissipation() : start_energy();
}

int Assembly::n_threads() const { return std::clamp(threads, 1, static_cast<int>(contacts_.partition().n_chunks)); }

template <typename Work>
void Assembly::for_chunks(const Work &work) const
{
  const Partition &partition = contacts_.partition();
  const int n = n_threads();
  if (n == 1)
    {
      for (std::size_t chunk = 0; chunk < partition.n_chunks; ++chunk)
        work(chunk);
      return;
    }
  shares_.update(n, partition.n_chunks, [&](std::size_t chunk) { // a block of pairs costs as much as 16 grains to move
    return 16.0 * contacts_.first_block(chunk) + partition.begin(chunk);
  });
#pragma omp parallel num_threads(n)
  {
    const int thread = omp_get_thread_num();
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t chunk = shares_.begin(thread); chunk < shares_.begin(thread + 1); ++chunk)
      work(chunk);
    shares_.add_time(thread, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
}

void Assembly::evaluate_chunk(std::size_t chunk) const
{
  const CellMotion motion{cell_ ? cell_->strain_step : Mat3::Zero(), &virial_};
  add_contact_forces(law_, packing_, time_step, contacts_, chunk, action_.data(),
                     measure_energy ? &dissipation_ : nullptr, &motion);
}

void Assembly::evaluate() const
{
  if (pending_ == Pending::contacts)
    for_chunks([&](std::size_t chunk) { evaluate_chunk(chunk); });
  if (pending_ != Pending::nothing)
    for_chunks([&](std::size_t chunk) { add_ghosts(contacts_, chunk, action_.data()); });
  pending_ = Pending::nothing;
}

void Assembly::start_energy()
{
  const StoredEnergy stored = stored_energy(snapshot());
  tally = {};
  tally.kinetic = -stored.kinetic();
  tally.elastic = -stored.elastic();
  if (cell_)
    virial_sum_ = virial_.sum();
  energy_started_ = true;
}

void Assembly::add_wall_forces(std::size_t chunk)
{
  WallSums sums{};
  for (int wall = 0; wall < 6; ++wall)
    {
      const double inward = -sign_of_wall(wall);
      for (std::uint32_t i : verlet_.near_wall(wall, chunk))
        {
          const double overlap = -wall_gap(packing_, box_, i, wall);
          const WallResponse response = overlap > 0 ? law_->wall(packing_.radius(i), overlap) : WallResponse{};
          action_[8 * i + wall / 2] += inward * response.force;
          sums.force[wall] += response.force;
          sums.stiffness[wall] += response.stiffness;
        }
    }
  wall_sums_[chunk] = sums;
}

void Assembly::sum_wall_forces()
{
  previous_wall_force_ = wall_force_;
  wall_force_.fill(0);
  wall_stiffness_sum_.fill(0);
  for (const WallSums &sums : wall_sums_) // in order of chunks
    for (int wall = 0; wall < 6; ++wall)
      {
        wall_force_[wall] += sums.force[wall];
        wall_stiffness_sum_[wall / 2] += sums.stiffness[wall];
      }
}

void Assembly::add_gravity()
{
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    for (int k = 0; k < 3; ++k)
      action_[8 * i + k] += gravity[k] * packing_.mass(i);
}

void Assembly::sum_dissipation()
{
  evaluate();
  // in pair order, so that the sums do not depend on the list either
  for (std::size_t p = 0; p < contacts_.n_lanes() && !dissipation_.sliding.empty(); ++p)
    {
      tally.sliding += dissipation_.sliding[p];
      tally.rolling += dissipation_.rolling[p];
      tally.released += dissipation_.released[p];
      tally.created += dissipation_.created[p];
    }
  sum_boundary_work();
}

void Assembly::sum_boundary_work()
{
  if (cell_)
    {
      const Mat3 before = std::exchange(virial_sum_, virial_.sum());
      tally.boundary_work -= (0.5 * (before + virial_sum_)).cwiseProduct(cell_->strain_step).sum();
      return;
    }
  for (int wall = 0; wall < 6; ++wall)
    tally.boundary_work -= 0.5 * (previous_wall_force_[wall] + wall_force_[wall]) * wall_displacement_[wall];
}

MotionReport Assembly::move_grains(double speed_limit, const AffineStep *affine)
{
  if (pending_ == Pending::contacts && n_threads() > 1) // threads were added since compute_forces()
    evaluate();
  const Partition &partition = contacts_.partition();
  const Pending pending = std::exchange(pending_, Pending::nothing);
  motion_reports_.resize(partition.n_chunks);
  for_chunks([&](std::size_t chunk) {
    // On one thread the chunks come in order. Pairs belong to their first grain, the lower one: once its chunk is
    // done, no later pair reads or pushes it, and all its ghosts are filled.
    if (pending == Pending::contacts)
      evaluate_chunk(chunk);
    if (pending != Pending::nothing)
      add_ghosts(contacts_, chunk, action_.data());
    motion_reports_[chunk] = integrate(packing_, partition.begin(chunk), partition.begin(chunk + 1), action_.data(),
                                       time_step, damping, speed_limit, measure_energy, affine);
  });
  return sum_of(motion_reports_);
}

void Assembly::move(const RigidBox &next_box)
{
  forces_known_ = false;
  const double speed_limit = explosion_step * min_radius_ / time_step;
  const MotionReport report = move_grains(speed_limit);
  if (report.exploded)
    report_explosion(speed_limit);
  tally.damping += report.damping_loss;
  double wall_step = 0;
  for (int wall = 0; wall < 6; ++wall)
    {
      const int axis = wall / 2;
      const double moved = wall % 2 ? next_box.upper[axis] - box_.upper[axis] : next_box.lower[axis] - box_.lower[axis];
      wall_displacement_[wall] = sign_of_wall(wall) * moved; // outward
      wall_step = std::max(wall_step, std::abs(moved));
    }
  max_step_ = report.max_speed * time_step + wall_step;
  box_ = next_box;
  ++step_;
  time_ += time_step;
}

void Assembly::deform(const Mat3 &displacement_gradient)
{
  const double size = displacement_gradient.norm();
  if (!(size < max_strain_step))
    throw RunFailure(
        fmt::format("step {}: a displacement gradient of {:.3g} in one time step; at most {:g} is allowed. "
                    "Divide the increment or lower the strain rate.",
                    step_, size, max_strain_step));
  forces_known_ = false;
  PeriodicCell next = *cell_; // forces that are pending belong to the cell as it still is
  const AffineStep affine(next.deform(displacement_gradient));
  const double speed_limit = explosion_step * min_radius_ / time_step;
  const MotionReport report = move_grains(speed_limit, &affine);
  if (report.exploded)
    report_explosion(speed_limit);
  tally.damping += report.damping_loss;
  max_step_ = report.max_speed * time_step + size * d_max_;
  cell_ = next;
  turn_upright();
  contacts_.set_cell(cell_->edges);
  ++step_;
  time_ += time_step;
}

void Assembly::turn_upright()
{
  const std::optional<Mat3> upright = cell_->upright_edges();
  if (!upright)
    return;
  cell_->edges = *upright;
  ++cell_->flips;
  const Mat3 to_fraction = upright->inverse();
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      const Vec3 whole = (to_fraction * packing_.centre(i)).array().floor();
      packing_.set_centre(i, packing_.centre(i) - *upright * whole);
    }
  verlet_.invalidate(); // shifts count other edges now
  verlet_.update(packing_, *cell_, 0.0, contacts_, n_threads());
}

void Assembly::report_explosion(double speed_limit) const
{
  for (std::size_t i = 0; i < packing_.n_grains(); ++i)
    {
      const double speed = packing_.linear_velocity(i).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
      if (!std::isfinite(speed) || !packing_.angular_velocity(i).allFinite())
        throw RunFailure(
            fmt::format("step {}: the velocity of grain {} is not a number. A force or the state it started "
                        "from was not one; look at the last checkpoint.",
                        step_, packing_.id[i]));
      if (speed >= speed_limit)
        throw RunFailure(fmt::format(
            "step {}: grain {} moves at {:.3g} m/s, more than {:.3g} m/s (5 % of the smallest radius per step of "
            "{:.3g} "
            "s): the packing explodes. Lower motion.time_step_safety, the strain rate or the fixed time step.",
            step_, packing_.id[i], speed, speed_limit, time_step));
    }
  throw RunFailure(fmt::format("step {}: the packing explodes", step_)); // not reached: integrate() found one
}
} // namespace isostat
