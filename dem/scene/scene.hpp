// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/programme.hpp"
#include "dem/law/law.hpp"
#include "dem/scene/sand.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace isostat
{
/// Grain sizes and the random cloud they start from.
struct GradingSpec
{
  std::string curve = "karlsruhe-fine-sand";    ///< name of a built-in curve; empty when `table` is given
  std::vector<std::pair<double, double>> table; ///< (diameter in m, percent finer by mass), rising; instead of `curve`
  double finest_percent = 0;                    ///< the curve is cut below this percentage finer and rescaled
  double coarsest_percent = 100;                ///< ... and above this one
  std::uint64_t grains = 10000;
  double cloud_edge = 10e-3;      ///< edge of the cube that holds the cloud, m; without meaning where d50 is set
  std::optional<double> d50 = {}; ///< median diameter by mass of the grains made, m; the edge follows from it
  double solid_fraction = 0.33;   ///< of the cloud; with the edge it fixes the up-scaling of the grading
  double density = 2650;          ///< kg/m3
  std::uint64_t seed = 1;         ///< realisation

  bool operator==(const GradingSpec &) const = default;
};

/// The edge of a cloud that a scene leaves out, m: this many grains are as large as 10,000 of them in 10 mm.
double usual_cloud_edge(std::uint64_t grains);

/// Densities of grains, kg/m3, that scenes and files of packings may have: 2.65 is meant in g/cm3, 2.65e6 in g/m3.
/// Between them there is room for light models of grains, and for heavy ones that make the time step longer.
inline constexpr double lightest_grains = 30, heaviest_grains = 1e6;

/// How the specimen is made. Exactly one of relative_density, void_ratio, preparation_friction, file is set.
struct SpecimenSpec : ServoSpec
{
  std::string domain = "rigid-box";
  std::string consolidation = "isotropic"; ///< or "k0": vertical stress `pressure`, no lateral strain; cell only
  std::optional<double> relative_density, void_ratio;
  std::optional<double> preparation_friction; ///< tan(phi) during isotropic compression
  double expansion = 0;                       ///< strain by which it is opened and compressed again; 0: it is not
  std::string file;                           ///< a specimen or snapshot (.h5), or "library.h5#entry"
  /// Limits that define the relative density: those of Karlsruhe fine sand as the paper's packings have them. A grading
  /// of the user, and a packing from a file, have none unless they are given.
  std::optional<double> e_min = 0.568, e_max = 0.841;
  double density_tolerance = 0.01; ///< on D_r
  double damping = 0.3;            ///< local damping during preparation
  std::string cache = "specimens"; ///< folder of cached specimens, relative to the output folder's parent

  bool has_limits() const { return e_min && e_max; }
  bool operator==(const SpecimenSpec &) const = default;
};

/// Remedy in messages for a relative density without its limits.
inline constexpr const char *no_limits =
    "needs e_min and e_max of this grading; those of Karlsruhe fine sand hold for no other. Find them with "
    "void_ratio_limits and give specimen.e_min and specimen.e_max, or give void_ratio or preparation_friction instead.";

/// What specimen.file points to: "library.h5#s0007" is an entry of a library, all else a file.
struct SpecimenPlace
{
  std::string path, entry; ///< no entry: empty
};
SpecimenPlace specimen_place(const std::string &file);

/// Keys of [grading] and [specimen] that a text, or --set, gave values to. A scene is the same whichever of its values
/// were written out, so all of these are equal.
struct WrittenKeys
{
  std::vector<std::string> paths; ///< "specimen.pressure"

  bool has(std::string_view path) const { return std::ranges::find(paths, path) != paths.end(); }
  bool operator==(const WrittenKeys &) const { return true; }
};

/// What is written, and how often.
struct OutputSpec : RecordSpec
{
  std::string folder; ///< default: results/<scene file name>
  bool paraview = true;
  bool energy = false; ///< energy balance (a loop with dissipation sums)
  double checkpoint_minutes = 5;
  double yield_margin = 1e-9; ///< of I_R and shares of contacts in the history, ContactLaw::yield() [-]

  bool operator==(const OutputSpec &) const = default;
};

/// A whole run: what a scene file says after defaults, overrides and checks.
struct Scene
{
  std::string title;
  SandSpec sand;
  GradingSpec grading;
  Law contact;
  SpecimenSpec specimen;
  MotionSpec motion;
  StaticDrive drive;
  ControlSpec control;
  std::vector<Stage> stages;
  OutputSpec output;
  WrittenKeys written; ///< what may have its default, and is held against a packing from a file all the same

  /// The part of it that is run on a specimen.
  Programme programme() const { return {motion, drive, specimen, output, control, stages}; }
  bool operator==(const Scene &) const = default; ///< bit for bit, every field
};

/// Reads and checks a scene file. Angles of friction become their tangents here and nowhere else; an output folder left
/// out becomes results/<scene file name without ending>; a relative specimen.file becomes absolute.
/// It counts from the folder of the scene file or else from the working directory (found_file()).
/// @param overrides  "a.b=c" strings from --set, applied before the checks; `stage.0.strain=...` addresses the array.
///        c is a TOML value, or else plain text (`specimen.pressure=200 kPa`, `=200kPa`). An override of one of several
///        keys that exclude each other (specimen.void_ratio, motion.strain_rate, grading.table ...) takes the place of
///        the one in the file; two such overrides are an error.
/// @throws InputError with file:line (or `--set a.b`), value, allowed range and remedy for an unknown key, a wrong unit
///         or type, a value out of range, a missing required key, keys that exclude each other, a missing file
/// tested: tests/dem/scene/scene_test.cpp, tests/dem/scene/scene_error_test.cpp
Scene read_scene(const std::string &path, const std::vector<std::string> &overrides = {});

/// The same from text; `name` stands for the file in messages, empty as in SceneDocument. Reads no file but that of a
/// sand: specimen.file is not searched for, and an output folder left out stays empty.
Scene parse_scene(const std::string &text, const std::string &name, const std::vector<std::string> &overrides = {});

/// The scene as a complete TOML file: every key with its value and unit. parse_scene(to_toml(s)) equals s bit for bit
/// for every s that read_scene or parse_scene returned: numbers are written with the digits that bring them back,
/// friction as degrees, or as "0.3 tan" where no decimal number of degrees has that tangent. Not kept, because it has
/// no effect: the value of a switched-off part of the law, of a key that another one excludes, of a stage key foreign
/// to the kind of its stage, the control of a scene without stages, and the consolidation in a rigid box. A scene whose
/// packing comes from a file has of the grading, and of a pressure that no stage takes, what was written.
std::string to_toml(const Scene &scene);

/// A commented TOML scene with all defaults, units, ranges and one sentence per key (--print-defaults).
std::string default_scene();

/// The table of all keys as Markdown: docs/scene_reference.md is this text (a test compares them).
std::string scene_manual();
} // namespace isostat
