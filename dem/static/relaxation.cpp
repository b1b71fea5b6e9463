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
constexpr std::uint64_t look_interval = 10, mass_interval = 200;
/// Contacts of its own size that a grain has at least, as far as its mass goes: one that gains a contact stays stable.
constexpr double least_contacts = 3;

/// Gives an assembly fictitious masses and no damping but that of grains without a force, as long as it lives.
class WithoutInertia
{
public:
  explicit WithoutInertia(Assembly &assembly)
      : assembly_(assembly), settings_(assembly.settings), own_(assembly.inverse_inertia())
  {
    follow_stiffness();
    assembly.settings.contact_damping = assembly.settings.damping = 0;
    assembly.settings.free_grain_damping = 1;
  }
  ~WithoutInertia()
  {
    assembly_.stop_grains();
    assembly_.set_inverse_inertia(own_);
    assembly_.settings = settings_;
  }
  WithoutInertia(const WithoutInertia &) = delete;
  WithoutInertia &operator=(const WithoutInertia &) = delete;

  /// M_i and J_i of the contacts as they are.
  void follow_stiffness()
  {
    const Packing &grains = assembly_.packing();
    const ContactLaw &law = assembly_.law();
    std::vector<ContactStiffness> sums(grains.n_grains(), ContactStiffness{});
    const auto add = [&](std::size_t i, const ContactStiffness &k, double times) {
      const double r = grains.radius(i);
      sums[i].normal += times * (k.normal + k.shear);
      sums[i].rolling += times * (k.shear * r * r + k.rolling + k.twisting);
    };
    assembly_.live_contacts().for_pairs([&](std::uint32_t i, std::uint32_t j, const Vec3 &branch, const Vec3 &) {
      const double r1 = grains.radius(i), r2 = grains.radius(j);
      const ContactStiffness k = law.stiffness(r1, r2, r1 + r2 - branch.norm());
      add(i, k, 1);
      add(j, k, 1);
    });
    const double dt2 = assembly_.settings.time_step * assembly_.settings.time_step;
    std::vector<InverseInertia> inverse(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
      {
        const ContactStiffness found = std::exchange(sums[i], ContactStiffness{});
        const double r = grains.radius(i);
        add(i, law.stiffness(r, r, overlap_expected * r), least_contacts);
        const double least_inertia = least_contacts * 1e-3 * sums[i].normal * r * r; // of a law without friction
        inverse[i] = {1 / (dt2 * std::max(found.normal, sums[i].normal)),
                      1 / (dt2 * std::max({found.rolling, sums[i].rolling, least_inertia}))};
      }
    assembly_.set_inverse_inertia(inverse);
  }

private:
  static constexpr double overlap_expected = 1e-3; ///< of the radius: for laws whose stiffness grows with overlap

  Assembly &assembly_;
  StepSettings settings_;
  std::vector<InverseInertia> own_;
};
} // namespace

void BalanceSpec::check() const
{
  if (!(tolerance > 0 && tolerance < 1))
    throw InputError(fmt::format("balance: tolerance = {:g}; must be in (0, 1)", tolerance));
  if (!(left_out >= 0 && left_out < 1))
    throw InputError(fmt::format("balance: left_out = {:g}; must be in [0, 1)", left_out));
}

Relaxed relax(Assembly &assembly, const Mat3 &displacement_gradient, const BalanceSpec &spec,
              const RelaxationLimits &limits)
{
  Relaxed found;
  WithoutInertia scope(assembly);
  assembly.stop_grains();
  for (Mat3 gradient = displacement_gradient;; gradient.setZero())
    {
      if (found.steps == 1 || (found.steps > 0 && found.steps % look_interval == 0))
        {
          found.balance = assembly.balance(spec.left_out);
          if (found.balance.within <= spec.tolerance)
            return found;
          if (limits.go_on && !limits.go_on())
            throw RunFailure("it was interrupted");
          if (found.steps >= limits.max_steps)
            throw RunFailure(
                fmt::format("not in balance after {} force evaluations: {:.3g} where {:g} is allowed for all but {:g} "
                            "% of {} loaded "
                            "grains; grain {} is worst, {:.3g}. Take a smaller increment, or a larger tolerance.",
                            found.steps, found.balance.within, spec.tolerance, 100 * spec.left_out,
                            found.balance.loaded, found.balance.grain, found.balance.worst));
          if (found.steps % mass_interval == 0)
            scope.follow_stiffness();
        }
      if (!(assembly.power() > 0))
        assembly.stop_grains();
      assembly.deform(gradient);
      assembly.compute_forces();
      ++found.steps;
    }
}
} // namespace isostat
