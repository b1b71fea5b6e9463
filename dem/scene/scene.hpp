// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/law.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace isostat
{
/// Grain sizes and the random cloud they start from (DESIGN 5).
struct GradingSpec
{
  std::string curve = "karlsruhe-fine-sand";    ///< name of a built-in curve; empty when `table` is given
  std::vector<std::pair<double, double>> table; ///< (diameter in m, percent finer by mass), rising; instead of `curve`
  double finest_percent = 0;                    ///< the curve is cut below this percentage finer and rescaled
  double coarsest_percent = 100;                ///< ... and above this one
  std::uint64_t grains = 10000;
  double cloud_edge = 10e-3;    ///< edge of the cube that holds the cloud, m
  double solid_fraction = 0.33; ///< of the cloud; with the edge it fixes the up-scaling of the grading
  double density = 2650;        ///< kg/m3
  std::uint64_t seed = 1;       ///< realisation

  bool operator==(const GradingSpec &) const = default;
};

/// How the specimen is made. Exactly one of relative_density, void_ratio, preparation_friction, file is set.
struct SpecimenSpec
{
  std::string domain = "rigid-box";
  std::string consolidation = "isotropic"; ///< or "k0": vertical stress `pressure`, no lateral strain; cell only
  double pressure = 200e3;                 ///< p0'; with "k0" the vertical effective stress, Pa
  std::optional<double> relative_density, void_ratio;
  std::optional<double> preparation_friction; ///< tan(phi) during isotropic compression
  std::string file;                           ///< a specimen (.h5), "library.h5#entry", or a folder of text tables
  double e_min = 0.568, e_max = 0.841;        ///< limits that define the relative density
  double density_tolerance = 0.01;            ///< on D_r
  double damping = 0.3;                       ///< local damping during preparation
  double compaction_rate = 30;     ///< wall strain-rate ceiling of the servo while the cloud is compacted, 1/s
  std::string cache = "specimens"; ///< folder of cached specimens, relative to the output folder's parent

  bool operator==(const SpecimenSpec &) const = default;
};

/// What specimen.file points to: "library.h5#s0007" is an entry of a library, all else a file or folder.
struct SpecimenPlace
{
  std::string path, entry; ///< no entry: empty
};
SpecimenPlace specimen_place(const std::string &file);

struct MotionSpec
{
  double damping = 0.2;                      ///< local (non-viscous) damping coefficient [-]
  std::optional<double> strain_rate;         ///< fixed axial rate, 1/s; instead of the tolerance
  std::optional<double> inertial_number;     ///< fixed I, the rate follows p'; instead of the tolerance
  double quasi_static_tolerance = 0.01;      ///< error indicator to be kept, see dem/drive/rate_control.hpp
  double rate_floor = 0.2, rate_ceiling = 2; ///< 1/s, bounds of the controlled rate
  double time_step_safety = 0.8;             ///< fraction of the critical step
  std::optional<double> time_step;           ///< fixed, s; checked against the critical step

  bool operator==(const MotionSpec &) const = default;
};

enum class StageKind
{
  compress,  ///< isotropic servo compression to `pressure`
  friction,  ///< set the intergranular friction
  rebalance, ///< keep the pressure until forces are in balance
  undrained_monotonic,
  undrained_cyclic,
  drained,                      ///< axial strain, lateral stresses kept
  constant_p,                   ///< axial strain, mean stress kept
  hold,                         ///< walls at rest
  k0_compress,                  ///< axial stress to `pressure`, no lateral strain: periodic cell only, as the next two
  undrained_simple_shear,       ///< shear strain gamma_xy at constant volume and shape otherwise
  undrained_cyclic_simple_shear ///< the same between +-stress_ratio times the initial vertical stress
};

/// Which family a kind of stage belongs to.
inline bool is_simple_shear(StageKind kind)
{
  return kind == StageKind::undrained_simple_shear || kind == StageKind::undrained_cyclic_simple_shear;
}
inline bool is_cyclic(StageKind kind)
{
  return kind == StageKind::undrained_cyclic || kind == StageKind::undrained_cyclic_simple_shear;
}
inline bool is_undrained(StageKind kind)
{
  return is_cyclic(kind) || kind == StageKind::undrained_monotonic || kind == StageKind::undrained_simple_shear;
}
inline bool is_shear(StageKind kind)
{
  return is_undrained(kind) || kind == StageKind::drained || kind == StageKind::constant_p;
}

/// One stage of the programme; which keys a kind takes is in the schema (dem/scene/schema.cpp).
struct Stage
{
  StageKind kind = StageKind::hold;
  double pressure = 0;              ///< Pa: compress, rebalance, k0-compress (0: the specimen's pressure)
  double friction = 0;              ///< tan(phi): friction
  bool extension = false;           ///< first loading direction; simple shear: gamma_xy falls first
  double strain = 0;                ///< axial, in simple shear gamma_xy: its amount ends a stage [-]
  double deviator_amplitude = 60e3; ///< q_amp, Pa: undrained-cyclic
  double stress_ratio = 0.15;       ///< CSR = tau_amp / sigma'_v0 [-]: undrained-cyclic-simple-shear
  double liquefaction_ratio = 0.01; ///< p'/p0 below which the specimen counts as liquefied
  std::uint64_t max_cycles = 200;   ///< a cyclic stage ends after so many
  std::uint64_t reversals_after_liquefaction = 10; ///< ... or so many reversals after initial liquefaction
  double max_strain = 0.15;                        ///< ... or when |axial strain| or |gamma_xy| exceeds this
  std::uint64_t max_steps = 0;                     ///< any stage: stop after so many steps (0: no limit)
  double balance = 1e-4;                           ///< unbalanced-force ratio that ends compress, rebalance, hold
  std::optional<double> strain_rate;               ///< fixed rate (axial or of gamma_xy), 1/s, instead of [motion]

  bool operator==(const Stage &) const = default;
};

struct OutputSpec
{
  std::string folder;                  ///< default: results/<scene file name>
  double record_stress = 1e3;          ///< a history row whenever p' or q has moved by this much, Pa
  double record_strain = 1e-4;         ///< ... or the axial strain by this much
  std::uint64_t record_steps = 5000;   ///< ... or after so many steps
  std::string snapshots = "reversals"; ///< "none", "reversals" (and stage ends), "strain"
  double snapshot_strain = 0.01;       ///< spacing for "strain"
  bool paraview = true;
  bool energy = false; ///< energy balance (a loop with dissipation sums)
  double checkpoint_minutes = 5;

  bool operator==(const OutputSpec &) const = default;
};

/// A whole run: what a scene file says after defaults, overrides and checks.
struct Scene
{
  std::string title;
  GradingSpec grading;
  Law contact;
  SpecimenSpec specimen;
  MotionSpec motion;
  std::vector<Stage> stages;
  OutputSpec output;

  bool operator==(const Scene &) const = default; ///< bit for bit, every field
};

/// Reads and checks a scene file. Angles of friction become their tangents here and nowhere else; an output folder left
/// out becomes results/<scene file name without ending>; a relative specimen.file counts from the working directory.
/// @param overrides  "a.b=c" strings from --set, applied before the checks; `stage.0.strain=...` addresses the array.
///        c is a TOML value, or else plain text (`specimen.pressure=200 kPa`, `=200kPa`). An override of one of several
///        keys that exclude each other (specimen.void_ratio, motion.strain_rate, grading.table ...) takes the place of
///        the one in the file; two such overrides are an error.
/// @throws InputError with file:line (or `--set a.b`), value, allowed range and remedy for an unknown key, a wrong unit
///         or type, a value out of range, a missing required key, keys that exclude each other, a missing file
/// tested: tests/dem/scene/scene_test.cpp, tests/dem/scene/scene_error_test.cpp
Scene read_scene(const std::string &path, const std::vector<std::string> &overrides = {});

/// The same from text; `name` stands for the file in messages. Does not touch the disk: specimen.file is not looked
/// for, and an output folder left out stays empty.
Scene parse_scene(const std::string &text, const std::string &name, const std::vector<std::string> &overrides = {});

/// The scene as a complete TOML file: every key with its value and unit. parse_scene(to_toml(s)) equals s to the bit
/// for every s that read_scene or parse_scene returned: numbers are written with the digits that bring them back,
/// friction as degrees, or as "0.3 tan" where no decimal number of degrees has that tangent. Not kept, because it has
/// no effect: the value of a switched-off part of the law, of a key that another one excludes, of a stage key foreign
/// to the kind of its stage, and of the consolidation in a rigid box.
std::string to_toml(const Scene &scene);

/// A commented TOML scene with all defaults, units, ranges and one sentence per key (--print-defaults).
std::string default_scene();

/// The table of all keys as Markdown: docs/scene_reference.md is this text (a test compares them).
std::string scene_manual();
} // namespace isostat
