// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidar-feel with players that are separate programs, and an SH4 board on an emulated USB.
#include <csignal>
#include <string>
#include <tuple>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/pipelines/feel_fixture.h"
#include "tests/support/child_process.h"

namespace spidar::test {
namespace {

TEST_F(Feel, APlayerIsFeltWhileItPlaysAndAtRestWhilePaused) {
  for (const char* playbin : {"playbin", "playbin3"}) expect_felt_and_at_rest(playbin, 40, 300);
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
      {"max-force=much -- true", 2,
       "max-force: \"much\" is not a number from 0 to 20. Largest force on the grip, in newtons"},
      {"max-force=1e9 -- true", 2, "max-force: \"1e9\" is not a number from 0 to 20"},
      {"max-force=nan -- true", 2, "max-force: \"nan\" is not a number from 0 to 20"},
      {"alpha=0 -- true", 2, "alpha: \"0\" is not a number from 1e-06 to 10"},
      {"ts-offset=late -- true", 2,
       "\"late\" is not a whole number from -10000000000 to 10000000000"},
      {"ts-offset=late -- true", 2, "in nanoseconds"},
      {"controller=wild -- true", 2,
       "controller: \"wild\" is not one of linear, nonlinear, adaptive\n"},
      {"mute=perhaps -- true", 2, "mute: \"perhaps\" is neither true nor false"},
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
  EXPECT_EQ(run_shell("GST_TRACERS=stats " + feel + " printenv GST_TRACERS 2>/dev/null").text,
            "stats;spidarfeel\n");
}

TEST_F(Feel, ADeviceThatCannotExistOrBeDrivenIsNamedBeforeThePlayerStarts) {
  const std::tuple<std::string, std::string> wrong[] = {
      {"device=zzz", "unknown device \"zzz\"; known are: sim, "},
      {"device=", "unknown device \"\""},
      {"device=sim:zzz", "unknown simulated board \"zzz\"; known are: sim:sh4, "},
      {"device=uart:,/dev/ttyUSB0 profile=spidar-g6x4", "a path is empty"},
      {"profile=nope", "unknown profile \"nope\"; known are spidar-g, "},
      {"profile=nope.toml", "nope.toml: cannot be read: No such file or directory"},
      {"device=none profile=nope", "unknown profile \"nope\""},
      // The board puts out positive volts only.
      {"device=usb", "usb: the motors get no force: no board is plugged in whose profile is"},
      {"device=usb profile=spidar-gcc", "usb: profile \"spidar-gcc\" wants negative volts"},
  };
  for (const auto& [properties, text] : wrong) {
    const CommandResult outcome =
        run(std::string(SPIDAR_FEEL) + " " + properties + " -- echo plays");
    EXPECT_EQ(outcome.status, 2) << properties << ": " << outcome.text;
    EXPECT_EQ(outcome.text.find("spidar-feel: "), 0u) << properties << ": " << outcome.text;
    EXPECT_NE(outcome.text.find(text), std::string::npos) << properties << ": " << outcome.text;
    EXPECT_EQ(outcome.text.find("plays"), std::string::npos) << properties << ": " << outcome.text;
  }
  // Whether these are plugged in is seen when the video plays.
  for (const std::string properties :
       {"device=usb:7 profile=spidar-g6c", "device=mouse:7",
        "device=uart:/dev/no-such-line profile=spidar-g6x4", "device=ff:/dev/no-such-joystick",
        "device=none", "device=usb profile=spidar-g6x3-v2-l", "device=zzz device=sim",
        "'device=\"sim\"'"})
    EXPECT_EQ(
        run_shell(std::string(SPIDAR_FEEL) + " " + properties + " -- echo plays 2>/dev/null").text,
        "plays\n")
        << properties;
}

TEST_F(Feel, APlayerThatShowsNoVideoByGStreamerIsNamed) {
  plug(0, UsbKind::kSh4);
  const std::string feel = std::string(SPIDAR_FEEL) + " device=usb profile=spidar-g6x3-v2-r -- ";
  // When it has ended.
  EXPECT_EQ(run(feel + "echo plays").text.find("plays\nspidar-feel: echo has shown no video"), 0u);
  // While it plays: the shell waits for the line, as long as the test may last.
  const std::string log = (folder->path / "log").string();
  const CommandResult outcome = run_shell(feel + "sh -c 'until grep -q \"no video\" " + log +
                                          "; do sleep 0.1; done' 2>" + log + "; cat " + log);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.text.find("spidar-feel: sh has shown no video"), std::string::npos)
      << outcome.text;
  // Not when it does, also from a process that it starts.
  for (const char* const begin : {"", "sh -c '\"$0\" \"$@\"; :' "}) {
    std::string line = feel + begin;
    for (const std::string& word : player({"play", "frames=10", "stop"})) line += " " + word;
    EXPECT_EQ(run(line).text, "");
  }
}

TEST_F(Feel, WithoutADeviceItSaysThatNothingRealMoves) {
  const std::string feel = SPIDAR_FEEL, line = "a simulated one takes the force";
  EXPECT_NE(run(feel + " true").text.find(line), std::string::npos);
  EXPECT_EQ(run(feel + " device=sim -- true").text.find(line), std::string::npos);
}

#ifdef EMULATED_BUS_LIBRARY

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

TEST_F(Feel, EveryFilmOfAGaplessListIsFeltToItsEnd) {
  for (const char* playbin : {"--use-playbin3", "--quiet"}) {
    SCOPED_TRACE(playbin);
    std::filesystem::remove(trace());
    // In the queue, the last second of a film waits while the next one arrives.
    const CommandResult outcome =
        run_all({SPIDAR_FEEL, "motion=mean", "haptic-trace=" + trace(), "--", "gst-play-1.0", "-q",
                 "--no-interactive", "--gapless", playbin, "--videosink=queue ! fakesink sync=true",
                 short_film, short_film});
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    constexpr int kFilm_ms = 2000;
    // The device opens when the first second has passed the element already.
    for (const int from_ms : {1200, kFilm_ms + 200, kFilm_ms + 1200}) {
      double felt_N = 0;
      for (const Tick& tick : read_trace(trace())) {
        const int64_t ms = tick.running_ns / 1'000'000;
        if (tick.playing && ms >= from_ms && ms < from_ms + 700)
          felt_N = std::max(felt_N, tick.force_N);
      }
      EXPECT_GT(felt_N, 0.1) << "from " << from_ms << " ms on";
    }
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
