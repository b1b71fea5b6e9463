// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/summary.hpp"

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

/// r_u compares with the stress in situ, which the load of a consolidation has no part in.
bool has_ru(const ColumnScene &scene) { return shaken(scene) && scene.water.drainage != Drainage::dry; }

/// What a peak of horizontal acceleration is, if two axes move.
const char *of_both_axes(const ColumnScene &scene)
{
  const auto horizontal = [](const ColumnMotion &motion) { return motion.axis != Axis::z; };
  return std::ranges::count_if(scene.motions, horizontal) > 1 ? ", x and y as a vector" : "";
}

/// The largest of the values at the nodes, and its depth.
struct Largest
{
  double value = 0, depth = 0;
};

/// None of a box, whose nodes are those of one vertical, and of what does not shake.
std::optional<Largest> largest(const ColumnSummary &s, const ColumnScene &scene, const std::vector<double> &of_nodes)
{
  if (!shaken(scene) || s.box_motion || s.node_depths.empty())
    return std::nullopt;
  const auto at = std::ranges::max_element(of_nodes);
  return Largest{*at, s.node_depths[static_cast<std::size_t>(at - of_nodes.begin())]};
}

std::string largest_text(const ColumnSummary &s, const ColumnScene &scene)
{
  std::string text;
  for (const auto &[name, unit, of_nodes] : {std::tuple("peak velocity", "m/s", &s.peaks.line_velocity),
                                             {"peak displacement", "m", &s.peaks.line_displacement}})
    if (const auto found = largest(s, scene, *of_nodes))
      text += fmt::format("  {:<25}{:.4g} {}{} at a depth of {:.2f} m\n", name, found->value, unit,
                          scene.base.compliant() ? "" : " against the base", found->depth);
  return text;
}

void add_largest(const ColumnSummary &s, const ColumnScene &scene, Json &json)
{
  for (const auto &[name, of_nodes] :
       {std::pair("peak_velocity", &s.peaks.line_velocity), std::pair("peak_displacement", &s.peaks.line_displacement)})
    {
      const auto found = largest(s, scene, *of_nodes);
      json[name] = found ? Json(found->value) : Json();
      json[fmt::format("{}_depth", name)] = found ? Json(found->depth) : Json();
    }
}

double amplification(const ColumnPeaks &peaks) { return peaks.input > 0 ? peaks.surface / peaks.input : 0; }

/// Energy that came from nowhere, of the largest that any row has.
double relative_residual(const ColumnState &last)
{
  return last.max_energy > 0 ? std::abs(last.residual) / last.max_energy : 0;
}

double degrees(const Slope &slope) { return std::atan(slope.tangent) * 180 / std::numbers::pi; }

std::string slope_text(const Spreading &s, const ColumnScene &scene)
{
  std::string text = fmt::format("  slope                    {:.4g} deg", degrees(scene.slope));
  if (s.safety)
    text +=
        fmt::format(", factor of safety at the start {:.3f} at a depth of {:.2f} m", s.safety->factor, s.safety->depth);
  return text + fmt::format("\n  moved downslope          {:.4f} m at the surface; at the end the largest shear strain "
                            "is {:.3f} % at a depth of {:.2f} m\n",
                            s.displacement, 100 * s.gamma, s.gamma_depth);
}

void add_slope(const Spreading &s, const ColumnScene &scene, Json &json)
{
  json["slope"] = degrees(scene.slope);
  json["factor_of_safety"] = s.safety ? Json(s.safety->factor) : Json();
  json["factor_of_safety_depth"] = s.safety ? Json(s.safety->depth) : Json();
  json["downslope"] = s.displacement;
  json["end_gamma"] = s.gamma;
  json["end_gamma_depth"] = s.gamma_depth;
}

/// From the surface down.
Json layers_json(const ColumnScene &scene)
{
  Json layers = Json::array();
  double top = 0;
  for (const ColumnLayer &layer : scene.layers)
    {
      layers.push_back({{"name", layer.name},
                        {"top", top},
                        {"bottom", top + layer.thickness},
                        {"material", material_names[static_cast<int>(layer.material)]},
                        {"density", layer.density},
                        {"shear_modulus", layer.from_formula() ? Json(layer.small_strain_modulus()) : Json()}});
      top += layer.thickness;
    }
  return layers;
}
Json expansions_json(const std::vector<CapExpansion> &caps)
{
  Json json = Json::array();
  for (const CapExpansion &cap : caps)
    json.push_back({{"below", cap.layer},
                    {"depth", cap.depth},
                    {"largest", cap.largest},
                    {"largest_time", cap.largest_time},
                    {"end", cap.last}});
  return json;
}

std::string grains_text(const GrainsSummary &g)
{
  std::string text =
      fmt::format("  packings                 {}, V_s {:.0f} to {:.0f} m/s\n", g.packings, g.slowest, g.fastest);
  if (g.has_profiles)
    text +=
        fmt::format("  smallest I_R             {:.3f} at a depth of {:.2f} m, t = {:.5g} s; {}\n", g.min_redundancy,
                    g.min_redundancy_depth, g.min_redundancy_time, index_name(static_cast<int>(g.constraints)));
  return text;
}

void add_grains(const GrainsSummary &g, Json &json)
{
  json["packings"] = g.packings;
  if (!g.seeds.empty())
    json["seeds"] = g.seeds;
  json["shear_velocities"] = {g.slowest, g.fastest};
  if (!g.has_profiles)
    return;
  json["min_redundancy"] = g.min_redundancy;
  json["min_redundancy_depth"] = g.min_redundancy_depth;
  json["min_redundancy_time"] = g.min_redundancy_time;
  json["min_redundancy_constraints"] = g.constraints;
}
} // namespace

std::string to_text(const ColumnSummary &s, const ColumnScene &scene)
{
  const ColumnPeaks &p = s.peaks;
  std::string text =
      fmt::format("\n{}\n  soil                     {:.4g} m in {} layer{}, {}\n  mesh                  "
                  "   {} elements, {} points, dimension {}\n",
                  scene.title.empty() ? "Soil column" : scene.title, scene.height(), scene.layers.size(),
                  scene.layers.size() > 1 ? "s" : "", drainage_names[static_cast<int>(scene.water.drainage)], s.cells,
                  s.points, scene.mesh.dimension);
  if (shaken(scene))
    text +=
        fmt::format("  time                     {:.6g} s in {:.0f} steps of {:.5g} ms\n  peak input acceleration  "
                    "{:.4f} m/s2{}{}\n  peak surface             {:.4f} m/s2{}\n",
                    scene.analysis.duration, s.steps, 1e3 * s.time_step, p.input,
                    scene.base.compliant() ? " (outcrop)" : "", of_both_axes(scene), p.surface, of_both_axes(scene));
  else if (!s.plate)
    text += fmt::format("  time                     {:.6g} s in {:.0f} steps\n", s.last.time, s.steps);
  if (p.input > 0)
    text += fmt::format("  amplification            {:.3f}\n", amplification(p));
  if (p.input > 0)
    text += fmt::format("  above {:<19}{:.1f} % of the squared acceleration of the surface, {:.1f} % of the input's; "
                        "peak surface below it {:.4f} m/s2\n",
                        fmt::format("{:.4g} Hz", scene.analysis.highest_frequency), 100 * s.bands.share,
                        100 * s.bands.input_share, s.bands.peak_below);
  text += largest_text(s, scene);
  text += fmt::format("  peak shear strain        {:.5f} % at a depth of {:.2f} m\n", 100 * p.gamma, p.gamma_depth);
  if (has_ru(scene))
    text += fmt::format("  largest r_u              {:.4f} at a depth of {:.2f} m, t = {:.5g} s\n", p.ru, p.ru_depth,
                        p.ru_time);
  if (!s.box_motion) // which says where
    text += fmt::format("  settlement               {:.4f} mm\n", 1e3 * s.last.settlement);
  for (const CapExpansion &cap : s.expansions)
    text += fmt::format(
        "  net expansion            {:.3f} mm of water below {} ({:.2f} m) at t = {:.5g} s; {:.3f} mm at the end\n",
        1e3 * cap.largest, cap.layer, cap.depth, cap.largest_time, 1e3 * cap.last);
  if (s.spreading)
    text += slope_text(*s.spreading, scene);
  if (s.box_motion)
    text += to_text(*s.box_motion, mesh_spec(scene));
  if (s.box_motion && p.gamma > 0.1)
    text += "  large strains            beyond 10 %, but taken as small: displacements have an error of their order\n";
  if (s.grains)
    text += grains_text(*s.grains);
  if (!s.point_depths.empty())
    text += fmt::format("  depths of histories      {:.4g} m, the points nearest to those asked for\n",
                        fmt::join(s.point_depths, ", "));
  for (const std::string &warning : s.warnings)
    text += fmt::format("  warning: {}\n", warning);
  if (shaken(scene))
    return text + fmt::format("  energy residual          {:.2e} J/m2, {:.1e} of the largest energy\n", s.last.residual,
                              relative_residual(s.last));
  if (s.plate)
    return text + to_text(*s.plate, scene.plate);
  text += fmt::format("  final settlement         {:.4f} mm, drained\n", 1e3 * s.final_settlement);
  return std::isfinite(s.degree) ? text + fmt::format("  degree of consolidation  {:.4f}\n", s.degree) : text;
}

namespace
{
/// Where the time of a column of grains went; the rest of the material's time is waiting for other ranks.
std::string packings_text(const RunTimes &t)
{
  return fmt::format(
      "  packings                 {:.0f} calls, {:.1f} time steps each; {:.1f} s, on all cores together {:.1f} s\n"
      "  outside of packings      {:.2f} % of the wall time; wave velocities {:.1f} s\n",
      t.packing_trials, t.packing_steps / t.packing_trials, t.in_packings, t.all_packings,
      100 * (1 - t.in_packings / t.wall), t.waves);
}
} // namespace

std::string to_text(const RunTimes &t)
{
  const double n = std::max(t.steps, 1.0);
  return (t.packing_trials > 0 ? packings_text(t) : "") +
         fmt::format(
             "  time per step            {:.1f} us elements, {:.1f} us material\n  wall time                {:.2f} "
             "s, {:.0f} steps\n",
             1e6 * t.solver / n, 1e6 * t.material / n, t.wall, t.steps);
}

Json to_json(const ColumnSummary &s, const ColumnScene &scene)
{
  const ColumnPeaks &p = s.peaks;
  const bool drains = scene.analysis.kind == AnalysisKind::consolidation;
  Json json{{"title", scene.title},
            {"analysis", analysis_names[static_cast<int>(scene.analysis.kind)]},
            {"drainage", drainage_names[static_cast<int>(scene.water.drainage)]},
            {"base", scene.base.compliant() ? "compliant" : "rigid"},
            {"layers", layers_json(scene)},
            {"dimension", scene.mesh.dimension},
            {"height", scene.height()},
            {"mass_damping", scene.analysis.mass_damping},
            {"viscosity", shaken(scene) ? Json(scene.analysis.viscosity) : Json()},
            {"highest_frequency", shaken(scene) ? Json(scene.analysis.highest_frequency) : Json()},
            {"spectrum_damping", scene.output.spectrum_damping},
            {"requested_depths", scene.output.depths},
            {"depths", s.point_depths},
            {"elements", s.cells},
            {"points", s.points},
            {"warnings", s.warnings},
            {"steps", std::llround(s.steps)},
            {"time_step", s.time_step},
            {"end", s.last.time},
            {"peak_input", s.plate ? Json() : Json(p.input)},
            {"peak_surface", s.plate ? Json() : Json(p.surface)},
            {"amplification", s.plate ? Json() : Json(amplification(p))},
            {"peak_surface_below", shaken(scene) ? Json(s.bands.peak_below) : Json()},
            {"share_above", shaken(scene) ? Json(s.bands.share) : Json()},
            {"input_share_above", shaken(scene) ? Json(s.bands.input_share) : Json()},
            {"peak_gamma", p.gamma},
            {"peak_gamma_depth", p.gamma_depth},
            {"max_ru", has_ru(scene) ? Json(p.ru) : Json()},
            {"max_ru_depth", has_ru(scene) ? Json(p.ru_depth) : Json()},
            {"max_ru_time", has_ru(scene) ? Json(p.ru_time) : Json()},
            {"settlement", s.last.settlement},
            {"expansions", expansions_json(s.expansions)},
            {"energy_residual", s.last.residual},
            {"relative_energy_residual", relative_residual(s.last)},
            {"final_settlement", drains ? Json(s.final_settlement) : Json()},
            {"degree_of_consolidation", drains ? Json(s.degree) : Json()}};
  add_largest(s, scene, json);
  if (s.spreading)
    add_slope(*s.spreading, scene, json);
  if (s.box_motion)
    json["surface_motion"] = to_json(*s.box_motion, mesh_spec(scene));
  if (s.plate)
    json["plate"] = to_json(*s.plate);
  if (s.grains)
    add_grains(*s.grains, json);
  return json;
}

Json to_json(const RunTimes &t)
{
  return {{"wall", t.wall},
          {"steps", std::llround(t.steps)},
          {"solver", t.solver},
          {"material", t.material},
          {"packing_calls", std::llround(t.packing_trials)},
          {"packing_steps", std::llround(t.packing_steps)},
          {"packings", t.in_packings},
          {"all_packings", t.all_packings},
          {"wave_velocities", t.waves}};
}
} // namespace isostat
