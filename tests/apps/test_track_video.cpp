// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Output of track_video, compared with the element's trace of the same file.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace {

using nlohmann::json;
using spidar::test::TemporaryFolder;

constexpr int kFrames = 12;

void run_pipeline(const std::string& line) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  ASSERT_EQ(error, nullptr) << error->message;
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, 20 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  ASSERT_NE(message, nullptr) << "no end: " << line;
  EXPECT_EQ(GST_MESSAGE_TYPE(message), GST_MESSAGE_EOS) << line;
  gst_message_unref(message);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

struct Output {
  int status = -1;
  std::vector<std::string> lines;
  std::string errors;
};

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

class TrackVideo : public testing::Test {
 protected:
  void SetUp() override { gst_init(nullptr, nullptr); }

  /// A ball in front of a plain background; `format` as GStreamer names it.
  std::string clip(const std::string& format) const {
    const std::string file = folder / (format + ".mkv");
    run_pipeline("videotestsrc pattern=ball num-buffers=" + std::to_string(kFrames) +
                 " ! video/x-raw,width=320,height=240,framerate=25/1,format=" + format +
                 " ! matroskamux ! filesink location=" + file);
    return file;
  }

  Output run(const std::string& arguments) const {
    const std::string command = std::string(TRACK_VIDEO) + " " + arguments + " > " +
                                (folder / "out").string() + " 2> " + (folder / "errors").string();
    Output output;
    const int status = std::system(command.c_str());
    if (WIFEXITED(status)) output.status = WEXITSTATUS(status);
    output.lines = lines_of(folder / "out");
    for (const std::string& line : lines_of(folder / "errors")) output.errors += line + "\n";
    return output;
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder = temporary_.path;
};

TEST_F(TrackVideo, SaysWhatTheElementsTracesSay) {
  const std::string file = clip("I420");
  const Output output = run(file);
  EXPECT_EQ(output.status, 0) << output.errors;
  ASSERT_EQ(output.lines.size(), static_cast<size_t>(kFrames));

  for (const char* name : {"trace.jsonl", "trace.csv"}) {
    run_pipeline("filesrc location=" + file +
                 " ! matroskademux ! spidarmotion device=none motion=object trace=" +
                 (folder / name).string() + " ! fakesink sync=false");
  }
  EXPECT_EQ(lines_of(folder / "trace.jsonl"), output.lines);

  const std::vector<std::string> csv = lines_of(folder / "trace.csv");
  ASSERT_EQ(csv.size(), output.lines.size() + 1);
  for (size_t n = 0; n < output.lines.size(); ++n) {
    const json frame = json::parse(output.lines[n]);
    const json& force_N = frame["wrench"]["force_N"];
    const json& torque_Nm = frame["wrench"]["torque_Nm"];
    const json& velocity_px_s = frame["motion"]["velocity_px_s"];
    const std::vector<json> expected = {
        frame["running_time_ns"],
        frame["stream_time_ns"],
        frame["features"],
        frame["motion"]["tracked"],
        velocity_px_s[0],
        velocity_px_s[1],
        force_N[0],
        force_N[1],
        force_N[2],
        torque_Nm[0],
        torque_Nm[1],
        torque_Nm[2],
    };
    std::stringstream cells(csv[n + 1]);
    size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (column == expected.size()) break;  // `limit` is the element's, not the analysis's
      ASSERT_LT(column, expected.size());
      EXPECT_EQ(std::stod(cell), expected[column].get<double>()) << "frame " << n << " " << column;
    }
    EXPECT_EQ(column, expected.size());
  }
}

TEST_F(TrackVideo, FollowsTheBall) {
  const Output output = run(clip("I420") + " --points");
  ASSERT_EQ(output.lines.size(), static_cast<size_t>(kFrames)) << output.errors;
  EXPECT_TRUE(json::parse(output.lines[0])["restarted"].get<bool>());
  const json last = json::parse(output.lines.back());
  EXPECT_EQ(last["background"]["model"], "still");
  ASSERT_EQ(last["objects"].size(), 1u);
  EXPECT_EQ(last["objects"][0]["velocity_px_s"], last["motion"]["velocity_px_s"]);
  EXPECT_EQ(last["points"].size(), last["objects"][0]["tracks"].get<size_t>());
}

TEST_F(TrackVideo, TakesTheLumaOfAPlane) {
  const std::vector<std::string> expected = run(clip("GRAY8")).lines;
  ASSERT_EQ(expected.size(), static_cast<size_t>(kFrames));
  // videotestsrc draws the ball with the same luma in both.
  EXPECT_EQ(run(clip("I420")).lines, expected);
}

TEST_F(TrackVideo, MeanLooksAtNoObject) {
  const Output output = run("--motion=mean " + clip("I420"));
  const json last = json::parse(output.lines.back());
  EXPECT_TRUE(last["background"].is_null());
  EXPECT_EQ(last["objects"], json::array());
  EXPECT_GT(last["motion"]["tracked"].get<int>(), 0);
}

TEST_F(TrackVideo, SaysWhatIsWrong) {
  const Output nowhere = run("/nowhere.mkv");
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_EQ(nowhere.errors.rfind("track_video: /nowhere.mkv: no such file", 0), 0u)
      << nowhere.errors;

  const std::string text = folder / "film.txt";
  std::ofstream(text) << "no film\n";
  const Output no_film = run(text);
  EXPECT_EQ(no_film.status, 1);
  EXPECT_EQ(no_film.errors.rfind("track_video: " + text + ": ", 0), 0u) << no_film.errors;

  for (const char* arguments : {"", "--points", "a b", "--waltz a", "--motion=waltz a"}) {
    const Output usage = run(arguments);
    EXPECT_EQ(usage.status, 2) << arguments;
    EXPECT_EQ(usage.errors.rfind("usage: ", 0), 0u) << usage.errors;
  }
  if (!std::filesystem::exists("/dev/full")) return;
  const std::string command = std::string(TRACK_VIDEO) + " " + clip("I420") + " > /dev/full 2>&1";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

}  // namespace
