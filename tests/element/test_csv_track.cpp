// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Tables as spreadsheets, loggers and people write them.
#include <cmath>

#include "core/track/track_format.h"
#include "plugin/tools/csv_track.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::csv_track_test {
namespace {

using std::string_literals::operator""s;

/// Each character as two bytes, the lower one first.
std::string utf16(const std::string& ascii) {
  std::string bytes;
  for (const char c : ascii) bytes += {c, '\0'};
  return bytes;
}

class CsvTrack : public testing::Test {
 protected:
  std::vector<TrackSample> read(const std::string& text) const {
    std::ofstream(path, std::ios::binary) << text;
    std::vector<TrackSample> samples;
    tools::read_csv(path, [&](const TrackSample& sample) { samples.push_back(sample); });
    return samples;
  }

  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).substr(path.size());
    }
    return "read";
  }

  const TemporaryFolder folder;
  const std::string path = folder.path / "table.csv";
};

TEST_F(CsvTrack, ATableMeansTheSameInEveryDialect) {
  // At 1 ms, 0.5 N to the right and -0.02 N m about z, from rest at 0.
  for (
      const std::string& text : {
          "time_s,fx_N,tz_Nm\n0,0,0\n0.001,0.5,-0.02\n"s,
          "time_s,fx_N,tz_Nm\r\n0,0,0\r\n0.001,0.5,-0.02"s,
          "time_s,fx_N,tz_Nm\r0,0,0\r0.001,0.5,-0.02\r"s,
          // Tabs, semicolons, blanks, and decimal commas.
          "\xEF\xBB\xBFtime_s;fx_N;tz_Nm\n0;0;0\n0,001;0,5;-0,02\n"s,
          "time_s\tfx_N\ttz_Nm\n0\t0\t0\n0,001\t0,5\t-2E-02\n"s,
          "time_s,fx_N,tz_Nm\n\"0\",\"0\",\"0\"\n\"0,001\",\"0,5\",\"-0,02\"\n"s,
          "  time  fx  tz\n  0.000e+00  0.0e+00 0\n  1.0e-03 +5.0e-01  -2.0e-02\n"s,
          "\xFF\xFE"s + utf16("time_s\tfx_N\ttz_Nm\r\n0\t0\t0\r\n0,001\t0,5\t-0,02\r\n"),
          // The separator as Excel says it, and its rows of nothing.
          "sep=;\r\ntime_s;fx_N;tz_Nm\r\n0;0;0\r\n;;\r\n0,001;0,5;-0,02\r\n;;\r\n"s,
          "sep=\t\ntime_s\tfx_N\ttz_Nm\n0\t0\t0\n0.001\t0.5\t-0.02\n"s,
          "sep=|\ntime_s|fx_N|tz_Nm\n0|0|0\n0.001|0.5|-0.02\n"s,
          // Names in quotes, with separators and a line break in them, and columns of others.
          "\"time, s\",\"note; \"\"free\"\"\",\"fx, N\",\"tz, N m\"\n0,a,0,0\n0.001,\"b, c\",0.5,-0.02\n"s,
          "\"Time\n(s)\",\"FX\n(N)\",Tz [N m],force\n0,0,0,7\n0.001,0.5,-0.02,7\n"s,
          ",tz,fx,t\n0,0,0,0\n1,-0.02,0.5,0.001\n"s,
          // Names in comments, as numpy.savetxt and MATLAB's users write them, among others.
          "# run 7, at 1000 Hz\n# time_s,fx_N,tz_Nm\n0,0,0\n# here it moves\n1e-3,5e-1,-2e-2\n"s,
          "# time fx tz\n# in s, N and N m\n0.0 0.0 0.0\n0.001 0.5 -0.02\n"s,
          "% time;fx;tz\n0;0;0\n0,001;0,5;-0,02\n"s,
          "# time_s, fx_mN\ntime_s,fx_N,tz_Nm\n0,0,0\n0.001,0.5,-0.02\n"s,
          "\n# a track\n0,0,0,0,0,0,0\n0.001,0.5,0,0,0,0,-0.02\n"s,
          // Units.
          "time_ms,fx_mN,tz_mNm\n0,0,0\n1,500,-20\n"s,
          "Time (µs);Fx (cN);Tz (N·mm)\n0;0;0\n1000;50;-20\n"s,
          "TIME_MS,FX_N,TZ_N\u00A0M\n0,0,0\n1,0.5,-0.02\n"s,
          "t/ns,fx/kN,tz/N.cm\n0,0,0\n1e6,5e-4,-2\n"s,
          "t_min\tfx_uN\ttz [N*m]\n0\t0\t0\n1.6666666666667e-5\t500000\t-0.02\n"s,
      }) {
    SCOPED_TRACE(text);
    std::vector<TrackSample> samples;
    ASSERT_NO_THROW(samples = read(text)) << refusal(text);
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[0], TrackSample{});
    EXPECT_FLOAT_EQ(samples[1][0], 0.05f);  // of 10 N
    EXPECT_FLOAT_EQ(samples[1][5], -0.02f);
    EXPECT_EQ(samples[1][1] + samples[1][2] + samples[1][3] + samples[1][4], 0);
  }
}

TEST_F(CsvTrack, LinesGoFromRowToRowAfterARest) {
  const auto samples = read("time_ms,fy_N\n10,1\n20,3\n20,-3\n20,-1\n22,1\n");
  ASSERT_EQ(samples.size(), 23u);
  for (size_t ms = 0; ms < samples.size(); ++ms) {
    const double at = static_cast<double>(ms);
    const double force_N = ms < 10 ? 0 : ms <= 20 ? 1 + (at - 10) / 5 : at - 21;  // a step at 20
    EXPECT_NEAR(samples[ms][1], force_N / kTrackForceScale_N, 1e-7) << ms;
  }
}

TEST_F(CsvTrack, WhatIsWrongIsNamedWithItsLine) {
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {"", ", line 0: the table has no rows"},
           {"time,fx\n", ", line 1: the table has no rows"},
           {"time,velocity\n0,1\n", ", line 1: names no column time and none of fx"},
           {"0,1,2\n", ", line 1: names no column time"},
           {"t,fx\n0,a\n", ", line 2: \"a\" is not a number"},
           {"t,fx\n0,\n", ", line 2: \"\" is not a number"},
           {"t,fx\n0,nan\n", ", line 2: \"nan\" is not a number"},
           {"t,fx\n0,1,2\n", ", line 2: has 3 columns, and not 2"},
           {"t;fx\n0;1.234,5\n", ", line 2: \"1.234,5\" is not a number"},
           {"t;fx\n0,5;1\n1.5;1\n",
            ", line 3: \"1.5\" is not a number, as decimals are behind a ','"},
           {"t,fx\n0,1\n\n0.5,\"1\n", ", line 4: a quotation mark is not closed"},
           {"t,fx,Fx\n0,1,1\n", ", line 1: names fx twice"},
           // A unit that is not known would be felt as another force.
           {"time_s,fx_lbf\n0,1\n",
            ", line 1: fx: the unit \"lbf\" is not one of N, cN, kN, mN, uN"},
           {"time_s,tz_Nmm2\n0,1\n", ", line 1: tz: the unit \"Nmm2\" is not one of Ncm, Nm, Nmm"},
           {"time_s,fx_MN\n0,1\n", ", line 1: fx: the unit \"MN\" is not"},
           {"time_s,tx_N\n0,1\n", ", line 1: tx: the unit \"N\" is not"},
           {"Time (days);fx\n0;1\n", ", line 1: time: the unit \"days\" is not one of min, ms"},
           {"# time_frames,fx\n0,1\n", ", line 2: time: the unit \"frames\" is not"},
           {"time_s,fx_N/m\n0,1\n", ", line 1: fx: the unit \"N/m\" is not"},
           // Times and forces that cannot be meant.
           {"t,fx\n0,1\n1,1\n0.5,1\n", ", line 4: its time is before that of the line before"},
           {"t,fx\n1764427000,1\n", ", line 2: its time is not within a day from 0"},
           {"t,fx\n-1,1\n", ", line 2: its time is not within a day"},
           {"t,fx\n0,1\n1e308,1\n", ", line 3: its time is not within a day"},
           {"t,fx\n0,1\n1,1\n90000,1\n", ", line 4: its time is not within a day"},
           {"t,fx\n0,1\n1,1e308\n", ", line 3: \"1e308\" is too large"},
           {"t,fx\n0,1\n1,-1e39\n", ", line 3: \"-1e39\" is too large"},
           // Text of older programs, and what is none.
           {"t,fx,Kraft f\xFCr x\n0,1,1\n", ", line 1: is neither UTF-8 nor marked as UTF-16"},
           {"\xFF\xFE", ", line 0: the table has no rows"},
           {"\xFE\xFF\0"s, ": cannot be read"},
           {utf16("t,fx\n0,1\n"), ", line 1: is neither UTF-8 nor marked as UTF-16"},
           {"\xFF\xFE"s + utf16("t,fx\n0,1\n") + "\xD8", ": cannot be read"},
       }) {
    EXPECT_EQ(refusal(text).substr(0, said.size()), said) << text << "\n" << refusal(text);
  }
}

}  // namespace
}  // namespace spidar::test::csv_track_test
