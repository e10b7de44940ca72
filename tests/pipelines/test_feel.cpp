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
  UsbPort& port = plug(0, UsbKind::kSh4);
  for (const std::string playbin : {"playbin", "playbin3"}) {
    SCOPED_TRACE(playbin);
    const CommandResult outcome =
        run_all(felt_player({"play", "frames=40", "pause", "wait=300", "stop"}, playbin));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(outcome.text, "");
    EXPECT_TRUE(port.at_rest());
    expect_felt_until_paused();
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
