// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A person chooses an object in the debug window of a player, saves that, and plays the film again:
// a real X server, and xdotool, which moves the mouse.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/choice/feel_rules.h"
#include "plugin/window/model/layout.h"
#include "tests/support/child_process.h"
#include "tests/support/moving_scene.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace spidar::test::window_choice_test {
namespace {

using Eigen::Vector2d;

/// Two discs that circle half a turn apart, so that they always move in opposite directions.
constexpr int kWidth = 480, kHeight = 270, kDiscs = 2;
constexpr int kTurn_frames = 50, kRate = 25, kFrames = 60 * kRate, kAgain_frames = 8 * kRate;
constexpr double kCircle_px = 24, kAside_px = 110, kMostFrames = 0.95;

double angle_rad(int disc, double frame) {
  return 2 * M_PI * (frame / kTurn_frames + static_cast<double>(disc) / kDiscs);
}

void make_film(const std::string& path) {
  MovingScene scene(kWidth, kHeight);
  scene.add_disc(36);
  scene.add_disc(28);
  std::string turn;
  for (int frame = 0; frame < kTurn_frames; ++frame) {
    std::vector<Placement> places;
    for (int disc = 0; disc < kDiscs; ++disc) {
      const double angle = angle_rad(disc, frame);
      places.push_back({Vector2d(disc == 0 ? -kAside_px : kAside_px, 0) +
                        kCircle_px * Vector2d(std::cos(angle), std::sin(angle))});
    }
    const ImageView picture = scene.draw({}, places);
    for (int y = 0; y < kHeight; ++y) {
      turn.append(reinterpret_cast<const char*>(picture.at(0, y)), kWidth);
    }
  }
  std::ofstream raw(path + ".raw", std::ios::binary);
  for (int n = 0; n < kFrames; n += kTurn_frames) raw << turn;
  raw.close();
  const CommandResult made = run("gst-launch-1.0 -q filesrc location=" + path +
                                 ".raw ! rawvideoparse format=gray8 width=480 height=270 "
                                 "framerate=25/1 ! jpegenc ! avimux ! filesink location=" +
                                 path);
  EXPECT_EQ(made.status, 0) << made.text;
  std::filesystem::remove(path + ".raw");
}

/// Waits until it is so. False when it is not within a minute, a hundred times what it takes.
template <typename Condition>
bool comes(const Condition& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

class WindowChoice : public testing::Test {
 protected:
  void SetUp() override {
    if (!VirtualDisplay::shared().runs()) GTEST_SKIP() << VirtualDisplay::kWhyNot;
    if (run("command -v xdotool").status != 0)
      GTEST_SKIP() << "xdotool, which moves the mouse, is not installed";
    make_film(film());
  }

  std::string film() const { return folder.path / "film.avi"; }
  /// The trace of the player with the window.
  std::string played() const { return folder.path / "played.csv"; }
  std::string rules_file() const { return film() + ".feel"; }
  std::vector<FeelRule> rules() const {
    std::ifstream file(rules_file());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return text.empty() ? std::vector<FeelRule>() : FeelRules(text).rules();
  }
  /// Of the first rule; −1 when there is none.
  int chosen_disc() const { return rules().empty() ? -1 : rules()[0].place.x() < 0.5 ? 0 : 1; }

  using TraceRow = std::map<std::string, double>;
  /// Time and velocity of each frame in a trace; a line that is still being written is left out.
  static std::vector<TraceRow> traced(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> names = fields(line);
    std::vector<TraceRow> rows;
    while (std::getline(file, line) && !file.eof()) {
      const std::vector<std::string> values = fields(line);
      TraceRow row;
      for (const char* name : {"stream_time_ns", "velocity_x_px_s", "velocity_y_px_s"}) {
        const auto at = std::find(names.begin(), names.end(), name) - names.begin();
        row[name] = std::stod(values.at(static_cast<size_t>(at)));
      }
      rows.push_back(std::move(row));
    }
    return rows;
  }

  /// The share of the frames from one time to another in which this disc is felt.
  double felt_share(int disc, int64_t from_ns, int64_t to_ns) const {
    const std::string trace = folder.path / "trace.csv";
    const CommandResult played =
        run("gst-launch-1.0 -q filesrc location=" + film() +
            " ! decodebin ! identity eos-after=" + std::to_string(kAgain_frames) +
            " ! spidarmotion device=none feel=auto trace=" + trace + " ! fakesink sync=false");
    EXPECT_EQ(played.status, 0) << played.text;
    int right = 0, all = 0;
    for (TraceRow& row : traced(trace)) {
      const double time_ns = row["stream_time_ns"];
      if (time_ns < static_cast<double>(from_ns) || time_ns >= static_cast<double>(to_ns)) continue;
      // Measured between two frames.
      const double angle = angle_rad(disc, 1e-9 * time_ns * kRate - 0.5);
      const Vector2d along(-std::sin(angle), std::cos(angle));
      // Half of its speed: the other one goes the other way.
      const double speed_px_s = 2 * M_PI * kCircle_px * kRate / kTurn_frames;
      ++all;
      right += along.dot(Vector2d(row["velocity_x_px_s"], row["velocity_y_px_s"])) > speed_px_s / 2;
    }
    EXPECT_GT(all, kRate) << "more than a second was felt";
    return static_cast<double>(right) / all;
  }

  void click(const Rect& place) const {
    const CommandResult done =
        run("xdotool mousemove " +
            std::to_string(origin_px_[0] + static_cast<int>(place.x + place.width / 2)) + " " +
            std::to_string(origin_px_[1] + static_cast<int>(place.y + place.height / 2)) +
            " sleep 0.3 mousedown 1 sleep 0.3 mouseup 1 sleep 0.3");
    EXPECT_EQ(done.status, 0) << done.text;
  }
  bool find_window() {
    const CommandResult found =
        run_shell("xdotool search --onlyvisible --name 'what is felt' getwindowgeometry --shell");
    std::istringstream lines(found.text);
    std::map<std::string, int> values;
    for (std::string line; std::getline(lines, line);) {
      const size_t is = line.find('=');
      if (is != std::string::npos) values[line.substr(0, is)] = std::stoi(line.substr(is + 1));
    }
    origin_px_ = {values["X"], values["Y"]};
    layout_ = lay_out(values["WIDTH"], values["HEIGHT"], 1);
    return values["HEIGHT"] > 0;
  }
  Rect row(size_t i) const { return object_rows(layout_.objects, 1, kDiscs).at(i); }
  /// In the title of the list.
  Rect save_button() const { return {layout_.objects.right() - 60, layout_.objects.y + 8, 40, 10}; }

  TemporaryFolder folder;
  std::array<int, 2> origin_px_{};
  WindowLayout layout_;

 private:
  static std::vector<std::string> fields(const std::string& line) {
    std::istringstream row(line);
    std::vector<std::string> all;
    for (std::string field; std::getline(row, field, ',');) all.push_back(field);
    return all;
  }
};

TEST_F(WindowChoice, OfAnObjectIsObeyedWhenTheFilmIsPlayedAgain) {
  ChildProcess player({"gst-launch-1.0", "-q", "filesrc", "location=" + film(), "!", "decodebin",
                       "!", "spidarmotion", "device=none", "debug-window=true", "trace=" + played(),
                       "!", "fakesink", "sync=true"});
  ASSERT_TRUE(comes([this] { return find_window(); })) << "no window";
  // A row that is not there yet cannot be clicked, and a second click would let go.
  for (const size_t i : {1, 0}) {
    const int before = chosen_disc();
    ASSERT_TRUE(comes([&] {
      click(row(i));
      click(save_button());
      return chosen_disc() != before && chosen_disc() >= 0;
    })) << "row "
        << i << " is not chosen and saved";
    ASSERT_EQ(rules().size(), 1u) << "the last one of a scene counts";
  }
  const int64_t saved_to_ns = rules()[0].to_ns;
  ASSERT_TRUE(comes([&] {
    const std::vector<TraceRow> rows = traced(played());
    return !rows.empty() && rows.back().at("stream_time_ns") > static_cast<double>(saved_to_ns);
  })) << "it does not play on";
  player.end(SIGINT);  // as Control-C does: the pipeline is stopped
  ASSERT_EQ(rules().size(), 1u);
  const FeelRule rule = rules()[0];
  EXPECT_GT(rule.to_ns, saved_to_ns) << "what was played after it had been saved belongs to it";
  const int disc = chosen_disc();
  EXPECT_GE(felt_share(disc, rule.from_ns, rule.to_ns), kMostFrames);
  EXPECT_LE(felt_share(1 - disc, rule.from_ns, rule.to_ns), 1 - kMostFrames);

  // The other one, by hand.
  std::ofstream(rules_file()) << "object at "
                              << (disc == 0 ? 0.5 + kAside_px / kWidth : 0.5 - kAside_px / kWidth)
                              << ",0.5\n";
  EXPECT_GE(felt_share(1 - disc, 500'000'000, FeelRule::kNoEnd), kMostFrames);
}

}  // namespace
}  // namespace spidar::test::window_choice_test
