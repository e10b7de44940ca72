// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What examples/play says and draws of a playback.
#include <gst/gst.h>

#include "examples/play/picture.h"
#include "examples/play/record.h"
#include "examples/play/report.h"
#include "plugin/tools/gnuplot.h"
#include "spidar/part_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace {

using Structure = std::unique_ptr<GstStructure, void (*)(GstStructure*)>;

Structure structure(const std::string& text) {
  gst_init(nullptr, nullptr);
  Structure result(gst_structure_from_string(text.c_str(), nullptr), gst_structure_free);
  EXPECT_TRUE(result) << text;
  return result;
}

/// A frame of a film with 10 frames/s.
void add_frame(Record& record, int number, const std::string& limit = "none",
               const std::string& more = "") {
  record.add_frame(structure("spidar-motion, running-time=(guint64)" +
                             std::to_string(100'000'000LL * number) +
                             ", velocity-x=(double)30, velocity-y=(double)-20, "
                             "force-x=(double)1, force-y=(double)0, force-z=(double)0, "
                             "torque-z=(double)0, no-force-reason=(string)" +
                             limit + more)
                       .get());
}

std::string device_stats(const std::string& more = "") {
  return "stats, device=(string)sim, device-state=(string)running, force-x=(double)1, "
         "force-y=(double)0, force-z=(double)0, torque-z=(double)0, "
         "tensions=(double)<0.5, 0.7, 0>, skew-median=(guint64)400000, skew-p99=(guint64)900000, "
         "analysis-median=(guint64)310000, analysis-max=(guint64)1200000" +
         more;
}

/// The rows of numbers of a block of data in a script; a blank line is an empty row.
std::vector<std::vector<double>> block(const std::string& script, const std::string& name) {
  std::istringstream lines(script.substr(script.find(name + " << END\n")));
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line != "END") {
    std::istringstream numbers(line);
    rows.emplace_back();
    for (double number; numbers >> number;) rows.back().push_back(number);
  }
  return rows;
}

TEST(PlayRecord, TheFilmsOwnReasonComesFirst) {
  Record record;
  add_frame(record, 0, "nothing-to-compare");
  add_frame(
      record, 1, "camera-only",
      ", no-force-text=(string)\"Only the camera moves.\", device-no-force-reason=(string)muted");
  add_frame(
      record, 2, "none",
      ", device-no-force-reason=(string)muted, device-no-force-text=(string)\"It is muted.\"");
  // The device will be ready when the frame is shown.
  add_frame(record, 3, "none", ", device-no-force-reason=(string)device-starting");
  ASSERT_EQ(record.frames().size(), 4u);
  EXPECT_TRUE(record.frames()[0].begins_scene);
  EXPECT_FALSE(record.frames()[1].begins_scene);
  EXPECT_EQ(record.frames()[1].reason, "camera-only");
  EXPECT_EQ(record.sentence("camera-only"), "Only the camera moves.");
  EXPECT_EQ(record.frames()[2].reason, "muted");
  EXPECT_EQ(record.frames()[3].reason, kFelt);
  EXPECT_EQ(record.sentence("unknown"), "unknown");
  EXPECT_EQ(record.frames()[3].velocity_px_s[1], 20) << "upwards";
}

// Messages come before their frames: the line of progress is of the frame on the screen.
TEST(PlayRecord, KnowsWhichFrameIsShown) {
  Record record;
  EXPECT_EQ(record.shown_at(5), nullptr);
  for (int number : {1, 2, 3}) add_frame(record, number);
  EXPECT_EQ(record.shown_at(0.05), nullptr);
  EXPECT_EQ(record.shown_at(0.25)->time_s, 0.2);
  EXPECT_EQ(record.shown_at(9)->time_s, 3 * 0.1);
}

TEST(PlayRecord, BeginsAgainAfterASeek) {
  Record record;
  for (int number : {4, 5, 1}) add_frame(record, number);
  ASSERT_EQ(record.frames().size(), 1u);
  EXPECT_EQ(record.reasons().size(), 1u);
  EXPECT_EQ(record.shown_at(9)->time_s, 0.1);
}

TEST(PlayRecord, ARepeatedFrameKeepsTheForceOfItsPicture) {
  Record record;
  add_frame(record, 1);
  add_frame(record, 2, "none", ", repeated=(boolean)true");
  EXPECT_EQ(record.frames().size(), 1u);
  EXPECT_EQ(record.repeated(), 1u);
  EXPECT_EQ(record.reasons().size(), 2u) << "why nothing is felt is said of every frame";
}

TEST(PlayReport, IsSixLinesOfWhatAPersonWants) {
  Record record;
  for (int number = 0; number <= 100; ++number) add_frame(record, number);
  const Structure stats = structure(device_stats(", frames=(guint64)99"));
  record.add_device(stats.get(), 1);
  EXPECT_EQ(report_text(record, stats.get(), 101),
            "Video: 10.0 s, 99 analysed of 101 frames shown.\n"
            "Force at the grip: 1.00 N in the median, 1.00 N at most.\n"
            "In time: a force comes 0.40 ms after its frame in the median, 0.90 ms at 99 %.\n"
            "Analysis: 0.31 ms a frame in the median, 1.20 ms at most.\n"
            "Device: sim, no problems found.\n"
            "Felt: 100.0 % of the frames.\n");
}

TEST(PlayReport, CountsTicksWithoutAForceThatWasDue) {
  Record record;
  add_frame(record, 1);
  const Structure stats =
      structure(device_stats(", ticks=(guint64)10000, overruns=(guint64)7, "
                             "missed-ticks=(guint64)52, gap-ticks=(guint64)340"));
  const std::string text = report_text(record, stats.get(), 1);
  EXPECT_NE(text.find("Device: sim, 7 of 10000 ticks came late, 52 ticks were left out, no force "
                      "for 0.34 s in all, because no frame came in time.\n"),
            std::string::npos)
      << text;
}

TEST(PlayReport, SaysWhyNothingWasFeltTheMostFrequentReasonFirst) {
  Record record;
  for (int number = 0; number < 1000; ++number) {
    const bool muted = number < 100, still = number >= 600;
    add_frame(record, number,
              muted   ? "muted"
              : still ? "nothing-moves"
                      : "none",
              still ? ", no-force-text=(string)\"Nothing moves in the picture.\"" : "");
  }
  add_frame(record, 1000, "late");  // too few for a line
  const std::string text = report_text(record, structure(device_stats()).get(), 1001);
  // 1000 frames, and one that is late.
  EXPECT_NE(text.find("Felt: 50.0 % of the frames; the others:\n"
                      "  40.0 %  Nothing moves in the picture.\n"
                      "  10.0 %  muted\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("late"), std::string::npos) << text;

  Record still;
  add_frame(still, 0, "nothing-moves", ", no-force-text=(string)\"Nothing moves.\"");
  const std::string one = report_text(still, structure("stats").get(), 1);
  EXPECT_NE(one.find("Nothing was felt: Nothing moves.\n"), std::string::npos) << one;
}

// Only its first frame is compared with nothing; the others show its picture again.
TEST(PlayReport, OfAStillFilmSaysHowLongItIsAndThatItsPictureRemains) {
  Record record;
  add_frame(record, 0, "nothing-to-compare");
  for (int number = 1; number < 100; ++number) {
    add_frame(record, number, "repeated-frames", ", repeated=(boolean)true");
  }
  EXPECT_EQ(record.shown_at(5)->reason, "repeated-frames");
  const std::string text = report_text(record, structure("stats, frames=(guint64)100").get(), 100);
  for (const char* line : {"Video: 9.9 s, 100 analysed of 100 frames shown.\n",
                           "Felt: 0.0 % of the frames; the others:\n"
                           "  99.0 %  repeated-frames\n"
                           "  1.0 %  nothing-to-compare\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  }
}

constexpr const char* kOfTrack = ", track=(string)/films/film.mp4.haptic.flac";

TEST(PlayReport, SaysWhatWasNotMeasuredAndThatATrackWasPlayed) {
  Record record;
  add_frame(record, 0, "none", kOfTrack);
  const std::string text =
      report_text(record, structure("stats, track-frames=(guint64)300").get(), 300);
  for (const char* line :
       {"Force that is wanted: 1.00 N", "In time: not measured", "Device: none.",
        "Video: 0.0 s, 300 frames shown.\n",
        "Analysis: none, because the force is that of the haptic track film.mp4.haptic.flac.\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  }
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
}

TEST(PlayReport, TheLineOfAFrameWithATrackHasItsForceAndNoSpeed) {
  Record record;
  EXPECT_EQ(progress_line(0, nullptr), "    0.0 s");
  add_frame(record, 1);
  EXPECT_NE(progress_line(0.1, &record.frames()[0]).find("36 px/s   1.00 N"), std::string::npos);
  add_frame(record, 2, "none", kOfTrack);
  const std::string line = progress_line(0.2, &record.frames()[1]);
  EXPECT_NE(line.find("1.00 N [=======             ] x +1.00 y +0.00  felt"), std::string::npos)
      << line;
  EXPECT_EQ(line.find("px/s"), std::string::npos) << line;
}

TEST(PlayReport, NamesTheProblemsOfTheDevice) {
  Record record;
  add_frame(record, 0);
  const std::string text = report_text(
      record,
      structure("stats, device=(string)usb, device-state=(string)lost, times-lost=(guint64)2, "
                "exchange-errors=(guint64)21, faulty-string=(int)4, "
                "pose-fault=(string)\"the string lengths fit no pose\", "
                "refused-wrenches=(guint64)3")
          .get(),
      1);
  for (const char* problem :
       {"it does not answer", "lost 2 times", "21 exchanges failed", "string 4",
        "the pose is not known: the string lengths", "of 3 frames was not rendered"}) {
    EXPECT_NE(text.find(problem), std::string::npos) << problem << "\n" << text;
  }
  EXPECT_EQ(text.find("no problems"), std::string::npos);
}

TEST(PlayPicture, ThePositionBeginsAgainAfterACut) {
  Record record;
  add_frame(record, 0, "nothing-to-compare");
  add_frame(record, 1);
  add_frame(record, 2);
  add_frame(record, 3, "nothing-to-compare");
  add_frame(record, 4);
  const auto rows = block(picture_script(record, 3, "film"), "$frames");
  // Time, x, y; a line does not go on through the empty row.
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_TRUE(rows[0].empty());
  EXPECT_TRUE(rows[4].empty());
  const double x_px[] = {NAN, 0, 3, 6, NAN, 0, 3};
  for (const size_t row : {1, 2, 3, 5, 6}) {
    EXPECT_NEAR(rows[row][1], x_px[row], 1e-9) << row;
    EXPECT_NEAR(rows[row][2], x_px[row] * 2 / 3, 1e-9) << row;
  }
}

TEST(PlayPicture, MarksWhenAndWhyNothingIsFelt) {
  Record record;
  add_frame(record, 0, "camera-only");
  add_frame(record, 1, "camera-only");
  add_frame(record, 2);
  add_frame(record, 3, "nothing-moves");
  add_frame(record, 4, "camera-only");
  add_frame(record, 6);
  const std::string script = picture_script(record, 3, "film");
  // Begin, row of the reason, length.
  const std::vector<std::vector<double>> expected = {{0, 0, 0.2}, {0.3, 1, 0.1}, {0.4, 0, 0.2}};
  const auto rows = block(script, "$reasons");
  ASSERT_EQ(rows.size(), expected.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(rows[i][k], expected[i][k], 1e-6) << i;
  }
  EXPECT_NE(script.find("set ytics ('camera-only' 0, 'nothing-moves' 1)"), std::string::npos);
}

TEST(PlayPicture, IsDrawnOfAnyPlayback) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "gnuplot is not installed";
  }
  const spidar::test::TemporaryFolder folder;
  const std::string png = folder.path / "play.png";
  const auto height = [&](const Record& record, double max_force_N) {
    spidar::PartFile picture(png, {true, ""});
    spidar::tools::draw_with_gnuplot(picture_script(record, max_force_N, "it's | a 'film'"),
                                     picture);
    picture.publish();
    std::ifstream file(png, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    return bytes.size() < 24 ? 0 : GST_READ_UINT32_BE(bytes.data() + 20);
  };
  // Of curves, and of reasons why nothing is felt: a line for each, and one more.
  const auto expected = [](unsigned curves, unsigned reasons) {
    return 98 + 262 * curves + (reasons > 0 ? 66 + 24 * reasons : 0);
  };
  Record silent;
  silent.add_frame(
      structure("m, running-time=(guint64)0, no-force-reason=(string)nothing-moves").get());
  EXPECT_EQ(height(silent, 0), expected(0, 1))
      << "only the reasons: nothing moves, nothing is felt";
  Record of_track;
  for (int number = 0; number < 3; ++number) add_frame(of_track, number, "none", kOfTrack);
  EXPECT_EQ(height(of_track, 3), expected(2, 0)) << "two forces";
  Record moving;
  for (int number = 0; number < 3; ++number) add_frame(moving, number);
  EXPECT_EQ(height(moving, 3), expected(4, 0));
  // Torque is felt, and strings pull.
  moving.add_device(structure("stats, device-state=(string)running, torque-z=(double)0.05, "
                              "tensions=(double)<0.5, 0.7, 0>")
                        .get(),
                    0.1);
  EXPECT_EQ(height(moving, 3), expected(6, 0));
}

}  // namespace
