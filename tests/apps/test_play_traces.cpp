// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reading traces in the player.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "apps/play/session_record.h"
#include "apps/play/trace_reader.h"

namespace {

namespace fs = std::filesystem;

class Traces : public testing::Test {
 protected:
  void SetUp() override {
    std::string path = fs::temp_directory_path() / "play-traces-XXXXXX";
    ASSERT_NE(mkdtemp(path.data()), nullptr);
    folder_ = path;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Lets a reader of columns b and a read what is written, and returns its rows as "b a".
  std::vector<std::string> read(const std::string& written, const std::string& copy = "") {
    std::vector<std::string> rows;
    TraceReader reader(folder_ / "pipe", copy, {"b", "a"}, [&](const TraceReader::Fields& row) {
      rows.push_back(std::string(row[0]) + " " + std::string(row[1]));
    });
    std::ofstream(folder_ / "pipe") << written;
    reader.finish();
    return rows;
  }

  fs::path folder_;
};

using Rows = std::vector<std::string>;

TEST_F(Traces, ColumnsAreFoundByName) {
  EXPECT_EQ(read("a,x,b\n1,2,3\n4,5,6\n"), (Rows{"3 1", "6 4"}));
}

TEST_F(Traces, ATraceThatIsOpenedAgainBeginsWithItsHeader) {
  EXPECT_EQ(read("a,b\n1,2\nb,a\n3,4\n"), (Rows{"2 1", "3 4"}));
}

TEST_F(Traces, ARowCutShortIsLeftOut) {
  EXPECT_EQ(read("a,b\n1,2\n3"), (Rows{"2 1"}));
}

TEST_F(Traces, AColumnThatIsMissingIsNamed) {
  try {
    read("a,c\n1,2\n");
    FAIL() << "read a trace without column b";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("column b"), std::string::npos) << error.what();
  }
}

TEST_F(Traces, CopiesWhatItReads) {
  const std::string written = "a,b\n1,2\n3,4\n";
  read(written, folder_ / "copy.csv");
  std::stringstream copy;
  copy << std::ifstream(folder_ / "copy.csv").rdbuf();
  EXPECT_EQ(copy.str(), written);
}

TEST_F(Traces, ACopyThatCannotBeWrittenIsRefused) {
  EXPECT_THROW(read("a,b\n", folder_ / "none" / "copy.csv"), std::runtime_error);
}

TEST_F(Traces, EndsEvenIfNothingIsWritten) {
  TraceReader reader(folder_ / "pipe", "", {"a"}, [](const TraceReader::Fields&) { FAIL(); });
  EXPECT_NO_THROW(reader.finish());
}

TraceReader::Fields split(const std::string& line) {
  TraceReader::Fields fields;
  size_t begin = 0;
  for (size_t end; (end = line.find(',', begin)) != std::string::npos; begin = end + 1) {
    fields.push_back(std::string_view(line).substr(begin, end - begin));
  }
  fields.push_back(std::string_view(line).substr(begin));
  return fields;
}

/// Rows in the order of motion_columns() and haptic_columns().
void add_motion(SessionRecord& record, const std::string& line) {
  record.add_motion(split(line));
}
void add_haptic(SessionRecord& record, const std::string& line) {
  record.add_haptic(split(line + ",0,0,0,0,0,0,0,0"));
}

TEST(SessionRecord, MotionIsSummedUpwards) {
  SessionRecord record;
  add_motion(record, "0,0,0,0,0,0,0,nothing-to-compare");
  add_motion(record, "500000000,30,-40,0.3,0.4,0,-0.01,none");
  const SessionRecord::Numbers& numbers = record.numbers();
  EXPECT_EQ(numbers.frames, 2u);
  EXPECT_EQ(numbers.limits.at("nothing-to-compare"), 1u);
  EXPECT_EQ(numbers.limits.at("none"), 1u);
  EXPECT_DOUBLE_EQ(numbers.duration_s, 0.5);
  EXPECT_DOUBLE_EQ(numbers.speed_px_s.max(), 50.0);
  EXPECT_DOUBLE_EQ(numbers.wanted_N.max(), 0.5);
  std::stringstream curve;
  numbers.frames_curve.write(curve);
  std::vector<double> values;
  for (double value; curve >> value;) values.push_back(value);
  // Half a second of 30 px/s to the right and 40 px/s up, y of the image being down.
  EXPECT_EQ(values, (std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                                         0.5, 15, 20, 30, 40, 0.3, 0.4, 0, -0.01}));
}

TEST(SessionRecord, OnlyFramesDuringPlaybackCount) {
  SessionRecord record;
  add_haptic(record, "900,1000,0,-1,0,opening,1,0,9,9");
  add_haptic(record, "1000000,2000,50,40,1,running,0.03,0.04,0,0.001");
  add_haptic(record, "2000000,2000,60,40,1,running,0,0,-0.03,0");
  record.add_shown(40, 500'000);
  const SessionRecord::Numbers& numbers = record.numbers();
  EXPECT_EQ(numbers.ticks, 2u);
  EXPECT_EQ(numbers.felt_ticks, 1u);  // 0.05 N and 0.03 N
  EXPECT_EQ(numbers.largest_depth_N, 0.03);
  EXPECT_EQ(numbers.largest_roll_Nm, 0.001);
  EXPECT_EQ(numbers.lateness_ms.count(), 3u);
  EXPECT_DOUBLE_EQ(numbers.skew.signed_ms().max(), 0.5);
  EXPECT_EQ(record.now().device, "running");
  EXPECT_EQ(record.now().running_ns, 60);
}

}  // namespace
