// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The mouse in the windows of players that are separate programs: a real X server, sinks that send
// what the mouse does, and xdotool, which moves it.
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/moving_scene.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace spidar::test::player_mouse_test {
namespace {

using Eigen::Vector2d;
using Words = std::vector<std::string>;

/// Three discs that circle about places of their own, a third of a turn apart, so that each moves
/// in another direction than the others at any time.
constexpr int kWidth = 480, kHeight = 270, kDiscs = 3;
constexpr int kTurn_frames = 50, kTurns = 60, kRate = 25;
constexpr double kCircle_px = 24, kDisc_px = 28;
const std::array<Vector2d, kDiscs> kMiddles_px{Vector2d(-150, -70), Vector2d(150, -70),
                                               Vector2d(0, 75)};

double angle_rad(int disc, double frame) {
  return 2 * M_PI * (frame / kTurn_frames + static_cast<double>(disc) / kDiscs);
}

/// Of the film, which ends after two minutes. Its background tells that the camera rests.
std::string make_film(const std::filesystem::path& folder) {
  MovingScene scene(kWidth, kHeight);
  for (int i = 0; i < kDiscs; ++i) scene.add_disc(kDisc_px);
  std::string turn;
  for (int frame = 0; frame < kTurn_frames; ++frame) {
    std::vector<Placement> places;
    for (int disc = 0; disc < kDiscs; ++disc) {
      const double angle = angle_rad(disc, frame);
      places.push_back({kMiddles_px[static_cast<size_t>(disc)] +
                        kCircle_px * Vector2d(std::cos(angle), std::sin(angle))});
    }
    const ImageView picture = scene.draw({}, places);
    for (int y = 0; y < kHeight; ++y) {
      turn.append(reinterpret_cast<const char*>(picture.at(0, y)), kWidth);
    }
  }
  const std::string raw = folder / "film.raw", film = folder / "film.avi";
  std::ofstream file(raw, std::ios::binary);
  for (int n = 0; n < kTurns; ++n) file << turn;
  file.close();
  const CommandResult made =
      run("gst-launch-1.0 -q filesrc location=" + raw +
          " ! rawvideoparse format=gray8 width=480 height=270 framerate=" + std::to_string(kRate) +
          "/1 ! jpegenc ! avimux ! filesink location=" + film);
  EXPECT_EQ(made.status, 0) << made.text;
  std::filesystem::remove(raw);
  return film;
}

/// Rows of a CSV file that is still written, the last `most` of those that are whole.
std::vector<std::map<std::string, std::string>> last_rows(const std::string& path, size_t most) {
  std::ifstream file(path);
  std::string line, field;
  Words names;
  if (!std::getline(file, line) || file.eof()) return {};
  for (std::istringstream row(line); std::getline(row, field, ',');) names.push_back(field);
  // A row has at most 2048 characters.
  file.seekg(0, std::ios::end);
  const auto tail = static_cast<std::streamoff>((most + 1) * 2048);
  const std::streamoff begin = std::max<std::streamoff>(file.tellg() - tail, 0);
  file.seekg(begin);
  std::getline(file, line);  // the names, or a part of a row
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line) && !file.eof()) {
    std::map<std::string, std::string> values;
    std::istringstream row(line);
    for (size_t i = 0; i < names.size() && std::getline(row, field, ','); ++i) {
      values[names[i]] = field;
    }
    if (values.size() == names.size()) rows.push_back(std::move(values));
  }
  if (rows.size() > most) rows.erase(rows.begin(), rows.end() - static_cast<long>(most));
  return rows;
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

bool is_there(const std::string& command) {
  return run(command).status == 0;
}

class PlayerMouse : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    VirtualDisplay::shared();
    folder = std::make_unique<TemporaryFolder>();
    film = make_film(folder->path);
  }
  static void TearDownTestSuite() { folder.reset(); }

  void SetUp() override {
    if (!VirtualDisplay::shared().runs()) GTEST_SKIP() << VirtualDisplay::kWhyNot;
    if (!is_there("command -v xdotool"))
      GTEST_SKIP() << "xdotool, which moves the mouse, is not installed";
  }

  void start(const Words& command) {
    std::filesystem::remove(trace());
    player_ = std::make_unique<ChildProcess>(command);
    ASSERT_TRUE(comes([this] { return find_window(); })) << "no window";
    ASSERT_TRUE(comes([this] { return !last_rows(trace(), 1).empty(); })) << "no frame";
  }
  void TearDown() override {
    if (player_) player_->end(SIGTERM);
  }

  std::string trace() const { return folder->path / "trace.csv"; }
  static Words launch(const std::string& sink, const std::string& properties) {
    Words words{"gst-launch-1.0", "-q", "filesrc",     "location=" + film, "!",
                "decodebin",      "!",  "spidarmotion"};
    std::istringstream all(properties);
    for (std::string word; all >> word;) words.push_back(word);
    for (const char* word : {"!", "videoconvert", "!"}) words.emplace_back(word);
    words.push_back(sink);
    words.emplace_back("qos=false");  // no frame is left out on a slow machine
    return words;
  }

  /// To a place of the picture, which fills the window; `then` is what xdotool does there.
  void mouse(const Vector2d& place, const std::string& then = "") const {
    const CommandResult done = run("xdotool mousemove " + std::to_string(at_px(place, 0)) + " " +
                                   std::to_string(at_px(place, 1)) + " " + then);
    EXPECT_EQ(done.status, 0) << done.text;
  }
  static Vector2d place_of(int disc) {
    const Vector2d& middle_px = kMiddles_px[static_cast<size_t>(disc)];
    return {0.5 + middle_px.x() / kWidth, 0.5 + middle_px.y() / kHeight};
  }

  /// The disc that moves most like what was felt in this row.
  static int felt(std::map<std::string, std::string>& row) {
    const double frame = 1e-9 * std::stod(row["stream_time_ns"]) * kRate;
    const Vector2d felt_px_s(std::stod(row["velocity_x_px_s"]), std::stod(row["velocity_y_px_s"]));
    int nearest = 0;
    double best = -1e9;
    for (int disc = 0; disc < kDiscs; ++disc) {
      // Measured between two frames.
      const double angle = angle_rad(disc, frame - 0.5);
      const double along = felt_px_s.dot(Vector2d(-std::sin(angle), std::cos(angle)));
      if (along > best) nearest = disc;
      best = std::max(best, along);
    }
    return nearest;
  }
  int64_t newest_ns() const {
    auto rows = last_rows(trace(), 1);
    return rows.empty() ? 0 : std::stoll(rows[0]["stream_time_ns"]);
  }
  /// Whether this disc comes to be felt, and stays so for half a turn.
  bool comes_to_feel(int disc) const {
    constexpr size_t kRows = kTurn_frames / 2;
    return comes([&] {
      auto rows = last_rows(trace(), kRows);
      for (auto& row : rows)
        if (felt(row) != disc) return false;
      return rows.size() == kRows;
    });
  }
  /// Until what has happened by now is in the trace.
  bool passes_s(double seconds) const {
    const auto until_ns = newest_ns() + static_cast<int64_t>(1e9 * seconds);
    return comes([&] { return newest_ns() >= until_ns; });
  }

  void expect_mouse_chooses() {
    for (const int disc : {0, 1, 2}) {
      mouse(place_of(disc));
      ASSERT_TRUE(comes_to_feel(disc)) << disc;
    }
    mouse(place_of(2), "click 1");
    mouse(place_of(0));
    ASSERT_TRUE(passes_s(4));
    ASSERT_TRUE(comes_to_feel(2)) << "the click has kept it";
    mouse(place_of(0), "click 1");
    ASSERT_TRUE(comes_to_feel(0)) << "the second one has let go";
  }

  static inline std::unique_ptr<TemporaryFolder> folder;
  static inline std::string film;

 private:
  bool find_window() {
    const CommandResult found = run_shell(
        "xdotool search --onlyvisible --name . getwindowgeometry --shell 2>/dev/null | tail -n 7");
    std::istringstream lines(found.text);
    int seen = 0;
    for (std::string line; std::getline(lines, line);) {
      const size_t is = line.find('=');
      const std::string name = line.substr(0, is);
      constexpr const char* kNames[] = {"X", "Y", "WIDTH", "HEIGHT"};
      for (size_t i = 0; i < geometry_px_.size(); ++i) {
        if (name != kNames[i]) continue;
        geometry_px_[i] = std::stoi(line.substr(is + 1));
        ++seen;
      }
    }
    return seen == 4 && geometry_px_[2] > 100;
  }
  int at_px(const Vector2d& place, int axis) const {
    const auto i = static_cast<size_t>(axis);
    return geometry_px_[i] + static_cast<int>(std::lround(place[axis] * geometry_px_[i + 2]));
  }

  std::unique_ptr<ChildProcess> player_;
  std::array<int, 4> geometry_px_{};  ///< x, y, width, height of the window
};

class SinkMouse : public PlayerMouse, public testing::WithParamInterface<const char*> {};

TEST_P(SinkMouse, ChoosesTheObjectThatIsFelt) {
  const std::string sink = GetParam();
  if (!is_there("gst-launch-1.0 -q videotestsrc num-buffers=1 ! videoconvert ! " + sink))
    GTEST_SKIP() << sink << " shows nothing here";
  start(launch(sink, "device=none motion=objects pointer=mouse trace=" + trace()));
  ASSERT_FALSE(HasFatalFailure());
  expect_mouse_chooses();
}
INSTANTIATE_TEST_SUITE_P(Sinks, SinkMouse,
                         testing::Values("ximagesink", "xvimagesink", "glimagesink"),
                         [](const auto& sink) { return std::string(sink.param); });

TEST_F(PlayerMouse, ChoosesInAPlayerThatKnowsNothingOfIt) {
  start({SPIDAR_FEEL, "device=none", "motion=objects", "pointer=mouse", "trace=" + trace(), "--",
         "gst-play-1.0", "--quiet", "--no-interactive", "--videosink=ximagesink qos=false", film});
  ASSERT_FALSE(HasFatalFailure());
  expect_mouse_chooses();
}

/// The grip of the simulated device in its newest tick, metres.
Vector2d grip_m(const std::string& haptic_trace) {
  auto rows = last_rows(haptic_trace, 1);
  if (rows.empty()) return {0, 0};
  return {std::stod(rows[0]["position_x_m"]), std::stod(rows[0]["position_y_m"])};
}

TEST_F(PlayerMouse, IsAFingerOnTheSimulatedDevice) {
  const std::string ticks = folder->path / "ticks.csv";
  start(launch("ximagesink",
               "device=sim touch=luma pointer=mouse trace=" + trace() + " haptic-trace=" + ticks));
  ASSERT_FALSE(HasFatalFailure());
  // Half of the way to the upper right corner of 59 mm × 64 mm; a film in motion pushes the grip
  // about by some millimetres.
  mouse({0.75, 0.25}, "mousedown 1");
  ASSERT_TRUE(comes([&] { return (grip_m(ticks) - Vector2d(0.0148, 0.016)).norm() < 0.004; }));
  mouse({0.25, 0.75});
  ASSERT_TRUE(comes([&] { return (grip_m(ticks) + Vector2d(0.0148, 0.016)).norm() < 0.004; }));
  mouse({0.25, 0.75}, "mouseup 1");
  ASSERT_TRUE(comes([&] { return grip_m(ticks).norm() < 0.004; })) << "it is let go";
}

}  // namespace
}  // namespace spidar::test::player_mouse_test
