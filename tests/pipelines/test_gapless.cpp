// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// One film after another without a gap: the second one arrives while frames of the first one are
// still waiting for the screen. On a test clock; every tick is checked.
#include "plugin/filter/motion_state.h"
#include "plugin/filter/spidar_motion.h"
#include "tests/pipelines/stepped_pipeline.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/wav_track.h"

namespace spidar::test::gapless_test {
namespace {

struct Film {
  int width, height;
  int frames_per_s;
  int frames;
  std::string picture;
  std::string track = {};

  int frame_ms() const { return 1000 / frames_per_s; }
  int duration_ms() const { return frames * frame_ms(); }
  std::string source() const {
    return "videotestsrc " + picture + " num-buffers=" + std::to_string(frames) +
           " ! video/x-raw,format=GRAY8,width=" + std::to_string(width) +
           ",height=" + std::to_string(height) + ",framerate=" + std::to_string(frames_per_s) +
           "/1 ";
  }
};

/// A source asks those behind it for memory when its caps are new, and a queue answers when it is
/// empty, which would be after the end of the first film.
void refuse_allocation(GstElement* element) {
  GstPad* pad = gst_element_get_static_pad(element, "src");
  const auto probe = [](GstPad*, GstPadProbeInfo* info, gpointer) {
    const bool asks = GST_QUERY_TYPE(GST_PAD_PROBE_INFO_QUERY(info)) == GST_QUERY_ALLOCATION;
    return asks ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
  };
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM, probe, nullptr, nullptr);
  gst_object_unref(pad);
}

/// What the property `track` is for the first stream, for the second one, …
void set_tracks(GstElement* element, std::vector<std::string>& tracks) {
  GstPad* pad = gst_element_get_static_pad(element, "sink");
  const auto probe = [](GstPad* sink_pad, GstPadProbeInfo* info, gpointer user) {
    auto& left = *static_cast<std::vector<std::string>*>(user);
    if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_STREAM_START) {
      GstElement* const motion = GST_PAD_PARENT(sink_pad);
      GST_OBJECT_LOCK(motion);
      gst_spidar_motion_state(GST_SPIDAR_MOTION(motion)).settings.track = left.at(0);
      GST_OBJECT_UNLOCK(motion);
      left.erase(left.begin());
    }
    return GST_PAD_PROBE_OK;
  };
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, probe, &tracks, nullptr);
  gst_object_unref(pad);
}

/// What is felt in every millisecond of `source`, from the first one on. All frames wait behind the
/// element before the first one is shown, as behind a player's queue.
std::vector<TickRecord> felt(const std::string& source, int duration_ms,
                             std::vector<std::string> tracks) {
  SteppedPipeline pipeline(source +
                           "! spidarmotion name=motion motion=mean ! queue max-size-buffers=0 "
                           "max-size-bytes=0 max-size-time=0 ! fakesink name=sink sync=true");
  refuse_allocation(pipeline.element());
  set_tracks(pipeline.element(), tracks);
  pipeline.set_state(GST_STATE_PAUSED);
  pipeline.await_end_of_stream();
  pipeline.set_state(GST_STATE_PLAYING);
  std::vector<TickRecord> ticks;
  for (int ms = 1; ms < duration_ms; ++ms) ticks.push_back(pipeline.idle(GST_MSECOND));
  return ticks;
}

std::vector<TickRecord> felt(const Film& film) {
  return felt(film.source(), film.duration_ms(), {film.track});
}

std::vector<TickRecord> felt(const Film& first, const Film& second) {
  return felt(first.source() + "! c. " + second.source() + "! c. concat name=c ",
              first.duration_ms() + second.duration_ms(), {first.track, second.track});
}

/// From `from_ms` to `to_ms` of a film, it is felt as when it is shown alone.
void expect_same(const std::vector<TickRecord>& both, const std::vector<TickRecord>& alone,
                 int shift_ms, int from_ms, int to_ms) {
  double largest_N = 0;
  for (int ms = std::max(from_ms, 1); ms <= to_ms; ++ms) {
    const TickRecord& one = alone[static_cast<size_t>(ms - 1)];
    const TickRecord& other = both[static_cast<size_t>(ms + shift_ms - 1)];
    ASSERT_EQ(one.running_ns, ms * kTick_ns);
    ASSERT_EQ(other.running_ns, (ms + shift_ms) * kTick_ns);
    // Velocities are quotients of differences of the same times: some roundings of numbers below 3.
    ASSERT_LE((one.wanted.stacked() - other.wanted.stacked()).norm(), 1e-12) << ms << " ms";
    largest_N = std::max(largest_N, one.wanted.force_N.norm());
  }
  EXPECT_GT(largest_N, 0.1);
}

/// Between the last frame of one film and the second frame of the next one, the curve of the force
/// depends on both films.
void expect_both_felt(const Film& first, const Film& second) {
  const std::vector<TickRecord> both = felt(first, second);
  {
    SCOPED_TRACE("first film");
    expect_same(both, felt(first), 0, 0, first.duration_ms() - first.frame_ms());
  }
  SCOPED_TRACE("second film");
  expect_same(both, felt(second), first.duration_ms(), second.frame_ms(),
              second.duration_ms() - second.frame_ms());
}

constexpr const char* kMovingBall = "pattern=ball";
constexpr const char* kMovingBars = "pattern=smpte horizontal-speed=-3";
const Film kBall{320, 240, 25, 50, kMovingBall};
const Film kBars{320, 240, 25, 50, kMovingBars};

TEST(Gapless, FilmsOfOneKind) {
  expect_both_felt(kBall, kBars);
}

TEST(Gapless, AnotherSizeAndFrameRate) {
  expect_both_felt({160, 120, 20, 30, kMovingBars}, kBall);
}

class GaplessTrack : public testing::Test {
 protected:
  GaplessTrack() {
    with_track.track = (folder.path / "film.wav").string();
    write_track(with_track.track, with_track.duration_ms());
  }

  const TemporaryFolder folder;
  Film with_track = kBall;
};

TEST_F(GaplessTrack, BothFilms) {
  expect_both_felt(with_track, with_track);
}

TEST_F(GaplessTrack, FirstFilmOnly) {
  expect_both_felt(with_track, kBars);
}

TEST_F(GaplessTrack, SecondFilmOnly) {
  expect_both_felt(kBars, with_track);
}

}  // namespace
}  // namespace spidar::test::gapless_test
