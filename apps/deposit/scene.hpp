// SPDX-License-Identifier: BSD-3-Clause
// What a run of the soil column consists of. Lengths m, stresses Pa, times s, accelerations m/s2, as everywhere inside.
#pragma once
#include "apps/deposit/biaxial.hpp"
#include "apps/deposit/layer_curve.hpp"
#include "apps/deposit/plate.hpp"
#include "base/scene/fragment.hpp"
#include "coupling/batch/rve_material_settings.hpp"
#include "coupling/in_situ/specimen_request.hpp"
#include "fem/material/liquefaction_resistance.hpp"
#include "fem/material/mohr_coulomb.hpp"
#include "fem/material/soil.hpp"
#include "fem/material/umat.hpp"
#include "fem/motion/base.hpp"
#include "fem/motion/motion_input.hpp"
#include "fem/space/block.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat
{
class SceneDocument;

/// What a file of the scene says: scenes that name it are equal.
template <typename T>
struct FromFile : std::shared_ptr<T>
{
  FromFile(std::shared_ptr<T> content = nullptr) : std::shared_ptr<T>(std::move(content)) {}
  bool operator==(const FromFile &) const { return true; }
};

struct ColumnMesh
{
  unsigned dimension = 1;    ///< 1 the column; 2 (x, z) and 3 a strip and a block
  unsigned degree = 2;       ///< of the displacement
  double width = 1;          ///< along x, in 3D along y too, m
  unsigned cells_across = 1; ///< along the same
  unsigned points = 0;       ///< Gauss points of an element along each axis; 0: those of MeshSpec
  Sides sides = Sides::tied;
  std::vector<double> ground_x, ground_z; ///< points of a surface that is not level, m; empty: level
  std::string file;                       ///< of Gmsh, in place of rectangles; empty: none
  FromFile<const GivenMesh> given;        ///< what it says, null without one
  bool distributed = false;               ///< one mesh over all ranks instead of a copy on each

  bool is_boundary(double x) const; ///< whether elements meet there

  bool operator==(const ColumnMesh &) const = default;
};

/// A part of the mesh whose elements are halved: Refinement.
struct ColumnRefinement
{
  std::vector<double> from, to; ///< x, in 3D y, and z above the base, m; empty: to the ends of the soil
  unsigned levels = 1;

  bool operator==(const ColumnRefinement &) const = default;
};

struct ColumnWater : Water
{
  Drainage drainage = Drainage::coupled;
  double table = 0;                    ///< its depth below the surface, m
  bool drained_base = false;           ///< water leaves through the base as well
  bool lagged_compressibility = false; ///< undrained only

  bool operator==(const ColumnWater &) const = default;
};

struct ColumnBase : Base
{
  std::optional<double> unit_weight; ///< only in files: check_column() makes a density of it, N/m3

  bool operator==(const ColumnBase &) const = default;
};

enum class LayerMaterial
{
  elastic,
  iwan,
  mohr_coulomb,
  grains, ///< a packing at every Gauss point (coupling/batch/rve_material.hpp)
  umat,   ///< a shared library (fem/material/umat.hpp)
  user    ///< given to the run by C++ or Python (apps/deposit/soil_material.hpp)
};

/// Their words in scenes and summaries, and those of Drainage.
inline constexpr const char *material_names[] = {"elastic", "iwan", "mohr_coulomb", "grains", "umat", "user"};
inline constexpr const char *drainage_names[] = {"dry", "undrained", "coupled"};

/// A layer with its material.
struct ColumnLayer : Layer
{
  LayerMaterial material = LayerMaterial::elastic;
  std::optional<double> unit_weight;                   ///< only in files, as that of ColumnBase
  std::optional<double> shear_modulus, shear_velocity; ///< one of them is set, of a formula
  std::optional<double> reference_pressure;            ///< of that stiffness, Pa; left out: in_situ_pressure
  double in_situ_pressure = 100e3;      ///< p' in the middle of the layer, Pa; follows from the scene when it is read
  double in_situ_depth = 0;             ///< of that place, m; likewise
  double poisson_ratio = 0.3;           ///< of the drained skeleton
  std::optional<double> damping;        ///< ratio of critical at small strain; left out: see small_strain_damping()
  LayerCurve curve;                     ///< of iwan
  std::optional<double> shear_strength; ///< of iwan at in_situ_pressure, Pa; left out: iwan.strength_ratio
  IwanParameters iwan;                  ///< ignored by other materials; its stiffness is the layer's, see sand()
  SandDensity sand_density;             ///< likewise; resisting_layer() gives its sand
  MohrCoulombParameters mohr_coulomb;   ///< likewise, see frictional_soil()
  SpecimenRequest grains;               ///< ignored by other materials
  UmatParameters umat;                  ///< likewise
  std::string table;                    ///< only in files: when a scene has been read, its rows have become layers

  bool from_formula() const { return shear_modulus || shear_velocity; }
  double small_strain_modulus() const;           ///< G, Pa, whichever of the two was given (rho V_s^2)
  double in_situ_modulus() const;                ///< G at in_situ_pressure, Pa
  IwanParameters sand() const;                   ///< `iwan` with the stiffness of the layer
  MohrCoulombParameters frictional_soil() const; ///< `mohr_coulomb` with the stiffness of the layer
  /// K0 of soil that was never loaded more, 1 - sin(phi) (Jaky 1944): phi the friction angle of mohr_coulomb; of iwan
  /// sin(phi) = M, as in simple shear between sigma_1 and sigma_3 tau = sin(phi) (sigma_1 + sigma_3)/2 and p' is their
  /// mean, but at least the K0 that needs nine tenths of M; else 0.5.
  double default_k0() const;

  bool operator==(const ColumnLayer &) const = default;
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
  AccelerationUnit unit = AccelerationUnit::stated;
  Baseline baseline = Baseline::none;
  double factor = 1;
  std::optional<double> peak; ///< instead of the factor
  double amplitude = 0, frequency = 0;
  double duration = 0, ramp = 0;  ///< harmonic
  std::optional<double> centre;   ///< ricker: time of its peak
  std::optional<double> interval; ///< between samples of harmonic and ricker
  std::optional<double> again;    ///< from its start to that of the second time, s

  double peak_time() const { return centre.value_or(1.5 / frequency); } ///< of a ricker, s
  /// Not of a record, s.
  double sample_interval() const
  {
    return interval.value_or(std::max(Motion::shortest_interval, 1 / (500 * frequency)));
  }

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
  double surcharge = 0; ///< vertical, there from the start and part of the in-situ stress, Pa of the surface
  std::optional<double> surcharge_from, surcharge_to; ///< x of the part of the surface that has it, m; left out: all
  Axis direction = Axis::z;
  double amplitude = 0; ///< along z compression is positive, Pa
  double frequency = 0; ///< harmonic: amplitude sin(2 pi f t)
  double ramp = 0;      ///< smooth rise from 0 to the whole, s

  bool bears_on_all() const; ///< the surcharge
  /// Traction at a time as the solvers take it: tension positive, Pa. The surcharge is not in it.
  std::array<double, 3> traction(double time) const;

  bool operator==(const ColumnLoad &) const = default;
};

enum class AnalysisKind
{
  dynamic,
  consolidation,
  plate,
  biaxial
};

/// Their words in scenes.
inline constexpr const char *analysis_names[] = {"dynamic", "consolidation", "plate", "biaxial"};

enum class TimeScheme
{
  explicit_,
  implicit
};

/// Their words in scenes.
inline constexpr const char *scheme_names[] = {"explicit", "implicit"};

struct ColumnAnalysis
{
  AnalysisKind kind = AnalysisKind::dynamic;
  double duration = 0;             ///< dynamic
  std::optional<double> time_step; ///< left out: `safety` of the stable one
  double safety = 0.8;
  TimeScheme scheme = TimeScheme::explicit_;
  double spectral_radius = 0.8;         ///< of implicit steps
  double mass_damping = 0;              ///< a_M, 1/s
  std::optional<double> viscosity;      ///< beta of SkeletonViscosity, s; 0: none; read_column_scene() sets it
  bool large_strain = false;            ///< DynamicsSettings::large_strain
  double highest_frequency = 25;        ///< of interest: what is faster may be damped, Hz
  double first_time = 0, last_time = 0; ///< consolidation
  unsigned steps = 50;
  std::string petsc; ///< options of the linear solvers; empty: direct

  /// Ends of the time steps of a consolidation, rising geometrically from first_time to last_time.
  std::vector<double> times() const;

  bool operator==(const ColumnAnalysis &) const = default;
};

struct ColumnOutput
{
  std::string folder;             ///< default: results/<scene file name>
  double history_interval = 0.01; ///< between rows
  std::vector<double> depths;     ///< below the surface; points with their own history, m
  std::optional<double> x; ///< where these depths, and profiles, are; left out: the middle between walls, else 0, m
  std::optional<double> profile_interval, paraview_interval; ///< left out: none
  double checkpoint_minutes = 5;
  double spectrum_damping = 0.05; ///< of critical

  bool operator==(const ColumnOutput &) const = default;
};

/// What packings of grains leave, where.
struct GrainOutput
{
  std::vector<double> snapshot_depths; ///< below the surface; whole packings are stored there, m
  std::vector<double> path_depths;     ///< below the surface; whole strain histories are stored there, m
  double snapshot_interval = 1;        ///< s

  bool operator==(const GrainOutput &) const = default;
};

/// A whole run: what a scene file says after defaults, overrides and checks.
struct ColumnScene
{
  std::string title;
  ColumnMesh mesh;
  std::vector<ColumnRefinement> refine;
  ColumnWater water;
  Slope slope;
  std::vector<ColumnLayer> layers; ///< from the surface down
  ColumnBase base;
  std::vector<ColumnMotion> motions; ///< at most one per axis
  ColumnLoad load;
  RveMaterialSettings grains; ///< as the scene says it; ignored without a layer of grains
  GrainOutput grain_output;   ///< likewise
  ColumnAnalysis analysis;
  Plate plate;          ///< ignored by other kinds of analysis
  Biaxial biaxial;      ///< likewise
  LoadSteps load_steps; ///< of a plate and a biaxial block
  ColumnOutput output;

  double height() const; ///< that of soil_profile(), m
  bool has_grains() const;
  bool needs_common_library() const;               ///< a layer of grains names none of its own
  RveMaterialSettings packings(int threads) const; ///< `grains` with the drainage of the scene

  bool operator==(const ColumnScene &) const = default; ///< bit for bit, every field
};

/// Layers and water as the solvers take them, layers in the order of the scene. Without water (dry) its density is 0,
/// so that all weight is effective.
SoilProfile soil_profile(const ColumnScene &scene);

/// Sets ColumnLayer::in_situ_pressure and in_situ_depth of all layers; a surcharge on a part of the surface does
/// not count. Reading a scene does so, too.
void find_in_situ_states(ColumnScene &scene);

/// The surface of a box that is not level.
GroundLine ground_line(const ColumnMesh &mesh);
/// The mesh of a scene, before a consolidation cuts its cells (deposit_space()); its plate is patch 0.
MeshSpec mesh_spec(const ColumnScene &scene);

/// The motions along x, y, z: read, corrected and scaled, or sampled. Rest where none is given. They have one clock:
/// the earliest first sample is at t = 0, those of records without times and of formulas are at 0 of that clock.
/// @throws InputError from the record's file
std::array<Motion, 3> column_motions(const ColumnScene &scene);

/// Reads and checks a scene file of the soil column. A relative motion file is looked for as found_file() does;
/// an output folder left out becomes results/<scene file name without ending>, and layers of a dynamic run without
/// `cells` get them (default_mesh.hpp).
/// @param overrides  "a.b=c" from --set, as in dem/scene/scene.hpp; `layer.0.thickness=2 m` is the uppermost layer
/// @throws InputError with file:line (or `--set a.b`), value, allowed range and remedy
/// tested: tests/apps/deposit/scene_test.cpp, tests/apps/deposit/scene_error_test.cpp
ColumnScene read_column_scene(const std::string &path, const std::vector<std::string> &overrides = {});

/// The same from text; `name` stands for the file in messages. Motion files are not looked for and keep their path, an
/// output folder left out stays empty; a `layer.table` is read, as read_column_scene() reads it. Cells left out are
/// those for analysis.highest_frequency if a motion is a record.
ColumnScene parse_column_scene(const std::string &text, const std::string &name,
                               const std::vector<std::string> &overrides = {});

/// The scene as a complete TOML file: parse_column_scene(to_toml(s)) equals every s that was read, bit for bit. Not
/// kept, because it has no effect: keys foreign to the kind of their table.
std::string to_toml(const ColumnScene &scene);

/// The keys of a soil column: fields are those of a ColumnScene, of a ColumnLayer below [[layer]] and of a ColumnMotion
/// below [[motion]].
const SceneSchema &column_schema();
SceneFragment<ColumnMotion> ground_motion_keys(); ///< those of [[motion]]
SceneFragment<ColumnAnalysis> analysis_keys();    ///< those of [analysis]
/// Rules that bind several keys.   @throws InputError   tested: tests/apps/deposit/scene_error_test.cpp
void check_column(const SceneDocument &document, ColumnScene &scene);

std::string default_column_scene(); ///< commented, with all defaults, units and ranges (--print-defaults)
std::string column_scene_manual();  ///< docs/column_scene_reference.md (a test compares them)
} // namespace isostat
