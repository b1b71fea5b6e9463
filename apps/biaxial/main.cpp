// SPDX-License-Identifier: BSD-3-Clause
// biaxial SCENE: a block of soil in plane strain, confined on its sides and compressed by its top, to see a shear band
// form; quasi-static, drained or undrained, by Newton with the tangent of the material or by relaxation.
//
//      ____v____  smooth plate, moves down
//   -> |       | <-
//   -> |   #   | <-  constant pressure      elastic, iwan, mohr_coulomb, packings at the Gauss points;
//   -> |       | <-                         # weak elements
//      ---------  smooth plate
//
//   biaxial apps/scenes/biaxial/iwan.toml
//   biaxial apps/scenes/biaxial/grains.toml --set test.steps=100 --threads 2
//   biaxial apps/scenes/biaxial/grains.toml --resume
#include "apps/biaxial/run.hpp"
#include "apps/deposit/ranks.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace
{
using namespace isostat;

void run_scene(const SceneOptions &options)
{
  if (ranks().size > 1)
    throw InputError("a biaxial block runs on one rank only. Give it --threads.");
  const BiaxialRequest request(read_biaxial_scene(options.scene, options.set), options);
  if (has_finished(request.folder, request.use, to_toml(request.scene)))
    {
      if (const Json summary = read_json(request.folder / "summary.json"); !summary.at("complete"))
        throw RunFailure(fmt::format("{}: this run has failed, and would fail again: {}", request.folder.string(),
                                     summary.at("failure").get<std::string>()));
      return tell_finished(request.folder, "biaxial", !options.no_figures);
    }
  check_result_folder(request.folder, request.use);
  const BiaxialSummary summary = run_biaxial(request);
  const std::string times = fmt::format("  time                     {}: packings {}, their tangents {}\n",
                                        duration_text(summary.wall_seconds), duration_text(summary.material_seconds),
                                        duration_text(summary.tangent_seconds));
  const Summary report = report_of(summary, request.scene);
  write_json(request.folder / "summary.json", report.json());
  leave_summary(request.folder, report.text(), times, "biaxial", !options.no_figures);
  if (!summary.complete)
    throw RunFailure(summary.failure);
}

constexpr SceneProgram biaxial{
    .name = "biaxial",
    .description = "A block of soil in plane strain, confined and compressed: does a shear band form?",
    .first_scene = "apps/scenes/biaxial/iwan.toml",
    .scene_text = "scene file (TOML); see docs/biaxial_scene_reference.md",
    .set_example = "test.steps=100",
    .threads_text = "threads that share the packings, 0: all the process may use; results do not depend on it",
    .manual_page = "docs/biaxial_scene_reference.md",
    .defaults = default_biaxial_scene,
    .manual = biaxial_scene_manual,
    .resolved = [](const std::string &scene,
                   const std::vector<std::string> &overrides) { return to_toml(read_biaxial_scene(scene, overrides)); },
    .run = run_scene,
    .guard = guarded_on_ranks};
} // namespace

int main(int argc, char **argv) { return biaxial.main(argc, argv); }
