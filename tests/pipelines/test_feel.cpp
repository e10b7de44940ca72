// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidar-feel with players that are separate programs, and an SH4 board on an emulated USB.
#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/felt_ticks.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test {
namespace {

/// Waits without a limit; the test has one.
template <typename Condition>
void wait_for(const Condition& condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

class Feel : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    film = make_film("film.avi", 1500);  // a minute
    short_film = make_film("short.avi", 50);
  }
  static void TearDownTestSuite() { folder.reset(); }

  /// A picture that moves as a whole, 25 frames/s.
  static std::string make_film(const char* name, int frames) {
    const std::string path = (folder->path / name).string();
    const CommandResult made =
        run("gst-launch-1.0 -q videotestsrc pattern=smpte horizontal-speed=2 num-buffers=" +
            std::to_string(frames) +
            " ! video/x-raw,width=160,height=120,framerate=25/1 ! jpegenc ! avimux ! filesink "
            "location=" +
            path);
    EXPECT_EQ(made.status, 0) << made.text;
    return path;
  }

  Feel() { clear_bus(); }
  ~Feel() override { clear_bus(); }

  /// How often a device was opened since the test began.
  size_t opened() const { return bus().files_opened - opened_before_; }

  std::string trace() const { return (folder->path / "trace.csv").string(); }

  /// Sets up the SH4 board and a trace, before the player starts.
  std::vector<std::string> felt() const {
    return {SPIDAR_FEEL, "device=usb", "motion=mean", "haptic-trace=" + trace(), "--"};
  }
  static std::vector<std::string> player(const std::vector<std::string>& steps,
                                         const std::string& playbin = "playbin") {
    std::vector<std::string> arguments{FEEL_PLAYER, playbin, film};
    arguments.insert(arguments.end(), steps.begin(), steps.end());
    return arguments;
  }
  static std::vector<std::string> joined(std::vector<std::string> a,
                                         const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
  std::vector<std::string> felt_player(const std::vector<std::string>& steps,
                                       const std::string& playbin = "playbin") const {
    return joined(felt(), player(steps, playbin));
  }
  static CommandResult run_all(const std::vector<std::string>& arguments) {
    std::string command;
    for (const std::string& argument : arguments) command += "'" + argument + "' ";
    return run(command);
  }

  static std::unique_ptr<TemporaryFolder> folder;
  static std::string film, short_film;

 private:
  const size_t opened_before_ = bus().files_opened;
};
std::unique_ptr<TemporaryFolder> Feel::folder;
std::string Feel::film, Feel::short_film;

TEST_F(Feel, APlayerIsFeltWhileItPlaysAndAtRestWhilePaused) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  for (const std::string playbin : {"playbin", "playbin3"}) {
    SCOPED_TRACE(playbin);
    const CommandResult outcome =
        run_all(felt_player({"play", "frames=40", "pause", "wait=300", "stop"}, playbin));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(outcome.text, "");
    EXPECT_TRUE(port.at_rest());
    const std::vector<Tick> ticks = read_trace(trace());
    EXPECT_GT(largest_N(ticks), 0.1);
    int64_t played_ns = 0;
    int rested = 0;
    for (const Tick& tick : ticks) {
      if (tick.playing) played_ns = tick.monotonic_ns;
      if (tick.monotonic_ns - played_ns < 60'000'000) continue;
      EXPECT_EQ(tick.force_N, 0) << tick.monotonic_ns - played_ns << " ns after it was paused";
      ++rested;
    }
    EXPECT_GT(rested, 0);
  }
}

TEST_F(Feel, TheDeviceIsAtRestHoweverThePlayerEnds) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  for (const std::string end : {"stop", "exit"}) {
    const CommandResult outcome = run_all(felt_player({"play", "frames=30", end}));
    EXPECT_EQ(outcome.status, 0) << end << ": " << outcome.text;
    EXPECT_GT(port.updates, 0u) << end;
    wait_for([&] { return port.at_rest(); });
    port.updates = 0;
  }
  for (const int signal : {SIGTERM, SIGINT, SIGKILL}) {
    ChildProcess child(felt_player({"play", "stay"}));
    wait_for([&] { return !port.at_rest() || !child.lives(); });
    ASSERT_TRUE(child.lives());
    child.end(signal);
    wait_for([&] { return port.at_rest(); });
  }
}

TEST_F(Feel, TheNextFilmIsFeltToo) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const CommandResult outcome = run_all(
      felt_player({"play", "frames=10", "stop", "preroll", "wait=20", "play", "frames=40"}));
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_EQ(opened(), 2u);
  EXPECT_GT(largest_N(read_trace(trace())), 0.1);
  EXPECT_TRUE(port.at_rest());
}

TEST_F(Feel, AFilmOfTenBitsWithFullColourIsConvertedForTheScreen) {
  const std::string deep = (folder->path / "deep.webm").string();
  CommandResult outcome =
      run("gst-launch-1.0 -q videotestsrc pattern=smpte horizontal-speed=2 num-buffers=50 ! "
          "video/x-raw,format=Y444_10LE,width=160,height=120,framerate=25/1 ! "
          "vp9enc deadline=1 cpu-used=8 ! webmmux ! filesink location=" +
          deep);
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  // It is what its name says.
  outcome = run("gst-launch-1.0 -q filesrc location=" + deep +
                " ! matroskademux ! vp9dec ! video/x-raw,format=Y444_10LE ! fakesink");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  UsbPort& port = plug(0, UsbKind::kSh4);
  for (const std::string playbin : {"playbin", "playbin3"}) {
    SCOPED_TRACE(playbin);
    const std::vector<std::string> play{FEEL_PLAYER, playbin,     deep,  "window",
                                        "play",      "frames=30", "stop"};
    // Nothing else converts.
    EXPECT_NE(run_all(joined({"timeout", "20"}, play)).status, 0);
    outcome = run_all(joined(felt(), play));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(outcome.text, "");
    EXPECT_GT(largest_N(read_trace(trace())), 0.1);
    EXPECT_TRUE(port.at_rest());
  }
}

TEST_F(Feel, InspectingAFilmOpensNoDevice) {
  plug(0, UsbKind::kSh4);
  // As a thumbnailer does.
  CommandResult outcome = run_all(felt_player({"preroll", "wait=100", "loaded"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text, "loaded\n");
  outcome = run_all(felt_player({"own-filter", "play", "frames=30"}));
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  outcome = run_all(felt_player({"own-sink", "play", "wait=500"}));
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_EQ(opened(), 0u);
}

TEST_F(Feel, OfTwoPlayersInAProcessTheFirstHasTheDevice) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const CommandResult outcome =
      run_all(felt_player({"play", "frames=30", "other", "play", "frames=60", "stop"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text, "");
  EXPECT_EQ(opened(), 1u);
  EXPECT_TRUE(port.at_rest());
}

TEST_F(Feel, ADeviceThatCannotBeOpenedStopsNoVideo) {
  const CommandResult outcome = run_all(felt_player({"play", "frames=30", "stop"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text.find("spidar-feel: "), 0u) << outcome.text;
  EXPECT_NE(outcome.text.find("usb"), std::string::npos) << outcome.text;
}

TEST_F(Feel, WhatADeviceCannotRenderIsPrinted) {
  plug_evdev(0, EvdevKind::kPad);
  const CommandResult outcome =
      run_all(joined({SPIDAR_FEEL, "device=ff", "--"}, player({"play", "frames=10", "stop"})));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text,
            "spidar-feel: Emulated Pad, rumble only: the strength of the force is felt, not its "
            "direction.\n");
}

TEST_F(Feel, WithoutItThePluginIsNotLoaded) {
  plug(0, UsbKind::kSh4);
  const CommandResult outcome = run_all(player({"play", "frames=30", "loaded"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text, "not loaded\n");
  EXPECT_EQ(opened(), 0u);
}

TEST_F(Feel, WrongUsageIsNamed) {
  const std::string feel = SPIDAR_FEEL;
  const std::tuple<std::string, int, std::string> cases[] = {
      {"", 2, "no PROGRAM given"},
      {"max-force=2", 2, "spidar-feel max-force=2 -- PROGRAM"},
      {"max-force=2 true", 2, "spidar-feel max-force=2 -- PROGRAM"},
      {"max-force=2 --", 2, "no PROGRAM given"},
      {"--dance", 2, "--dance is no option"},
      {"max-farce=2 -- true", 2, "spidarmotion has no property \"max-farce\""},
      {"stats=2 -- true", 2, "spidarmotion has no property \"stats\" that can be set"},
      {"max-force=much -- true", 2, "max-force: \"much\" is not among its values"},
      {"max-force=1e9 -- true", 2, "max-force: \"1e9\" is not among its values"},
      {"controller=wild -- true", 2, "controller: \"wild\" is not among its values"},
      {"no-such-program", 127, "no-such-program: No such file or directory"},
      {"/", 126, "/: Permission denied"},
      {"controller=linear max-force=2 -- true", 0, ""},
      {"true", 0, ""},
      {"--help", 0, "usage: spidar-feel"},
      {"--version", 0, "spidar-feel "},
  };
  for (const auto& [arguments, status, text] : cases) {
    const CommandResult outcome = run(feel + " " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments << ": " << outcome.text;
    EXPECT_NE(outcome.text.find(text), std::string::npos) << arguments << ": " << outcome.text;
  }
  EXPECT_EQ(run(feel + " device=none -- printenv SPIDAR_FEEL GST_TRACERS").text,
            "device=none\n\nspidarfeel\n");
  EXPECT_EQ(run("GST_TRACERS=stats " + feel + " printenv GST_TRACERS").text, "stats;spidarfeel\n");
}

#ifdef EMULATED_BUS_LIBRARY

/// Programs that are not built here see the bus through this library.
const std::vector<std::string> kOnTheBus{"LD_PRELOAD=" EMULATED_BUS_LIBRARY};

TEST_F(Feel, GstPlayIsFeltAndAtRestHoweverItEnds) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const std::vector<std::string> gst_play =
      joined(felt(), {"gst-play-1.0", "-q", "--no-interactive", "--videosink=fakesink sync=true",
                      "--audiosink=fakesink"});
  {
    ChildProcess child(joined(gst_play, {short_film}), kOnTheBus);
    EXPECT_EQ(child.wait(), 0);
    EXPECT_TRUE(port.at_rest());
    EXPECT_GT(largest_N(read_trace(trace())), 0.1);
  }
  for (const int signal : {SIGTERM, SIGINT}) {
    ChildProcess child(joined(gst_play, {film}), kOnTheBus);
    wait_for([&] { return !port.at_rest() || !child.lives(); });
    ASSERT_TRUE(child.lives());
    child.end(signal);
    wait_for([&] { return port.at_rest(); });
  }
}

TEST_F(Feel, GstDiscovererOpensNoDevice) {
  plug(0, UsbKind::kSh4);
  ChildProcess child(joined(felt(), {"gst-discoverer-1.0", film}), kOnTheBus);
  EXPECT_EQ(child.wait(), 0);
  EXPECT_EQ(opened(), 0u);
}

#endif

}  // namespace
}  // namespace spidar::test

int main(int argc, char** argv) {
  const spidar::test::SharedBus shared;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
