// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarmotion with a track instead of its analysis. On a test clock; every tick is checked.
#include "tests/pipelines/stepped_pipeline.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/wav_track.h"

namespace spidar::test::track_replay_test {
namespace {

constexpr int kFrames = 100;  // 4 s
constexpr int kFrame_ms = 40;

class TrackReplay : public testing::Test {
 protected:
  /// A ball moves about, which is not to be felt. The source makes so many frames in all, -1 for
  /// ever, also those that a seek throws away: the queue holds few.
  void open(const std::string& track, int frames = kFrames) {
    pipeline = std::make_unique<SteppedPipeline>(
        "videotestsrc pattern=ball num-buffers=" + std::to_string(frames) +
        " ! video/x-raw,format=GRAY8,width=320,height=240,framerate=25/1 ! spidarmotion "
        "name=motion "
        "track=" +
        track + " ! queue max-size-buffers=2 ! fakesink name=sink sync=true");
  }
  std::string track_of(int samples) {
    const std::string path = (folder.path / "film.wav").string();
    write_track(path, samples);
    return path;
  }
  template <typename Value, typename Get>
  Value stat_of(Get get, const char* name) const {
    GstStructure* stats = nullptr;
    Value value{};
    g_object_get(pipeline->element(), "stats", &stats, nullptr);
    EXPECT_TRUE(get(stats, name, &value)) << name;
    gst_structure_free(stats);
    return value;
  }
  double number(const char* name) const { return stat_of<double>(gst_structure_get_double, name); }
  uint64_t stat(const char* name) const { return stat_of<guint64>(gst_structure_get_uint64, name); }
  std::string reason(const char* field = "no-force-reason") const {
    const auto copy = [](const GstStructure* stats, const char* name, std::string* text) {
      *text = gst_structure_get_string(stats, name);
      return true;
    };
    return stat_of<std::string>(copy, field);
  }
  void play(int frames) {
    for (int i = 0; i < frames; ++i) {
      pipeline->step();
      pipeline->idle((kFrame_ms - 1) * GST_MSECOND);
    }
  }
  /// Plays frames, and feels in each of their milliseconds what the track has there; stream time is
  /// `stream_ms` at running time 0.
  void expect_track(int frames, double stream_ms = 0, double rate = 1) {
    // Of what is interpolated between two samples a millisecond apart, h²/8 · |f''|, and of floats.
    const double tolerance = 0.15 * 1e-4 * 10 * 1.2 / 8 + 2e-6;
    for (int i = 0; i < frames; ++i) {
      expect_sample(pipeline->step(), stream_ms, rate, tolerance);
      for (int ms = 1; ms < static_cast<int>(kFrame_ms / std::fabs(rate)); ++ms) {
        expect_sample(pipeline->idle(GST_MSECOND), stream_ms, rate, tolerance);
      }
    }
  }
  void expect_sample(const TickRecord& tick, double stream_ms, double rate, double tolerance) {
    const double ms = 1e-6 * static_cast<double>(tick.running_ns);
    const Wrench expected = to_wrench(sample_at(stream_ms + rate * ms));
    EXPECT_TRUE(tick.found == Found::kExact || tick.found == Found::kInterpolated) << ms;
    EXPECT_LE((tick.wanted.stacked() - expected.stacked()).norm(), tolerance) << ms;
  }

  TemporaryFolder folder;
  std::unique_ptr<SteppedPipeline> pipeline;
};

TEST_F(TrackReplay, ASeekLeadsToTheSampleOfThatTime) {
  open(track_of(kFrames * kFrame_ms));
  pipeline->set_state(GST_STATE_PLAYING);
  expect_track(10);
  EXPECT_EQ(stat("frames"), 0u) << "nothing was analysed";
  EXPECT_GE(stat("track-frames"), 10u);
  pipeline->set_state(GST_STATE_PAUSED);
  pipeline->idle(GST_MSECOND);
  pipeline->seek(2 * GST_SECOND);
  pipeline->set_state(GST_STATE_PLAYING);
  expect_track(10, 2000);
}

/// As videorate does with frames that it shows again: two of three have no picture.
GstPadProbeReturn flag_gap(GstPad*, GstPadProbeInfo* info, void* count) {
  if ((*static_cast<int*>(count))++ % 3 == 0) return GST_PAD_PROBE_OK;
  GstBuffer* const buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
  GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_GAP);
  info->data = buffer;
  return GST_PAD_PROBE_OK;
}

TEST_F(TrackReplay, FramesWithoutAPicturePlayTheTrackToo) {
  open(track_of(kFrames * kFrame_ms));
  int count = 0;
  GstPad* const pad = gst_element_get_static_pad(pipeline->element(), "sink");
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, flag_gap, &count, nullptr);
  gst_object_unref(pad);
  pipeline->set_state(GST_STATE_PLAYING);
  expect_track(20);
  EXPECT_EQ(reason(), "none");
  pipeline.reset();  // before `count`
}

TEST_F(TrackReplay, AtAnotherRateTheAmplitudeStaysAndNothingLimitsIt) {
  for (const double rate : {0.5, 1.0, 2.0, -1.0}) {
    SCOPED_TRACE(rate);
    open(track_of(kFrames * kFrame_ms));
    pipeline->set_state(GST_STATE_PAUSED);
    pipeline->seek(rate, GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE, 0,
                   rate < 0 ? 2 * GST_SECOND : GST_CLOCK_TIME_NONE);
    pipeline->set_state(GST_STATE_PLAYING);
    if (rate > 0) {
      expect_track(20, 0, rate);
    } else {
      play(20);
    }
    EXPECT_EQ(reason(), "none");
  }
}

TEST_F(TrackReplay, WhereATrackIsSilentTheReasonSaysSo) {
  const std::string path = (folder.path / "film.wav").string();
  write_track(path, kFrames * kFrame_ms,
              [](double ms) { return ms < 400 ? sample_at(ms) : TrackSample{}; });
  open(path + " trace=" + (folder.path / "trace.csv").string());
  pipeline->set_state(GST_STATE_PLAYING);
  const auto play_again = [&](int frames) {
    pipeline->set_state(GST_STATE_PAUSED);
    pipeline->idle(GST_MSECOND);
    pipeline->seek(0);
    pipeline->set_state(GST_STATE_PLAYING);
    play(frames);
  };
  play(20);
  EXPECT_EQ(reason(), "none") << "felt 0.4 s ago";
  play(20);
  EXPECT_EQ(reason(), "silent-track");
  play_again(20);
  EXPECT_EQ(reason(), "none") << "after a seek";
  g_object_set(pipeline->element(), "max-force", 0.0, nullptr);
  play_again(8);
  EXPECT_EQ(reason(), "too-weak");
  pipeline->set_state(GST_STATE_NULL);
  std::ifstream trace(folder.path / "trace.csv");
  std::string header, row;
  std::getline(trace, header);
  std::getline(trace, row);
  std::getline(trace, row);
  EXPECT_EQ(row.rfind("40000000,40000000,0,0,0,0,", 0), 0u) << row;
  EXPECT_EQ(row.find(",0,0,0,0,0,0,"), std::string::npos) << "the wrench of the track: " << row;
}

TEST_F(TrackReplay, WhatIsMissingOrNoTrackIsNamedAndTheFilmAnalysed) {
  const std::string no_track = (folder.path / "text.wav").string();
  std::ofstream(no_track) << "no music";
  for (const std::string& path : {(folder.path / "none.flac").string(), no_track}) {
    open(path, -1);
    pipeline->set_state(GST_STATE_PLAYING);
    // On a loaded machine, frames may come before it is known that the file is no track.
    for (int i = 0; i < 5 || !pipeline->has_posted(GST_MESSAGE_WARNING); ++i) {
      if (i >= 5) g_usleep(50'000);
      pipeline->step();
    }
    EXPECT_GE(stat("frames"), 5u);
  }
}

// ±3 N and ±0.1 N m, which on the default profile's grip of 32.5 mm are another 3 N, turn over 25
// times a second.
TEST_F(TrackReplay, ATrackThatShakesIsLoweredAndSaysSo) {
  const std::string path = (folder.path / "film.wav").string();
  write_track(path, kFrames * kFrame_ms, [](double ms) {
    const float sign = std::fmod(ms, 80) < 40 ? 1 : -1;
    return TrackSample{3 * sign, 0, 0, 0, 0, 0.1F * sign};
  });
  open(path);
  pipeline->set_state(GST_STATE_PLAYING);
  play(10);
  EXPECT_LT(number("vibration-left"), 1);
  EXPECT_EQ(number("vibration-fraction"), 1);
  // As after some minutes: the store is empty.
  const int64_t now_ns = pipeline->loop().snapshot().last.monotonic_ns;
  pipeline->loop().vibration().restore(now_ns + 24 * 3600 * 1'000'000'000LL);
  play(30);
  const double left = number("vibration-left"), fraction = number("vibration-fraction");
  EXPECT_LT(fraction, 0.1);
  EXPECT_EQ(reason("device-no-force-reason"), "vibration");
  pipeline->await_message(GST_MESSAGE_WARNING);
  // Neither a seek nor a pause gives anything back, except what comes back with time.
  pipeline->set_state(GST_STATE_PAUSED);
  pipeline->idle(10 * GST_MSECOND);
  pipeline->seek(GST_SECOND);
  pipeline->set_state(GST_STATE_PLAYING);
  pipeline->step();
  EXPECT_LT(number("vibration-left"), left + 1e-4);
  EXPECT_LT(number("vibration-fraction"), 0.97);
}

}  // namespace
}  // namespace spidar::test::track_replay_test
