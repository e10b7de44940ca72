// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidar-feel with players that use decoders without playbin, and an SH4 board on an emulated USB.
#include <csignal>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/pipelines/feel_fixture.h"
#include "tests/support/child_process.h"

namespace spidar::test {
namespace {

class FeelDecoders : public Feel {
 protected:
  static void SetUpTestSuite() {
    Feel::SetUpTestSuite();
    very_short_film = make_film("very_short.avi", kFrames);
  }

  /// What a player shows by itself.
  std::string shown_alone() {
    const CommandResult outcome = run_all(player({"play", "end"}, "uridecodebin", very_short_film));
    EXPECT_EQ(outcome.text.find(std::to_string(kFrames) + " frames, "), 0u) << outcome.text;
    return outcome.text;
  }

  /// Its decoder lets the sink crop the frames.
  static std::string make_theora(const char* name) {
    return make_film(name, kFrames, "theoraenc ! oggmux");
  }
  /// The words of a line, of which none has spaces.
  static std::vector<std::string> words(const std::string& line) {
    std::istringstream text(line);
    return {std::istream_iterator<std::string>(text), {}};
  }

  static constexpr int kFrames = 15;
  inline static std::string very_short_film;
};

const std::vector<std::string> kDecoders{"uridecodebin", "uridecodebin3", "decodebin",
                                         "decodebin3"};

TEST_F(FeelDecoders, AreFeltWhileTheyPlayAndAtRestWhilePaused) {
  for (const std::string& decoder : kDecoders) expect_felt_and_at_rest(decoder, 15, 150);
}

TEST_F(FeelDecoders, AreFeltAgainAfterSeeksPausesAndStops) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  // After READY, decodebin3 of GStreamer 1.22 fails, without spidar-feel, too.
  for (const std::string decoder : {"uridecodebin", "uridecodebin3", "decodebin"}) {
    SCOPED_TRACE(decoder);
    for (const std::string end : {"pause", "ready"}) {
      SCOPED_TRACE(end);
      const size_t before = opened();
      const CommandResult outcome = run_all(felt_player(
          {"play", "frames=3", "seek", "frames=3", end, "play", "frames=3", "seek", "frames=10"},
          decoder));
      EXPECT_EQ(outcome.status, 0) << outcome.text;
      EXPECT_EQ(outcome.text, "");
      EXPECT_EQ(opened() - before, end == "pause" ? 1u : 2u);
      EXPECT_GT(largest_N(read_trace(trace())), 0.1);
      EXPECT_TRUE(port.at_rest());
    }
  }
}

TEST_F(FeelDecoders, AreFeltWhenTheirPadIsReplacedWhileTheyPlay) {
  const std::string chain = (folder->path / "chain.ogg").string();
  // Each with a serial number of its own.
  const std::string parts[] = {make_theora("first.ogg"), make_theora("second.ogg")};
  const CommandResult made = run("cat " + parts[0] + " " + parts[1] + " > " + chain);
  ASSERT_EQ(made.status, 0) << made.text;
  UsbPort& port = plug(0, UsbKind::kSh4);
  // The others do not play such a film, without spidar-feel, too.
  for (const std::string decoder : {"uridecodebin", "decodebin"}) {
    SCOPED_TRACE(decoder);
    const size_t before = opened();
    const CommandResult alone = run_all(player({"play", "end"}, decoder, chain));
    EXPECT_EQ(alone.text.find("30 frames, "), 0u) << alone.text;
    EXPECT_EQ(run_all(felt_player({"play", "end"}, decoder, chain)).text, alone.text);
    EXPECT_EQ(opened() - before, 2u);
    // The second part's decoder waits for its pad when the filter is to be put in.
    EXPECT_EQ(run_all(felt_player({"slow-pads", "play", "end"}, decoder, chain)).text, alone.text);
    // That of the second part; the first part's was replaced.
    EXPECT_GT(largest_N(read_trace(trace())), 0.1);
    EXPECT_TRUE(port.at_rest());
  }
}

TEST_F(FeelDecoders, NeedNotAllocateAnewDuringSeeks) {
  plug(0, UsbKind::kSh4);
  const std::string theora = make_theora("theora.ogg");
  for (const char* wait : {"wait=20", "wait=40", "wait=60", "wait=80"}) {
    SCOPED_TRACE(wait);
    const CommandResult outcome =
        run_all(felt_player({"play", wait, "seek", "seek", "seek", "end"}, "decodebin", theora));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
  }
}

TEST_F(FeelDecoders, ShowTheSameFrames) {
  plug(0, UsbKind::kSh4);
  const std::string alone = shown_alone();
  for (const std::string& decoder : kDecoders) {
    SCOPED_TRACE(decoder);
    EXPECT_EQ(run_all(felt_player({"play", "end"}, decoder, very_short_film)).text, alone);
    EXPECT_GT(largest_N(read_trace(trace())), 0.1);
  }
}

TEST_F(FeelDecoders, ShowTheSameFramesWhenTheFilterDoesNotFit) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const std::string alone = shown_alone();
  for (const std::string& decoder : kDecoders) {
    SCOPED_TRACE(decoder);
    const CommandResult refused =
        run_all(felt_player({"preroll", "refuse", "play", "end"}, decoder, very_short_film));
    EXPECT_EQ(refused.text,
              "spidar-feel: the video does not fit through the filter and is not felt\n" + alone);
    EXPECT_TRUE(port.at_rest());
  }
}

TEST_F(FeelDecoders, OpenNoDeviceForPlayersThatOnlyLookOrHaveTheirOwnMotion) {
  plug(0, UsbKind::kSh4);
  for (const std::string decoder : {"uridecodebin", "decodebin3"}) {
    SCOPED_TRACE(decoder);
    CommandResult outcome = run_all(felt_player({"preroll", "wait=100"}, decoder));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    outcome = run_all(felt_player({"own-sink", "play", "frames=10"}, decoder));
    EXPECT_EQ(outcome.status, 0) << outcome.text;
  }
  EXPECT_EQ(opened(), 0u);
}

TEST_F(FeelDecoders, OfTwoInAProcessTheFirstHasTheDevice) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const CommandResult outcome = run_all(
      felt_player({"play", "frames=10", "other", "play", "frames=20", "stop"}, "uridecodebin"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text, "");
  EXPECT_EQ(opened(), 1u);
  EXPECT_TRUE(port.at_rest());
}

TEST_F(FeelDecoders, PlayWithoutADeviceWhenNoneCanBeOpened) {
  const CommandResult outcome =
      run_all(felt_player({"play", "end"}, "uridecodebin", very_short_film));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text.find("spidar-feel: "), 0u) << outcome.text;
  EXPECT_NE(outcome.text.find("usb"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find(shown_alone()), std::string::npos) << outcome.text;
}

#ifdef EMULATED_BUS_LIBRARY

TEST_F(FeelDecoders, OfGstLaunchAreFelt) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const std::string uri = "uri=file://" + short_film;
  for (const std::string& source :
       {"uridecodebin " + uri, "uridecodebin3 " + uri,
        "filesrc location=" + short_film + " ! decodebin",
        "filesrc location=" + short_film + " ! decodebin3",
        // Its pad appears while the pipeline plays.
        std::string("videotestsrc is-live=true horizontal-speed=2 num-buffers=50 ! "
                    "video/x-raw,width=160,height=120,framerate=25/1 ! jpegenc ! decodebin")}) {
    SCOPED_TRACE(source);
    ChildProcess child(
        joined(felt(), words("gst-launch-1.0 -q " + source + " ! videoconvert ! fakevideosink")),
        kOnTheBus);
    EXPECT_EQ(child.wait(), 0);
    EXPECT_GT(largest_N(read_trace(trace())), 0.1);
    EXPECT_TRUE(port.at_rest());
  }
}

TEST_F(FeelDecoders, PlayWithoutForceWhenTheDecoderTakesTheFilterOutAgain) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  ChildProcess child(
      joined(felt(), words("gst-launch-1.0 -q videotestsrc num-buffers=15 ! video/x-raw,width=160,"
                           "height=120,framerate=25/1 ! decodebin3 ! fakevideosink")),
      kOnTheBus);
  EXPECT_EQ(child.wait(), 0);
  EXPECT_TRUE(port.at_rest());
}

TEST_F(FeelDecoders, OfGstLaunchAreAtRestWhenItIsInterrupted) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    ChildProcess child(joined(felt(), words("gst-launch-1.0 -q uridecodebin uri=file://" + film +
                                            " ! videoconvert ! fakevideosink")),
                       kOnTheBus);
    wait_for([&] { return !port.at_rest() || !child.lives(); });
    ASSERT_TRUE(child.lives());
    child.end(signal);
    wait_for([&] { return port.at_rest(); });
  }
}

TEST_F(FeelDecoders, OpenNoDeviceWhereNothingIsShown) {
  plug(0, UsbKind::kSh4);
  const std::string film_file = (folder->path / "other.webm").string();
  for (const std::string& sink : {"vp8enc deadline=1 ! webmmux ! filesink location=" + film_file,
                                  std::string("fakesink sync=true")}) {
    SCOPED_TRACE(sink);
    ChildProcess child(joined(felt(), words("gst-launch-1.0 -q uridecodebin uri=file://" +
                                            very_short_film + " ! videoconvert ! " + sink)),
                       kOnTheBus);
    EXPECT_EQ(child.wait(), 0);
  }
  EXPECT_EQ(opened(), 0u);
}

TEST_F(FeelDecoders, OfATimelineAreLeftAlone) {
  plug(0, UsbKind::kSh4);
  ChildProcess child(joined(felt(), {"/usr/bin/python3", FELT_TIMELINE, film}), kOnTheBus);
  const int status = child.wait();
  if (status == 77) GTEST_SKIP() << "GES is not installed: gir1.2-ges-1.0, python3-gi";
  EXPECT_EQ(status, 0);
  EXPECT_EQ(opened(), 0u);
}

#endif

}  // namespace
}  // namespace spidar::test
