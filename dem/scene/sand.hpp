// SPDX-License-Identifier: BSD-3-Clause
// Sands as files: a sand is a part of a scene, [grading], [contact] and [specimen], with a table [sand] that says where
// it comes from and where it holds. A scene takes one with `sand = "NAME"`, in place of that table.
#pragma once
#include "base/scene/fragment.hpp"

#include <optional>
#include <string>
#include <vector>

namespace isostat
{
class SceneDocument;
struct Scene;

/// What the numbers of a scene are worth. Nothing of it has an effect on the run; its range makes warnings.
struct SandSpec
{
  std::string name;                           ///< empty: the scene is of no sand
  std::string source, tests;                  ///< where its numbers come from; the tests they were compared with
  std::optional<double> misfit, blind_misfit; ///< of tests fitted and not fitted: rms of q and eps_v over their largest
  std::optional<double> lowest_pressure, highest_pressure;     ///< p0' of the tests, Pa
  std::optional<double> lowest_void_ratio, highest_void_ratio; ///< of the packings at the start of the tests
  std::optional<double> largest_strain;                        ///< axial, amount

  bool operator==(const SandSpec &) const = default;
};

/// The keys of [sand].
SceneFragment<SandSpec> sand_keys();

/// Replaces `sand = "NAME"` by what the file of that sand says, where the scene says nothing itself. Of keys that
/// exclude each other the scene's alone stays. A file name, which ends in .toml, counts as found_file() does; another
/// name is one of the installed sands, share/isostat/scenes/sands/NAME.toml.
/// @throws InputError  no such sand; a table in its file that makes no sand
/// tested: tests/dem/scene/sand_test.cpp
void take_sand(SceneDocument &document, const std::string &scene_path);

/// The table [sand] of a scene as text, for files of its packings; empty: it is of no sand.
std::string sand_text(const Scene &scene);
/// The same back.   @throws InputError
SandSpec sand_from(const std::string &text);

/// Why a value is outside of the range in which a sand was compared with tests; empty: it is not, or there is none.
/// @param what  "specimen.pressure = 800 kPa"
std::string beyond_pressures(const SandSpec &sand, const std::string &what, double pressure);
std::string beyond_void_ratios(const SandSpec &sand, const std::string &what, double void_ratio);
/// What of a scene is: pressures, strains, and the density that it asks for.
/// tested: tests/dem/scene/sand_test.cpp
std::vector<std::string> beyond_sand(const Scene &scene);
} // namespace isostat
