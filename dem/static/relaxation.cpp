// SPDX-License-Identifier: BSD-3-Clause
#include "dem/static/relaxation.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace isostat
{
namespace
{
constexpr std::uint64_t look_interval = 10, mass_interval = 200; ///< iterations
constexpr double iterations_of_increment = 100;
/// Contacts of its own size that a grain has at least, as far as its mass goes: one that gains a contact stays stable.
constexpr double least_contacts = 3;

/// Grains that rattle between others would do so for ever while the kinetic energy of the rest has its peaks.
constexpr double contact_damping = 0.05;
constexpr double overlap_expected = 1e-3; ///< of the radius: for laws whose stiffness grows with overlap

/// Adds `times` one contact to the sums of k over contacts that M (`normal`) and J (`rolling`) are made of.
void add(ContactStiffness &sum, const ContactStiffness &k, double r, double times)
{
  sum.normal += times * (k.normal + k.shear);
  sum.rolling += times * (k.shear * r * r + k.rolling + k.twisting);
}
} // namespace

void BalanceSpec::check() const
{
  if (!(tolerance > 0 && tolerance < 1))
    throw InputError(fmt::format("balance: tolerance = {:g}; must be in (0, 1)", tolerance));
  if (!(left_out >= 0 && left_out < 1))
    throw InputError(fmt::format("balance: left_out = {:g}; must be in [0, 1)", left_out));
}

void StaticStepping::check() const
{
  if (!(increment > 0 && increment <= 1e-3))
    throw InputError(fmt::format("increment = {:g}; must be in (0, 1e-3]", increment));
  balance.check();
}

Relaxation::Relaxation(Assembly &assembly, double increment)
    : assembly_(assembly), increment_(increment), settings_(assembly.settings), own_(assembly.inverse_inertia())
{
  assembly.settings.contact_damping = assembly.settings.damping = 0;
  assembly.settings.free_grain_damping = 1;
}

Relaxation::~Relaxation()
{
  assembly_.set_inverse_inertia(own_);
  assembly_.settings = settings_;
}

void Relaxation::follow_stiffness()
{
  const Packing &grains = assembly_.packing();
  const ContactLaw &law = assembly_.law();
  std::vector<ContactStiffness> sums(grains.n_grains(), ContactStiffness{});
  const LiveContacts contacts = assembly_.live_contacts();
  contacts.for_pairs([&](std::uint32_t i, std::uint32_t j, const Vec3 &branch, const Vec3 &) {
    const double r1 = grains.radius(i), r2 = grains.radius(j);
    const ContactStiffness k = law.stiffness(r1, r2, r1 + r2 - branch.norm());
    add(sums[i], k, r1, 1);
    add(sums[j], k, r2, 1);
  });
  contacts.for_walls([&](std::uint32_t i, int, double overlap, double) {
    sums[i].normal += law.wall(grains.radius(i), overlap).stiffness;
  });
  const double dt2 = assembly_.settings.time_step * assembly_.settings.time_step;
  std::vector<InverseInertia> inverse(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    {
      const double r = grains.radius(i);
      ContactStiffness least{};
      add(least, law.stiffness(r, r, overlap_expected * r), r, least_contacts);
      const double least_inertia = least_contacts * 1e-3 * least.normal * r * r; // of a law without friction
      inverse[i] = {1 / (dt2 * std::max(sums[i].normal, least.normal)),
                    1 / (dt2 * std::max({sums[i].rolling, least.rolling, least_inertia}))};
    }
  assembly_.set_inverse_inertia(inverse);
}

void Relaxation::hold()
{
  if (assembly_.cell())
    assembly_.deform(Mat3::Zero());
  else
    assembly_.move(assembly_.box());
  assembly_.compute_forces();
}

void Relaxation::look(Relaxed &found, const BalanceSpec &spec, const RelaxationLimits &limits) const
{
  found.balance = assembly_.balance(spec.left_out, limits.reference);
  found.balanced = found.balance.within <= spec.tolerance;
  if (found.balanced)
    return;
  if (limits.go_on && !limits.go_on())
    throw RunFailure("it was interrupted");
  if (found.steps >= limits.max_steps)
    throw RunFailure(fmt::format(
        "not in balance after {} force evaluations: {:.3g} where {:g} is allowed for all but {:g} % of {} loaded "
        "grains; grain {} is worst, {:.3g}. Take a smaller `increment` or a larger tolerance, `balance`.",
        found.steps, found.balance.within, spec.tolerance, 100 * spec.left_out, found.balance.loaded,
        found.balance.grain, found.balance.worst));
}

// Leapfrog: velocities are half a step older than forces.
double Relaxation::half_work() const { return 0.5 * assembly_.settings.time_step * assembly_.power(); }

double Relaxation::energy_of_motion() const { return assembly_.kinetic_energy() + half_work(); }

double Relaxation::stop()
{
  const double lost = energy_of_motion();
  if (assembly_.settings.measure_energy)
    assembly_.add_loss(lost);
  assembly_.stop_grains();
  return lost;
}

template <typename Move>
std::uint64_t Relaxation::spread(double strain, const Vec3 &box_strain, const Move &move)
{
  follow_stiffness();
  const bool loaded = !assembly_.stress().isZero(0);
  const double whole = std::ceil(iterations_of_increment * strain / increment_ * (1 - 1e-9));
  const std::uint64_t n = loaded && whole > 1 ? static_cast<std::uint64_t>(whole) : 1;
  if (assembly_.walls())
    {
      assembly_.set_homogeneous_motion(box_strain / (static_cast<double>(n) * assembly_.settings.time_step));
      if (assembly_.settings.measure_energy)
        assembly_.add_loss(-energy_of_motion()); // that they are given
    }
  assembly_.settings.contact_damping = contact_damping;
  for (std::uint64_t k = 1; k <= n; ++k)
    {
      assembly_.compute_forces();
      move(k, n);
    }
  assembly_.settings.contact_damping = 0;
  if (assembly_.settings.measure_energy)
    assembly_.add_loss(assembly_.kinetic_energy()); // of the masses it was gained with: run() has others
  return n;
}

std::uint64_t Relaxation::deform(const Mat3 &gradient)
{
  return spread(gradient.cwiseAbs().maxCoeff(), Vec3::Zero(),
                [&](std::uint64_t, std::uint64_t n) { assembly_.deform(gradient / static_cast<double>(n)); });
}

std::uint64_t Relaxation::move(const RigidBox &next)
{
  const RigidBox from = assembly_.box();
  const Vec3 strain = (next.edges().array() / from.edges().array()).log();
  return spread(strain.cwiseAbs().maxCoeff(), strain, [&](std::uint64_t k, std::uint64_t n) {
    const double left = static_cast<double>(n - k) / static_cast<double>(n);
    assembly_.move(k == n ? next
                          : RigidBox{next.lower + left * (from.lower - next.lower),
                                     next.upper + left * (from.upper - next.upper)});
  });
}

Relaxed Relaxation::run(const BalanceSpec &spec, const RelaxationLimits &limits)
{
  if (assembly_.settings.measure_energy)
    assembly_.add_loss(half_work()); // the rest of what spread() has lost
  assembly_.stop_grains();
  follow_stiffness();
  Relaxed found;
  std::uint64_t followed = 0; ///< when masses were made last
  look(found, spec, limits);  // the last part of a move has no dashpots
  assembly_.settings.contact_damping = contact_damping;
  for (; !found.balanced; ++found.steps)
    {
      if (!(assembly_.power() > 0))
        {
          found.lost += stop();
          if (found.steps >= followed + mass_interval)
            follow_stiffness(), followed = found.steps;
        }
      hold();
      if ((found.steps + 1) % look_interval == 0)
        look(found, spec, limits);
    }
  found.lost += stop();
  assembly_.settings.contact_damping = 0;
  return found;
}
} // namespace isostat
