// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarsink with tracks. On a test clock; every tick is checked.
#include "core/force/motion_rendering.h"
#include "plugin/films/stream_content.h"
#include "plugin/tracks/track_tags.h"
#include "tests/pipelines/stepped_track.h"
#include "tests/support/test.h"
#include "tests/support/wav_track.h"

namespace spidar::test::track_playback_test {
namespace {

/// One second in which sample n is sample_at(first + n · step).
std::vector<TrackSample> curve(double first = 0, double step = 1, int count = 1000) {
  std::vector<TrackSample> samples;
  for (int i = 0; i < count; ++i) samples.push_back(sample_at(first + step * i));
  return samples;
}

void expect_wanted(const TickRecord& tick, double ms, double tolerance) {
  EXPECT_TRUE(tick.found == Found::kExact || tick.found == Found::kInterpolated) << ms;
  const Wrench expected = to_wrench(sample_at(ms));
  EXPECT_LE((tick.wanted.stacked() - expected.stacked()).norm(), tolerance) << ms;
}

/// What a linear interpolation between samples `step_ms` apart is wrong by: h²/8 · |f''|, with
/// |f''| below 0.15 · 0.01² · 10 N · √(1 + 1/4 + 1/9).
double interpolation_error(double step_ms) {
  return step_ms * step_ms / 8 * 0.15 * 1e-4 * 10 * 1.2 + 1e-6;
}

/// A float as the format stores it, in the byte order of little-endian formats.
std::vector<guint8> encoded(float value, int bits, bool padded) {
  guint8 bytes[4];
  if (bits == 0) {
    GST_WRITE_FLOAT_LE(bytes, value);
  } else {
    GST_WRITE_UINT32_LE(
        bytes, static_cast<guint32>(static_cast<gint32>(std::lround(std::ldexp(value, bits - 1)))));
  }
  return {bytes, bytes + (padded ? 4 : bits / 8)};
}

/// Sample by sample, or channel by channel.
std::vector<guint8> stored(const std::vector<TrackSample>& samples, const std::string& format,
                           bool planar) {
  const int bits = format == "F32LE" ? 0 : std::stoi(format.substr(1));
  const bool padded = bits == 0 || format == "S24_32LE";
  std::vector<guint8> bytes;
  const size_t values = samples.size() * kTrackChannels;
  for (size_t i = 0; i < values; ++i) {
    const float value = planar ? samples[i % samples.size()][i / samples.size()]
                               : samples[i / kTrackChannels][i % kTrackChannels];
    for (const guint8 byte : encoded(value, bits, padded)) bytes.push_back(byte);
  }
  return bytes;
}

TEST(TrackPlayback, TakesEveryFormatMaskAndLayout) {
  for (const std::string format : {"F32LE", "S16LE", "S24LE", "S24_32LE", "S32LE"}) {
    for (const std::string rest :
         {"interleaved,channel-mask=(bitmask)0x0", "interleaved,channel-mask=(bitmask)0x3f",
          "non-interleaved,channel-mask=(bitmask)0x3f"}) {
      SCOPED_TRACE(format + " " + rest);
      SteppedTrack track("",
                         "audio/x-raw,rate=1000,channels=6,format=" + format + ",layout=" + rest);
      const std::vector<guint8> bytes = stored(curve(), format, rest[0] == 'n');
      track.push_bytes(bytes.data(), bytes.size(), 0, GST_SECOND);
      track.end();
      track.set_state(GST_STATE_PLAYING);
      // Half a step on each of six axes, of 10 N at most.
      const double half_step =
          format[0] == 'F' ? 0
                           : 10 * std::ldexp(0.5, 1 - std::stoi(format.substr(1))) * std::sqrt(6);
      for (int ms = 1; ms < 300; ++ms) expect_wanted(track.tick(), ms, half_step + 1e-6);
    }
  }
}

TEST(TrackPlayback, EachBlockHasAMessageAsAFrameHas) {
  for (const bool is_asked : {true, false}) {
    SteppedTrack track(is_asked ? "name=hand" : "name=hand post-messages=false");
    const std::vector<TrackSample> samples = curve();
    track.push(samples, 0);
    track.end();
    track.set_state(GST_STATE_PLAYING);
    track.run(400);
    const std::vector<MotionMessage> messages = track.motions();
    if (!is_asked) {
      EXPECT_TRUE(messages.empty());
      continue;
    }
    // Of 40 samples each; the sink hands them on before they are felt.
    ASSERT_GE(messages.size(), 10u);
    for (size_t i = 0; i < 10; ++i) {
      EXPECT_EQ(messages[i].running_time, i * 40 * GST_MSECOND);
      EXPECT_EQ(messages[i].stream_time, i * 40 * GST_MSECOND);
      EXPECT_EQ(messages[i].track, "hand") << "there is no file";
      EXPECT_EQ(messages[i].no_force, "none");
      double largest_N = 0;
      for (size_t k = 0; k < 40; ++k) {
        largest_N = std::max(largest_N, size_N(to_wrench(samples[40 * i + k])));
      }
      EXPECT_NEAR(size_N(messages[i].wrench), largest_N, 1e-6);
    }
  }
}

TEST(TrackPlayback, AMarkBeforeTheStartOfItsStreamCounts) {
  TrackMark mark;
  const auto follow = [&mark](GstEvent* event) {
    mark.update(event);
    gst_event_unref(event);
    return mark.is_set();
  };
  GstCaps* const caps = gst_caps_new_empty_simple("audio/x-raw");
  EXPECT_FALSE(follow(gst_event_new_stream_start("made up")));
  EXPECT_TRUE(follow(gst_event_new_tag(tracks::tags())));
  EXPECT_TRUE(follow(gst_event_new_stream_start("track"))) << "as after lost packets";
  EXPECT_TRUE(follow(gst_event_new_caps(caps)));
  EXPECT_FALSE(follow(gst_event_new_stream_start("sound")));
  gst_caps_unref(caps);
}

TEST(TrackPlayback, TakesEveryRate) {
  for (const int rate_Hz : {200, 441, 1000, 1500, 4000, 8000}) {
    SCOPED_TRACE(rate_Hz);
    SteppedTrack track("", "audio/x-raw,format=F32LE,layout=interleaved,channels=6,rate=" +
                               std::to_string(rate_Hz) + ",channel-mask=(bitmask)0x3f");
    const double step_ms = 1000.0 / rate_Hz;
    track.push(curve(0, step_ms, rate_Hz), 0, rate_Hz);
    track.end();
    track.set_state(GST_STATE_PLAYING);
    // The mean of a group spans as much of the curve again.
    const double group_ms = step_ms * std::ceil(rate_Hz / 1000.0);
    track.run(8);
    for (int ms = 9; ms < 900; ++ms) {
      expect_wanted(track.tick(), ms, 2 * interpolation_error(group_ms));
    }
  }
}

TEST(TrackPlayback, TakesBuffersOfAnySize) {
  for (const int size : {1, 24, 40, 2400}) {
    SCOPED_TRACE(size);
    SteppedTrack track;
    for (int at = 0; at < 2400; at += size) {
      track.push(curve(at, 1, size), static_cast<GstClockTime>(at) * GST_MSECOND);
    }
    track.end();
    track.set_state(GST_STATE_PLAYING);
    for (int ms = 1; ms < 2400; ++ms) expect_wanted(track.tick(), ms, 1e-6);
    EXPECT_EQ(track.run(51).commanded.stacked().norm(), 0) << "at rest after the end";
    EXPECT_TRUE(track.ended());
    EXPECT_EQ(track.stat("samples"), 2400u);
    EXPECT_EQ(track.stat("samples-refused"), 0u);
    EXPECT_TRUE(track.warnings().empty());
  }
}

TEST(TrackPlayback, ASeekIsExactToTheSampleAndForgetsWhatWasThere) {
  SteppedTrack track;
  track.push(curve(), 0);
  track.end();
  track.set_state(GST_STATE_PLAYING);
  track.run(100);
  track.seek(1, 4320 * GST_MSECOND);
  track.push(curve(4000), 4 * GST_SECOND);
  track.end();
  track.set_state(GST_STATE_PLAYING);
  track.tick();
  for (int ms = 2; ms < 600; ++ms) {
    const TickRecord tick = track.tick();
    EXPECT_EQ(tick.running_ns, ms * 1'000'000);
    expect_wanted(tick, 4320 + ms, 1e-6);
  }
}

TEST(TrackPlayback, AnotherRateChangesTheTimeAndNotTheAmplitude) {
  for (const double rate : {0.5, 2.0}) {
    SCOPED_TRACE(rate);
    SteppedTrack track;
    track.push(curve(), 0);
    track.end();
    track.set_state(GST_STATE_PAUSED);
    track.seek(rate, 0);
    track.push(curve(), 0);
    track.end();
    track.set_state(GST_STATE_PLAYING);
    track.tick();
    for (int ms = 2; ms < 400; ++ms) expect_wanted(track.tick(), rate * ms, interpolation_error(1));
  }
}

TEST(TrackPlayback, ALoopWithoutAFlushIsFeltWithoutAGap) {
  // What a seek with GST_SEEK_FLAG_SEGMENT gives: the same samples again, in a segment whose
  // running time begins where the one before ended.
  constexpr int kRound_ms = 629;   // of the curve; its end meets its beginning
  constexpr int kFadeIn_ms = 300;  // the device energises its strings and is trusted
  SteppedTrack track;
  for (int round = 0; round < 3; ++round) {
    if (round > 0)
      track.continue_with(0, static_cast<GstClockTime>(round * kRound_ms) * GST_MSECOND);
    track.push(curve(0, 1, kRound_ms), 0);
  }
  track.end();
  track.set_state(GST_STATE_PLAYING);
  for (int ms = 1; ms < 3 * kRound_ms; ++ms) {
    const TickRecord tick = track.tick();
    expect_wanted(tick, ms % kRound_ms, 1e-6);
    EXPECT_TRUE(ms < kFadeIn_ms || tick.commanded.stacked() == tick.wanted.stacked()) << ms;
  }
  EXPECT_EQ(track.run(51).commanded.stacked().norm(), 0);
}

TEST(TrackPlayback, ASeekWhilePausedIsFeltWhenItPlaysAgainAlsoBackwards) {
  SteppedTrack track;
  track.push(curve(), 0);
  track.end();
  track.set_state(GST_STATE_PLAYING);
  track.run(100);
  track.set_state(GST_STATE_PAUSED);
  track.run(60);
  track.seek(-1, 0, GST_SECOND);
  for (int at = 960; at >= 0; at -= 40) {
    track.push(curve(at, 1, 40), static_cast<GstClockTime>(at) * GST_MSECOND);
  }
  track.end();
  track.set_state(GST_STATE_PAUSED);
  EXPECT_EQ(track.run(100).commanded.stacked().norm(), 0);
  track.set_state(GST_STATE_PLAYING);
  track.tick();
  for (int ms = 2; ms < 900; ++ms) expect_wanted(track.tick(), 1000 - ms, 1e-6);
}

TEST(TrackPlayback, GainMuteAndOffset) {
  SteppedTrack track("gain=0.5 ts-offset=100000000");
  for (int second = 0; second < 3; ++second) {
    track.push(curve(1000.0 * second), static_cast<GstClockTime>(second) * GST_SECOND);
  }
  track.end();
  track.set_state(GST_STATE_PLAYING);
  track.run(200);
  const Wrench expected = 0.5 * to_wrench(sample_at(101));
  EXPECT_LE((track.tick().wanted.stacked() - expected.stacked()).norm(), 1e-6);
  g_object_set(track.sink(), "mute", TRUE, nullptr);
  EXPECT_EQ(track.run(50).commanded.stacked().norm(), 0);
  EXPECT_EQ(track.run(300).commanded.stacked().norm(), 0);
  g_object_set(track.sink(), "mute", FALSE, nullptr);
  const TickRecord tick = track.run(300);
  EXPECT_EQ(tick.found, Found::kExact) << "0.2 s later it is there again";
  EXPECT_EQ(tick.running_ns, (201 + 350 + 300 - 100) * GST_MSECOND);
}

}  // namespace
}  // namespace spidar::test::track_playback_test
