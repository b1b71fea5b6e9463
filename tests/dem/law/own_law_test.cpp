// SPDX-License-Identifier: BSD-3-Clause
// A second contact law, made outside the library (soft_spheres/), through the loop, the time step, scenes and files.
#include "base/error.hpp"
#include "dem/assembly/assembly.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/motion/critical_step.hpp"
#include "dem/rve/rve.hpp"
#include "dem/scene/scene.hpp"
#include "tests/dem/contact/random_cloud.hpp"
#include "tests/dem/contact/soft_spheres/law.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <hwy/targets.h>

namespace isostat
{
namespace
{
using test::SoftSpheres;

const bool registered = (register_law(SoftSpheres()), true);

/// Velocities of two grains in a wide box that meet head on along x.
Snapshot two_grains(double speed)
{
  constexpr double radius = 1e-3;
  Snapshot s;
  s.grains = make_packing({Vec3(-1.01 * radius, 0, 0), Vec3(1.01 * radius, 0, 0)}, {radius, radius}, 2650);
  s.grains.set_linear_velocity(0, Vec3(speed, 0, 0));
  s.grains.set_linear_velocity(1, Vec3(-speed, 0, 0));
  s.box = {Vec3::Constant(-1), Vec3::Constant(1)};
  s.law = SoftSpheres();
  return s;
}

double safe_step(const Assembly &a)
{
  return 0.05 * critical_step_bound(a.law(), a.packing(), a.walls(), a.contacts());
}
} // namespace

TEST(OwnLaw, LoopGivesItsEquationOnEveryInstructionSet)
{
  const test::Cloud cloud = test::random_cloud(7);
  const SoftSpheres law;
  std::vector<Vec3> expected(cloud.packing.n_grains(), Vec3::Zero());
  for (const auto &[i, j] : cloud.pairs)
    {
      const double r1 = cloud.packing.radius(i), r2 = cloud.packing.radius(j);
      const Vec3 branch = cloud.packing.centre(j) - cloud.packing.centre(i);
      if (const double overlap = r1 + r2 - branch.norm(); overlap > 0)
        {
          const Vec3 force = law.normal_force(r1, r2, overlap) * branch.normalized();
          expected[i] -= force, expected[j] += force;
        }
    }
  for (const std::int64_t set : test::instruction_sets())
    {
      hwy::SetSupportedTargetsForTest(set);
      ContactList list(law.history());
      list.replace_pairs(cloud.pairs, static_cast<std::uint32_t>(cloud.packing.n_grains()));
      AlignedVector<double> action(8 * list.n_slots(), 0.0);
      add_contact_forces(law, cloud.packing, 1e-8, list, action.data());
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_BELOW_BECAUSE((Vec3(&action[8 * i]) - expected[i]).norm(), 1e-11 * (1 + expected[i].norm()),
                             "round-off of overlaps, 1e-16 of a position over 1e-5 of it")
            << hwy::TargetName(set);
    }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(OwnLaw, TwoGrainsBounceBackAsFastAsTheyCame)
{
  Assembly assembly(two_grains(0.1));
  assembly.settings.damping = 0;
  assembly.settings.time_step = safe_step(assembly);
  for (bool parted = false; !parted; assembly.move(assembly.box()))
    {
      assembly.compute_forces();
      parted = assembly.snapshot().contacts.empty() && assembly.packing().linear_velocity(0)[0] < 0;
      ASSERT_LT(assembly.step(), 100000u);
    }
  EXPECT_NEAR_BECAUSE(assembly.packing().linear_velocity(0)[0], -0.1, 1e-3 * 0.1,
                      "leapfrog: the square of a step's share of the impact, which takes some 60");
  EXPECT_DOUBLE_EQ(assembly.packing().linear_velocity(1)[0], -assembly.packing().linear_velocity(0)[0]);
  EXPECT_EQ(assembly.packing().angular_velocity(0), Vec3::Zero());
}

TEST(OwnLaw, PackingKeepsItsEnergy)
{
  Snapshot start = import_tables(ISOSTAT_SOURCE_DIR "/tests/reference/n1000/medium", SoftSpheres(), 2650);
  Assembly assembly(start);
  assembly.settings.damping = 0;
  assembly.settings.measure_energy = true;
  assembly.settings.time_step = safe_step(assembly);
  for (int step = 0; step < 200; ++step)
    {
      assembly.compute_forces();
      assembly.move(assembly.box());
    }
  assembly.compute_forces();
  const EnergyBalance balance = assembly.energy();
  EXPECT_GT(balance.kinetic, 0);
  EXPECT_BELOW_BECAUSE(std::abs(balance.residual()), 0.05 * balance.kinetic,
                       "kinetic energy is that of half a step before: a twentieth of the critical step leaves a few %");
  EXPECT_EQ(balance.dissipated(), 0);
}

TEST(OwnLaw, IsAWordOfTheScene)
{
  ASSERT_TRUE(registered);
  const std::string head = "[grading]\n[specimen]\nrelative_density = 0.5\n[contact]\n";
  const Scene scene = parse_scene(head + "law = \"soft-spheres\"\nyoung = \"2 GPa\"\nsoftness = 0.25\n", "scene.toml");
  EXPECT_EQ(scene.contact->young, 2e9);
  EXPECT_EQ(scene.contact.as<SoftSpheres>().softness, 0.25);
  EXPECT_THAT(to_toml(scene), testing::HasSubstr("law = \"soft-spheres\"\n"));
  EXPECT_EQ(parse_scene(to_toml(scene), "again.toml"), scene);

  const Scene usual = parse_scene(head, "scene.toml");
  EXPECT_STREQ(usual.contact->name(), "linear-rolling");
  EXPECT_THAT(to_toml(usual), testing::Not(testing::HasSubstr("law = ")));
  EXPECT_ANY_THROW(parse_scene(head + "softness = 0.25\n", "scene.toml"));
  EXPECT_ANY_THROW(parse_scene(head + "law = \"soft-spheres\"\nstiffness_ratio = 0.3\n", "scene.toml"));
}

TEST(OwnLaw, BytesOfAnElementNameIt)
{
  Snapshot specimen = test::periodic_specimen(500, 10);
  specimen.law = SoftSpheres();
  specimen.law.as<SoftSpheres>().softness = 0.7;
  const Rve element(specimen, {});
  const Rve again = Rve::unpack(element.pack(), {});
  EXPECT_EQ(again.assembly().law(), specimen.law);
  EXPECT_EQ(again.stress(), element.stress());
}

using OwnLawFiles = TemporaryFolder;
TEST_F(OwnLawFiles, NameItAndKeepItsParameters)
{
  Snapshot s = two_grains(0);
  s.law.as<SoftSpheres>().softness = 0.7;
  hdf5::File file = hdf5::File::create(folder / "law.h5");
  write_snapshot(file.root().create_group("state"), s);
  file.commit();
  const hdf5::File again = hdf5::File::open(folder / "law.h5");
  EXPECT_EQ(read_snapshot(again.root().group("state")).law, s.law);
  EXPECT_THROW(law_named("hard-spheres"), InputError);
}
} // namespace isostat
