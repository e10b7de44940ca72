// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Invalid and faulty haptic tracks, in spidarmotion track= and in spidarsink: the messages, with a
// check of every tick. In real time, with the plugin as GStreamer loads it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <sys/stat.h>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "tests/pipelines/launched.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::bad_tracks_test {
namespace {

constexpr int kFrames = 25;  // 1 s

struct Case {
  const char* name;
  size_t channels;
  int rate_Hz;
  const char* mask;
  const char* said;
};

class BadTracks : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }

  /// Frames of `channels` floats, which a parser takes for a track or for something else.
  std::string raw(const std::vector<float>& values, int channels, int rate_Hz,
                  const std::string& mask) const {
    const std::string file = path("raw");
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
    return "filesrc location=" + file +
           " ! rawaudioparse use-sink-caps=false format=pcm pcm-format=f32le sample-rate=" +
           std::to_string(rate_Hz) + " num-channels=" + std::to_string(channels) +
           " ! capssetter caps=\"audio/x-raw,channel-mask=(bitmask)" + mask + "\" ! ";
  }
  /// One second of a track that pushes to the right.
  static std::vector<float> second(size_t channels = kTrackChannels) {
    std::vector<float> values(1000 * channels);
    for (size_t i = 0; i < 1000; ++i) {
      values[i * channels] = 0.1F * std::sin(0.01F * static_cast<float>(i));
    }
    return values;
  }
  std::string write(const std::string& source, const std::string& encoder,
                    const std::string& name) const {
    const Outcome outcome = launch(source + encoder + " ! filesink location=" + path(name));
    EXPECT_TRUE(outcome.eos) << outcome.error;
    return path(name);
  }
  /// WAVE_FORMAT_EXTENSIBLE, with a mask as Windows counts: 0x60f is 0xc0f of GStreamer. wavenc
  /// keeps no mask.
  std::string write_masked_wav(const std::vector<float>& values, uint32_t mask) const {
    std::string wav = "RIFF....WAVEfmt ";
    const auto put = [&wav](uint32_t value, int bytes) {
      for (int i = 0; i < bytes; ++i) wav += static_cast<char>(value >> (8 * i) & 0xff);
    };
    put(40, 4);
    put(0xfffe, 2);
    put(kTrackChannels, 2);
    put(1000, 4);
    put(24000, 4);
    put(24, 2);
    put(32, 2);
    put(22, 2);
    put(32, 2);
    put(mask, 4);
    put(3, 4);  // floats
    wav += std::string("\x00\x00\x10\x00\x80\x00\x00\xaa\x00\x38\x9b\x71", 12);
    wav += "data";
    put(static_cast<uint32_t>(values.size() * sizeof(float)), 4);
    wav.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    std::ofstream(path("masked.wav"), std::ios::binary) << wav;
    return path("masked.wav");
  }
  std::string write(const Case& bad) const {
    if (std::string(bad.mask) == "0xc0f") return write_masked_wav(second(), 0x60f);
    return write(raw(second(bad.channels), static_cast<int>(bad.channels), bad.rate_Hz, bad.mask),
                 "wavenc", "bad.wav");
  }
  /// A film of a second with this track.
  static Outcome play(const std::string& track) {
    return launch("videotestsrc pattern=ball num-buffers=" + std::to_string(kFrames) +
                  " ! video/x-raw,width=320,height=240,framerate=25/1 ! spidarmotion track=" +
                  track + " ! queue ! fakesink sync=true");
  }
  static void expect_said(const Outcome& outcome, const std::string& word) {
    ASSERT_FALSE(outcome.warnings.empty());
    EXPECT_NE(outcome.warnings[0].find(word), std::string::npos)
        << "\"" << word << "\" is not in: " << outcome.warnings[0];
  }

  TemporaryFolder folder;
};

constexpr Case kCases[] = {
    {"5 channels", 5, 1000, "0x37", "5 channels"},
    {"8 channels", 8, 1000, "0xc3f", "8 channels"},
    {"too fast", 6, 48000, "0x3f", "not 48000"},
    {"too slow", 6, 96, "0x3f", "not 96"},
    {"channels moved", 6, 1000, "0xc0f", "channel-mask 0xc0f"},
};

TEST_F(BadTracks, ForAFilmTheyAreNamedAndTheFilmIsAnalysed) {
  for (const Case& bad : kCases) {
    SCOPED_TRACE(bad.name);
    const Outcome outcome = play(write(bad));
    EXPECT_TRUE(outcome.eos) << outcome.error;
    expect_said(outcome, bad.said);
    EXPECT_EQ(outcome.motions, kFrames) << "analysed";
  }
}

TEST_F(BadTracks, InTheSinkTheyAreAnErrorThatSaysWhatIsWrong) {
  for (const Case& bad : kCases) {
    SCOPED_TRACE(bad.name);
    const Outcome outcome = launch("filesrc location=" + write(bad) + " ! wavparse ! spidarsink");
    EXPECT_FALSE(outcome.eos);
    EXPECT_NE(outcome.error.find(bad.said), std::string::npos) << outcome.error;
  }
}

TEST_F(BadTracks, TheSinkHasOnlyCapsInItsTemplateThatItAccepts) {
  GstElementFactory* factory = gst_element_factory_find("spidarsink");
  const GList* templates = gst_element_factory_get_static_pad_templates(factory);
  ASSERT_EQ(g_list_length(const_cast<GList*>(templates)), 1u);
  GstCaps* accepted =
      gst_static_pad_template_get_caps(static_cast<GstStaticPadTemplate*>(templates->data));
  const auto is_accepted = [accepted](size_t channels, int rate_Hz, const std::string& mask) {
    GstCaps* sound = gst_caps_from_string(
        ("audio/x-raw,format=F32LE,layout=interleaved,rate=" + std::to_string(rate_Hz) +
         ",channels=" + std::to_string(channels) + ",channel-mask=(bitmask)" + mask)
            .c_str());
    const bool accepts = gst_caps_can_intersect(accepted, sound) != FALSE;
    gst_caps_unref(sound);
    return accepts;
  };
  for (const Case& bad : kCases) {
    EXPECT_FALSE(is_accepted(bad.channels, bad.rate_Hz, bad.mask)) << bad.name;
  }
  for (const int rate_Hz : {200, 1000, 8000}) {
    EXPECT_TRUE(is_accepted(kTrackChannels, rate_Hz, "0x0")) << rate_Hz;
    EXPECT_TRUE(is_accepted(kTrackChannels, rate_Hz, "0x3f")) << rate_Hz;
  }
  gst_caps_unref(accepted);
  gst_object_unref(factory);
}

/// What is logged, as "category: text".
std::vector<std::string> logged;

void collect(GstDebugCategory* category, GstDebugLevel, const gchar*, const gchar*, gint, GObject*,
             GstDebugMessage* message, gpointer) {
  logged.push_back(std::string(gst_debug_category_get_name(category)) + ": " +
                   gst_debug_message_get(message));
}

TEST_F(BadTracks, MessagesAreLoggedUnderTheNameOfTheElement) {
  for (const std::string element : {"spidarsink", "spidarmotion"}) {
    for (const auto& [property, said] :
         {std::pair{"device=no-such-device", ": error: unknown device"},
          {"haptic-trace=/dev/full", ": warning: The haptic trace can no longer be written"}}) {
      SCOPED_TRACE(element + " " + property);
      GstElement* opened = gst_parse_launch((element + " " + property).c_str(), nullptr);
      logged.clear();
      gst_debug_set_default_threshold(GST_LEVEL_WARNING);
      gst_debug_add_log_function(collect, nullptr, nullptr);
      gst_element_set_state(opened, GST_STATE_PAUSED);
      gst_element_set_state(opened, GST_STATE_NULL);
      gst_debug_remove_log_function(collect);
      gst_debug_set_default_threshold(GST_LEVEL_NONE);
      gst_object_unref(opened);
      EXPECT_TRUE(std::any_of(logged.begin(), logged.end(),
                              [&, begin = element + said](const std::string& line) {
                                return line.rfind(begin, 0) == 0;
                              }));
    }
  }
}

TEST_F(BadTracks, SamplesThatAreNoNumbersAreRestAndHugeOnesLimited) {
  std::vector<float> values = second();
  values[200 * kTrackChannels] = std::numeric_limits<float>::quiet_NaN();
  values[300 * kTrackChannels + 5] = -std::numeric_limits<float>::infinity();
  for (size_t i = 400; i < 500; ++i) values[i * kTrackChannels + 1] = 1e30F;
  const std::string source = raw(values, kTrackChannels, 1000, "0x3f");
  const Outcome film = play(write(source, "wavenc", "bad.wav"));
  EXPECT_TRUE(film.eos) << film.error;
  ASSERT_EQ(film.warnings.size(), 2u);
  EXPECT_NE(film.warnings[0].find("2 samples that are not numbers"), std::string::npos);
  EXPECT_NE(film.warnings[1].find("100 samples beyond full scale"), std::string::npos);
  const Outcome sink = launch(source + "spidarsink");
  EXPECT_TRUE(sink.eos) << sink.error;
  EXPECT_EQ(sink.warnings.size(), 2u);
}

TEST_F(BadTracks, ATruncatedFlacIsNamedForAFilmAndGoesToRestInTheSink) {
  const std::string track =
      write(raw(second(), kTrackChannels, 1000, "0x3f"),
            "audioconvert dithering=none noise-shaping=none ! audio/x-raw,format=S24_32LE ! "
            "flacenc blocksize=40",
            "cut.flac");
  std::filesystem::resize_file(track, std::filesystem::file_size(track) * 2 / 3);
  const Outcome film = play(track);
  EXPECT_TRUE(film.eos) << film.error;
  expect_said(film, "it is cut off");
  EXPECT_EQ(film.motions, kFrames) << "analysed";
  // The watch looks for rest 50 ms after the last sample.
  const Outcome sink = launch("filesrc location=" + track + " ! flacparse ! flacdec ! spidarsink");
  EXPECT_TRUE(sink.eos || !sink.error.empty());
}

TEST_F(BadTracks, WhatMayNeverEndIsNotRead) {
  ASSERT_EQ(mkfifo(path("fifo.flac").c_str(), 0600), 0);
  const Outcome film = play(path("fifo.flac"));
  EXPECT_TRUE(film.eos) << film.error;
  expect_said(film, "not a regular file");
  EXPECT_EQ(film.motions, kFrames) << "analysed";
}

/// Reading would block for ever, and stopping with it.
TEST_F(BadTracks, AFifoBesideTheFilmIsNamedAndDelaysNothing) {
  launch("videotestsrc num-buffers=" + std::to_string(kFrames) +
         " ! video/x-raw,width=64,height=48,framerate=25/1 ! jpegenc ! avimux ! filesink "
         "location=" +
         path("film.avi"));
  ASSERT_EQ(mkfifo(path("film.avi.haptic.flac").c_str(), 0600), 0);
  const std::string line = "filesrc location=" + path("film.avi") +
                           " ! avidemux ! jpegdec ! videoconvert ! spidarmotion track=auto ! "
                           "fakesink sync=true";
  for (const GstState state : {GST_STATE_PAUSED, GST_STATE_PLAYING}) {
    GstElement* pipeline = gst_parse_launch(line.c_str(), nullptr);
    gst_element_set_state(pipeline, state);
    EXPECT_EQ(gst_element_set_state(pipeline, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    gst_object_unref(pipeline);
  }
  const Outcome film = launch(line);
  EXPECT_TRUE(film.eos) << film.error;
  expect_said(film, "not a regular file");
}

TEST_F(BadTracks, TheTrackOfAnotherFilmMayDifferByAFrameAndNoMore) {
  const auto lasting = [&](int samples) {
    std::vector<float> values = second();
    values.resize(static_cast<size_t>(samples) * kTrackChannels);
    return write(raw(values, kTrackChannels, 1000, "0x3f"), "wavenc",
                 std::to_string(samples) + ".wav");
  };
  for (const int samples : {960, 1000, 1040}) {
    SCOPED_TRACE(samples);
    const Outcome outcome = play(lasting(samples));
    EXPECT_TRUE(outcome.warnings.empty());
    EXPECT_EQ(outcome.motions, 0) << "not analysed";
  }
  for (const int samples : {940, 1060}) {
    SCOPED_TRACE(samples);
    const Outcome outcome = play(lasting(samples));
    expect_said(outcome, "the film 1.000 s");
    EXPECT_EQ(outcome.motions, kFrames) << "analysed";
  }
}

}  // namespace
}  // namespace spidar::test::bad_tracks_test
