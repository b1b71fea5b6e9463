// SPDX-License-Identifier: BSD-3-Clause
// What a run of the soil column consists of. Lengths m, stresses Pa, times s, accelerations m/s2, as everywhere inside.
#pragma once
#include "fem/material/soil.hpp"
#include "fem/motion/motion_input.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace isostat
{
struct ColumnMesh
{
  unsigned dimension = 1;    ///< 1 the column; 2 (x, z) and 3 with tied sides
  unsigned degree = 2;       ///< of the displacement
  double width = 1;          ///< along x, in 3D along y too, m
  unsigned cells_across = 1; ///< along the same
  bool distributed = false;  ///< one mesh over all ranks instead of a copy on each

  bool operator==(const ColumnMesh &) const = default;
};

struct ColumnWater
{
  Drainage drainage = Drainage::coupled;
  double density = 1000;               ///< kg/m3
  double bulk_modulus = 2.2e9;         ///< K_f, Pa
  double gravity = 9.81;               ///< m/s2, also of the soil's weight
  bool lagged_compressibility = false; ///< undrained only

  bool operator==(const ColumnWater &) const = default;
};

enum class LayerMaterial
{
  elastic,
  iwan,
  grains ///< a packing at every Gauss point (coupling/batch/rve_material.hpp)
};

/// Numbers of the sand of fem/material/iwan.hpp (IwanParameters says what they mean); its small-strain stiffness is the
/// layer's at `reference_pressure`. The defaults are a loose sand.
struct IwanSpec
{
  double reference_pressure = 100e3;       ///< Pa
  double exponent = 0.5;                   ///< of G ~ (p'/reference_pressure)^exponent [-]
  double strength_ratio = 0.55;            ///< sqrt(J2)/p' at most [-]
  double phase_transformation_ratio = 0.4; ///< sqrt(J2)/p' beyond which shearing dilates [-]
  double contraction = 0.5, dilation = 0.3;
  double fabric_limit = 8, fabric_rate = 1000;
  double critical_pressure = 1e6; ///< Pa
  unsigned elements = 12;

  bool operator==(const IwanSpec &) const = default;
};

/// Which specimens of the library a layer of grains is made of.
struct GrainsSpec
{
  std::optional<double> relative_density; ///< D_r; left out: the library has one density only
  std::uint64_t realisation = 0;          ///< the first of the layer's seeds

  bool operator==(const GrainsSpec &) const = default;
};

/// A layer with its material; from the surface down in a ColumnScene.
struct ColumnLayer
{
  std::string name;
  double thickness = 0;
  unsigned cells = 0;      ///< through its thickness; 0: from cell_size
  double cell_size = 0;    ///< largest height of a cell, m
  double density = 2000;   ///< of soil and water together, kg/m3
  double porosity = 0.4;   ///< [-]
  double permeability = 0; ///< hydraulic conductivity, m/s
  double k0 = 0.5;         ///< sigma'_h / sigma'_v in situ [-]
  LayerMaterial material = LayerMaterial::elastic;
  std::optional<double> shear_modulus, shear_velocity; ///< one of them is set
  double poisson_ratio = 0.3;                          ///< of the drained skeleton
  IwanSpec iwan;                                       ///< of no meaning to other materials
  GrainsSpec grains;                                   ///< of no meaning to other materials

  double small_strain_modulus() const; ///< G, Pa, whichever of the two was given (rho V_s^2)
  unsigned n_cells() const;            ///< whichever of the two was given

  bool operator==(const ColumnLayer &) const = default;
};

enum class BaseKind
{
  rigid,    ///< the base has the given motion
  compliant ///< elastic rock, the motion is that of its outcrop
};

struct ColumnBase
{
  BaseKind kind = BaseKind::rigid;
  double density = 2300;            ///< of the rock, kg/m3
  double shear_velocity = 800;      ///< m/s
  std::optional<double> p_velocity; ///< m/s

  double rock_p_velocity() const { return p_velocity.value_or(2 * shear_velocity); } ///< Poisson's ratio 1/3

  bool operator==(const ColumnBase &) const = default;
};

enum class Axis
{
  x,
  y,
  z
};

enum class MotionKind
{
  record,
  harmonic,
  ricker
};

/// The motion along one axis.
struct ColumnMotion
{
  Axis axis = Axis::x;
  MotionKind kind = MotionKind::record;
  std::string file; ///< after read_column_scene an absolute path
  AccelerationUnit unit = AccelerationUnit::g;
  Baseline baseline = Baseline::none;
  double factor = 1;
  std::optional<double> peak; ///< instead of the factor
  double amplitude = 0, frequency = 0;
  double duration = 0, ramp = 0;  ///< harmonic
  std::optional<double> centre;   ///< ricker: time of its peak
  std::optional<double> interval; ///< between samples of harmonic and ricker
  std::optional<double> again;    ///< start of the same motion for the second time, s

  double peak_time() const { return centre.value_or(1.5 / frequency); }               ///< of a ricker, s
  double sample_interval() const { return interval.value_or(1 / (500 * frequency)); } ///< not of a record, s

  bool operator==(const ColumnMotion &) const = default;
};

enum class LoadKind
{
  none,
  step,
  harmonic
};

/// Traction on the surface.
struct ColumnLoad
{
  LoadKind kind = LoadKind::none;
  double surcharge = 0; ///< vertical, there from the start and part of the in-situ stress, Pa
  Axis direction = Axis::z;
  double amplitude = 0; ///< along z compression is positive, Pa
  double frequency = 0; ///< harmonic: amplitude sin(2 pi f t)
  double ramp = 0;      ///< smooth rise from 0 to the whole, s

  /// Traction along `direction` at a time as the solver wants it: tension positive, Pa. The surcharge is not in it.
  double traction(double time) const;

  bool operator==(const ColumnLoad &) const = default;
};

enum class AnalysisKind
{
  dynamic,
  consolidation
};

struct ColumnAnalysis
{
  AnalysisKind kind = AnalysisKind::dynamic;
  double duration = 0;             ///< dynamic
  std::optional<double> time_step; ///< left out: `safety` of the stable one
  double safety = 0.8;
  double mass_damping = 0;              ///< a_M, 1/s
  double first_time = 0, last_time = 0; ///< consolidation
  unsigned steps = 50;

  /// Ends of the time steps of a consolidation, rising geometrically from first_time to last_time.
  std::vector<double> times() const;

  bool operator==(const ColumnAnalysis &) const = default;
};

struct ColumnOutput
{
  std::string folder;             ///< default: results/<scene file name>
  double history_interval = 0.01; ///< between rows
  std::vector<double> depths;     ///< below the surface; points with a history of their own, m
  std::optional<double> profile_interval, paraview_interval; ///< left out: none
  double checkpoint_minutes = 5;
  double spectrum_damping = 0.05; ///< of critical

  bool operator==(const ColumnOutput &) const = default;
};

enum class GrainsInSitu
{
  all_stresses,     ///< vertical and horizontal stress as the layer's weight and k0 say
  no_lateral_strain ///< the horizontal stress is what the packing gives
};

/// How packings of grains are run.
struct ColumnGrains
{
  std::string library; ///< of specimens; after read_column_scene an absolute path
  std::string cache;   ///< file of in-situ states for the next start; empty: none
  GrainsInSitu in_situ = GrainsInSitu::all_stresses;
  std::uint64_t realisations = 1;            ///< packings of a point
  double quasi_static_tolerance = 0.01;      ///< as in the element tests [-]
  double rate_floor = 0.2, rate_ceiling = 2; ///< 1/s
  std::uint64_t min_steps = 20;              ///< time steps of the grains in a step of the column, at least
  double damping = 0.2;                      ///< [-]
  std::vector<double> snapshot_depths;       ///< below the surface; whole packings are stored there, m
  double snapshot_interval = 1;              ///< s
  std::vector<double> path_depths;           ///< below the surface; whole strain histories are stored there, m

  bool operator==(const ColumnGrains &) const = default;
};

/// A whole run: what a scene file says after defaults, overrides and checks.
struct ColumnScene
{
  std::string title;
  ColumnMesh mesh;
  ColumnWater water;
  std::vector<ColumnLayer> layers; ///< from the surface down
  ColumnBase base;
  std::vector<ColumnMotion> motions; ///< at most one per axis
  ColumnLoad load;
  ColumnGrains grains; ///< of no meaning without a layer of grains
  ColumnAnalysis analysis;
  ColumnOutput output;

  double height() const;
  bool has_grains() const;

  bool operator==(const ColumnScene &) const = default; ///< bit for bit, every field
};

/// Layers from the base up, as the solvers take them; layer k of the scene is layer n-1-k of the profile. Without water
/// (dry) its density is 0, so that all weight is effective.
SoilProfile soil_profile(const ColumnScene &scene);

/// The motions along x, y, z: read, corrected and scaled, or sampled. Rest where none is given.
/// @throws InputError from the record's file
std::array<Motion, 3> column_motions(const ColumnScene &scene);

/// Reads and checks a scene file of the soil column. A relative motion file counts from the folder of the scene file;
/// an output folder left out becomes results/<scene file name without ending>.
/// @param overrides  "a.b=c" from --set, as in dem/scene/scene.hpp; `layer.0.thickness=2 m` is the uppermost layer
/// @throws InputError with file:line (or `--set a.b`), value, allowed range and remedy
/// tested: tests/apps/deposit/scene_test.cpp, tests/apps/deposit/scene_error_test.cpp
ColumnScene read_column_scene(const std::string &path, const std::vector<std::string> &overrides = {});

/// The same from text; `name` stands for the file in messages. Does not touch the disk: motion files are not looked for
/// and keep their path, an output folder left out stays empty.
ColumnScene parse_column_scene(const std::string &text, const std::string &name,
                               const std::vector<std::string> &overrides = {});

/// The scene as a complete TOML file: parse_column_scene(to_toml(s)) equals s to the bit for every s that was read. Not
/// kept, because it has no effect: keys foreign to the kind of their table.
std::string to_toml(const ColumnScene &scene);

std::string default_column_scene(); ///< commented, with all defaults, units and ranges (--print-defaults)
std::string column_scene_manual();  ///< docs/column_scene_reference.md (a test compares them)
} // namespace isostat
