// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/motion_header.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

double factor(const std::string &text, AccelerationUnit unit = AccelerationUnit::stated, bool names_columns = false)
{
  return record_unit("motion.txt", {{3, text, names_columns}}, unit).factor;
}

TEST(MotionHeader, UnitsInTheirSpellings)
{
  for (const std::string text :
       {"CORRECTED ACCELERATION (CM/S/S)", "2000 POINTS OF ACCEL DATA EQUALLY SPACED AT .020 SEC. (UNITS: CM/SEC/SEC)",
        "Acceleration [cm/s^2]", "UNITS: cm/s**2", "acc in cm/sec2", "acceleration, cm s-2", "acc cm/s\u00b2",
        "COMPONENT 090 (CM/SEC/SEC) acceleration", "ACCELERATION IN GAL", "# unit = Gal", "cm per second squared",
        "CM/(S*S)", "ACCELERATION (CM/SQ SEC)", "Accel. cm/sec-sec", "VELOCITY = 30.2 CM/SEC, ACCELERATION (CM/S/S)",
        "acc (centimeters/second/second)", "cm s\u207b\u00b2"})
    EXPECT_EQ(factor(text), 0.01) << text;
  for (const std::string text : {"ACCELERATION TIME SERIES IN UNITS OF G", "Acceleration (g)", "ACC IN G'S",
                                 "UNITS OF G. FILTER", "M 6.5 at 20 km; --shear-velocity 3.5, UNITS OF G",
                                 "no unit at all", "", "Vs30 = 760 m/s", "Vs30 (m/s): 760", "PGA 196 cm/s2"})
    EXPECT_EQ(factor(text), standard_gravity) << text;
  for (const std::string text : {"acceleration m/s2", "(m/s/s)", "acc (meters/second^2)", "m s^-2", "units m/sec/sec"})
    EXPECT_EQ(factor(text), 1) << text;
  EXPECT_EQ(factor("ACC (MM/S2)"), 1e-3);
  EXPECT_EQ(factor("acceleration (mg)"), 1e-3 * standard_gravity);
  EXPECT_EQ(factor("acceleration (%g)"), 1e-2 * standard_gravity);
  EXPECT_EQ(factor("time (s), acceleration (g)", AccelerationUnit::stated, true), standard_gravity);
  EXPECT_EQ(factor("time_s acc_m/s2", AccelerationUnit::stated, true), 1);
}

TEST(MotionHeader, OtherQuantities)
{
  for (const std::string text : {"VELOCITY TIME SERIES IN UNITS OF CM/S",
                                 "UNCORRECTED (CM/SEC)",
                                 "CORRECTED VELOCITY",
                                 "Displacement",
                                 "VEL 090 (CM/S)",
                                 "DISPLACEMENT TIME HISTORY IN UNITS OF CM",
                                 "units: m",
                                 "UNITS: CM",
                                 "strain",
                                 "pore pressure",
                                 "in mm/s",
                                 "UNITS OF M/S",
                                 "velocity by integration of cm/s2",
                                 "rotation (rad/s2)",
                                 "units: rad/s",
                                 "units: counts",
                                 "MICROSTRAIN",
                                 "FORCE (KN)",
                                 "COUNTS",
                                 "cm/s's"})
    EXPECT_THAT(message_of<InputError>([&] { factor(text); }),
                AllOf(HasSubstr("motion.txt:3: \"" + text + "\": not accelerations"), HasSubstr("take this line off")))
        << text;
  for (const std::string text : {"time (s), velocity (m/s)", "t (s), d (cm)", "time,strain (-)", "t [s] gamma [%]",
                                 "time v", "period (s), acceleration (g)", "time (s) disp_x"})
    EXPECT_THAT(message_of<InputError>([&] { factor(text, AccelerationUnit::stated, true); }),
                HasSubstr("not accelerations"))
        << text;
}

TEST(MotionHeader, UnitOfTheScene)
{
  EXPECT_EQ(factor("no unit", AccelerationUnit::cm_s2), 0.01);
  EXPECT_EQ(factor("ACC (GAL)", AccelerationUnit::cm_s2), 0.01);
  EXPECT_EQ(factor("from g, in m/s2", AccelerationUnit::m_s2), 1);
  EXPECT_THAT(message_of<InputError>([&] { factor("ACC (GAL)", AccelerationUnit::m_s2); }),
              HasSubstr("motion.txt:3: \"ACC (GAL)\" says gal, and the scene says unit = \"m/s2\"; they must agree"));
  EXPECT_THAT(message_of<InputError>([&] { factor("ACC (GAL), in units of g"); }),
              HasSubstr("says g, and line 3 says gal; expected one unit. Give motion.unit"));
}

TEST(MotionHeader, UnitsOfTime)
{
  for (const auto &[text, unit] : {std::pair("time (s), a (m/s2)", 1.0),
                                   {"time (ms), a (g)", 1e-3},
                                   {"t_ms a", 1e-3},
                                   {"t [msec] a", 1e-3},
                                   {"t [min] a", 60.0},
                                   {"t a", 1.0},
                                   {"time,acc m/s2", 1.0}})
    EXPECT_EQ(time_factor(text), unit) << text;
}
} // namespace
} // namespace isostat
