// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Common players and sources in real time. The tests do not depend on the speed of the machine:
// they check that frames arrive, that a force is felt, and every tick.
#include <memory>
#include <random>
#include <string>
#include <thread>

#include <gst/app/gstappsrc.h>
#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/bench/skew/sound_card.h"
#include "tests/pipelines/launched.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::players_test {
namespace {

/// A picture that goes to the left as a whole: JPEG leaves little of a ball to follow.
const std::string kPan =
    "videotestsrc pattern=smpte horizontal-speed=2 num-buffers=15 ! "
    "video/x-raw,width=160,height=120,framerate=30/1 ! jpegenc ";
const std::string kMotion = "spidarmotion motion=mean ";

class Players : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    gst_init(nullptr, nullptr);
    folder = std::make_unique<TemporaryFolder>();
    // Half a second with sound.
    film = (folder->path / "film.mkv").string();
    const Outcome written = launch(kPan + "! matroskamux name=m ! filesink location=" + film +
                                   " audiotestsrc num-buffers=22 ! audio/x-raw,rate=44100 ! "
                                   "m.");
    ASSERT_TRUE(written.eos) << written.error;
  }
  static void TearDownTestSuite() { folder.reset(); }

  static std::string uri(const std::string& file) {
    gchar* text = gst_filename_to_uri(file.c_str(), nullptr);
    std::string result = text;
    g_free(text);
    return result;
  }

  static void expect_felt(const Outcome& outcome, int frames) {
    EXPECT_EQ(outcome.error, "");
    EXPECT_TRUE(outcome.warnings.empty()) << outcome.warnings[0];
    EXPECT_EQ(outcome.motions, frames);
    EXPECT_GT(outcome.largest_force_N, 0.1);
  }

  static std::unique_ptr<TemporaryFolder> folder;
  static std::string film;
};
std::unique_ptr<TemporaryFolder> Players::folder;
std::string Players::film;

TEST_F(Players, AFilmByTheClockOfItsSound) {
  for (const char* name : {"playbin", "playbin3"}) {
    SCOPED_TRACE(name);
    GstElement* player = gst_element_factory_make(name, nullptr);
    GstElement* filter = gst_parse_launch(kMotion.c_str(), nullptr);
    GstElement* sink = gst_parse_launch("fakesink sync=true", nullptr);
    g_object_set(player, "uri", uri(film).c_str(), "video-filter", filter, "video-sink", sink,
                 "audio-sink", bench::make_sound_card(100e-6), nullptr);
    const Outcome outcome = run_to_end(player);
    EXPECT_EQ(outcome.clock, "GstAudioClock");
    expect_felt(outcome, 15);
  }
}

TEST_F(Players, Decodebin) {
  expect_felt(launch("filesrc location=" + film +
                     " ! decodebin name=d d. ! queue ! videoconvert ! " + kMotion +
                     "! fakesink "
                     "d. ! queue ! audioconvert ! fakesink"),
              15);
}

TEST_F(Players, ADecoderThatChangesItsSizeInMidPlay) {
  const auto part = [](int width, int height) {
    return "videotestsrc num-buffers=10 pattern=smpte horizontal-speed=2 ! video/x-raw,width=" +
           std::to_string(width) + ",height=" + std::to_string(height) + " ! jpegenc ! c. ";
  };
  const Outcome outcome =
      launch("concat name=c ! jpegdec ! queue ! " + kMotion + "! queue ! fakesink " +
             part(160, 120) + part(640, 360) + part(320, 240));
  EXPECT_TRUE(outcome.eos);
  expect_felt(outcome, 30);
}

TEST_F(Players, ALiveSourceThatStampsItsFramesAsACameraDoes) {
  expect_felt(launch("videotestsrc is-live=true do-timestamp=true pattern=ball ! "
                     "video/x-raw,width=160,height=120,framerate=60/1 ! queue ! videoconvert ! "
                     "spidarmotion ! fakesink sync=true",
                     12),
              12);
}

TEST_F(Players, Rtp) {
  GstElement* receiver = gst_parse_launch(
      "udpsrc name=source address=127.0.0.1 port=0 "
      "caps=\"application/x-rtp,media=video,clock-rate=90000,encoding-name=JPEG,payload=26\" ! "
      "rtpjitterbuffer latency=50 ! rtpjpegdepay ! jpegdec ! spidarmotion motion=mean ! fakesink "
      "sync=true",
      nullptr);
  GstElement* source = gst_bin_get_by_name(GST_BIN(receiver), "source");
  gst_element_set_state(source, GST_STATE_READY);
  int port = 0;
  g_object_get(source, "port", &port, nullptr);
  gst_object_unref(source);
  ASSERT_GT(port, 0);
  GstElement* sender =
      gst_parse_launch(("videotestsrc is-live=true pattern=ball ! "
                        "video/x-raw,format=I420,width=160,height=120,framerate=30/1 ! jpegenc ! "
                        "rtpjpegpay ! udpsink host=127.0.0.1 port=" +
                        std::to_string(port))
                           .c_str(),
                       nullptr);
  gst_element_set_state(sender, GST_STATE_PLAYING);
  expect_felt(run_to_end(receiver, 10), 10);
  gst_element_set_state(sender, GST_STATE_NULL);
  gst_object_unref(sender);
}

/// A camera of an application's: a bright square that moves to the right, 20 frames when asked.
class SquareCamera {
 public:
  static void set_up(GstElement*, GstElement* source, SquareCamera* self) {
    GstCaps* caps =
        gst_caps_from_string("video/x-raw,format=GRAY8,width=160,height=120,framerate=0/1");
    g_object_set(source, "caps", caps, "is-live", TRUE, "do-timestamp", TRUE, "format",
                 GST_FORMAT_TIME, nullptr);
    gst_caps_unref(caps);
    // Not before: what is pushed before PLAYING has a time stamp of a clock without a base time.
    g_signal_connect(source, "need-data", G_CALLBACK(push), self);
  }

 private:
  static void push(GstAppSrc* source, guint, SquareCamera* self) {
    constexpr gsize kWidth = 160, kHeight = 120;
    if (self->frames_ == 20) {
      gst_app_src_end_of_stream(source);
      return;
    }
    g_usleep(10 * 1000);
    GstBuffer* frame = gst_buffer_new_allocate(nullptr, kWidth * kHeight, nullptr);
    gst_buffer_memset(frame, 0, 16, kWidth * kHeight);
    for (gsize y = 40; y < 80; ++y) {
      gst_buffer_memset(frame, y * kWidth + 20 + 3 * self->frames_, 200, 40);
    }
    ++self->frames_;
    gst_app_src_push_buffer(source, frame);
  }

  gsize frames_ = 0;  // streaming thread
};

TEST_F(Players, UridecodebinWithALiveSource) {
  GstElement* pipeline = gst_parse_launch(
      "uridecodebin uri=appsrc:// name=d ! queue ! videoconvert ! spidarmotion ! fakesink "
      "sync=true",
      nullptr);
  GstElement* decoder = gst_bin_get_by_name(GST_BIN(pipeline), "d");
  SquareCamera camera;
  g_signal_connect(decoder, "source-setup", G_CALLBACK(SquareCamera::set_up), &camera);
  gst_object_unref(decoder);
  const Outcome outcome = run_to_end(pipeline);
  EXPECT_TRUE(outcome.eos);
  expect_felt(outcome, 20);
}

TEST_F(Players, StoppedByAnotherThreadAtAnyMoment) {
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", run " + std::to_string(n));
    GstElement* pipeline = gst_parse_launch(
        "videotestsrc pattern=ball ! video/x-raw,width=160,height=120 ! queue ! spidarmotion ! "
        "queue ! fakesink sync=true",
        nullptr);
    const Traces traces(pipeline);
    const gulong delay_us = random() % 30'000;
    std::thread other([&] {
      g_usleep(delay_us);
      gst_element_set_state(pipeline, GST_STATE_NULL);
    });
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    if (random() % 2 == 0) {
      gst_element_seek_simple(pipeline, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SECOND);
    }
    other.join();
    EXPECT_EQ(gst_element_set_state(pipeline, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    gst_object_unref(pipeline);
  }
}

}  // namespace
}  // namespace spidar::test::players_test
