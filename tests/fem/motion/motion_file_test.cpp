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
  static constexpr AccelerationUnit stated = AccelerationUnit::stated;

  Motion read(const std::string &text, AccelerationUnit unit = AccelerationUnit::m_s2) const
  {
    return read_record(put("motion.txt", text), unit).motion;
  }
  std::string refusal(const std::string &text, AccelerationUnit unit = stated) const
  {
    return message_of<InputError>([&] { read(text, unit); });
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
  EXPECT_NEAR_BECAUSE(m.interval(), 1 / 300.0, 1e-9,
                      "times rounded to 1e-6 s: a mean over 3,000 of them is off by 1e-6/3,000 at most");
}

TEST_F(MotionFile, At2HeadersOldAndNew)
{
  for (const std::string fourth :
       {"NPTS=  7, DT=   .0050 SEC,", "NPTS= 7, DT= .005 SEC", "NPTS=      7, DT=   .0050 SEC", "NPTS=7,DT=.0050SEC",
        "7 0.0050 NPTS, DT", "    7    0.0050    NPTS, DT  ", "DT= 0.005, NPTS= 7", "npts= 7, dt= 5.0E-03 sec\r"})
    {
      const Motion m =
          read(at2(fourth, "  .1000000E-01 -.2000000E+00  .3000000E-02  .0000000E+00  .5\n -1 0.25\n"), stated);
      EXPECT_EQ(m.accelerations().size(), 7u) << fourth;
      EXPECT_EQ(m.interval(), 0.005) << fourth;
      EXPECT_EQ(m.accelerations()[1], -0.2 * standard_gravity) << fourth;
      EXPECT_EQ(m.peak(), standard_gravity) << fourth;
    }
}

TEST_F(MotionFile, At2WithAUnitOfItsOwn)
{
  const std::string rows = "\nNPTS= 2, DT= .02 SEC\n 1 -2\n";
  EXPECT_EQ(read("STATION Z\nCORRECTED ACCELERATION (CM/S/S)" + rows, stated).peak(), 0.02);
  EXPECT_EQ(read("STATION Z\nCORRECTED ACCELERATION (CM/S/S)" + rows, AccelerationUnit::cm_s2).peak(), 0.02);
  EXPECT_EQ(read("STATION Z\nACCELERATION" + rows, AccelerationUnit::cm_s2).peak(), 0.02);
  EXPECT_EQ(read("STATION Z\nACCELERATION" + rows, stated).peak(), 2 * standard_gravity);
  EXPECT_EQ(read("STATION Z\nNPTS= 2, DT= 20 MSEC\nACCELERATION IN GAL\n1 -2\n", stated).peak(), 0.02);
  EXPECT_EQ(read("STATION Z\nNPTS= 2, DT= 20 MSEC\n1 -2\n", stated).interval(), 0.02);
  EXPECT_THAT(refusal(at2("NPTS= 2, DT= .01 SEC", "1 1\n"), AccelerationUnit::cm_s2),
              AllOf(HasSubstr("motion.txt:3: \"ACCELERATION TIME HISTORY IN UNITS OF G."),
                    HasSubstr("says g, and the scene says unit = \"cm/s2\""), HasSubstr("Take unit out of the scene")));
}

/// Two columns must have a unit unless only their shape counts; AT2 and DEEPSOIL are in g by custom, up to 3 g.
TEST_F(MotionFile, AUnitThatNothingStates)
{
  EXPECT_THAT(refusal("0 1\n0.01 0.2\n"),
              AllOf(HasSubstr("motion.txt:1: neither the header nor the scene states the unit"),
                    HasSubstr("must be stated. Give motion.unit = \"g\", \"m/s2\" or \"cm/s2\" in the scene")));
  EXPECT_EQ(read_record(put("motion.txt", "0 1\n0.01 190\n"), stated, false).motion.accelerations().size(), 2u);
  EXPECT_THAT(refusal("2 0.01\n0 1\n0.01 190\n"),
              HasSubstr("the largest value, 190, is more than 3 g; give motion.unit in the scene"));
  EXPECT_THAT(refusal("A\nNPTS= 2, DT= .02 SEC\n1 3.1\n"), HasSubstr("the largest value, 3.1"));
  EXPECT_EQ(read("0 1\n0.01 190\n", AccelerationUnit::g).peak(), 190 * standard_gravity);
  EXPECT_EQ(read("t, a (g)\n0 1\n0.01 190\n", stated).peak(), 190 * standard_gravity);
}

TEST_F(MotionFile, StartsOfTables)
{
  for (const auto &[text, start] : {std::pair("0 1\n1 2\n", 0.0),
                                    {"2.5 1\n3 2\n", 2.5},
                                    {"-1 1\n-0.5 2\n", -1.0},
                                    {"time (ms), a (g)\n500,1\n505,2\n", 0.5}})
    {
      const Record record = read_record(put("motion.txt", text), AccelerationUnit::g);
      ASSERT_TRUE(record.start) << text;
      EXPECT_EQ(*record.start, start) << text;
      EXPECT_EQ(record.motion.delay(), 0) << text;
    }
  EXPECT_FALSE(read_record(put("motion.txt", at2("NPTS= 2, DT= .01 SEC", "1 1\n")), stated).start);
  EXPECT_NEAR_BECAUSE(read("time (ms), a (g)\n500,1\n505,2\n", stated).interval(), 0.005, 1e-15,
                      "times of 0.5 s are known to 1e-16");
}

TEST_F(MotionFile, RowNamesOfOtherPrograms)
{
  for (const std::string text : {"\"\",\"t\",\"a\"\n\"1\",0,1\n\"2\",0.5,-2\n", ",t,a\n0,0,1\n1,0.5,-2\n",
                                 "\"t\" \"a\"\n\"1\" 0 1\n\"2\" 0.5 -2\n"})
    EXPECT_EQ(read(text).accelerations(), (std::vector<double>{1, -2})) << text;
}

TEST_F(MotionFile, Deepsoil)
{
  const Record record = read_record(put("motion.txt", "3\t0.02\n0.000\t0.1\n0.020\t-0.2\n0.040\t0\n"), stated);
  EXPECT_EQ(record.motion.accelerations(), (std::vector<double>{0.1 * standard_gravity, -0.2 * standard_gravity, 0}));
  EXPECT_EQ(record.motion.interval(), 0.02);
  EXPECT_EQ(record.start, 0);
  EXPECT_THAT(refusal("4 0.02\n0 0.1\n0.02 -0.2\n0.04 0\n"),
              AllOf(HasSubstr("motion.txt:1: 3 rows follow"), HasSubstr("announces 4. Is the file cut off?")));
  EXPECT_THAT(refusal("3 0.01\n0 0.1\n0.02 -0.2\n0.04 0\n"),
              HasSubstr("motion.txt:1: step = 0.01 s; the times below rise by 0.02 s"));
}

std::string knet(const std::string &scale, const std::string &duration)
{
  return "Origin Time       2020/01/01 00:00:00\nDepth. (km)       24\nStation Height(m) 10\n"
         "Sampling Freq(Hz) 50Hz\nDuration Time(s)  " +
         duration + "\nDir.              N-S\nScale Factor      " + scale +
         "\nMax. Acc. (gal)   196.000\nLast Correction   2020/01/01 00:00:15\nMemo.             \n"
         "    12345   -13096\n       10        0\n";
}

TEST_F(MotionFile, Knet)
{
  const Motion m = read(knet("3920(gal)/6182761", "0.08"), stated);
  ASSERT_EQ(m.accelerations().size(), 4u);
  EXPECT_NEAR_BECAUSE(m.accelerations()[1], -13096 * 39.20 / 6182761, 1e-15, "round-off of a product");
  EXPECT_EQ(m.interval(), 0.02);
  EXPECT_THAT(refusal(knet("3920(gal)/6182761", "0.1")),
              HasSubstr("the file ends after 4 values; Duration Time on line"));
  EXPECT_THAT(refusal(knet("3920(gal)/6182761", "0.06")), HasSubstr("\"0\" follows the 3 values"));
  EXPECT_THAT(refusal(knet("3920(gal)", "0.08")), HasSubstr("motion.txt:7: \"3920(gal)\"; expected a scale factor"));
  EXPECT_THAT(refusal(knet("3920(cm/s)/61", "0.08")), HasSubstr("not accelerations"));
  EXPECT_THAT(refusal(knet("3920(gal)/61", "0.08"), AccelerationUnit::g),
              HasSubstr("says gal, and the scene says unit"));
}

std::string esm(const std::string &units, const std::string &type, const std::string &n = "3")
{
  std::string text =
      "EVENT_NAME: MADE UP\nMAGNITUDE_W: 6.0\nVS30_M/S: 760\nSAMPLING_INTERVAL_S: 0.005000\nNDATA: " + n +
      "\nUNITS: " + units + "\nPGA_CM/S^2: -2.000000\nDATA_TYPE: " + type + "\n";
  for (int k = 0; k < 56; ++k)
    text += "USER" + std::to_string(k) + ": \n";
  return text + "1.0\n-2.0\n0.5\n";
}

TEST_F(MotionFile, Esm)
{
  const Motion m = read(esm("cm/s^2", "ACCELERATION"), stated);
  EXPECT_EQ(m.accelerations(), (std::vector<double>{0.01, -0.02, 0.005}));
  EXPECT_EQ(m.interval(), 0.005);
  EXPECT_THAT(refusal(esm("cm/s", "VELOCITY")), HasSubstr("motion.txt:8: DATA_TYPE = VELOCITY; must be ACCELERATION"));
  EXPECT_THAT(refusal(esm("cm/s", "ACCELERATION")), HasSubstr("motion.txt:6: \"UNITS: cm/s\": not accelerations"));
  EXPECT_THAT(refusal(esm("cm/s^2", "ACCELERATION", "4")),
              HasSubstr("ends after 3 values; NDATA on line 5 announces 4"));
}

TEST_F(MotionFile, DecimalCommasSemicolonsAndUtf16)
{
  EXPECT_THAT(refusal("0,012\n-0,5\n0,3\n"),
              AllOf(HasSubstr("motion.txt:2: \"-0,5\" has decimal commas"), HasSubstr("with points")));
  EXPECT_THAT(refusal("0,00 0,012\n0,01 -0,5\n"), HasSubstr("motion.txt:1: \"0,00 0,012\" has decimal commas"));
  EXPECT_THAT(refusal("0,00;0,012\n0,01;-0,5\n"), HasSubstr("has decimal commas"));
  EXPECT_THAT(refusal("0.00;0.012\n0.01;-0.5\n"), HasSubstr("separated by semicolons"));
  EXPECT_THAT(refusal("A\nNPTS= 2, DT= .01 SEC\n 0,1 0,2\n"),
              HasSubstr("motion.txt:3: \" 0,1 0,2\" has decimal commas"));
  EXPECT_THAT(refusal(std::string("\xFF\xFE"
                                  "0\0 \0"
                                  "1\0",
                                  8)),
              HasSubstr("motion.txt:1: the text is UTF-16"));
}

TEST_F(MotionFile, Gzipped)
{
  const auto path = folder / "motion.at2.gz";
  const std::string text = at2("NPTS= 3, DT= .01 SEC", "0 1 0\n");
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), text.size());
  gzclose(file);
  EXPECT_EQ(read_record(path, AccelerationUnit::g).motion.peak(), standard_gravity);
}

TEST_F(MotionFile, Missing)
{
  EXPECT_THAT(message_of<InputError>([&] { read_record(folder / "absent.at2", AccelerationUnit::g); }),
              HasSubstr("absent.at2: cannot be opened: No such file or directory; check path"));
  EXPECT_THAT(message_of<InputError>([&] { read_record(folder, AccelerationUnit::g); }),
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
              HasSubstr("motion.txt:6: \"abc\" is not a number; expected accelerations, separated by blanks"));
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
              AllOf(HasSubstr("motion.txt:3:"), HasSubstr("not accelerations; expected accelerations in m/s2")));
}
} // namespace
} // namespace isostat
