// SPDX-License-Identifier: BSD-3-Clause
#include "apps/biaxial/run.hpp"
#include "base/record/progress.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
constexpr const char *material_names[] = {"elastic", "iwan", "grains"};
} // namespace

std::string to_text(const BiaxialSummary &s, const BiaxialScene &scene)
{
  std::string text = scene.title + "\n";
  text += fmt::format("  block               {} x {} m, {} x {} elements of degree {}, {} points, {}\n",
                      scene.mesh.width, scene.mesh.height, scene.mesh.cells_across, scene.mesh.cells_up,
                      scene.mesh.degree, s.points, material_names[static_cast<int>(scene.soil.material)]);
  text += fmt::format("  axial strain        {:.4g} % in {} steps{}\n", 100 * s.axial_strain, s.steps,
                      s.complete ? "" : ", then it stopped");
  text += fmt::format("  axial stress        {:.4g} kPa at the end, largest {:.4g} kPa at {:.3g} %\n",
                      s.last_stress / 1e3, s.peak_stress / 1e3, 100 * s.peak_strain);
  text += fmt::format("  volumetric strain   {:+.4g} % (compression positive)\n", 100 * s.volumetric_strain);
  text += fmt::format("  shear strain        90 % quantile {:.3g} times the median\n", s.localisation);
  text += fmt::format("  Newton              {} iterations, {} trials, {} sub-steps, {} rejected\n", s.iterations,
                      s.trials, s.substeps, s.rejected);
  if (!s.complete)
    text += fmt::format("  stopped             {}\n", s.failure);
  return text;
}

Json to_json(const BiaxialSummary &s, const BiaxialScene &scene)
{
  return {{"title", scene.title},
          {"complete", s.complete},
          {"failure", s.failure},
          {"steps", s.steps},
          {"points", s.points},
          {"width_m", scene.mesh.width},
          {"height_m", scene.mesh.height},
          {"cells_across", scene.mesh.cells_across},
          {"cells_up", scene.mesh.cells_up},
          {"confinement_Pa", scene.test.confinement},
          {"axial_strain", s.axial_strain},
          {"peak_stress_Pa", s.peak_stress},
          {"peak_strain", s.peak_strain},
          {"last_stress_Pa", s.last_stress},
          {"volumetric_strain", s.volumetric_strain},
          {"localisation", s.localisation},
          {"iterations", s.iterations},
          {"trials", s.trials},
          {"substeps", s.substeps},
          {"rejected", s.rejected},
          {"tangents", s.tangents},
          {"rve_steps", std::llround(s.rve_steps)}};
}
} // namespace isostat
