// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "fem/motion/motion_input.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

namespace isostat
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

class MotionFile : public TemporaryFolder
{
protected:
  Motion read(const std::string &text, AccelerationUnit unit = AccelerationUnit::m_s2) const
  {
    return read_motion(put("motion.txt", text), unit);
  }
  std::string refusal(const std::string &text) const
  {
    return message_of<InputError>([&] { read(text); });
  }
  /// An AT2 file with this fourth line.
  static std::string at2(const std::string &fourth, const std::string &values)
  {
    return "PEER STRONG MOTION DATABASE RECORD\nMADE UP FOR A TEST, STATION 1, 090\n"
           "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz\n" +
           fourth + "\n" + values;
  }
};

TEST_F(MotionFile, TwoColumns)
{
  for (const std::string text : {"0 1\n0.01 -2\n0.02 0.5\n",
                                 "# made by hand\n% too\n\ntime (s), acceleration (m/s2)\r\n0,1\r\n0.01, -2\r\n"
                                 "0.02,\t.5\r\n\r\n",
                                 "5.00 +1\n5.01 -2.0e0\n# inside\n5.02 5e-1"})
    {
      const Motion m = read(text);
      EXPECT_EQ(m.accelerations(), (std::vector<double>{1, -2, 0.5})) << text;
      EXPECT_NEAR_BECAUSE(m.interval(), 0.01, 1e-15, "times of 5 s are known to 1e-15") << text;
    }
}

TEST_F(MotionFile, Units)
{
  EXPECT_EQ(read("0 1\n1 2\n", AccelerationUnit::g).peak(), 2 * 9.80665);
  EXPECT_EQ(read("0 1\n1 2\n", AccelerationUnit::cm_s2).peak(), 0.02);
}

TEST_F(MotionFile, RoundedTimesGiveTheMeanInterval)
{
  std::string text;
  char row[64];
  for (int i = 0; i <= 3000; ++i)
    text += (snprintf(row, sizeof row, "%.6f %d\n", i / 300.0, i % 7), row);
  const Motion m = read(text);
  printf("times rounded to 1e-6 s: interval off by %.1e s\n", m.interval() - 1 / 300.0);
  EXPECT_NEAR_BECAUSE(m.interval(), 1 / 300.0, 1e-9,
                      "times rounded to 1e-6 s: a mean over 3,000 of them is off by 1e-6/3,000 at most");
}

TEST_F(MotionFile, At2HeadersOldAndNew)
{
  for (const std::string fourth :
       {"NPTS=  7, DT=   .0050 SEC,", "NPTS= 7, DT= .005 SEC", "NPTS=      7, DT=   .0050 SEC", "NPTS=7,DT=.0050SEC",
        "7 0.0050 NPTS, DT", "    7    0.0050    NPTS, DT  ", "DT= 0.005, NPTS= 7", "npts= 7, dt= 5.0E-03 sec\r"})
    {
      const Motion m = read(at2(fourth, "  .1000000E-01 -.2000000E+00  .3000000E-02  .0000000E+00  .5\n -1 0.25\n"));
      EXPECT_EQ(m.accelerations().size(), 7u) << fourth;
      EXPECT_EQ(m.interval(), 0.005) << fourth;
      EXPECT_EQ(m.accelerations()[1], -0.2 * standard_gravity) << fourth;
      EXPECT_EQ(m.peak(), standard_gravity) << fourth;
    }
}

TEST_F(MotionFile, At2IsInGWhateverUnitIsAsked)
{
  EXPECT_EQ(read(at2("NPTS= 2, DT= .01 SEC", "1 1\n"), AccelerationUnit::cm_s2).peak(), standard_gravity);
}

TEST_F(MotionFile, Gzipped)
{
  const auto path = folder / "motion.at2.gz";
  const std::string text = at2("NPTS= 3, DT= .01 SEC", "0 1 0\n");
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), text.size());
  gzclose(file);
  EXPECT_EQ(read_motion(path, AccelerationUnit::g).peak(), standard_gravity);
}

TEST_F(MotionFile, Missing)
{
  EXPECT_THAT(message_of<InputError>([&] { read_motion(folder / "absent.at2", AccelerationUnit::g); }),
              HasSubstr("absent.at2: cannot be opened: No such file or directory; check path"));
  EXPECT_THAT(message_of<InputError>([&] { read_motion(folder, AccelerationUnit::g); }),
              HasSubstr("cannot be opened: it is not a file"));
}

TEST_F(MotionFile, BadColumns)
{
  EXPECT_THAT(refusal("0 1\n0.01 x2\n"),
              AllOf(HasSubstr("motion.txt:2: \"x2\" is not a number"), HasSubstr("time in s and acceleration")));
  EXPECT_THAT(refusal("t a\nt a\n0 1\n"), HasSubstr("motion.txt:2: \"t\" is not a number"));
  EXPECT_THAT(refusal("0 1\n0.01 nan\n0.02 1\n"), HasSubstr("motion.txt:2: \"nan\" is not finite; repair"));
  EXPECT_THAT(refusal("0 1\n0.01 1\ninf 1\n"), HasSubstr("motion.txt:3: \"inf\" is not finite"));
  EXPECT_THAT(refusal("0 1\n0.01 1 7\n"),
              AllOf(HasSubstr("motion.txt:2: \"0.01 1 7\" has 3 columns"), HasSubstr("off")));
  EXPECT_THAT(refusal("0.1\n0.2\n"),
              AllOf(HasSubstr("motion.txt:1: \"0.1\" has 1 columns"), HasSubstr("add the times")));
  EXPECT_THAT(refusal("t a\n0 1\n"), HasSubstr("motion.txt:2: the file ends after 1 samples; needs two"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("motion.txt:1: the file ends after 0 samples"));
  EXPECT_THAT(refusal(""), HasSubstr("motion.txt:1: the file ends after 0 samples"));
}

TEST_F(MotionFile, BadTimes)
{
  EXPECT_THAT(refusal("0 1\n0.01 1\n0.02 1\n# gap\n0.05 1\n0.06 1\n"),
              AllOf(HasSubstr("motion.txt:5: time 0.05 s follows 0.02 s; expected 0.03 s, for the interval is 0.01 s"),
                    HasSubstr("Fill the gap")));
  EXPECT_THAT(refusal("0 1\n0.01 1\n0.0200 1\n0.03002 1\n0.04 1\n"), HasSubstr("motion.txt:4: time 0.03002 s"));
  EXPECT_THAT(refusal("0 1\n0.02 1\n0.01 1\n"), HasSubstr("motion.txt:3: time 0.01 s follows 0.02 s; time must rise"));
  EXPECT_THAT(refusal("0 1\n0 1\n"), HasSubstr("motion.txt:2: time 0 s follows 0 s; time must rise"));
}

TEST_F(MotionFile, BadAt2Values)
{
  const std::string header = "NPTS= 4, DT= .01 SEC";
  EXPECT_THAT(refusal(at2(header, "0 1\n2\n")),
              HasSubstr("motion.txt:6: the file ends after 3 values; NPTS on line 4 announces 4. Is it cut off?"));
  EXPECT_THAT(
      refusal(at2(header, "0 1\n2 3 9\n")),
      AllOf(HasSubstr("motion.txt:6: \"9\" follows the 4 values that NPTS on line 4"), HasSubstr("correct NPTS")));
  EXPECT_THAT(refusal(at2(header, "0 1\n2 abc\n")),
              HasSubstr("motion.txt:6: \"abc\" is not a number; expected accelerations in g, separated by blanks"));
  EXPECT_THAT(refusal(at2(header, "0 1 -.1E-02-.2E-02 3\n")), HasSubstr("motion.txt:5: \"-.1E-02-.2E-02\""));
  EXPECT_THAT(refusal(at2(header, "0 1 NaN 3\n")), HasSubstr("motion.txt:5: \"NaN\" is not finite"));
}

TEST_F(MotionFile, BadAt2Headers)
{
  EXPECT_THAT(refusal(at2("NPTS= 4", "0 1 2 3\n")), HasSubstr("motion.txt:4: \"NPTS= 4\" does not say"));
  EXPECT_THAT(refusal(at2("NPTS= four, DT= .01 SEC", "0 1 2 3\n")), HasSubstr("expected \"NPTS= 4000, DT= .005 SEC\""));
  EXPECT_THAT(refusal(at2("NPTS= 1, DT= .01 SEC", "0\n")), HasSubstr("motion.txt:4: NPTS = 1; must be a whole number"));
  EXPECT_THAT(refusal(at2("NPTS= 2.5, DT= .01 SEC", "0 1\n")), HasSubstr("motion.txt:4: NPTS = 2.5"));
  EXPECT_THAT(refusal(at2("NPTS= 2, DT= 0 SEC", "0 1\n")), HasSubstr("motion.txt:4: DT = 0 s; must be > 0"));
  EXPECT_THAT(refusal("A\nB\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 2, DT= .01 SEC\n0 1\n"),
              AllOf(HasSubstr("motion.txt:3:"), HasSubstr("not accelerations in g; give PEER's .AT2 file")));
}
} // namespace
} // namespace isostat
