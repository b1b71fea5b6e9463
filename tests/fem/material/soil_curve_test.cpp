// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/soil_curve.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
/// Values of the program pystrata at strains of 1e-6, 1e-4, 1e-3 and 1e-2.
void expect_curve(const SoilCurve &curve, const std::array<double, 4> &reduction, const std::array<double, 4> &damping)
{
  constexpr double strains[] = {1e-6, 1e-4, 1e-3, 1e-2};
  for (std::size_t k = 0; k < 4; ++k)
    {
      EXPECT_NEAR_BECAUSE(curve.reduction_at(strains[k]), reduction[k], 1e-6, "six digits of another program");
      EXPECT_NEAR_BECAUSE(curve.damping_at(strains[k]), damping[k], 1e-5,
                          "digits of another program, whose maximum over "
                          "strain is that of four strains");
    }
}

TEST(SoilCurve, FamiliesAreThoseOfOthers)
{
  expect_curve(darendeli_curve(200e3, 30, 2), {0.998118, 0.885097, 0.481391, 0.100603},
               {0.009676, 0.023007, 0.091846, 0.191300});
  expect_curve(darendeli_curve(50e3, 0, 1), {0.994306, 0.717165, 0.234041, 0.035513},
               {0.010304, 0.048360, 0.151270, 0.210829});
  expect_curve(menq_curve(50e3, 2, 0.3e-3), {0.994888, 0.810295, 0.387541, 0.085704},
               {0.009186, 0.029292, 0.103684, 0.169939});
  expect_curve(menq_curve(200e3, 2, 0.3e-3), {0.997994, 0.892163, 0.516195, 0.120955},
               {0.008137, 0.019687, 0.081344, 0.175643});
}

TEST(SoilCurve, DigitisedFamilies)
{
  EXPECT_EQ(vucetic_dobry_curve(0).reduction_at(1e-3), 0.26);
  EXPECT_EQ(vucetic_dobry_curve(200).damping_at(1e-2), 0.081);
  EXPECT_DOUBLE_EQ(vucetic_dobry_curve(40).reduction_at(1e-3), (0.53 + 0.67) / 2);
  EXPECT_DOUBLE_EQ(vucetic_dobry_curve(5).damping_at(1e-4), (2 * 0.054 + 0.045) / 3);
  EXPECT_EQ(epri_curve(6).reduction_at(1e-4), 0.759);
  EXPECT_EQ(epri_curve(6.2).reduction_at(1e-4), 0.83);
  EXPECT_EQ(epri_curve(1e4).damping_at(1), 0.16459);
}

TEST(SoilCurve, BetweenStrainsItIsSmoothAndMonotone)
{
  const SoilCurve curve = vucetic_dobry_curve(15);
  double before = 1;
  for (double strain = 1e-7; strain < 1; strain *= 1.01)
    {
      const double here = curve.reduction_at(strain);
      EXPECT_BELOW_BECAUSE(here - before, 1e-15, "round-off");
      EXPECT_BELOW_BECAUSE(before - here, 0.0035,
                           "1 % of strain, on a curve that falls by 0.3 at most over its logarithm");
      before = here;
    }
  EXPECT_EQ(before, 0.1);
}

TEST(SoilCurve, Tables)
{
  const auto path =
      std::filesystem::temp_directory_path() / ("isostat_soil_curve_" + std::to_string(getpid()) + ".csv");
  const auto read = [&](const std::string &text) {
    std::ofstream(path) << text;
    return read_soil_curve(path);
  };
  const auto expect_refused = [&](const std::string &text, const std::string &part) {
    EXPECT_THAT([&] { read(text); }, testing::ThrowsMessage<InputError>(testing::HasSubstr(part)));
  };
  const std::string head = "damping (-),strain (-),note,G/G_max (-)\n";
  const SoilCurve curve = read(head + "0.01,1e-5,a,1\n0.02,1e-4,b,0.8\n0.15,1e-3,c,0.3\n");
  EXPECT_EQ(curve.strains, (std::vector<double>{1e-5, 1e-4, 1e-3}));
  EXPECT_EQ(curve.reduction, (std::vector<double>{1, 0.8, 0.3}));
  EXPECT_EQ(curve.damping, (std::vector<double>{0.01, 0.02, 0.15}));
  EXPECT_TRUE(read("strain (-),G/G_max (-)\n1e-5,1\n1e-4,0.8\n1e-3,0.3\n").damping.empty());
  expect_refused(head + "0.01,1e-5,a,1\n0.02,1e-4,b,0.8\n", ":2: the curve has 2 rows");
  expect_refused(head + "0.01,1e-5,a,1\n0.02,1e-5,b,0.8\n0.15,1e-3,c,0.3\n",
                 ":3: strain (-) = 1e-05; must be above 0 and");
  expect_refused(head + "0.01,1e-5,a,0.9\n0.02,1e-4,b,0.95\n0.15,1e-3,c,0.3\n", ":3: G/G_max (-) = 0.95; must be in");
  expect_refused(head + "0.01,1e-5,a,1\n2,1e-4,b,0.8\n15,1e-3,c,0.3\n", ":3: damping (-) = 2; must be in [0, 1)");
  std::filesystem::remove(path);
}
} // namespace
} // namespace isostat
