// SPDX-License-Identifier: BSD-3-Clause
// What a column's scene says; what is refused is in tests/apps/deposit/scene_error_test.cpp.
#include "apps/deposit/scene.hpp"

#include "base/scene/document.hpp"
#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/near.hpp"
#include "tests/support/schema_checks.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <random>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
const std::string several = R"(title = "Three layers"
[mesh]
degree = 2
[water]
drainage = "coupled"
bulk_modulus = "200 MPa"
[[layer]]
name = "crust"
thickness = "2 m"
cell_size = "0.3 m"
permeability = "0 m/s"
material = "elastic"
shear_modulus = "30 MPa"
[[layer]]
name = "sand"
thickness = "6 m"
cells = 12
density = "1900 kg/m3"
permeability = "1e-2 cm/s"
material = "iwan"
shear_velocity = "160 m/s"
strength_ratio = 0.65
phase_transformation_ratio = 0.35
[base]
kind = "compliant"
density = "2300 kg/m3"
shear_velocity = "800 m/s"
[[motion]]
axis = "y"
kind = "record"
file = "motions/a.at2"
peak = "0.2 g"
baseline = "quadratic"
[[motion]]
kind = "ricker"
amplitude = "-1 m/s2"
frequency = "3 Hz"
[[motion]]
axis = "z"
kind = "harmonic"
amplitude = "5 gal"
frequency = "10 Hz"
duration = "8 s"
ramp = "1 s"
[load]
kind = "harmonic"
surcharge = "5 kPa"
amplitude = "2 kPa"
frequency = "1 Hz"
[analysis]
duration = "1 min"
time_step = "0.5 ms"
[output]
depths = ["0 m", "200 cm", "8 m"]
profile_interval = "0.1 s"
)";

std::string read_all(const std::string &path)
{
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ColumnScene, ReadsEverySection)
{
  const ColumnScene scene = parse_column_scene(several, "column.toml");
  EXPECT_EQ(scene.water.drainage, Drainage::coupled);
  EXPECT_EQ(scene.water.bulk_modulus, 200e6);
  ASSERT_EQ(scene.layers.size(), 2u);
  EXPECT_EQ(scene.layers[0].small_strain_modulus(), 30e6);
  EXPECT_EQ(scene.layers[0].n_cells(), 7u);
  EXPECT_EQ(scene.layers[1].small_strain_modulus(), 1900.0 * 160 * 160);
  EXPECT_EQ(scene.layers[1].permeability, 1e-4);
  EXPECT_EQ(scene.layers[1].material, LayerMaterial::iwan);
  EXPECT_EQ(scene.layers[1].iwan.strength_ratio, 0.65);
  EXPECT_EQ(scene.layers[1].iwan.contraction, 0.5);
  EXPECT_EQ(scene.base.kind, BaseKind::compliant);
  EXPECT_EQ(scene.base.rock_p_velocity(), 1600);
  ASSERT_EQ(scene.motions.size(), 3u);
  EXPECT_EQ(scene.motions[0].axis, Axis::y);
  EXPECT_EQ(scene.motions[0].peak, 0.2 * 9.80665);
  EXPECT_EQ(scene.motions[0].baseline, Baseline::quadratic);
  EXPECT_EQ(scene.motions[1].axis, Axis::x);
  EXPECT_EQ(scene.motions[1].amplitude, -1);
  EXPECT_EQ(scene.motions[1].peak_time(), 0.5);
  EXPECT_EQ(scene.motions[2].amplitude, 0.05);
  EXPECT_EQ(scene.load.kind, LoadKind::harmonic);
  EXPECT_EQ(scene.load.direction, Axis::z);
  EXPECT_EQ(scene.analysis.duration, 60);
  EXPECT_EQ(scene.analysis.time_step, 0.5e-3);
  EXPECT_EQ(scene.output.depths, (std::vector<double>{0, 2, 8}));
  EXPECT_FALSE(scene.output.paraview_interval);
}

/// The defaults of the table are those of the structs.
TEST(ColumnScene, DefaultsAreThoseOfTheStructs)
{
  ColumnScene expected;
  expected.water.drainage = Drainage::dry;
  expected.analysis.duration = 20;
  ColumnLayer one;
  one.thickness = 5;
  one.cells = 10;
  one.shear_velocity = 200;
  expected.layers = {one};
  expected.analysis.viscosity = 0; // of elastic soil
  find_in_situ_states(expected);
  EXPECT_DOUBLE_EQ(expected.layers[0].in_situ_pressure, 2.0 / 3 * 2000 * 9.81 * 2.5);
  EXPECT_EQ(parse_column_scene(smallest, "s"), expected);

  one.material = LayerMaterial::iwan;
  expected.analysis.viscosity = 1e-4;
  one.cells = 5;
  one.k0 = one.default_k0();
  expected.layers = {one};
  find_in_situ_states(expected);
  EXPECT_EQ(parse_column_scene(sand + dry + dynamic, "s"), expected);
  EXPECT_EQ(ColumnScene().water.drainage, parse_column_scene(consolidation, "s").water.drainage);
  EXPECT_EQ(ColumnScene().analysis.steps, parse_column_scene(consolidation, "s").analysis.steps);
}

TEST(ColumnScene, VelocityIsThatInSituUnlessAPressureIsGiven)
{
  const std::string load = "[load]\nsurcharge = \"30 kPa\"\n";
  const ColumnLayer plain = parse_column_scene(sand + undrained + dynamic + load, "s").layers[0];
  const double pressure = (1 + 2 * plain.k0) / 3 * (30e3 + 1000 * 9.81 * 2.5);
  EXPECT_DOUBLE_EQ(plain.in_situ_pressure, pressure);
  EXPECT_EQ(plain.sand().reference_pressure, plain.in_situ_pressure);
  EXPECT_DOUBLE_EQ(Iwan(plain.sand(), 1).shear_modulus(pressure), 2000.0 * 200 * 200);
  EXPECT_EQ(plain.in_situ_modulus(), 2000.0 * 200 * 200);
  const ColumnLayer given =
      parse_column_scene(sand + "reference_pressure = \"100 kPa\"\n" + undrained + dynamic + load, "s").layers[0];
  EXPECT_EQ(given.sand().reference_pressure, 100e3);
  EXPECT_DOUBLE_EQ(given.in_situ_modulus(), 2000.0 * 200 * 200 * std::sqrt(pressure / 100e3));
}

TEST(ColumnScene, ProfileHasTheLayersOfTheScene)
{
  const ColumnScene scene = parse_column_scene(several, "s");
  const SoilProfile profile = soil_profile(scene);
  ASSERT_EQ(profile.layers.size(), 2u);
  EXPECT_EQ(profile.layers[0].name, "crust");
  EXPECT_EQ(profile.layers[0].n_cells(), 7u);
  EXPECT_EQ(profile.layers[1].name, "sand");
  EXPECT_EQ(profile.layers[1].n_cells(), 12u);
  EXPECT_EQ(profile.height(), scene.height());
  EXPECT_EQ(profile.water.bulk_modulus, 200e6);
  EXPECT_NEAR_BECAUSE(profile.vertical_effective_stress(0), (2 * 1000 + 6 * 900) * 9.81, 1e-9,
                      "round-off of sums of 1e5 Pa");
  // all weight is effective without water
  EXPECT_NEAR_BECAUSE(soil_profile(parse_column_scene(smallest, "s")).vertical_effective_stress(0), 5 * 2000 * 9.81,
                      1e-9, "round-off of sums of 1e5 Pa");
}

TEST(ColumnScene, CellsFromTheirSize)
{
  const auto cells = [](const char *size) {
    return parse_column_scene(layer_without_cells + dry + dynamic, "s", {std::string("layer.0.cell_size=") + size})
        .layers[0]
        .n_cells();
  };
  EXPECT_EQ(cells("0.1 m"), 50u);
  EXPECT_EQ(cells("0.5 m"), 10u);
  EXPECT_EQ(cells("0.49 m"), 11u);
  EXPECT_EQ(cells("50 m"), 1u);
}

TEST(ColumnScene, UnitWeightsBecomeDensities)
{
  const ColumnScene scene =
      parse_column_scene(layer + "unit_weight = \"19.62 kN/m3\"\n" + dry + dynamic, "s",
                         {"base={ kind = 'compliant', unit_weight = '23.544 kN/m3', shear_velocity = '800 m/s' }"});
  EXPECT_EQ(scene.layers[0].density, 2000);
  EXPECT_NEAR_BECAUSE(scene.base.density, 2400, 1e-9, "round-off of a quotient");
  EXPECT_EQ(to_toml(scene).find("unit_weight"), std::string::npos);
  EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved"), scene);
}

/// 1 - sin(phi); of Iwan sin(phi) = M or, nearer to 1, what needs 0.9 M.
TEST(ColumnScene, K0FollowsFromFriction)
{
  const std::string soil = "[[layer]]\nthickness = \"5 m\"\nmaterial = \"mohr_coulomb\"\nshear_velocity = \"200 "
                           "m/s\"\ncells = 5\nfriction_angle = \"30 deg\"\n";
  EXPECT_NEAR_BECAUSE(parse_column_scene(soil + dry + dynamic, "s").layers[0].k0, 0.5, 1e-12, "round-off of an angle");
  EXPECT_EQ(parse_column_scene(smallest, "s").layers[0].k0, 0.5);
  const auto of_sand = [](const char *ratio) {
    return parse_column_scene(
               sand + dry + dynamic, "s",
               {"layer.0.phase_transformation_ratio=0.1", std::string("layer.0.strength_ratio=") + ratio})
        .layers[0]
        .k0;
  };
  EXPECT_NEAR_BECAUSE(of_sand("0.5"), 0.5, 1e-12, "the same formula");
  EXPECT_NEAR_BECAUSE(std::sqrt(3) * (1 - of_sand("0.65")) / (1 + 2 * of_sand("0.65")), 0.9 * 0.65, 1e-12,
                      "the same formula solved");
}

TEST(ColumnScene, TractionAndTimes)
{
  const ColumnScene step = parse_column_scene(consolidation, "s");
  EXPECT_EQ(step.load.traction(-1)[2], 0);
  EXPECT_EQ(step.load.traction(0)[2], -100e3);
  EXPECT_EQ(parse_column_scene(consolidation, "s", {"load.direction=x"}).load.traction(3)[0], 100e3);
  EXPECT_NEAR_BECAUSE(parse_column_scene(consolidation, "s", {"load.ramp=2 s"}).load.traction(1)[2], -50e3, 1e-9,
                      "round-off of an interpolation of 1e5 Pa");
  EXPECT_NEAR_BECAUSE(parse_column_scene(several, "s").load.traction(0.25)[2], -2e3, 1e-9,
                      "round-off of an interpolation of 1e5 Pa");
  EXPECT_EQ(ColumnLoad().traction(1)[2], 0);

  const std::vector<double> times = step.analysis.times();
  ASSERT_EQ(times.size(), 50u);
  EXPECT_EQ(times.front(), 1);
  EXPECT_EQ(times.back(), 7200);
  for (std::size_t i = 2; i < times.size(); ++i)
    EXPECT_NEAR_BECAUSE(times[i] / times[i - 1], times[1] / times[0], 1e-12, "round-off of powers of one ratio");
}

TEST(ColumnScene, OverridesReachLayersAndMotions)
{
  const ColumnScene scene = parse_column_scene(
      several, "s",
      {"layer.1.thickness=4 m", "layer.0.cells=3", "layer.1.shear_modulus=50MPa", "motion.0.factor=2",
       "output.depths=['1 m']", "base.kind=rigid", "base={ kind = 'rigid' }", "water.drainage=undrained"});
  EXPECT_EQ(scene.layers[1].thickness, 4);
  EXPECT_EQ(scene.layers[0].cells, 3u);
  EXPECT_EQ(scene.layers[0].cell_size, 0);
  EXPECT_EQ(scene.layers[1].shear_modulus, 50e6);
  EXPECT_FALSE(scene.layers[1].shear_velocity);
  EXPECT_EQ(scene.motions[0].factor, 2);
  EXPECT_FALSE(scene.motions[0].peak);
  EXPECT_EQ(scene.output.depths, std::vector<double>{1});
  EXPECT_EQ(scene.base.kind, BaseKind::rigid);
}

/// A value the key can hold, with random digits.
void scramble(const Key &key, const Field &field, std::mt19937_64 &random)
{
  std::uniform_real_distribution<double> unit(0, 1);
  const double low = std::max(key.range.low, 0.0), high = std::min(key.range.high, 1e3);
  double number = low + (high - low) * (0.1 + 0.8 * unit(random));
  if (key.unit.dimension == Dimension::angle)
    number = 0.01 + unit(random);
  if (double *const *plain = std::get_if<double *>(&field); plain && **plain != 0)
    **plain = number;
  else if (std::optional<double> *const *maybe = std::get_if<std::optional<double> *>(&field); maybe && **maybe)
    **maybe = number;
  else if (std::string *const *text = std::get_if<std::string *>(&field))
    **text = (*text)->empty() ? "" : "a \"b\" \\ c\n\t# \u00b5";
}

TEST(ColumnScene, RoundTripBitForBit)
{
  std::mt19937_64 random(5);
  for (const std::string &text : {several, smallest, consolidation, sand + undrained + dynamic})
    for (int repeat = 0; repeat < 50; ++repeat)
      {
        ColumnScene scene = parse_column_scene(text, "s");
        EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved"), scene) << to_toml(scene);
        for (const Key &key : column_schema().keys)
          if (key.section() == "layer")
            for (ColumnLayer &item : scene.layers)
              scramble(key, key.field(item), random);
          else if (key.section() == "motion")
            for (ColumnMotion &item : scene.motions)
              scramble(key, key.field(item), random);
          else if (key.section() != "refine") // box_test.cpp
            scramble(key, key.field(scene), random);
        for (ColumnLayer &item : scene.layers) // what rules bind, and what is not written
          {
            item.density = 1000 + scene.water.density / 3;
            if (item.shear_modulus)
              *item.shear_modulus *= 1e5;
            item.k0 = 0.5 + item.k0 / 20;
            item.saturation = scene.water.drainage == Drainage::coupled ? item.saturation : 1;
            item.iwan = item.material == LayerMaterial::iwan ? item.iwan : IwanParameters{};
            item.mohr_coulomb = {}; // its own test is below
            item.umat = {};         // likewise
            item.sand_density = {}; // excludes contraction; resistance_test.cpp
            if (item.material == LayerMaterial::iwan)
              item.iwan.phase_transformation_ratio = item.iwan.strength_ratio / 3;
          }
        for (ColumnMotion &item : scene.motions)
          {
            item.ramp = item.duration / 3;
            item.factor = item.peak || item.kind != MotionKind::record ? 1 : item.factor;
          }
        scene.water.henry = scene.water.drainage == Drainage::coupled ? scene.water.henry : 0;
        scene.water.atmospheric_pressure = 1e5 / 3;
        if (scene.base.kind == BaseKind::rigid)
          scene.base = {};
        scene.analysis.spectral_radius = ColumnAnalysis().spectral_radius;
        if (scene.analysis.kind == AnalysisKind::consolidation)
          {
            const ColumnAnalysis none;
            scene.analysis.safety = none.safety;
            scene.analysis.viscosity = none.viscosity;
            scene.analysis.highest_frequency = none.highest_frequency;
          }
        scene.plate = {}; // these have their own tests, in box_test.cpp
        scene.biaxial = {};
        scene.load_steps = {};
        scene.analysis.last_time = 7 * scene.analysis.first_time;
        for (double &depth : scene.output.depths)
          depth = scene.height() / 3;
        find_in_situ_states(scene);
        EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved"), scene) << to_toml(scene);
      }
}

TEST(ColumnScene, MohrCoulombLayerComesBackWithItsStiffness)
{
  const std::string text = "[[layer]]\nthickness = \"5 m\"\nmaterial = \"mohr_coulomb\"\nshear_velocity = \"200 "
                           "m/s\"\ncells = 5\n";
  const ColumnScene plain = parse_column_scene(text + dry + dynamic, "s");
  EXPECT_EQ(plain.layers[0].mohr_coulomb, MohrCoulombParameters{}); // defaults of the keys and of the struct
  const ColumnScene scene = parse_column_scene(
      text +
          "friction_angle = \"36.5 deg\"\ndilatancy_angle = \"6 deg\"\ncohesion = \"2 kPa\"\nsoftening_strain = 0.2\n" +
          "residual_friction_angle = \"31 deg\"\nresidual_dilatancy_angle = \"0 deg\"\nexponent = 0.5\n" + dry +
          dynamic,
      "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved"), scene) << to_toml(scene);
  const MohrCoulombParameters soil = scene.layers[0].frictional_soil();
  EXPECT_EQ(soil.shear_modulus, 2000.0 * 200 * 200);
  EXPECT_EQ(soil.poisson_ratio, 0.3);
  EXPECT_EQ(soil.residual_dilatancy, 0.0);
  EXPECT_FALSE(soil.residual_cohesion);
}

TEST(ColumnScene, PrintedDefaultsAreAScene)
{
  const ColumnScene scene = parse_column_scene(default_column_scene(), "default.toml");
  EXPECT_EQ(scene.layers.size(), 1u);
  EXPECT_EQ(scene.motions.size(), 1u);
  EXPECT_EQ(scene.motions[0].kind, MotionKind::ricker);
  for (const Key &key : column_schema().keys)
    EXPECT_TRUE(key.table || default_column_scene().find(std::string(key.name()) + " = ") != std::string::npos)
        << key.path;
}

TEST(ColumnSchema, EveryKeyIsDescribed) { test::expect_described(column_schema()); }

TEST(ColumnManual, EqualsTheFileInDocs)
{
  EXPECT_EQ(read_all(ISOSTAT_SOURCE_DIR "/docs/column_scene_reference.md"), column_scene_manual())
      << "regenerate docs/column_scene_reference.md from column_scene_manual()";
}

TEST(ColumnScenes, AllParseAndSayWhatTheyShow)
{
  int n_scenes = 0;
  for (const auto &entry : fs::directory_iterator(ISOSTAT_SOURCE_DIR "/apps/scenes/column"))
    {
      if (entry.path().extension() != ".toml")
        continue;
      SCOPED_TRACE(entry.path().string());
      ++n_scenes;
      // Libraries of specimens are made by the user: any file stands for them here.
      std::ifstream file(entry.path());
      const std::string text((std::istreambuf_iterator<char>(file)), {});
      std::vector<std::string> overrides;
      if (text.find("\n[grains]") != std::string::npos)
        overrides = {"grains.library=" + entry.path().string()};
      const ColumnScene scene = read_column_scene(entry.path().string(), overrides);
      EXPECT_FALSE(scene.title.empty());
      EXPECT_EQ(scene.output.folder, "results/" + entry.path().stem().string());
      EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved.toml"), scene);
    }
  EXPECT_GE(n_scenes, 4);
}
} // namespace
} // namespace isostat
