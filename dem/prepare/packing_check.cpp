// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/packing_check.hpp"

#include "base/error.hpp"
#include "dem/domain/lattice.hpp"
#include "dem/neighbours/cell_grid.hpp"
#include "dem/neighbours/periodic_grid.hpp"
#include "dem/scene/scene.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double remarkable = 0.05; // overlap of a radius that deserves a warning

void look_at_pairs(const Snapshot &s, PackingFigures &f)
{
  std::vector<ContactList::Pair> pairs;
  std::vector<ImageCode> images;
  if (!s.cell)
    pairs = find_pairs(s.grains, 0.0);
  else if (f.overlaps_known = shortest_period(s.cell->edges) > 2.005 * max_reach(s.grains); f.overlaps_known)
    std::tie(pairs, images) = find_pairs(s.grains, s.cell->edges, 0.0);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    {
      const auto [i, j] = pairs[k];
      Vec3 branch = s.grains.centre(j) - s.grains.centre(i);
      if (s.cell)
        branch += s.cell->edges * image_shift(images[k]).cast<double>();
      const double r1 = s.grains.radius(i), r2 = s.grains.radius(j);
      const double overlap = (r1 + r2 - branch.norm()) / std::min(r1, r2);
      f.n_deep += overlap > too_deep;
      if (overlap > f.overlap)
        {
          f.overlap = overlap;
          f.first = s.grains.id[i];
          f.second = s.grains.id[j];
        }
    }
}

void look_at_walls(const Snapshot &s, PackingFigures &f)
{
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    for (int wall = 0; wall < 6; ++wall)
      if (const double beyond = -wall_gap(s.grains, s.box, i, wall) / s.grains.radius(i); beyond > f.beyond_wall)
        {
          f.beyond_wall = beyond;
          f.outermost = s.grains.id[i];
        }
}

/// Whether the spheres fill less than half of the box along some axis.
bool is_roomy(const Snapshot &s)
{
  Vec3 low = s.grains.centre(0), high = low;
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    {
      low = low.cwiseMin(s.grains.centre(i) - Vec3::Constant(s.grains.radius(i)));
      high = high.cwiseMax(s.grains.centre(i) + Vec3::Constant(s.grains.radius(i)));
    }
  return ((high - low).array() < 0.5 * s.box.edges().array()).any();
}
/// That of lengths read as metres, if grains of soil are meant.
std::string likely_unit(double r_max) { return 1e-3 * r_max <= largest_radius_of_file ? "mm" : "um"; }
} // namespace

PackingFigures packing_figures(const Snapshot &s)
{
  PackingFigures f;
  f.n_grains = s.grains.n_grains();
  f.d50 = s.grains.d50();
  f.smallest = 2 * s.grains.min_radius();
  f.largest = 2 * s.grains.max_radius();
  f.edges = s.cell ? Vec3(s.cell->edges.colwise().norm().transpose()) : s.box.edges();
  f.void_ratio = void_ratio(s.volume(), s.grains.solid_volume());
  look_at_pairs(s, f);
  if (!s.cell)
    look_at_walls(s, f);
  return f;
}

std::string figures_text(const PackingFigures &f, const Snapshot &s)
{
  const bool leans = s.cell && !Mat3(s.cell->edges).isDiagonal(1e-12);
  const std::string overlap =
      !f.overlaps_known ? "not checked: the cell repeats itself within two of its grains"
      : f.overlap > 0   ? fmt::format("{:.3g} % of the radius, grains {} and {}", 100 * f.overlap, f.first, f.second)
                        : "none";
  return fmt::format("  grains           {}\n  d50              {:.4g} mm\n  diameters        {:.4g} to {:.4g} mm\n"
                     "  grain density    {:.6g} kg/m3\n  {:<17}{:.6g} x {:.6g} x {:.6g} mm{}\n  void ratio       "
                     "{:.4f}\n  largest overlap  {}\n",
                     f.n_grains, 1e3 * f.d50, 1e3 * f.smallest, 1e3 * f.largest, s.grains.density,
                     s.cell ? "periodic cell" : "box", 1e3 * f.edges[0], 1e3 * f.edges[1], 1e3 * f.edges[2],
                     leans ? ", leaning" : "", f.void_ratio, overlap);
}

std::vector<std::string> check_packing(const Snapshot &s, const std::string &file, const ScalingRemedy &remedy,
                                       double largest)
{
  const double r_max = s.grains.max_radius();
  if (r_max > largest)
    throw InputError(fmt::format(
        "{}: the largest radius is {:.4g} m; expected at most {} m for soil. "
        "Are its lengths in {}? If so, {}.{}",
        file, r_max, largest, likely_unit(r_max), remedy(likely_unit(r_max)),
        largest < largest_radius
            ? fmt::format(" If they are in m, {}: radii up to {} m are then allowed.", remedy("m"), largest_radius)
            : ""));
  if (r_max < smallest_radius)
    throw InputError(
        fmt::format("{}: the largest radius is {:.4g} m; expected at least {} m, because smaller grains are "
                    "clay. Were lengths scaled that are in m already, or in another unit? If in mm, {}.",
                    file, r_max, smallest_radius, remedy("mm")));
  if (s.grains.density < lightest_grains || s.grains.density > heaviest_grains)
    throw InputError(fmt::format("{}: the grain density is {:g} kg/m3; expected {:g} to {:g} kg/m3, such as 2650 for "
                                 "quartz. Is it, or are masses and lengths, in another unit? Correct it there, in SI.",
                                 file, s.grains.density, lightest_grains, heaviest_grains));
  const PackingFigures f = packing_figures(s);
  if (f.overlap > too_deep)
    throw InputError(
        fmt::format("{}: grains {} and {} overlap by {:.3g} % of the smaller radius ({} pairs by more than {} "
                    "%); expected less, because contacts of spheres are small. Are the radii diameters, or "
                    "in another unit than the positions?",
                    file, f.first, f.second, 100 * f.overlap, f.n_deep, 100 * too_deep));
  if (f.beyond_wall > too_deep)
    throw InputError(
        fmt::format("{}: grain {} reaches beyond a wall of the box by {:.3g} % of its radius; expected at most "
                    "{} %. Is it the box of this packing, in the unit of the positions?",
                    file, f.outermost, 100 * f.beyond_wall, 100 * too_deep));
  std::vector<std::string> warnings;
  if (f.overlap > remarkable)
    warnings.push_back(
        fmt::format("Grains {} and {} overlap by {:.3g} % of the smaller radius: the packing will fly apart "
                    "unless its contacts are that soft.",
                    f.first, f.second, 100 * f.overlap));
  if (!s.cell && is_roomy(s))
    warnings.emplace_back(
        "The box is more than twice as wide as the packing in it: walls of other codes are often inside "
        "the simulation box. Correct the box if they do.");
  return warnings;
}
} // namespace isostat
