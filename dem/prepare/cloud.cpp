// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/cloud.hpp"

#include "base/error.hpp"
#include "dem/prepare/grading.hpp"
#include "dem/prepare/random.hpp"
#include "dem/prepare/space_filling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace isostat
{
namespace
{
constexpr std::uint64_t max_attempts = 100'000; // per grain

/// The spheres placed so far, found through a uniform grid of about one cell per grain. A sphere is listed in every
/// cell its bounding box meets, so a new sphere looks only at the cells that its own box meets: as the new one is the
/// smallest yet, these are few however wide the grading is.
class PlacedSpheres
{
public:
  PlacedSpheres(double edge, std::size_t n_expected)
      : n_cells(std::clamp<std::size_t>(static_cast<std::size_t>(std::cbrt(static_cast<double>(n_expected))), 1, 512)),
        cells_per_metre(static_cast<double>(n_cells) / edge), cells(n_cells * n_cells * n_cells)
  {
    centres.reserve(n_expected);
    radii.reserve(n_expected);
  }

  bool overlaps(const Vec3 &centre, double radius) const
  {
    return any_cell(centre, radius, [&](std::size_t cell) {
      return std::any_of(cells[cell].begin(), cells[cell].end(), [&](std::uint32_t j) {
        const double reach = radius + radii[j];
        return (centres[j] - centre).squaredNorm() <= reach * reach;
      });
    });
  }

  void add(const Vec3 &centre, double radius)
  {
    const auto index = static_cast<std::uint32_t>(centres.size());
    centres.push_back(centre);
    radii.push_back(radius);
    any_cell(centre, radius, [&](std::size_t cell) {
      cells[cell].push_back(index);
      return false;
    });
  }

  const std::vector<Vec3> &all_centres() const { return centres; }

private:
  std::size_t cell_of(double coordinate) const
  {
    const double cell = std::clamp(coordinate * cells_per_metre, 0.0, static_cast<double>(n_cells - 1));
    return static_cast<std::size_t>(cell);
  }

  /// Calls visit(cell) for the cells the sphere's bounding box meets until one call returns true.
  template <typename Visit>
  bool any_cell(const Vec3 &centre, double radius, const Visit &visit) const
  {
    std::array<std::size_t, 3> first, last;
    for (int k = 0; k < 3; ++k)
      {
        first[k] = cell_of(centre[k] - radius);
        last[k] = cell_of(centre[k] + radius);
      }
    for (std::size_t z = first[2]; z <= last[2]; ++z)
      for (std::size_t y = first[1]; y <= last[1]; ++y)
        for (std::size_t x = first[0]; x <= last[0]; ++x)
          if (visit((z * n_cells + y) * n_cells + x))
            return true;
    return false;
  }

  std::size_t n_cells; // per axis
  double cells_per_metre;
  std::vector<std::vector<std::uint32_t>> cells;
  std::vector<Vec3> centres;
  std::vector<double> radii;
};

void check(const GradingSpec &spec)
{
  if (spec.grains == 0 || spec.grains > std::numeric_limits<std::uint32_t>::max())
    throw InputError(fmt::format(
        "grading.grains = {}; must be in [1, 4294967295] because a grain's number has 32 bits.", spec.grains));
  if (!(spec.cloud_edge > 0) || !std::isfinite(spec.cloud_edge))
    throw InputError(fmt::format("grading.cloud_edge = {:g} m; must be positive because it is the edge of a cube.",
                                 spec.cloud_edge));
  if (spec.d50 && (!(*spec.d50 > 0) || !std::isfinite(*spec.d50)))
    throw InputError(fmt::format("grading.d50 = {:g} m; must be positive because it is a diameter.", *spec.d50));
  if (!(spec.solid_fraction > 0 && spec.solid_fraction < 1))
    throw InputError(fmt::format("grading.solid_fraction = {:g}; must be in (0, 1) because it is solid volume over box "
                                 "volume. Random placement jams near 0.5 at the latest; the default is 0.33.",
                                 spec.solid_fraction));
  if (!(spec.density > 0) || !std::isfinite(spec.density))
    throw InputError(fmt::format("grading.density = {:g} kg/m3; must be positive because grains have mass. Quartz sand "
                                 "has 2650 kg/m3.",
                                 spec.density));
}

/// How large the cube is, and the grains in it.
struct CloudSize
{
  double edge;      ///< m
  double upscaling; ///< diameter in the cloud / diameter of the grading
};

CloudSize cloud_size(const GradingSpec &spec, const std::vector<double> &diameters)
{
  const auto cube = [](double x) { return x * x * x; };
  if (!spec.d50)
    return {spec.cloud_edge, upscaling_factor(diameters, spec.solid_fraction * cube(spec.cloud_edge))};
  const double upscaling = *spec.d50 / median_by_volume(diameters);
  double solid = 0;
  for (const double d : diameters)
    solid += std::numbers::pi / 6 * cube(upscaling * d);
  return {std::cbrt(solid / spec.solid_fraction), upscaling};
}

/// Centres of spheres in the cube 0 ... edge, in the order of `radii` (decreasing), up to the one that finds no place.
std::vector<Vec3> placed_at_random(const std::vector<double> &radii, double edge, std::uint64_t seed)
{
  PlacedSpheres placed(edge, radii.size());
  for (std::size_t grain = 0; grain < radii.size(); ++grain)
    {
      const double radius = radii[grain], upper = edge - radius;
      Vec3 centre;
      std::uint64_t attempt = 0;
      do
        {
          if (attempt == max_attempts)
            return placed.all_centres();
          const auto u = uniform(seed, RandomStream::cloud, grain, attempt++);
          for (int k = 0; k < 3; ++k)
            centre[k] = std::min(radius + u[k] * (upper - radius), upper);
        }
      while (placed.overlaps(centre, radius));
      placed.add(centre, radius);
    }
  return placed.all_centres();
}

/// What helps where a cloud is too dense: few grains are placed at lower fractions until there is room for all.
std::string remedy(const std::vector<double> &radii, double edge, const GradingSpec &spec)
{
  constexpr std::size_t few = 1000;
  for (int percent = static_cast<int>(100 * spec.solid_fraction); radii.size() <= few && --percent > 0;)
    if (const double fraction = percent / 100.0;
        placed_at_random(radii, edge * std::cbrt(spec.solid_fraction / fraction), spec.seed).size() == radii.size())
      return fmt::format("There is room at grading.solid_fraction = {:g}. More grains, a narrower grading or another "
                         "seed may help, too: the faces of the cube keep some room from few grains.",
                         fraction);
  return "Lower grading.solid_fraction, take a narrower grading, or try another seed.";
}

[[noreturn]] void refuse(const std::vector<double> &radii, std::size_t n_placed, double edge, const GradingSpec &spec)
{
  throw RunFailure(fmt::format("cloud: grain {} of {} (diameter {:.3g} m) found no free place in {} attempts at "
                               "grading.solid_fraction = {:g}. {}",
                               n_placed + 1, radii.size(), 2 * radii[n_placed], max_attempts, spec.solid_fraction,
                               remedy(radii, edge, spec)));
}
} // namespace

Cloud make_cloud(const GradingSpec &spec)
{
  check(spec);
  const std::vector<double> diameters = sample_diameters(grading_curve(spec), spec.grains);
  const CloudSize size = cloud_size(spec, diameters);
  Cloud cloud;
  cloud.box = {Vec3::Zero(), Vec3::Constant(size.edge)};
  cloud.upscaling = size.upscaling;
  cloud.seed = spec.seed;
  std::vector<double> radii(diameters.size());
  for (std::size_t i = 0; i < radii.size(); ++i)
    radii[i] = 0.5 * cloud.upscaling * diameters[i];
  if (!(2 * radii.front() < size.edge))
    throw InputError(fmt::format("grading.grains = {} at solid_fraction = {:g}: the largest grain, {:.3g} m, is wider "
                                 "than the cube of the cloud, {:g} m. Take more grains or a lower solid_fraction.",
                                 spec.grains, spec.solid_fraction, 2 * radii.front(), size.edge));

  const std::vector<Vec3> centres = placed_at_random(radii, size.edge, spec.seed);
  if (centres.size() < radii.size())
    refuse(radii, centres.size(), size.edge, spec);
  const std::vector<std::uint32_t> order = morton_order(centres);
  std::vector<Vec3> stored_centres(order.size());
  std::vector<double> stored_radii(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    {
      stored_centres[i] = centres[order[i]];
      stored_radii[i] = radii[order[i]];
    }
  cloud.packing = make_packing(stored_centres, stored_radii, spec.density);
  cloud.packing.id = order;
  return cloud;
}
} // namespace isostat
