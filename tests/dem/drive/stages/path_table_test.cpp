// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/path_table.hpp"

#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
class PathTableTest : public TemporaryFolder
{
protected:
  PathTable read(const std::string &text)
  {
    std::ofstream(folder / "path.csv") << text;
    return read_path_table(folder / "path.csv");
  }
  std::string complaint(const std::string &text)
  {
    return test::refusal([&] { read(text); });
  }
};

TEST_F(PathTableTest, IsReadInItsUnitsAndInterpolatedFromTheStart)
{
  const PathTable table = read("step (-),stress_x (kPa),gamma (%),mean_stress (MPa)\n1,100,0,0.2\n3,50,2,0.2\n");
  EXPECT_FALSE(table.by_time);
  EXPECT_TRUE(table.prescribes(PathQuantity::sigma_x));
  EXPECT_FALSE(table.prescribes(PathQuantity::sigma_y));
  EXPECT_EQ(table.value(PathQuantity::sigma_x, 0, 200e3), 200e3);
  EXPECT_EQ(table.value(PathQuantity::sigma_x, 0.5, 200e3), 150e3);
  EXPECT_EQ(table.value(PathQuantity::sigma_x, 2, 200e3), 75e3);
  EXPECT_EQ(table.value(PathQuantity::sigma_x, 9, 200e3), 50e3);
  EXPECT_EQ(table.value(PathQuantity::gamma, 2, 0), 0.01);
  EXPECT_EQ(table.value(PathQuantity::p, 1, 0), 0.2e6);
  EXPECT_NE(table.hash(), read("step (-),stress_x (kPa)\n1,100\n").hash());
  EXPECT_TRUE(read("time (s),tau (Pa)\n0.1,5\n").by_time);
}

TEST_F(PathTableTest, MistakesAreNamedWithTheirLine)
{
  const auto says = [&](const std::string &text, const std::string &where, const std::string &what) {
    const std::string said = complaint(text);
    EXPECT_NE(said.find("path.csv:" + where), std::string::npos) << said;
    EXPECT_NE(said.find(what), std::string::npos) << said;
  };
  says("", "1", "a path has the columns");
  says("stress_x (kPa),time (s)\n1,2\n", "1", "a path has the columns");
  says("step (-),stress_x\n1,2\n", "1", "\"stress_x\" is no column of a path");
  says("step (-),stress_x (-)\n1,2\n", "1", "stresses in (Pa)");
  says("step (-),tau (Pa),tau (kPa)\n1,2,3\n", "1", "twice");
  says("step (-),tau (Pa)\n0,2\n", "2", "must be above 0");
  says("step (-),stress_x (kPa)\n1,2\n2,-20\n", "3", "stress_x (kPa) = -20; must be >= 0");
  says("step (-),tau (Pa)\n1,2\n1,3\n", "3", "must be above 1");
  says("step (-),tau (Pa)\n1\n", "2", "1 values; the header names 2");
  says("step (-),tau (Pa)\n1,x\n", "2", "expected a number");
  says("step (-),tau (Pa)\n", "2", "no rows");
}
} // namespace
} // namespace isostat
