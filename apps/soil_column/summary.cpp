// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/summary.hpp"

#include "apps/common/summary.hpp"
#include "apps/deposit/layer_curve.hpp"
#include "apps/deposit/resistance.hpp"
#include "dem/measure/redundancy.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>

namespace isostat
{
namespace
{
bool shaken(const ColumnScene &scene) { return scene.analysis.kind == AnalysisKind::dynamic; }

/// r_u compares with the stress in situ, without the load of a consolidation.
bool has_ru(const ColumnScene &scene) { return shaken(scene) && scene.water.drainage != Drainage::dry; }

/// What a peak of horizontal acceleration is, if two axes move.
const char *of_both_axes(const ColumnScene &scene)
{
  const auto horizontal = [](const ColumnMotion &motion) { return motion.axis != Axis::z; };
  return std::ranges::count_if(scene.motions, horizontal) > 1 ? ", x and y as a vector" : "";
}

double degrees(const Slope &slope) { return std::atan(slope.tangent) * 180 / std::numbers::pi; }

void add_slope(const Spreading &s, const ColumnScene &scene, Summary &summary)
{
  for (const char *key : {"factor_of_safety", "factor_of_safety_depth"})
    summary[key] = nullptr;
  summary.row("slope", "{:.4g} deg{}", Value{"slope", degrees(scene.slope)},
              s.safety ? summary.text(", factor of safety at the start {:.3f} at a depth of {:.2f} m",
                                      Value{"factor_of_safety", s.safety->factor},
                                      Value{"factor_of_safety_depth", s.safety->depth})
                       : "");
  summary.row("moved downslope",
              "{:.4f} m at the surface; at the end the largest shear strain is {:.3f} % at a depth of {:.2f} m",
              Value{"downslope", s.displacement}, Value{"end_gamma", s.gamma, percent},
              Value{"end_gamma_depth", s.gamma_depth});
}

/// In the middle of the layer, at small strain.
double in_situ_velocity(const ColumnLayer &layer) { return std::sqrt(layer.in_situ_modulus() / layer.density); }

/// V_s of the layers that are not of grains or the user's; of many the slowest and the fastest.
void add_velocities(const ColumnScene &scene, Summary &summary)
{
  std::vector<double> velocities;
  for (const ColumnLayer &layer : scene.layers)
    if (layer.from_formula())
      velocities.push_back(in_situ_velocity(layer));
  constexpr std::size_t few = 6;
  if (velocities.empty())
    return;
  const auto [slowest, fastest] = std::ranges::minmax(velocities);
  summary.row("V_s in situ", "{} m/s {} {}",
              velocities.size() <= few ? fmt::format("{:.4g}", fmt::join(velocities, ", "))
                                       : fmt::format("{:.4g} to {:.4g}", slowest, fastest),
              scene.mesh.given ? "at the mean stress of" : "in the middle of",
              velocities.size() > 1 ? "the layers" : "the layer");
}

/// From the surface down; layers of a mesh from a file lie at no one depth.   @param used  as they were run
Json layers_json(const ColumnScene &scene, const std::vector<ColumnLayer> &used)
{
  Json layers = Json::array();
  double top = 0;
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      const ColumnLayer &layer = scene.layers[k];
      layers.push_back({{"name", layer.name},
                        {"top", scene.mesh.given ? Json() : Json(top)},
                        {"bottom", scene.mesh.given ? Json() : Json(top + layer.thickness)},
                        {"material", material_names[static_cast<int>(layer.material)]},
                        {"density", layer.density},
                        {"shear_modulus", layer.from_formula() ? Json(layer.small_strain_modulus()) : Json()},
                        {"in_situ_pressure", layer.in_situ_pressure},
                        {"in_situ_shear_velocity", layer.from_formula() ? Json(in_situ_velocity(layer)) : Json()},
                        {"damping", small_strain_damping(layer)}});
      if (const std::optional<double> resistance = layer_resistance(scene, k))
        {
          const IwanParameters &sand = used[k].iwan;
          layers.back()["crr"] = *resistance;
          layers.back()["sand"] = {{"contraction", sand.contraction},
                                   {"contraction_exponent", sand.contraction_exponent},
                                   {"fabric_limit", sand.fabric_limit},
                                   {"fabric_rate", sand.fabric_rate},
                                   {"reconsolidation", sand.reconsolidation}};
        }
      top += layer.thickness;
    }
  return layers;
}

void add_expansions(const std::vector<CapExpansion> &caps, Summary &summary)
{
  summary["expansions"] = Json::array();
  for (const CapExpansion &cap : caps)
    {
      if (cap.largest > 0.5e-6) // m, which is not 0.000 mm
        summary.row("net expansion", "{:.3f} mm of water below {} ({:.2f} m) at t = {:.5g} s; {:.3f} mm at the end",
                    1e3 * cap.largest, cap.layer, cap.depth, cap.largest_time, 1e3 * cap.last);
      summary["expansions"].push_back({{"below", cap.layer},
                                       {"depth", cap.depth},
                                       {"largest", cap.largest},
                                       {"largest_time", cap.largest_time},
                                       {"end", cap.last}});
    }
}

void add_grains(const GrainsSummary &g, Summary &summary)
{
  if (!g.seeds.empty())
    summary["seeds"] = g.seeds;
  summary["shear_velocities"] = {g.slowest, g.fastest};
  summary.row("packings", "{}, V_s {:.0f} to {:.0f} m/s", Value{"packings", g.packings}, g.slowest, g.fastest);
  if (!g.has_profiles)
    return;
  summary["min_redundancy_constraints"] = g.constraints;
  summary.row("smallest I_R", "{:.3f} at a depth of {:.2f} m, t = {:.5g} s; {}",
              Value{"min_redundancy", g.min_redundancy}, Value{"min_redundancy_depth", g.min_redundancy_depth},
              Value{"min_redundancy_time", g.min_redundancy_time}, index_name(static_cast<int>(g.constraints)));
}

/// What the elements of each layer carry.
void add_waves(const ColumnSummary &s, const ColumnScene &scene, Summary &summary)
{
  for (std::size_t k = 0; k < s.waves.size(); ++k)
    {
      const ColumnLayer &layer = scene.layers[k];
      const auto &[length, at_start, softened] = s.waves[k];
      summary.row(k == 0 ? "waves carried" : " ", "{}: {}elements of {:.3g} m, up to {:.3g} Hz at the start{}",
                  layer.name.empty() ? fmt::format("layer {}", k) : layer.name,
                  scene.refine.empty() ? fmt::format("{} ", layer.n_cells()) : "", length, at_start,
                  softened ? fmt::format(", {:.3g} Hz where softest", *softened) : "");
      summary["layers"][k].update({{"cells", layer.n_cells()},
                                   {"element_length", length},
                                   {"carried_frequency", at_start},
                                   {"softened_frequency", softened ? Json(*softened) : Json()}});
    }
}

/// What needs no row, and the first rows.
void add_scene(const ColumnSummary &s, const ColumnScene &scene, Summary &summary)
{
  summary["analysis"] = analysis_names[static_cast<int>(scene.analysis.kind)];
  summary["base"] = scene.base.compliant() ? "compliant" : "rigid";
  summary["layers"] = layers_json(scene, s.layers);
  summary["mass_damping"] = scene.analysis.mass_damping;
  summary["spectrum_damping"] = scene.output.spectrum_damping;
  summary["requested_depths"] = scene.output.depths;
  if (shaken(scene))
    {
      summary["viscosity"] = scene.analysis.viscosity.value_or(0);
      summary["highest_frequency"] = scene.analysis.highest_frequency;
    }
  summary.row("soil", "{:.4g} m in {} layer{}, {}", Value{"height", scene.height()}, scene.layers.size(),
              scene.layers.size() > 1 ? "s" : "",
              Value{"drainage", std::string(drainage_names[static_cast<int>(scene.water.drainage)])});
  add_velocities(scene, summary);
  summary.row("mesh", "{} elements, {} points, dimension {}", Value{"elements", s.cells}, Value{"points", s.points},
              Value{"dimension", scene.mesh.dimension});
  add_waves(s, scene, summary);
}

/// Time, and the motion of input and surface.
void add_motion(const ColumnSummary &s, const ColumnScene &scene, Summary &summary)
{
  const double input = s.peaks.input, surface = s.peaks.surface;
  summary["steps"] = std::llround(s.steps);
  summary["time_step"] = s.time_step;
  summary["end"] = s.last.time;
  if (s.plate)
    return;
  const Value peak_input{"peak_input", input}, peak_surface{"peak_surface", surface};
  const Value amplification{"amplification", input > 0 ? surface / input : 0};
  summary[peak_input.key] = input;
  summary[peak_surface.key] = surface;
  summary[amplification.key] = amplification.value;
  if (!shaken(scene))
    return summary.row("time", "{:.6g} s in {:.0f} steps", s.last.time, s.steps);
  summary.row("time", "{:.6g} s in {:.0f} steps of {:.5g} ms", scene.analysis.duration, s.steps, s.time_step / ms);
  summary.row("peak input acceleration", "{:.4f} m/s2{}{}", peak_input, scene.base.compliant() ? " (outcrop)" : "",
              of_both_axes(scene));
  summary.row("peak surface", "{:.4f} m/s2{}", peak_surface, of_both_axes(scene));
  const std::string bands = summary.text(
      "{:.1f} % of the squared acceleration of the surface, {:.1f} % of the input's; peak surface below it {:.4f} m/s2",
      Value{"share_above", s.bands.share, percent}, Value{"input_share_above", s.bands.input_share, percent},
      Value{"peak_surface_below", s.bands.peak_below});
  if (input == 0)
    return;
  summary.row("amplification", "{:.3f}", amplification);
  summary.row(fmt::format("above {:.4g} Hz", scene.analysis.highest_frequency), "{}", bands);
}

/// The largest of the values at the nodes, and its depth. None of a box, whose nodes are those of one vertical.
void add_largest(const ColumnSummary &s, const ColumnScene &scene, Summary &summary)
{
  if (!shaken(scene) || s.box_motion || s.node_depths.empty())
    return;
  for (const auto &[label, key, unit, of_nodes] :
       {std::tuple("peak velocity", "peak_velocity", "m/s", &s.peaks.line_velocity),
        {"peak displacement", "peak_displacement", "m", &s.peaks.line_displacement}})
    {
      const auto at = std::ranges::max_element(*of_nodes);
      const double depth = s.node_depths[static_cast<std::size_t>(at - of_nodes->begin())];
      summary.row(label, "{:.4g} {}{} at a depth of {:.2f} m", Value{key, *at}, unit,
                  scene.base.compliant() ? "" : " against the base", Value{fmt::format("{}_depth", key), depth});
    }
}

/// Energy that came from nowhere, what a plate met, or how far the soil has consolidated.
void add_end(const ColumnSummary &s, const ColumnScene &scene, Summary &summary)
{
  const Value residual{"energy_residual", s.last.residual};
  const Value share{"relative_energy_residual",
                    s.last.max_energy > 0 ? std::abs(s.last.residual) / s.last.max_energy : 0};
  const std::string text = summary.text("{:.2e} J/m2, {:.1e} of the largest energy", residual, share);
  if (shaken(scene))
    return summary.row("energy residual", "{}", text);
  if (s.plate)
    return add_plate(*s.plate, scene, summary);
  summary.row("final settlement", "{:.4f} mm, drained", Value{"final_settlement", s.final_settlement, mm});
  const std::string degree = summary.text("{:.4f}", Value{"degree_of_consolidation", s.degree});
  if (std::isfinite(s.degree))
    summary.row("degree of consolidation", "{}", degree);
}
} // namespace

Summary report_of(const ColumnSummary &s, const ColumnScene &scene)
{
  Summary summary(scene.title, "Soil column",
                  "viscosity highest_frequency peak_input peak_surface amplification "
                  "peak_surface_below share_above input_share_above max_ru max_ru_depth max_ru_time "
                  "final_settlement degree_of_consolidation peak_velocity peak_velocity_depth "
                  "peak_displacement peak_displacement_depth");
  const ColumnPeaks &p = s.peaks;
  add_scene(s, scene, summary);
  add_motion(s, scene, summary);
  add_largest(s, scene, summary);
  summary.row("peak shear strain", "{:.5f} % at a depth of {:.2f} m", Value{"peak_gamma", p.gamma, percent},
              Value{"peak_gamma_depth", p.gamma_depth});
  if (has_ru(scene))
    summary.row("largest r_u", "{:.4f} at a depth of {:.2f} m, t = {:.5g} s", Value{"max_ru", p.ru},
                Value{"max_ru_depth", p.ru_depth}, Value{"max_ru_time", p.ru_time});
  if (s.box_motion) // whose rows say where
    summary["settlement"] = s.last.settlement;
  else
    summary.row("settlement", "{:.4f} mm", Value{"settlement", s.last.settlement, mm});
  add_expansions(s.expansions, summary);
  if (s.spreading)
    add_slope(*s.spreading, scene, summary);
  if (s.box_motion)
    add_box_motion(*s.box_motion, mesh_spec(scene), summary);
  if ((s.box_motion || scene.slope.tangent > 0) && p.gamma > 0.1 && !scene.analysis.large_strain)
    summary.row("large strains", "beyond 10 %, but taken as small: displacements have an error of their order{}",
                scene.mesh.sides == Sides::free_field || scene.analysis.kind != AnalysisKind::dynamic ||
                        scene.analysis.scheme == TimeScheme::implicit
                    ? ""
                    : ". Give analysis.large_strain = true");
  if (s.grains)
    add_grains(*s.grains, summary);
  summary["depths"] = s.point_depths;
  summary["motion_depths"] = s.motion_depths;
  if (!s.point_depths.empty())
    summary.row("depths of histories", "{} m, the points nearest to those requested",
                fmt::format("{:.4g}", fmt::join(s.point_depths, ", ")));
  std::vector<std::string> warnings = s.warnings;
  if (const double rise = -s.last.settlement / scene.height(); !s.box_motion && rise > 0.01)
    warnings.push_back(fmt::format("the surface has risen by {:.2g} % of the height: soil without effective stress was "
                                   "pulled apart by water from below, which this model does not follow. Do not use "
                                   "settlements of this run.",
                                   100 * rise));
  summary["warnings"] = warnings;
  for (const std::string &warning : warnings)
    summary.row("", "warning: {}", warning);
  add_end(s, scene, summary);
  return summary;
}
} // namespace isostat
