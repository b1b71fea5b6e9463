// SPDX-License-Identifier: BSD-3-Clause
// What a column's scene file or an override can have wrong, and the message for the user.
#include "apps/deposit/scene.hpp"
#include "base/error.hpp"
#include "base/scene/schema.hpp"
#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

/// See test::refusal().
std::string complaint(const std::string &text, const Overrides &overrides = {})
{
  return test::refusal([&] { parse_column_scene(text, "column.toml", overrides); });
}

TEST(ColumnSceneError, Layers)
{
  EXPECT_EQ(complaint(smallest), "accepted");
  EXPECT_EQ(complaint(dry + dynamic), "column.toml: layer; must have at least one layer. Write [[layer]] with its "
                                      "thickness for each layer, from the surface downwards.");
  expect_refused("layer = []\n" + dry + dynamic, {"column.toml:1: layer", "at least one layer"});
  expect_refused("[layer]\nthickness = \"1 m\"\n" + dry + dynamic,
                 {"column.toml:1: layer; must be an array", "[[layer]]"});
  for (const char *wrong : {"0 m", "-1 m"})
    expect_refused(smallest, {"layer.0.thickness", "must be in [0.001 m, 100000 m] because a layer without height"},
                   {std::string("layer.0.thickness=") + wrong});
  expect_refused(
      "[[layer]]\nthickness = \"0 m\"\nmaterial = \"elastic\"\n" + dynamic,
      {"column.toml:2: layer.0.thickness = 0 m; must be in [0.001 m, 100000 m]", "Give for example \"5 m\"."});
  expect_refused(layer + "permeability = \"-1e-5 m/s\"\n" + dynamic,
                 {"column.toml:6: layer.0.permeability = -1e-5 m/s; must be in [0 m/s, 1 m/s]"});
  expect_refused(layer + "permeability = \"1e-5 m\"\n" + dynamic, {"but m is the unit of a length"});
  expect_refused(layer + dynamic, {"column.toml:1: layer.0.permeability; is missing", "1e-5 m/s"});
  expect_refused(layer + "cell_size = \"1 m\"\n" + dry + dynamic,
                 {"column.toml:6: layer.0.cell_size = 1 m; excludes layer.0.cells (column.toml:5)"});
  expect_refused(layer_without_cells + "cells = 0\n" + dry + dynamic, {"layer.0.cells = 0; must be in [1, 1000000]"});
  expect_refused(layer_without_cells + "cell_size = \"1 um\"\n" + dry + dynamic, {"more than 1000000 cells"});
  expect_refused(layer + "shear_modulus = \"1 MPa\"\n" + dry + dynamic, {"excludes layer.0.shear_velocity"});
  expect_refused(layer + "poisson_ratio = 0.5\n" + dry + dynamic, {"must be in [0, 0.5)"});
  expect_refused(layer + "porosity = 1.0\n" + dry + dynamic, {"column.toml:6: layer.0.porosity", "in (0, 1)"});
  expect_refused(layer + "density = \"900 kg/m3\"\n" + undrained + dynamic, {"column.toml:6:", "floats away"});
  EXPECT_EQ(complaint(layer + "density = \"900 kg/m3\"\n" + dry + dynamic), "accepted");
}

TEST(ColumnSceneError, UnitsThatWereMeant)
{
  for (const char *density : {"18 kg/m3", "18 g/cm3"})
    expect_refused(layer + dry + dynamic, {"must be in [500 kg/m3, 4000 kg/m3] because dry peat"},
                   {std::string("layer.0.density=") + density});
  expect_refused(layer + "unit_weight = \"1850 kN/m3\"\n" + dry + dynamic,
                 {"column.toml:6: layer.0.unit_weight = 1850 kN/m3; must be in [5 kN/m3, 40 kN/m3]"});
  expect_refused(layer + "density = \"1850 kg/m3\"\nunit_weight = \"18.5 kN/m3\"\n" + dry + dynamic,
                 {"column.toml:7: layer.0.unit_weight = 18.5 kN/m3; excludes layer.0.density (column.toml:6)"});
  expect_refused(layer + dry + dynamic,
                 {"layer.0.shear_modulus = 50 Pa; gives a shear-wave velocity sqrt(G/density) of 0.158 m/s; must be in "
                  "[1 m/s, 6000 m/s]"},
                 {"layer.0.shear_modulus=50 Pa"});
  expect_refused(layer + dynamic, {"must be in [0 m/s, 1 m/s] because water flows down"},
                 {"layer.0.permeability=2 m/s"});
  expect_refused(smallest, {"base.density = 23 kg/m3; must be in [1000 kg/m3, 5000 kg/m3]"},
                 {"base={ kind = 'compliant', density = '23 kg/m3', shear_velocity = '800 m/s' }"});
}

/// sqrt(3) (1 - 0.3)/(1 + 0.6) = 0.758; of M = 0.55 from (sqrt(3) - M)/(sqrt(3) + 2 M) to (sqrt(3) + M)/(sqrt(3) -
/// 2 M).
TEST(ColumnSceneError, K0BeyondTheStrength)
{
  expect_refused(sand + "k0 = 0.3\n" + undrained + dynamic,
                 {"column.toml:6: layer.0.k0 = 0.3; needs a strength_ratio of 0.758",
                  "has 0.55, which allows a k0 from "
                  "0.417 to 3.611"});
  EXPECT_EQ(complaint(sand + "k0 = 0.42\n" + undrained + dynamic), "accepted");
  for (const char *ratio : {"0.3", "0.55", "0.8", "1.2", "2"})
    EXPECT_EQ(complaint(sand + "phase_transformation_ratio = 0.1\n" + undrained + dynamic,
                        {std::string("layer.0.strength_ratio=") + ratio}),
              "accepted");
}

TEST(ColumnSceneError, RangesOfTwoSidesHaveReasons)
{
  for (const Key &key : column_schema().keys)
    {
      const bool two_sided = std::isfinite(key.range.low) && std::isfinite(key.range.high);
      EXPECT_TRUE(!two_sided || std::string_view(key.reason).starts_with("because ")) << key.path;
    }
}

TEST(ColumnSceneError, Materials)
{
  EXPECT_EQ(complaint(sand + undrained + dynamic), "accepted");
  expect_refused(
      layer + "strength_ratio = 0.6\n" + dry + dynamic,
      {"column.toml:6: layer.0.strength_ratio = 0.6; does not belong to a layer of material \"elastic\", only "
       "to iwan. Remove it or change the material."});
  expect_refused("[[layer]]\nthickness = \"1 m\"\nmaterial = \"sand\"\n" + dynamic,
                 {"must be \"elastic\", \"iwan\", \"mohr_coulomb\", \"grains\", \"umat\" or \"user\""});
  expect_refused("[[layer]]\nthickness = \"1 m\"\n" + dynamic, {"layer.0.material; is missing"});
  expect_refused(layer + sand + undrained + dynamic, {"--set layer.1.phase_transformation_ratio", "strength_ratio"},
                 {"layer.1.phase_transformation_ratio=0.6"});
  expect_refused(sand + undrained + dynamic, {"must be in [0, 1]", "plastic work"}, {"layer.0.dilation=1.5"});
  expect_refused(sand + undrained + dynamic, {"must be in [4, 128]"}, {"layer.0.elements=140"});
  expect_refused(sand + "dilatoin = 3\n" + undrained + dynamic,
                 {"column.toml:6: layer.0.dilatoin", "mean layer.dilation?"});
}

TEST(ColumnSceneError, MohrCoulomb)
{
  const std::string soil = "[[layer]]\nthickness = \"5 m\"\nmaterial = \"mohr_coulomb\"\nshear_velocity = \"200 "
                           "m/s\"\ncells = 5\n";
  const std::string rest = dry + dynamic;
  EXPECT_EQ(complaint(soil + rest), "accepted");
  expect_refused(soil + "friction_angle = \"90 deg\"\n" + rest,
                 {"column.toml:6: layer.0.friction_angle = 90 deg; must be in [0 deg, 90 deg) because tan()"});
  expect_refused(soil + "friction_angle = \"30 deg\"\ndilatancy_angle = \"31 deg\"\n" + rest,
                 {"column.toml:7: layer.0.dilatancy_angle = 31 deg; must not exceed friction_angle", "smaller"});
  expect_refused(soil + "cohesion = \"-1 kPa\"\n" + rest, {"layer.0.cohesion = -1 kPa; must be >= 0 kPa"});
  expect_refused(soil + "softening_strain = 0.1\n" + rest,
                 {"column.toml:6: layer.0.softening_strain = 0.1; has no effect", "residual_friction_angle"});
  expect_refused(soil + "residual_friction_angle = \"33 deg\"\n" + rest,
                 {"layer.0.softening_strain; must be above 0", "softening_strain = 0.1"});
  expect_refused(soil + rest, {"--set layer.0.residual_friction_angle", "must not exceed friction_angle"},
                 {"layer.0.softening_strain=0.1", "layer.0.residual_friction_angle=41 deg"});
  expect_refused(layer + "cohesion = \"5 kPa\"\n" + rest,
                 {"does not belong to a layer of material \"elastic\", only to mohr_coulomb."});
}

TEST(ColumnSceneError, MeshAndWater)
{
  expect_refused(layer + "permeability = \"0 m/s\"\n" + dynamic + "[output]\nprofile_interval = \"1 s\"\n",
                 {"column.toml:10: output.profile_interval", "mesh.distributed"},
                 {"mesh.dimension=2", "mesh.distributed=true"});
  expect_refused(consolidation, {"--set mesh.degree: mesh.degree = 1; must be 2", "oscillate"}, {"mesh.degree=1"});
  expect_refused(consolidation, {"mesh.degree = 3; must be in [1, 2]"}, {"mesh.degree=3"});
  expect_refused(layer + undrained + dynamic + "[mesh]\ndimension = 2\n",
                 {"column.toml:11: mesh.dimension = 2; must be 1 if water.drainage is \"undrained\""});
  expect_refused(smallest, {"mesh.dimension = 4; must be in [1, 3]"}, {"mesh.dimension=4"});
  expect_refused(smallest, {"must be a whole number"}, {"mesh.dimension=1.5"});
  expect_refused(smallest, {"mesh.distributed = true; must be false in a column"}, {"mesh.distributed=true"});
  EXPECT_EQ(complaint(smallest, {"mesh.distributed=true", "mesh.dimension=3"}), "accepted");
  expect_refused("[[layer]]\nthickness = \"1 m\"\nmaterial = \"user\"\ndensity = \"2000 kg/m3\"\ncells = 1\n" + dry +
                     dynamic,
                 {"column.toml:3: layer.0.material", "must not be \"user\" if mesh.distributed is true"},
                 {"mesh.distributed=true", "mesh.dimension=2"});
  expect_refused(smallest, {"water.lagged_compressibility", "has no effect"}, {"water.lagged_compressibility=true"});
  EXPECT_EQ(complaint(layer + undrained + dynamic, {"water.lagged_compressibility=true"}), "accepted");
  expect_refused(layer + undrained + dynamic, {"analysis.large_strain = true; has no effect", "keeps its length"},
                 {"analysis.large_strain=true"});
  expect_refused(smallest, {"water.base = drained; has no effect unless water.drainage is \"coupled\""},
                 {"water.base=drained"});
  expect_refused(smallest, {"must be \"dry\", \"undrained\" or \"coupled\""}, {"water.drainage=wet"});
  expect_refused(smallest + "[water2]\n", {"column.toml:10: water2; is an unknown key. Did you mean water?"});
}

TEST(ColumnSceneError, Base)
{
  expect_refused(smallest + "[base]\nkind = \"compliant\"\n", {"column.toml:10: base.shear_velocity; is missing"});
  expect_refused(smallest + "[base]\nkind = \"compliant\"\nshear_velocity = \"800 m/s\"\n",
                 {"column.toml:10: base; must have exactly one of density, unit_weight. Give for example density = "
                  "\"2300 kg/m3\"."});
  expect_refused(smallest + "[base]\nkind = \"compliant\"\ndensity = \"2300 kg/m3\"\n",
                 {"column.toml:10: base.shear_velocity; is missing"});
  expect_refused(smallest + "[base]\ndensity = \"2300 kg/m3\"\n",
                 {"column.toml:11: base.density = 2300 kg/m3; does not belong to a base of kind \"rigid\", only to "
                  "compliant."});
  const std::string rock =
      smallest + "[base]\nkind = \"compliant\"\ndensity = \"2300 kg/m3\"\nshear_velocity = \"800 m/s\"\n";
  EXPECT_EQ(complaint(rock), "accepted");
  expect_refused(rock + "p_velocity = \"900 m/s\"\n", {"column.toml:14: base.p_velocity = 900 m/s; must be more"});
}

TEST(ColumnSceneError, Motions)
{
  const std::string ricker = "[[motion]]\nkind = \"ricker\"\namplitude = \"0.1 g\"\nfrequency = \"2 Hz\"\n";
  EXPECT_EQ(complaint(smallest + ricker), "accepted");
  expect_refused(smallest + ricker + ricker, {"column.toml:14: motion.1.axis; already has a motion (column.toml:10)"});
  EXPECT_EQ(complaint(smallest + ricker + ricker + "axis = \"y\"\n"), "accepted");
  expect_refused(smallest + ricker + "file = \"a.txt\"\n", {"column.toml:14:", "only to record."});
  expect_refused(smallest + ricker, {"motion.0.frequency = 0 Hz; must be in [0.001 Hz, 1000 Hz]"},
                 {"motion.0.frequency=0 Hz"});
  expect_refused(smallest + ricker, {"motion.0.interval = 1e-9 s; must be in [1e-5 s, 10 s]"},
                 {"motion.0.interval=1e-9 s"});
  expect_refused(smallest + ricker, {"must be an acceleration with its unit (m/s2, cm/s2 or g)"},
                 {"motion.0.amplitude=0.1"});
  expect_refused(smallest + ricker, {"there is no motion 1; column.toml has 1"}, {"motion.1.amplitude=1 g"});
  expect_refused(smallest + ricker, {"motions are addressed by number. Write motion.0"}, {"motion.x.amplitude=1 g"});
  const std::string record = "[[motion]]\nkind = \"record\"\n";
  expect_refused(smallest + record, {"column.toml:10: motion.0.file; is missing"});
  expect_refused(smallest + record + "file = \"\"\n", {"motion.0.file", "must name a file"});
  expect_refused(smallest + record + "file = \"a\"\nfactor = 2\npeak = \"1 g\"\n", {"excludes motion.0.factor"});
  expect_refused(smallest + "[[motion]]\nkind = \"harmonic\"\namplitude = \"1 g\"\nfrequency = \"1 Hz\"\n"
                            "duration = \"2 s\"\nramp = \"1.5 s\"\n",
                 {"column.toml:15: motion.0.ramp = 1.5 s; must be at most half of the duration, 2 s"});
}

TEST(ColumnSceneError, AnalysisAndLoad)
{
  EXPECT_EQ(complaint(consolidation), "accepted");
  expect_refused(layer + dry, {"column.toml: analysis.duration; is missing"});
  expect_refused(consolidation, {"does not belong to an analysis of kind \"consolidation\", only to dynamic"},
                 {"analysis.safety=0.5"});
  expect_refused(consolidation, {"water.drainage = dry; must be \"coupled\""}, {"water.drainage=dry"});
  expect_refused(consolidation, {"load.kind = none; must be \"step\""}, {"load={ kind = 'none' }"});
  expect_refused(consolidation, {"analysis.last_time = 1 s; must be after first_time, 1 s"},
                 {"analysis.last_time=1 s"});
  expect_refused(consolidation + "[[motion]]\nkind = \"ricker\"\namplitude = \"1 g\"\nfrequency = \"1 Hz\"\n",
                 {"column.toml:14: motion; has no effect in a consolidation"});
  expect_refused(smallest, {"must be in (0, 1] because beyond the stable step"}, {"analysis.safety=1.1"});
  expect_refused(smallest, {"analysis.mass_damping = -1 1/s; must be >= 0 1/s"}, {"analysis.mass_damping=-1 1/s"});
  expect_refused(smallest, {"analysis.viscosity = -1 ms; must be >= 0 ms"}, {"analysis.viscosity=-1 ms"});
  expect_refused(smallest, {"analysis.highest_frequency = 0 Hz; must be > 0 Hz"}, {"analysis.highest_frequency=0 Hz"});
  expect_refused(smallest, {"analysis.time_step = 0 s; must be > 0 ms"}, {"analysis.time_step=0 s"});
  expect_refused(smallest, {"load.amplitude; is missing"}, {"load.kind=step"});
  expect_refused(smallest, {"must be key=value. Give for example --set analysis.safety=0.5"}, {"safety"});
}

TEST(ColumnSceneError, ImplicitSteps)
{
  const std::string scene = smallest + "scheme = \"implicit\"\ntime_step = \"5 ms\"\n";
  EXPECT_EQ(complaint(scene, {"analysis.spectral_radius=1"}), "accepted");
  EXPECT_EQ(complaint(scene, {"analysis.petsc=-statics_ksp_type gmres -statics_pc_type ilu"}), "accepted");
  expect_refused(smallest + "scheme = \"implicit\"\n", {"column.toml:10: analysis.scheme", "Give analysis.time_step"});
  expect_refused(smallest, {"analysis.spectral_radius", "has no effect on explicit"}, {"analysis.spectral_radius=1"});
  expect_refused(scene, {"analysis.spectral_radius = 1.1; must be in [0, 1]"}, {"analysis.spectral_radius=1.1"});
  expect_refused(scene, {"analysis.safety", "has no effect on implicit"}, {"analysis.safety=0.5"});
  expect_refused(scene, {"analysis.viscosity", "has no effect on implicit"}, {"analysis.viscosity=0.1 ms"});
  expect_refused(scene, {"analysis.scheme", "drainage is \"undrained\""}, {"water.drainage=undrained"});
  expect_refused(scene, {"analysis.scheme", "large_strain"}, {"analysis.large_strain=true"});
  expect_refused(scene, {"analysis.scheme", "sand that liquefies, layer.0"},
                 {"water.drainage=coupled", "layer.0.permeability=1e-4 m/s", "layer.0.material=iwan",
                  "layer.0.reference_pressure=100 kPa"});
  expect_refused(scene, {"analysis.petsc", "begin with -statics_"}, {"analysis.petsc=-water_ksp_type gmres"});
}

TEST(ColumnSceneError, OptionsOfLinearSolvers)
{
  const Overrides options = {"analysis.petsc=-statics_ksp_type cg -statics_ksp_rtol 1e-8 -water_ksp_type gmres"};
  expect_refused(smallest, {"analysis.petsc", "no effect without a linear system"}, options);
  expect_refused(consolidation, {"has the word -water_ksp_type", "begin with -statics_"}, options);
  expect_refused(consolidation, {"has the word ksp_type"}, {"analysis.petsc=ksp_type cg"});
  EXPECT_EQ(complaint(consolidation, {"analysis.petsc=-statics_mat_mumps_icntl_14 -1"}), "accepted");
  EXPECT_EQ(complaint(consolidation, {"analysis.petsc=-statics_pc_type fieldsplit"}), "accepted");
}

TEST(ColumnSceneError, Output)
{
  const std::string head = smallest + "[output]\ndepths = ";
  EXPECT_EQ(complaint(head + "[\"5 m\"]\n"), "accepted");
  EXPECT_EQ(complaint(head + "[]\n"), "accepted");
  expect_refused(
      head + "[\"2 m\", \"5.1 m\"]\n",
      {"column.toml:11: output.depths = [\"2 m\", \"5.1 m\"]; must lie in the soil, in [0 m, 5 m], but entry "
       "2 is 5.1 m."});
  expect_refused(smallest, {"output.history_interval = 100 s; must be in (0 s, 10 s]"},
                 {"output.history_interval=100 s"});
  expect_refused(head + "[\"-1 m\"]\n", {"column.toml:11: output.depths", "must be >= 0 m"});
  expect_refused(head + "[2]\n", {"must be a length with its unit (m, cm, mm or um), in quotes"});
  expect_refused(head + "\"2 m\"\n", {"must be a list [...] whose entries are a length with its unit"});
  expect_refused(head + "[\"2 s\"]\n", {"but s is the unit of a time"});
}

TEST(ColumnSceneError, MotionFiles)
{
  const fs::path folder = fs::path(testing::TempDir()) / "isostat_column_scene_test";
  fs::create_directories(folder / "motions");
  const std::string scene = (folder / "shaken.toml").string();
  std::ofstream(scene) << smallest + "[[motion]]\nkind = \"record\"\nfile = \"motions/a.txt\"\n";
  test::expect_parts(
      test::refusal([&] { read_column_scene(scene); }),
      {scene + ":12: motion.0.file = motions/a.txt; does not exist: neither ", (folder / "motions/a.txt").string()});
  std::ofstream(scene) << smallest + "[[motion]]\nkind = \"record\"\nfile = \"motions\"\n";
  test::expect_parts(test::refusal([&] { read_column_scene(scene); }), {"motion.0.file = motions; is a folder: "});
  std::ofstream(scene) << smallest + "[[motion]]\nkind = \"record\"\nfile = \"motions/a.txt\"\n";
  std::ofstream(folder / "motions/a.txt") << "time (s) a (g)\n0 0\n1 0\n";
  const ColumnScene read = read_column_scene(scene);
  EXPECT_EQ(read.motions[0].file, (folder / "motions/a.txt").string());
  EXPECT_EQ(read.output.folder, "results/shaken");
  EXPECT_EQ(parse_column_scene(to_toml(read), "resolved"), read);
  EXPECT_THROW(read_column_scene("/nowhere/column.toml"), InputError);
  fs::remove_all(folder);
}
} // namespace
} // namespace isostat
