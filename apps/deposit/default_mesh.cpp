// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/default_mesh.hpp"

#include "apps/deposit/formula_soil.hpp"
#include "base/scene/document.hpp"
#include "fem/motion/low_pass.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double most_cells = 1e6; // of a layer

bool is_nonlinear(const ColumnLayer &layer) { return layer.material != LayerMaterial::elastic; }

/// Share of a motion's squared acceleration above a frequency.
double share_above(const Motion &motion, double frequency)
{
  LowPass filter(frequency, motion.interval());
  double all = 0, low = 0;
  for (double a : motion.accelerations())
    {
      const double below = filter(a);
      all += a * a;
      low += below * below;
    }
  return all > 0 ? 1 - low / all : 0;
}

/// Height of an element whose middle is at z, m.
double allowed_height(const ColumnScene &scene, const ColumnLayer &layer, double z, double frequency)
{
  const double softening = is_nonlinear(layer) ? 0.4 : 1, highest = is_nonlinear(layer) ? 1 : 2;
  const std::optional<WaveModuli> moduli = moduli_in_situ(scene, layer, z);
  const double velocity = std::sqrt((moduli ? moduli->s : layer.small_strain_modulus()) / layer.density);
  return std::min(scene.mesh.degree * softening * velocity / (nodes_per_wave * frequency), highest);
}

/// @param top  height of the top of the layer, m
double fewest_cells(const ColumnScene &scene, const ColumnLayer &layer, double top, double frequency)
{
  double n = 0, needed = 1;
  while (needed > n && needed <= most_cells)
    {
      n = needed;
      const double height = allowed_height(scene, layer, top - layer.thickness / (2 * n), frequency);
      needed = std::ceil(layer.thickness / height * (1 - 1e-12)); // as Layer::n_cells()
    }
  return std::max(n, needed);
}

/// At least as many cells, so that a water table within the layer is between two of them.
/// @param top  depth of the layer, m
double cells_at_table(const SceneDocument &document, const ColumnScene &scene, std::size_t k, double top, double fewest)
{
  constexpr double near = 1e-6; // of a cell
  const double part = (scene.water.table - top) / scene.layers[k].thickness;
  if (scene.water.table == 0 || !(part > near && part < 1 - near))
    return fewest;
  for (double n = fewest; n <= 4 * fewest; ++n)
    if (std::abs(n * part - std::round(n * part)) < near)
      return n;
  document.refuse(
      "water.table",
      fmt::format("is within layer.{}, but not on a boundary between elements of equal height, up to {:.0f} "
                  "of them. End a layer at the table, or give layer.{}.cells.",
                  k, 4 * fewest, k));
}
} // namespace

double highest_frequency(const Motion &motion, double limit)
{
  constexpr double share = 0.01;
  if (motion.at_rest())
    return 0;
  if (share_above(motion, limit) > share)
    return limit;
  double low = 0, high = limit;
  for (int k = 0; k < 40; ++k)
    {
      const double middle = (low + high) / 2;
      (share_above(motion, middle) > share ? low : high) = middle;
    }
  return high;
}

double frequency_of_waves(const ColumnScene &scene, const ColumnLayer &layer, const std::array<Motion, 3> &motions)
{
  constexpr double harmonics = 5;
  const double limit = scene.analysis.highest_frequency;
  const double input = std::max(highest_frequency(motions[0], limit), highest_frequency(motions[1], limit));
  return input > 0 ? std::min(limit, is_nonlinear(layer) ? harmonics * input : input) : limit;
}

bool may_choose_cells(const ColumnScene &scene, const ColumnLayer &layer)
{
  return scene.analysis.kind == AnalysisKind::dynamic && layer.from_formula();
}

void choose_cells(const SceneDocument &document, ColumnScene &scene, const std::array<Motion, 3> &motions)
{
  double depth = 0; // of the top of the layer
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      ColumnLayer &layer = scene.layers[k];
      const double top = depth;
      depth += layer.thickness;
      if (layer.n_cells() > 0)
        continue;
      const double frequency = frequency_of_waves(scene, layer, motions);
      const double n = fewest_cells(scene, layer, scene.height() - top, frequency);
      if (!(n <= most_cells))
        document.refuse(fmt::format("layer.{}", k),
                        fmt::format("needs more than {:.0f} cells to carry waves of {:g} Hz. Give a larger stiffness, "
                                    "a lower analysis.highest_frequency, or cells.",
                                    most_cells, frequency));
      layer.cells = static_cast<unsigned>(cells_at_table(document, scene, k, top, n));
    }
}
} // namespace isostat
