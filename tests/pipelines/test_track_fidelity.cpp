// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Compares the strings of the simulated device during a recorded track with those during the
// analysis of the film. On a test clock; every tick is checked.
#include "plugin/tracks/open_track.h"
#include "plugin/tracks/track_elements.h"
#include "spidar/profiles/profile.h"
#include "tests/pipelines/stepped_pipeline.h"
#include "tests/pipelines/stepped_track.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::track_fidelity_test {
namespace {

/// Ticks of a playback by running time in microseconds.
using Ticks = std::map<int64_t, TickRecord>;

void keep(Ticks& ticks, const TickRecord& tick) {
  if (tick.playing) ticks[tick.running_ns / 1000] = tick;
}

struct Film {
  const char* name;
  int frames;
  int rate_Hz;
  const char* motion;  ///< of videotestsrc's ball

  std::string source() const {
    return "videotestsrc num-buffers=" + std::to_string(frames) + " pattern=ball motion=" + motion +
           " animation-mode=frames ! video/x-raw,format=GRAY8,width=320,height=240,framerate=" +
           std::to_string(rate_Hz) + "/1";
  }
  /// Running time of the motion of the last frame but one, half a frame before it is shown. What is
  /// felt from there on is the way to rest, which live depends on when the end of the stream
  /// becomes known.
  int64_t compared_us() const { return int64_t{500'000} * (2 * frames - 5) / rate_Hz; }
};

class TrackFidelity : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    init_gstreamer();
    GST_ELEMENT_REGISTER(spidarextract, nullptr);
  }

  /// The ticks of the film with these properties of spidarmotion.
  static Ticks play(const Film& film, const std::string& properties) {
    SteppedPipeline pipeline(film.source() + " ! spidarmotion name=motion " + properties +
                             " ! queue ! fakesink name=sink sync=true");
    pipeline.set_state(GST_STATE_PAUSED);
    pipeline.idle(kWarmUp_ms * GST_MSECOND);
    pipeline.set_state(GST_STATE_PLAYING);
    const bool analyses = properties.empty();
    Ticks ticks;
    for (int frame = 0; frame < film.frames; ++frame) {
      // The curve between two motions follows from the one before and the one after them, and
      // begins half a frame before the first of the two is shown.
      if (analyses) {
        pipeline.await_analysed(static_cast<size_t>(std::min(frame + 4, film.frames)));
      }
      keep(ticks, pipeline.step());
      if (frame + 1 == film.frames) break;
      const GstClockTime next = pipeline.await() - pipeline.now();
      for (GstClockTime ms = 1; ms * GST_MSECOND < next; ++ms) {
        keep(ticks, pipeline.idle(GST_MSECOND));
      }
    }
    return ticks;
  }

  static Ticks play(const Film& film, const std::vector<TrackSample>& samples) {
    SteppedTrack track;
    track.push(samples, 0);
    track.end();
    track.set_state(GST_STATE_PAUSED);
    track.run(kWarmUp_ms);
    track.set_state(GST_STATE_PLAYING);
    Ticks ticks;
    for (int64_t ms = 1; ms * 1000 < film.compared_us(); ++ms) keep(ticks, track.tick());
    return ticks;
  }

  std::string record(const Film& film) const {
    const std::string path = (folder.path / "film.haptic.wav").string();
    GError* error = nullptr;
    GstElement* pipeline =
        gst_parse_launch((film.source() +
                          " ! spidarmotion device=none attach-meta=true ! spidarextract name=x "
                          "x.wrench ! wavenc ! filesink location=\"" +
                          path + "\"")
                             .c_str(),
                         &error);
    EXPECT_EQ(error, nullptr) << error->message;
    GstBus* bus = gst_element_get_bus(pipeline);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    GstMessage* message = gst_bus_timed_pop_filtered(
        bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    EXPECT_EQ(GST_MESSAGE_TYPE(message), GST_MESSAGE_EOS);
    gst_message_unref(message);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(bus);
    gst_object_unref(pipeline);
    return path;
  }

  static std::vector<TrackSample> samples_of(const std::string& path) {
    std::vector<TrackSample> samples;
    const std::unique_ptr<tracks::OpenTrack> track = tracks::open_track(path);
    for (TrackBlock block; track->next(block);) {
      samples.insert(samples.end(), block.samples.begin(),
                     block.samples.begin() + static_cast<std::ptrdiff_t>(block.count));
    }
    return samples;
  }

  /// What the strings give to the grip differs in no tick by more than one step of each motor's
  /// D/A. `wanted` is what the wanted wrench may differ by, N and N m.
  static void expect_same(const Ticks& live, const Ticks& replayed, const Film& film,
                          double wanted) {
    const Profile profile = load_profile("spidar-gcc");
    StringVector step_N = StringVector::Zero();
    for (int i = 0; i < profile.geometry.count; ++i) {
      step_N[i] = profile.drives[static_cast<size_t>(i)].newtons_per_volt * profile.dac_max_V /
                  (std::ldexp(1.0, profile.dac_bits) - 1);
    }
    int compared = 0;
    double felt_N = 0;
    for (const auto& [us, tick] : replayed) {
      if (us >= film.compared_us() || live.count(us) == 0) continue;
      const TickRecord& expected = live.at(us);
      const StructureMatrix W = structure_matrix(profile.geometry, expected.pose);
      const Eigen::Matrix<double, 6, 1> step = W.cwiseAbs() * step_N;
      const auto difference =
          (tick.delivered.stacked() - expected.delivered.stacked()).cwiseAbs().eval();
      ASSERT_LE((tick.wanted.stacked() - expected.wanted.stacked()).norm(), wanted) << us << " us";
      ASSERT_TRUE((difference.array() <= step.array()).all())
          << us << " us: " << difference.transpose() << " of " << step.transpose();
      felt_N = std::max(felt_N, expected.delivered.force_N.norm());
      ++compared;
    }
    EXPECT_GT(compared, 0.99e-3 * static_cast<double>(film.compared_us()));
    EXPECT_GT(felt_N, 0.5) << "there is something to compare";
  }

  static constexpr int kWarmUp_ms = 200;
  TemporaryFolder folder;
};

TEST_F(TrackFidelity, AReplayedTrackIsFeltAsTheFilmIsLive) {
  // Ticks are at the times of samples: floats are all that is between them.
  const double rounding = 10 * std::ldexp(1.0, -23);
  for (const Film& film : {Film{"wavy", 100, 25, "wavy"}, Film{"sweep", 200, 50, "sweep"}}) {
    SCOPED_TRACE(film.name);
    const std::string track = record(film);
    const Ticks live = play(film, "");
    {
      SCOPED_TRACE("track=");
      expect_same(live, play(film, "track=" + track), film, rounding);
    }
    SCOPED_TRACE("spidarsink");
    expect_same(live, play(film, samples_of(track)), film, rounding);
  }
}

TEST_F(TrackFidelity, HoldsForFramesBetweenMilliseconds) {
  // 41.67 ms: ticks are between samples. Of the cubic that live analysis follows the straight line
  // differs by h²/8 · |f''|, and |f''| <= 6 · change / T² of a monotone one; a force changes
  // by 6 N (max-force twice) at most.
  const Film film{"wavy", 96, 24, "wavy"};
  const double period_s = 1.0 / film.rate_Hz;
  const double straight = 1e-6 / 8 * 6 * 6 / (period_s * period_s);
  const std::string track = record(film);
  expect_same(play(film, ""), play(film, "track=" + track), film, straight);
}

}  // namespace
}  // namespace spidar::test::track_fidelity_test
