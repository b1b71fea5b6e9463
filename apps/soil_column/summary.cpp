// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/summary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
bool shaken(const ColumnScene &scene) { return scene.analysis.kind == AnalysisKind::dynamic; }

double amplification(const ColumnPeaks &peaks) { return peaks.input > 0 ? peaks.surface / peaks.input : 0; }

/// Energy that came from nowhere, of the largest that any row has.
double relative_residual(const ColumnState &last)
{
  return last.max_energy > 0 ? std::abs(last.residual) / last.max_energy : 0;
}

std::string quoted(const std::string &text)
{
  std::string word = "\"";
  for (char c : text)
    if (c == '"' || c == '\\')
      word += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < ' ')
      word += fmt::format("\\u{:04x}", c);
    else
      word += c;
  return word + "\"";
}

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.17g}", x) : "null"; }

std::string list(const std::vector<double> &values)
{
  std::string text;
  for (double x : values)
    text += (text.empty() ? "" : ", ") + number(x);
  return "[" + text + "]";
}

const char *name_of(LayerMaterial material)
{
  return material == LayerMaterial::grains ? "grains" : material == LayerMaterial::iwan ? "iwan" : "elastic";
}

/// From the surface down.
std::string layers_json(const ColumnScene &scene)
{
  std::string text;
  double top = 0;
  for (const ColumnLayer &layer : scene.layers)
    {
      text += fmt::format("{}\n    {{\"name\": {}, \"top\": {}, \"bottom\": {}, \"material\": {}, \"density\": {}, "
                          "\"shear_modulus\": {}}}",
                          text.empty() ? "" : ",", quoted(layer.name), number(top), number(top + layer.thickness),
                          quoted(name_of(layer.material)), number(layer.density),
                          layer.material == LayerMaterial::grains ? "null" : number(layer.small_strain_modulus()));
      top += layer.thickness;
    }
  return "[" + text + "\n  ]";
}

const char *name_of(Drainage drainage)
{
  return drainage == Drainage::dry ? "dry" : drainage == Drainage::undrained ? "undrained" : "coupled";
}
} // namespace

std::string to_text(const ColumnSummary &s, const ColumnScene &scene)
{
  const ColumnPeaks &p = s.peaks;
  std::string text = fmt::format("\n{}\n  soil                     {:.4g} m in {} layer{}, {}\n  mesh                  "
                                 "   {} elements, {} points, dimension {}\n",
                                 scene.title.empty() ? "Soil column" : scene.title, scene.height(), scene.layers.size(),
                                 scene.layers.size() > 1 ? "s" : "", name_of(scene.water.drainage), s.cells, s.points,
                                 scene.mesh.dimension);
  if (shaken(scene))
    text += fmt::format("  time                     {:.6g} s in {:.0f} steps of {:.5g} ms\n  peak input acceleration  "
                        "{:.4f} m/s2{}\n  peak surface             {:.4f} m/s2\n",
                        scene.analysis.duration, s.steps, 1e3 * s.time_step, p.input,
                        scene.base.compliant() ? " (outcrop)" : "", p.surface);
  else
    text += fmt::format("  time                     {:.6g} s in {:.0f} steps\n", s.last.time, s.steps);
  if (p.input > 0)
    text += fmt::format("  amplification            {:.3f}\n", amplification(p));
  text += fmt::format("  peak shear strain        {:.5f} % at a depth of {:.2f} m\n", 100 * p.gamma, p.gamma_depth);
  if (scene.water.drainage != Drainage::dry)
    text += fmt::format("  largest r_u              {:.4f} at a depth of {:.2f} m, t = {:.5g} s\n", p.ru, p.ru_depth,
                        p.ru_time);
  text += fmt::format("  settlement               {:.4f} mm\n", 1e3 * s.last.settlement);
  if (s.grains)
    text += fmt::format("  packings                 {}, V_s {:.0f} to {:.0f} m/s\n", s.grains->packings,
                        s.grains->slowest, s.grains->fastest);
  if (s.grains && s.grains->has_profiles)
    text += fmt::format("  smallest I_R                {:.3f} at a depth of {:.2f} m, t = {:.5g} s\n",
                        s.grains->min_redundancy, s.grains->min_redundancy_depth, s.grains->min_redundancy_time);
  if (shaken(scene))
    return text + fmt::format("  energy residual          {:.2e} J/m2, {:.1e} of the largest energy\n", s.last.residual,
                              relative_residual(s.last));
  return text + fmt::format("  final settlement         {:.4f} mm, drained\n  degree of consolidation  {:.4f}\n",
                            1e3 * s.final_settlement, s.degree);
}

namespace
{
/// Where the time of a column of grains went; the rest of the material's time is waiting for other ranks.
std::string packings_text(const RunTimes &t)
{
  return fmt::format(
      "  packings                 {:.0f} calls, {:.1f} time steps each; {:.1f} s on the busiest rank, {:.1f} "
      "s on all\n  outside of packings      {:.2f} % of the wall time; wave velocities {:.1f} s\n",
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

std::string to_json(const ColumnSummary &s, const ColumnScene &scene)
{
  const ColumnPeaks &p = s.peaks;
  std::string text =
      fmt::format("{{\n  \"title\": {},\n  \"analysis\": \"{}\",\n  \"drainage\": \"{}\",\n  \"base\": "
                  "\"{}\",\n  \"layers\": {}",
                  quoted(scene.title), shaken(scene) ? "dynamic" : "consolidation", name_of(scene.water.drainage),
                  scene.base.compliant() ? "compliant" : "rigid", layers_json(scene));
  const auto add = [&](const char *name, const std::string &value) {
    text += fmt::format(",\n  \"{}\": {}", name, value);
  };
  add("dimension", std::to_string(scene.mesh.dimension));
  add("height", number(scene.height()));
  add("mass_damping", number(scene.analysis.mass_damping));
  add("spectrum_damping", number(scene.output.spectrum_damping));
  add("requested_depths", list(scene.output.depths));
  add("depths", list(s.point_depths));
  add("elements", std::to_string(s.cells));
  add("points", std::to_string(s.points));
  add("steps", number(s.steps));
  add("time_step", number(s.time_step));
  add("end", number(s.last.time));
  add("peak_input", number(p.input));
  add("peak_surface", number(p.surface));
  add("amplification", number(amplification(p)));
  add("peak_gamma", number(p.gamma));
  add("peak_gamma_depth", number(p.gamma_depth));
  add("max_ru", number(p.ru));
  add("max_ru_depth", number(p.ru_depth));
  add("max_ru_time", number(p.ru_time));
  add("settlement", number(s.last.settlement));
  add("energy_residual", number(s.last.residual));
  add("relative_energy_residual", number(relative_residual(s.last)));
  add("final_settlement", shaken(scene) ? "null" : number(s.final_settlement));
  add("degree_of_consolidation", shaken(scene) ? "null" : number(s.degree));
  if (s.grains)
    {
      add("packings", std::to_string(s.grains->packings));
      add("shear_velocities", list({s.grains->slowest, s.grains->fastest}));
    }
  if (s.grains && s.grains->has_profiles)
    {
      add("min_redundancy", number(s.grains->min_redundancy));
      add("min_redundancy_depth", number(s.grains->min_redundancy_depth));
      add("min_redundancy_time", number(s.grains->min_redundancy_time));
    }
  return text + "\n}\n";
}
} // namespace isostat
