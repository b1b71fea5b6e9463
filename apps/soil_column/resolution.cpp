// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/resolution.hpp"

#include "apps/deposit/layer_curve.hpp"
#include "apps/deposit/plausible.hpp"
#include "apps/deposit/resistance.hpp"
#include "dem/prepare/relative_density.hpp"
#include "fem/water/drainage.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <mpi.h>
#include <numbers>
#include <span>

namespace isostat
{
namespace
{
/// Of the elements of a box, in which waves run in all directions; 0: they run along z, or the mesh is of a file, whose
/// elements are about as wide as high.
double width_of_elements(const ColumnScene &scene)
{
  return scene.mesh.sides == Sides::tied || scene.mesh.given ? 0 : scene.mesh.width / scene.mesh.cells_across;
}

/// The longer side of the elements of a layer, m.
double length_of_elements(const ColumnScene &scene, std::size_t layer)
{
  return std::max(scene.layers[layer].thickness / scene.layers[layer].n_cells(), width_of_elements(scene));
}

/// The same of one that [[refine]] has halved, by its corners.
double length_of_element(const ColumnScene &scene, const CellTables &mesh, std::size_t cell)
{
  if (scene.refine.empty())
    return length_of_elements(scene, mesh.cell_layer[cell]);
  const std::size_t n = mesh.corner.size() / mesh.n_cells();
  double longest = 0;
  for (const int axis : {0, 1, 2})
    {
      const auto [low, high] = std::ranges::minmax(std::span(&mesh.corner[cell * n], n), {},
                                                   [axis](const Place &corner) { return corner[axis]; });
      if (axis == 2 || width_of_elements(scene) > 0)
        longest = std::max(longest, high[axis] - low[axis]);
    }
  return longest;
}

struct SlowCell
{
  double velocity = std::numeric_limits<double>::max(); ///< of the shear wave, by its mean slowness, m/s
  double length = 1;                                    ///< m
};

/// The cell of each layer that carries least: the one with the lowest velocity over length.
std::vector<SlowCell> slowest_cells(const ColumnScene &scene, const std::vector<double> &velocities,
                                    const CellTables &mesh)
{
  std::vector<SlowCell> slowest(scene.layers.size());
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
    {
      const std::size_t n = mesh.points_per_cell();
      double slowness = 0;
      for (std::size_t point = cell * n; point < (cell + 1) * n; ++point)
        slowness += 1 / (velocities[point] * static_cast<double>(n));
      const double length = length_of_element(scene, mesh, cell);
      SlowCell &least = slowest[mesh.cell_layer[cell]];
      if (1 / slowness / length < least.velocity / least.length)
        least = {1 / slowness, length};
    }
  for (SlowCell &least : slowest)
    {
      double ratio = least.velocity / least.length;
      MPI_Allreduce(MPI_IN_PLACE, &ratio, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
      double of_least[2] = {least.velocity, least.length};
      if (least.velocity / least.length > ratio)
        of_least[0] = of_least[1] = std::numeric_limits<double>::max();
      MPI_Allreduce(MPI_IN_PLACE, of_least, 2, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
      least = {of_least[0], of_least[1]};
    }
  return slowest;
}

/// The highest frequency of the horizontal motions that is of interest, Hz; 0: nothing moves.
double frequency_of_interest(const ColumnScene &scene, const std::array<Motion, 3> &motions)
{
  const double limit = scene.analysis.highest_frequency;
  return std::max(highest_frequency(motions[0], limit), highest_frequency(motions[1], limit));
}

/// Time of the last sample that is not 0, s.
double end_of_shaking(const Motion &motion)
{
  const std::vector<double> &a = motion.accelerations();
  const auto last = std::find_if(a.rbegin(), a.rend(), [](double value) { return value != 0; });
  return motion.duration() - static_cast<double>(last - a.rbegin()) * motion.interval();
}

/// Whether a motion that ends with a velocity has gone far, or very far without; a sine, whose velocity may be 0 at its
/// end all the same, four times as far as its amplitude A/omega^2 (one cycle: 2 pi).
bool drifts(const Motion &motion, const ColumnMotion &asked)
{
  constexpr double share = 0.05, far = 0.3, very_far = 10; // of the largest velocity, m, m
  const double end = motion.duration(), way = std::abs(motion.displacement(end));
  if (asked.kind == MotionKind::harmonic)
    return way > 4 * motion.peak() / std::pow(2 * std::numbers::pi * asked.frequency, 2);
  double fastest = 0;
  for (std::size_t i = 0; i < motion.accelerations().size(); ++i)
    fastest = std::max(fastest, std::abs(motion.velocity(motion.delay() + static_cast<double>(i) * motion.interval())));
  return way > very_far || (way > far && std::abs(motion.velocity(end)) > share * fastest);
}

/// What makes the elements of a layer smaller.
std::string size_of_elements(const ColumnScene &scene, std::size_t layer)
{
  return scene.mesh.given ? "the size of its elements in the mesh" : fmt::format("layer.{}.cell_size", layer);
}

/// What is wrong with cells that are too high for the skin of a harmonic load (drainage_bound()).
std::string coarse_skin(const ColumnScene &scene, const DrainageBound &bound)
{
  const double skin = std::sqrt(bound.coefficient / (std::numbers::pi * scene.load.frequency));
  if (bound.cell <= cells_per_skin * skin)
    return "";
  const ColumnLayer &layer = scene.layers[bound.layer];
  return fmt::format(
      "the cells of layer.{}{} where water drains, {:.3g} m high, do not show the skin in which a load of {:g} Hz "
      "moves the water there: sqrt(2 c/omega) = {:.3g} m (c = {:.3g} m2/s), and pore pressures are within 2 % only "
      "with cells of {:.2f} of it. Set {} to {:.2g} m or less, or disregard pore pressures within "
      "three cells, {:.3g} m, of where water drains.",
      bound.layer, quoted_name(layer), bound.cell, scene.load.frequency, skin, bound.coefficient, cells_per_skin,
      size_of_elements(scene, bound.layer), cells_per_skin * skin, 3 * bound.cell);
}
} // namespace

std::vector<std::string> motion_warnings(const ColumnScene &scene, const std::array<Motion, 3> &motions)
{
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < scene.motions.size(); ++k)
    {
      const ColumnMotion &asked = scene.motions[k];
      const Motion &motion = motions[static_cast<std::size_t>(asked.axis)];
      const char axis = "xyz"[static_cast<std::size_t>(asked.axis)];
      const double end = end_of_shaking(motion);
      if (end > scene.analysis.duration + motion.interval())
        warnings.push_back(fmt::format("the analysis ends at {:.4g} s, before the motion along {}, which lasts until "
                                       "{:.4g} s. Set analysis.duration to that or more to include all of it.",
                                       scene.analysis.duration, axis, end));
      if (drifts(motion, asked))
        warnings.push_back(fmt::format(
            "the motion along {} ends {:.3g} m from where it began, with {:.3g} m/s: its baseline drifts. {}", axis,
            std::abs(motion.displacement(motion.duration())), motion.velocity(motion.duration()),
            asked.kind == MotionKind::harmonic ? fmt::format("Set motion.{}.ramp to a few periods.", k)
            : asked.baseline == Baseline::none
                ? fmt::format("Set motion.{}.baseline = \"quadratic\", or give a record that was filtered by "
                              "a high-pass.",
                              k)
                : "Give a record that was filtered by a high-pass."));
      if (std::abs(motion.origin()) > 1.5 * motion.interval() && motion.delay() == 0)
        warnings.push_back(
            fmt::format("the record along {} begins at {:.4g} s of its own times, and the analysis begins "
                        "there. Add {:.4g} s to times of the results to compare them with the record.",
                        axis, motion.origin(), motion.origin()));
    }
  return warnings;
}

std::vector<double> shear_velocities(const ColumnScene &scene, const Material &material, const CellTables &mesh)
{
  std::vector<WaveModuli> moduli(material.n_points());
  material.wave_moduli(moduli);
  std::vector<double> velocities;
  std::vector<double> shares;
  for (const ColumnLayer &layer : scene.layers)
    shares.push_back(one_hertz_share(layer));
  for (std::size_t point = 0; point < moduli.size(); ++point)
    {
      const std::size_t layer = mesh.cell_layer[point / mesh.points_per_cell()];
      velocities.push_back(std::sqrt(shares[layer] * moduli[point].s / scene.layers[layer].density));
    }
  return velocities;
}

std::vector<CarriedWaves> carried_waves(const ColumnScene &scene, const std::vector<double> &velocities,
                                        const std::vector<double> &softened, const CellTables &mesh)
{
  const std::vector<SlowCell> start = slowest_cells(scene, velocities, mesh),
                              end = softened.empty() ? std::vector<SlowCell>() : slowest_cells(scene, softened, mesh);
  const auto carried = [&](const SlowCell &cell) {
    return cell.velocity * (scene.mesh.degree / (nodes_per_wave * cell.length));
  };
  std::vector<CarriedWaves> waves;
  for (std::size_t k = 0; k < start.size(); ++k)
    {
      waves.push_back({start[k].length, carried(start[k]), {}});
      if (!end.empty())
        waves.back().softened = carried(end[k]);
    }
  return waves;
}

std::vector<double> softened_velocities(const ColumnScene &scene, std::vector<double> velocities,
                                        const CellTables &mesh, const ColumnLine &line, const ColumnPeaks &peaks)
{
  for (std::size_t k = 0; k < line.points.size(); ++k)
    if (const std::size_t q = line.points[k]; peaks.line_secant[k] > 0)
      velocities[q] =
          std::min(velocities[q],
                   std::sqrt(peaks.line_secant[k] / scene.layers[mesh.cell_layer[q / mesh.points_per_cell()]].density));
  return velocities;
}

std::string softened_elements(const ColumnScene &scene, const std::vector<CarriedWaves> &waves,
                              const std::array<Motion, 3> &motions)
{
  constexpr double enough = 0.25;
  const double frequency = frequency_of_interest(scene, motions);
  std::size_t worst = 0;
  for (std::size_t k = 0; k < waves.size(); ++k)
    if (waves[k].softened.value_or(frequency) < waves[worst].softened.value_or(frequency))
      worst = k;
  const double carried = waves[worst].softened.value_or(frequency);
  if (carried >= enough * frequency)
    return "";
  const Layer &layer = scene.layers[worst];
  return fmt::format(
      "the soil of layer.{}{} became so soft that its elements, {:.3g} m long, carried waves up to {:.3g} "
      "Hz only ({} nodes to a wave), and {:.3g} Hz are of interest. See with {} what depends "
      "on it, and take more cells if it matters; strains of soil that liquefies depend on the mesh at any size.",
      worst, quoted_name(layer), waves[worst].length, carried, nodes_per_wave, frequency,
      scene.mesh.given ? "a finer mesh" : "--check-mesh");
}

std::string coarse_elements(const ColumnScene &scene, const std::vector<double> &velocities, const CellTables &mesh,
                            const std::array<Motion, 3> &motions)
{
  const double frequency = frequency_of_interest(scene, motions);
  const std::vector<SlowCell> slowest = slowest_cells(scene, velocities, mesh);
  std::size_t worst = 0;
  double fewest = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < slowest.size(); ++k)
    {
      const double nodes = slowest[k].velocity / frequency * scene.mesh.degree / slowest[k].length;
      if (nodes < fewest)
        worst = k, fewest = nodes;
    }
  if (frequency == 0 || fewest >= nodes_per_wave)
    return "";
  const Layer &soft = scene.layers[worst];
  const auto [velocity, length] = slowest[worst];
  const double enough = length * fewest / nodes_per_wave;
  const auto count = [&](const std::string &key, double of) {
    return fmt::format("{} to {:.0f} or more", key, std::ceil(of / enough));
  };
  std::string remedy = fmt::format("{} to {:.2g} m or less", size_of_elements(scene, worst), enough);
  if (!scene.mesh.given)
    remedy = width_of_elements(scene) == length_of_elements(scene, worst)
                 ? count("mesh.cells_across", scene.mesh.width)
                 : count(fmt::format("layer.{}.cells", worst), soft.thickness);
  return fmt::format(
      "the elements of layer.{}{} are too long for the shortest wave of interest: {:.1f} nodes in {:.3g} m ({:.3g} m/s "
      "at {:.3g} Hz), {} are needed. Set {}, or analysis.highest_frequency to what matters.",
      worst, quoted_name(soft), fewest, velocity / frequency, velocity, frequency, nodes_per_wave, remedy);
}

std::string coarse_drainage(const ColumnScene &scene, const FiniteElementSpace &space, const Material &material)
{
  const bool slow = scene.analysis.kind == AnalysisKind::consolidation;
  if (scene.water.drainage != Drainage::coupled || scene.load.kind == LoadKind::none ||
      (!slow && scene.load.direction != Axis::z))
    return "";
  const DrainageBound bound = drainage_bound(space, material);
  if (scene.load.kind == LoadKind::harmonic)
    return coarse_skin(scene, bound);
  const double first = slow ? scene.analysis.first_time : scene.load.ramp;
  if (bound.time <= first)
    return "";
  const ColumnLayer &layer = scene.layers[bound.layer];
  const std::string where = fmt::format("layer.{}", bound.layer);
  const std::string finer = first > 0 ? fmt::format("{} to {:.2g} m or less, or ", size_of_elements(scene, bound.layer),
                                                    layer.thickness / layer.n_cells() * std::sqrt(first / bound.time))
                                      : "";
  return fmt::format(
      "the cells of {}{} where water drains, {:.3g} m high, show pore pressure and settlement within 2 % "
      "only from 1.5 h2/c = {:.3g} s after the load on (c = {:.3g} m2/s); before h2/(6 c) = {:.3g} s the "
      "pressure oscillates there. Set {}{} to {:.3g} s or more, or disregard what is earlier.",
      where, quoted_name(layer), bound.cell, bound.time, bound.coefficient, bound.time / 9, finer,
      slow ? "analysis.first_time" : "load.ramp", bound.time);
}

std::vector<std::string> scene_warnings(const ColumnScene &scene, const std::vector<ColumnLayer> &layers,
                                        const std::vector<double> &velocities, const CellTables &mesh,
                                        const std::array<Motion, 3> &motions)
{
  std::vector<std::string> warnings = profile_warnings(scene);
  for (const std::vector<std::string> &more :
       {resistance_warnings(scene, layers), motion_size_warnings(scene, motions), motion_warnings(scene, motions)})
    warnings.insert(warnings.end(), more.begin(), more.end());
  if (std::string coarse = coarse_elements(scene, velocities, mesh, motions); !coarse.empty())
    warnings.push_back(std::move(coarse));
  if (const double step = scene.analysis.time_step.value_or(0), steps = scene.output.history_interval / step;
      step > 0 && steps > 1 && std::abs(steps - std::round(steps)) > 1e-6)
    warnings.push_back(fmt::format("output.history_interval = {:g} s is {:.6g} of the time step, {:g} s: rows are "
                                   "{:.6g} s apart. Leave analysis.time_step out, or give a step that divides it.",
                                   scene.output.history_interval, steps, step, std::round(steps) * step));
  const auto vertical = [](const ColumnMotion &motion) { return motion.axis == Axis::z; };
  if (scene.water.drainage == Drainage::undrained && std::ranges::any_of(scene.motions, vertical))
    warnings.push_back(
        "the motion along z moves the column as a rigid body: without drainage its volume is constant, and "
        "no P wave runs in it. Set water.drainage = \"coupled\" for P waves.");
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (const ColumnLayer &layer = scene.layers[k]; layer.curve.is_given())
      if (const std::optional<double> strain = strain_of_strength(layer))
        warnings.push_back(fmt::format(
            "layer.{}: beyond a shear strain of {:.2g} % the curve would exceed 0.9 of the shear strength, {:.4g} kPa "
            "at "
            "p' = {:.4g} kPa, and the soil goes over to the strength there. Give the layer the shear_strength that was "
            "measured, or "
            "take it as an estimate.",
            k, 100 * *strain, layer.sand().strength_ratio * layer.in_situ_pressure / 1e3,
            layer.in_situ_pressure / 1e3));
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (const auto &[material, density] = std::pair(scene.layers[k].material, scene.layers[k].grains.relative_density);
        material == LayerMaterial::grains && density && !density_remark(*density).empty())
      warnings.push_back(fmt::format("layer.{}.relative_density = {:g}{}", k, *density, density_remark(*density)));
  return warnings;
}
} // namespace isostat
