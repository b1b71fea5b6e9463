// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/plausible.hpp"

#include "apps/deposit/formula_soil.hpp"
#include "apps/deposit/resistance.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// V_s in situ in the middle of each layer, m/s; 0: its material does not say.
std::vector<double> velocities_in_situ(const ColumnScene &scene)
{
  std::vector<double> velocities;
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      const ColumnLayer &layer = scene.layers[k];
      const auto moduli = layer.from_formula() ? moduli_at(layer, middle_stress(scene, k)) : std::nullopt;
      velocities.push_back(moduli ? std::sqrt(moduli->s / layer.density) : 0);
    }
  return velocities;
}
} // namespace

std::string quoted_name(const Layer &layer) { return layer.name.empty() ? "" : " (" + layer.name + ")"; }

std::vector<std::string> profile_warnings(const ColumnScene &scene)
{
  constexpr double softest = 30, stiffest = 1500, inversion = 3; // m/s, m/s, of neighbours
  std::vector<std::string> warnings;
  const bool stacked = !scene.mesh.given; // else layers lie anywhere
  const std::vector<double> velocities = velocities_in_situ(scene);
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      const ColumnLayer &layer = scene.layers[k];
      if (!layer.from_formula())
        continue;
      const double given = std::sqrt(layer.small_strain_modulus() / layer.density);
      if (given < softest || given > stiffest)
        warnings.push_back(
            fmt::format("layer.{}.{} gives layer.{}{} a shear-wave velocity of {:.4g} m/s; of soil it is "
                        "{:g} to {:g} m/s. Check its value and unit.",
                        k, layer.shear_modulus ? "shear_modulus" : "shear_velocity", k, quoted_name(layer), given,
                        softest, stiffest));
      if (stacked && k > 0 && velocities[k] > 0 && velocities[k - 1] > inversion * velocities[k])
        warnings.push_back(fmt::format("the shear wave is {:.1f} times as fast in layer.{}{} as in layer.{}{} below it "
                                       "({:.4g} and {:.4g} m/s in situ); usual is at most {:g} times. Check both.",
                                       velocities[k - 1] / velocities[k], k - 1, quoted_name(scene.layers[k - 1]), k,
                                       quoted_name(layer), velocities[k - 1], velocities[k], inversion));
    }
  if (stacked && scene.base.compliant() && scene.base.shear_velocity < velocities.back())
    warnings.push_back(
        fmt::format("base.shear_velocity = {:.4g} m/s is below that of the layer above it, {:.4g} m/s in "
                    "situ{}; rock is stiffer than soil. Check both.",
                    scene.base.shear_velocity, velocities.back(), quoted_name(scene.layers.back())));
  return warnings;
}

std::vector<std::string> motion_size_warnings(const ColumnScene &scene, const std::array<Motion, 3> &motions)
{
  constexpr double strongest = 3; // g
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < scene.motions.size(); ++k)
    {
      const ColumnMotion &asked = scene.motions[k];
      const Motion &motion = motions[static_cast<std::size_t>(asked.axis)];
      const double peak = motion.peak() / standard_gravity, frequency = scene.analysis.highest_frequency,
                   highest = 1 / (2 * motion.interval());
      if (peak > strongest)
        warnings.push_back(
            fmt::format("motion.{} has a peak of {:.3g} g; of ground motions it is below {:g} g. Check {}.", k, peak,
                        strongest, asked.kind == MotionKind::record ? "its unit, factor or peak" : "its amplitude"));
      if (asked.kind == MotionKind::record && highest < frequency * (1 - 1e-6))
        warnings.push_back(
            fmt::format("motion.{} is a record with samples {:.4g} s apart, which has nothing above {:.3g} "
                        "Hz; analysis.highest_frequency is {:g} Hz. Set that to {:.3g} Hz, or give a "
                        "record with finer samples.",
                        k, motion.interval(), highest, frequency, highest));
    }
  return warnings;
}
} // namespace isostat
