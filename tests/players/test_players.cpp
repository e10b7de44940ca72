// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The players of desktops under spidar-feel, on a screen that nobody sees, with an SH4 board on an
// emulated USB.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "spidar/loop/haptic_loop.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"
#include "tests/players/session.h"
#include "tests/support/child_process.h"
#include "tests/support/felt_ticks.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace spidar::test::players_test {
namespace {

using Words = std::vector<std::string>;

struct Player {
  std::string name;
  Words command;       ///< FILM and PAGE stand for those
  std::string toggle;  ///< key that pauses and plays; empty: SIGUSR1 does
  std::string quit;    ///< key; empty: SIGUSR2 does; else a command that begins with the program
  std::string check;   ///< says why it cannot run and exits with another status than 0
  std::string environment = "SPIDAR=";  ///< a line NAME=VALUE
  bool needs_session = true;
};

void PrintTo(const Player& player, std::ostream* out) {
  *out << player.name;
}

const std::string kScripts = SCRIPTS;
const Player kPlayers[] = {
    {"Totem", {"totem", "FILM"}, "space", "totem --quit", ""},
    {"Parole", {"parole", "FILM"}, "space", "ctrl+q", ""},
    {"Showtime", {"showtime", "FILM"}, "space", "ctrl+q", ""},
    {"Clapper", {"clapper", "FILM"}, "space", "ctrl+q", ""},
    // Without OpenGL: Mesa's renderer in software crashes now and then, also without spidar-feel.
    {"GtkVideo",
     {"/usr/bin/python3", kScripts + "/gtk_video.py", "FILM"},
     "",
     "",
     "/usr/bin/python3 " + kScripts + "/gtk_video.py --check",
     "GDK_DEBUG=gl-disable",
     false},
    {"WebKitGTK",
     {"/usr/bin/python3", kScripts + "/web_video.py", "PAGE"},
     "space",
     "",
     "/usr/bin/python3 " + kScripts + "/web_video.py --check"},
    // The sandbox of its pages hides devices, files and what is preloaded.
    {"GnomeWeb",
     {"epiphany", "--private-instance", "PAGE"},
     "space",
     "ctrl+q",
     "",
     "WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS=1"},
};

/// A hand trembles: counters that never move while the force changes are known to be broken.
class Hand {
 public:
  explicit Hand(UsbPort& port) : port_(port), thread_([this] { tremble(); }) {}
  ~Hand() {
    ends_ = true;
    thread_.join();
  }

 private:
  void tremble() {
    for (int32_t by = 1; !ends_; by = -by) {
      for (auto& count : port_.count) count += by;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  UsbPort& port_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

class PlayerTest : public testing::TestWithParam<Player> {
 protected:
  static void SetUpTestSuite() {
    // What is preloaded is not for the program that reads plugins.
    EXPECT_EQ(run("gst-inspect-1.0 spidarmotion").status, 0);
    folder_ = std::make_unique<TemporaryFolder>();
    // 40 s of a picture that moves as a whole.
    const CommandResult made =
        run("gst-launch-1.0 -q videotestsrc pattern=smpte horizontal-speed=2 num-buffers=1000 ! "
            "video/x-raw,width=160,height=120,framerate=25/1 ! vp8enc deadline=1 cpu-used=16 "
            "keyframe-max-dist=25 ! webmmux ! filesink location=" +
            film());
    EXPECT_EQ(made.status, 0) << made.text;
    std::ofstream(page()) << "<video id=v src=film.webm autoplay muted loop width=320></video>"
                             "<script>onkeydown = e => { e.preventDefault(); "
                             "v.paused ? v.play() : v.pause() }</script>";
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string film() { return (folder_->path / "film.webm").string(); }
  static std::string page() { return (folder_->path / "page.html").string(); }
  static std::string picture() { return (folder_->path / "picture.png").string(); }
  static std::string trace() { return (folder_->path / "trace.csv").string(); }

  void SetUp() override {
    clear_bus();
    const Player& player = GetParam();
    if (!VirtualDisplay::shared().runs()) GTEST_SKIP() << VirtualDisplay::kWhyNot;
    if (!is_installed(player.command[0])) GTEST_SKIP() << player.command[0] << " is not installed";
    if (player.needs_session && !has_session_bus())
      GTEST_SKIP() << "dbus-run-session is not installed (package dbus-daemon)";
    if (!player.toggle.empty() && !is_installed("xdotool"))
      GTEST_SKIP() << "xdotool, which presses keys, is not installed";
    if (player.check.empty()) return;
    const CommandResult checked = run(player.check);
    if (checked.status != 0) GTEST_SKIP() << checked.text;
  }
  void TearDown() override {
    std::remove(trace().c_str());
    clear_bus();
  }

  static Words command() {
    Words words = GetParam().command;
    for (std::string& word : words) {
      if (word == "FILM") word = film();
      if (word == "PAGE") word = "file://" + page();
      if (word == "PICTURE") word = picture();
    }
    return words;
  }
  static Words felt_command() {
    Words words{SPIDAR_FEEL,
                "device=usb",
                "profile=spidar-g6x3-v2-r",
                "motion=mean",
                "haptic-trace=" + trace(),
                "--"};
    for (const std::string& word : command()) words.push_back(word);
    return words;
  }
  static Words environment() {
    return {"LD_PRELOAD=" EMULATED_BUS_LIBRARY, GetParam().environment};
  }

  static void toggle(const ChildProcess& player) {
    if (GetParam().toggle.empty())
      player.send(SIGUSR1);
    else
      EXPECT_TRUE(press(GetParam().toggle));
  }
  static void quit(const ChildProcess& player) {
    const std::string& how = GetParam().quit;
    if (how.empty())
      player.send(SIGUSR2);
    else if (how.find(' ') != std::string::npos)
      EXPECT_EQ(run(how).status, 0);
    else
      EXPECT_TRUE(press(how));
  }

  /// The largest force of the newest 100 ticks; zero unless it plays.
  static double force_now_N() {
    const std::vector<Tick> ticks = read_trace(trace());
    if (ticks.size() < 100 || !ticks.back().playing) return 0;
    return largest_N({ticks.end() - 100, ticks.end()});
  }
  /// For failures.
  static std::string seen() {
    const std::vector<Tick> ticks = read_trace(trace());
    const auto playing = [](const Tick& tick) { return tick.playing; };
    return std::to_string(ticks.size()) + " ms traced, playing in " +
           std::to_string(std::count_if(ticks.begin(), ticks.end(), playing)) + ", at most " +
           std::to_string(largest_N(ticks)) + " N; " + std::to_string(bus().files_opened) +
           " devices opened";
  }
  static double last_force_N() {
    const std::vector<Tick> ticks = read_trace(trace());
    return ticks.empty() ? 0 : ticks.back().force_N;
  }
  /// No process can set the motors any more, and they are at zero.
  static bool is_over(const UsbPort& port) {
    return processes_with("libgstspidar.so").empty() &&
           processes_with("emulated-guardian").empty() && port.at_rest();
  }

 private:
  static std::unique_ptr<TemporaryFolder> folder_;
};
std::unique_ptr<TemporaryFolder> PlayerTest::folder_;

/// How long it has been paused, to the newest tick.
double paused_s(const std::vector<Tick>& ticks) {
  for (size_t i = ticks.size(); i-- > 0;)
    if (ticks[i].playing)
      return static_cast<double>(ticks.back().monotonic_ns - ticks[i].monotonic_ns) * 1e-9;
  return 0;
}

/// Counted in ticks of the loop, one each millisecond: on a machine that is too busy to run it, no
/// force changes. Nor does the force change in a tick that the device does not answer in time.
/// After kMaxErrors of these in succession, the device is lost.
void expect_rest_while_paused(const std::vector<Tick>& ticks) {
  constexpr int kRampTicks = 60;
  int paused = 0, repeated = 0;
  double most_N = 0;
  for (size_t i = 1; i < ticks.size(); ++i) {
    if (ticks[i].playing) {
      paused = repeated = 0;
      continue;
    }
    const bool repeats = ticks[i].force_N > 0 && ticks[i].force_N == ticks[i - 1].force_N;
    repeated = repeats ? repeated + 1 : 0;
    if (!repeats || repeated >= HapticLoop::kMaxErrors) ++paused;
    if (paused > kRampTicks) most_N = std::max(most_N, ticks[i].force_N);
  }
  EXPECT_EQ(most_N, 0) << "more than " << kRampTicks << " ticks after it was paused";
}

TEST_P(PlayerTest, IsFeltWhileItPlaysAndAtRestWhilePausedAndAfterQuit) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const Hand hand(port);
  ChildProcess player(felt_command(), environment());
  ASSERT_TRUE(comes([] { return force_now_N() > 0.1; })) << "nothing is felt: " << seen();
  EXPECT_FALSE(port.at_rest());
  toggle(player);
  ASSERT_TRUE(comes([] { return paused_s(read_trace(trace())) > 0.5; })) << "it does not pause";
  toggle(player);
  ASSERT_TRUE(comes([] { return force_now_N() > 0.1; }))
      << "nothing is felt after a pause: " << seen();
  expect_rest_while_paused(read_trace(trace()));
  quit(player);
  EXPECT_TRUE(comes([&] { return !player.lives(); })) << "it does not quit";
  EXPECT_TRUE(comes([&] { return is_over(port); })) << "the motors are not at zero";
  std::printf("quit: the player's last force is %.2f N\n", last_force_N());
}

TEST_P(PlayerTest, IsAtRestAfterASignal) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const Hand hand(port);
  for (const int signal : {SIGTERM, SIGKILL}) {
    SCOPED_TRACE(strsignal(signal));
    ChildProcess player(felt_command(), environment());
    ASSERT_TRUE(comes([] { return force_now_N() > 0.1; })) << "nothing is felt: " << seen();
    player.end(signal);
    EXPECT_TRUE(comes([&] { return is_over(port); })) << "the motors are not at zero";
    std::printf("%s: the player's last force is %.2f N\n", strsignal(signal), last_force_N());
    std::remove(trace().c_str());
  }
}

TEST_P(PlayerTest, WithoutSpidarFeelNothingOfThisPluginIsThere) {
  plug(0, UsbKind::kSh4);
  const size_t opened = bus().files_opened;
  const ChildProcess player(command(), environment());
  // The decoder.
  ASSERT_TRUE(comes([] { return !processes_with("libgstvpx.so").empty(); })) << "it does not play";
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_TRUE(processes_with("libgstspidar.so").empty());
  EXPECT_EQ(bus().files_opened, opened);
}

INSTANTIATE_TEST_SUITE_P(Desktop, PlayerTest, testing::ValuesIn(kPlayers),
                         [](const auto& one) { return one.param.name; });

// What looks at films opens no device.
class LookerTest : public PlayerTest {};

const Player kLookers[] = {
    {"TotemVideoThumbnailer", {"totem-video-thumbnailer", "FILM", "PICTURE"}, "", "", ""},
    {"GstDiscoverer", {"gst-discoverer-1.0", "FILM"}, "", "", ""},
};

TEST_P(LookerTest, OpensNoDevice) {
  plug(0, UsbKind::kSh4);
  const size_t opened = bus().files_opened;
  ChildProcess looks(felt_command(), environment());
  EXPECT_EQ(looks.wait(), 0);
  EXPECT_EQ(bus().files_opened, opened);
  EXPECT_FALSE(std::filesystem::exists(trace()));
  if (GetParam().command.back() == "PICTURE") {
    EXPECT_GT(std::filesystem::file_size(picture()), 100u);
  }
}

INSTANTIATE_TEST_SUITE_P(Desktop, LookerTest, testing::ValuesIn(kLookers),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace spidar::test::players_test

static int run_tests(int argc, char** argv) {
  const spidar::test::SharedBus shared;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}

int main(int argc, char** argv) {
  return spidar::test::run_in_session(argc, argv, run_tests);
}
