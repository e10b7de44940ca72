// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Films, and players that are separate programs, with and without spidar-feel and an SH4 board on
/// an emulated USB.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"
#include "tests/support/felt_ticks.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test {

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
  static std::string make_film(const char* name, int frames,
                               const char* encoder = "jpegenc ! avimux") {
    const std::string path = (folder->path / name).string();
    const CommandResult made =
        run("gst-launch-1.0 -q videotestsrc pattern=smpte horizontal-speed=2 num-buffers=" +
            std::to_string(frames) + " ! video/x-raw,width=160,height=120,framerate=25/1 ! " +
            encoder + " ! filesink location=" + path);
    EXPECT_EQ(made.status, 0) << made.text;
    return path;
  }

  Feel() { clear_bus(); }
  ~Feel() override { clear_bus(); }

  /// How often a device was opened since the test began.
  size_t opened() const { return bus().files_opened - opened_before_; }

  std::string trace() const { return (folder->path / "trace.csv").string(); }

  /// Sets up the SH4 board and a new trace, before the player starts.
  std::vector<std::string> felt() const {
    std::filesystem::remove(trace());
    return {SPIDAR_FEEL,
            "device=usb",
            "profile=spidar-g6x3-v2-r",
            "motion=mean",
            "haptic-trace=" + trace(),
            "--"};
  }
  static std::vector<std::string> player(const std::vector<std::string>& steps,
                                         const std::string& playbin = "playbin",
                                         const std::string& shown = film) {
    std::vector<std::string> arguments{FEEL_PLAYER, playbin, shown};
    arguments.insert(arguments.end(), steps.begin(), steps.end());
    return arguments;
  }
  static std::vector<std::string> joined(std::vector<std::string> a,
                                         const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
  std::vector<std::string> felt_player(const std::vector<std::string>& steps,
                                       const std::string& playbin = "playbin",
                                       const std::string& shown = film) const {
    return joined(felt(), player(steps, playbin, shown));
  }
  /// Runs a command. A player that gets no processor time for 50 ms is set to rest by its guardian
  /// and opens the device once more: on a machine that is so busy, the command runs again, up to
  /// three times in all. opened() counts what the last of them has opened.
  CommandResult run_all(const std::vector<std::string>& arguments) {
    std::string command;
    for (const std::string& argument : arguments) command += "'" + argument + "' ";
    for (int runs = 1;; ++runs) {
      const size_t before = bus().files_opened;
      CommandResult outcome = run(command);
      if (runs == 3 || outcome.text.find("guardian") == std::string::npos) return outcome;
      std::cout << "This machine is busy, so this runs again: " << outcome.text;
      opened_before_ += bus().files_opened - before;
    }
  }

  /// According to the trace, the film was felt, and from 60 ms after each pause nothing was.
  void expect_felt_until_paused() const {
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

  /// Plays, pauses and stops: it is felt, at rest from 60 ms after the pause, and has nothing to
  /// say.
  void expect_felt_and_at_rest(const std::string& player, int frames, int pause_ms) {
    SCOPED_TRACE(player);
    const UsbPort& port = plug(0, UsbKind::kSh4);
    const CommandResult outcome =
        run_all(felt_player({"play", "frames=" + std::to_string(frames), "pause",
                             "wait=" + std::to_string(pause_ms), "stop"},
                            player));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(outcome.text, "");
    EXPECT_TRUE(port.at_rest());
    expect_felt_until_paused();
  }

  inline static std::unique_ptr<TemporaryFolder> folder;
  inline static std::string film, short_film;

 private:
  size_t opened_before_ = bus().files_opened;
};

#ifdef EMULATED_BUS_LIBRARY
/// Programs that are not built here see the bus through this library.
inline const std::vector<std::string> kOnTheBus{"LD_PRELOAD=" EMULATED_BUS_LIBRARY};
#endif

}  // namespace spidar::test
