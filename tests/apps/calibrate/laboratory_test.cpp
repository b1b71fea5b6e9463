// SPDX-License-Identifier: BSD-3-Clause
// Curves of the laboratory, and what their files may have wrong.
#include "apps/calibrate/laboratory.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

const std::string header = "eps_a[%],eps_v[%],sigma_v[kPa],sigma_r[kPa]\n";
const std::string rows = "0,0,100,100\n1,0.2,200,100\n2,0.1,250,100\n4,-0.5,300,100\n";
constexpr test::Tolerance ten_operations{1e-12, "round-off of some ten operations"};

class LaboratoryFile : public testing::Test
{
protected:
  LaboratoryFile()
  {
    fs::create_directories(folder_);
    plan.path = (folder_ / "lab.csv").string();
    plan.strain_end = 0.04;
    plan.where = "plan.toml:9";
  }
  ~LaboratoryFile() override { fs::remove_all(folder_); }

  Curve read(const std::string &text, double pressure = 100e3)
  {
    std::ofstream(plan.path) << text;
    return read_laboratory(plan, pressure);
  }
  void expect_complaint(const std::string &text, const std::vector<std::string> &parts, double pressure = 100e3)
  {
    test::expect_parts(test::refusal([&] { read(text, pressure); }), parts);
  }

  PlanCurve plan;

private:
  fs::path folder_ = fs::temp_directory_path() /
                     (std::string("isostat_curve_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(LaboratoryFile, IsReadInItsUnits)
{
  const Curve curve = read(header + rows);
  EXPECT_THAT(curve.strain, testing::ElementsAre(0, 0.01, 0.02, 0.04));
  EXPECT_THAT(curve.q, testing::ElementsAre(0, 100e3, 150e3, 200e3));
  EXPECT_NEAR_BECAUSE(curve.other[3], -0.005, ten_operations);
  plan.columns = {"e1 (-)", "ev (-)", "s1 (MPa)", "s3 (Pa)", "", ""};
  const Curve other = read("s3 (Pa),s1 (MPa),e1 (-),ev (-)\n1e5,0.1,0,0\n1e5,0.3,0.05,0.001\n");
  EXPECT_THAT(other.strain, testing::ElementsAre(0, 0.05));
  EXPECT_NEAR_BECAUSE(other.q[1], 200e3, 1e-9, "round-off of numbers of 1e5");
}

TEST_F(LaboratoryFile, OfAnExtensionTestGrowsInItsDirection)
{
  plan.test = LaboratoryTest::undrained;
  plan.direction = LoadDirection::extension;
  const Curve curve = read("eps_a[%],p[kPa],q[kPa]\n0,100,0\n-1,80,-50\n-5,60,-70\n");
  EXPECT_THAT(curve.strain, testing::ElementsAre(0, 0.01, 0.05));
  EXPECT_THAT(curve.q, testing::ElementsAre(0, -50e3, -70e3));
  EXPECT_THAT(curve.other, testing::ElementsAre(100e3, 80e3, 60e3));
}

TEST_F(LaboratoryFile, NeedsItsColumnsWithUnits)
{
  expect_complaint("eps_a[%],eps_v[%],sigma_v[kPa]\n1,2,3\n", {"lab.csv:1: no column \"sigma_r[kPa]\""});
  plan.columns.strain = "eps_a";
  expect_complaint("eps_a,eps_v[%],sigma_v[kPa],sigma_r[kPa]\n" + rows,
                   {"lab.csv:1: column \"eps_a\": no unit; a strain must be in one of [%], [-]", "plan.toml:9"});
  plan.columns.strain = "eps_a[kPa]";
  expect_complaint("eps_a[kPa],eps_v[%],sigma_v[kPa],sigma_r[kPa]\n" + rows,
                   {"lab.csv:1", "the unit is kPa", "[%], [-]"});
  plan.columns.strain = "eps_a[%]";
  plan.columns.axial = "sigma_v[%]";
  expect_complaint("eps_a[%],eps_v[%],sigma_v[%],sigma_r[kPa]\n" + rows,
                   {"lab.csv:1", "a stress", "[Pa], [kPa], [MPa]"});
}

TEST_F(LaboratoryFile, WithWrongUnitsIsRefused)
{
  plan.columns.strain = "eps_a[-]";
  expect_complaint("eps_a[-],eps_v[%],sigma_v[kPa],sigma_r[kPa]\n" + rows, {"lab.csv:3: eps_a[-] = 1", "in percent?"});
  plan.columns.strain = "eps_a[%]";
  expect_complaint(header + "0,0,100,100\n0.01,0,200,100\n0.04,0,200,100\n",
                   {"lab.csv:4: eps_a[%] = 0.04", "before strain_end = 0.04 (4 %) of plan.toml:9"});
  plan.columns.volume = "eps_v[-]";
  expect_complaint("eps_a[%],eps_v[-],sigma_v[kPa],sigma_r[kPa]\n0,0,100,100\n4,-2,300,100\n",
                   {"lab.csv:3: eps_v[-] = -2", "no volumetric strain"});
  plan.columns.volume = "eps_v[%]";
  expect_complaint(header + rows,
                   {"lab.csv:2: sigma_r[kPa] = 100", "a lateral stress of 200 kPa", "25 %", "plan.toml:9"}, 200e3);
}

TEST_F(LaboratoryFile, WithStrainsThatGoBackIsRefused)
{
  expect_complaint(header + "0,0,100,100\n2,0,200,100\n1.5,0,150,100\n5,0,200,100\n",
                   {"lab.csv:4: eps_a[%] = 1.5; goes back from 2", "compression", "Remove unloading", "plan.toml:9"});
  plan.direction = LoadDirection::extension;
  expect_complaint(header + rows, {"lab.csv:3: eps_a[%] = 1; goes back from 0", "extension"});
}

TEST_F(LaboratoryFile, WithHolesIsRefused)
{
  expect_complaint(header + "0,0,100,100\n", {"lab.csv:1", "fewer than two rows"});
  expect_complaint(header + "0,0,100,100\n1,0,x,100\n", {"lab.csv:3: sigma_v[kPa] = \"x\"", "finite number"});
  expect_complaint(header + "3,0,100,100\n4,0,100,100\n", {"lab.csv:2: eps_a[%] = 3", "has no beginning"});
}

/// The plan's names of columns need not repeat the file's units.
TEST_F(LaboratoryFile, TellsTheUnitsOfItsColumns)
{
  const Curve curve =
      read("eps_a (-),eps_v[%],sigma_v[MPa],sigma_r[Pa]\n0,0,0.1,1e5\n0.01,0.2,0.2,1e5\n0.04,0.1,0.25,1e5\n");
  EXPECT_THAT(curve.strain, testing::ElementsAre(0, 0.01, 0.04));
  EXPECT_NEAR_BECAUSE(curve.q[2], 150e3, 1e-9, "round-off of numbers of 1e5");
  expect_complaint("eps_a[%],eps_v[%],sigma_v[bar],sigma_r[kPa]\n" + rows,
                   {"lab.csv:1: column \"sigma_v[bar]\": the unit is bar", "[Pa], [kPa], [MPa]"});
}

TEST_F(LaboratoryFile, WithSwappedColumnsIsRefused)
{
  expect_complaint("eps_a[%],eps_v[%],sigma_r[kPa],sigma_v[kPa]\n" + rows,
                   {"lab.csv:3: sigma_r[kPa] = 200", "a lateral stress of 100 kPa"});
  expect_complaint(header + "0,0,100,100\n1,0.2,80,100\n4,0.5,60,100\n",
                   {"lab.csv:4: sigma_v[kPa] = 60; makes q = -40 kPa", "must be > 0 in compression", "swapped"});
}

TEST_F(LaboratoryFile, WithStressesThatNoSandBearsIsRefused)
{
  expect_complaint(header + "0,0,100,100\n1,0.2,2000,100\n4,0.5,3000,100\n",
                   {"lab.csv:3: sigma_v[kPa] = 2000", "no sand bears"});
  expect_complaint(header + "0,0,100,100\n1,0.2,100.1,100\n4,0.5,100.2,100\n",
                   {"lab.csv:4: sigma_v[kPa] = 100.2", "a ratio of 1.2"});
  expect_complaint(header + "0,0,200,100\n4,0.5,300,100\n", {"lab.csv:2: sigma_v[kPa] = 200", "begin isotropic"});
  plan.test = LaboratoryTest::undrained;
  expect_complaint("eps_a[%],p[kPa],q[kPa]\n0,100,0\n1,80,-50\n5,60,-70\n",
                   {"lab.csv:4: q[kPa] = -70", "must be > 0 in compression", "sign of q"});
  expect_complaint("eps_a[%],p[kPa],q[kPa]\n0,100,0\n1,80,50000\n5,60,70000\n", {"lab.csv:3", "no sand bears"});
  read("eps_a[%],p[kPa],q[kPa]\n0,100,0\n1,80,50\n2,1,-2\n5,0,0.1\n"); // liquefied: ratios mean nothing
}

TEST_F(LaboratoryFile, WithVolumesOfTheWrongSignOrUnitIsRefused)
{
  expect_complaint(
      header + "0,0,100,100\n0.2,-0.1,200,100\n4,0.5,300,100\n",
      {"lab.csv:3: eps_v[%] = -0.1; at an axial strain of 0.2 %", "contracts at first", "change the sign"});
  expect_complaint(header + "0,0,100,100\n1,0.002,200,100\n4,-0.005,300,100\n",
                   {"lab.csv:4: eps_v[%] = -0.005", "strain_end = 0.04", "fraction under a header in percent"});
  plan.direction = LoadDirection::extension;
  read(header + "0,0,100,100\n-0.2,-0.1,70,100\n-4,0.5,40,100\n");
}
} // namespace
} // namespace isostat
