// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Films and cameras whose frames repeat pictures, in whole pipelines on a test clock: the force in
// each millisecond is that of the film without repeated frames, live, at other rates, after seeks
// and after frame steps. A picture that stays is at rest.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/pipelines/stepped_pipeline.h"
#include "tests/support/felt_film.h"
#include "tests/support/film_studio.h"

namespace spidar::test::repeated_frames_test {
namespace {

constexpr int kWidth = 480, kHeight = 272;
/// A rhythm is known by then.
constexpr int64_t kLearnt_ms = 700;
const double kDegree_rad = M_PI / 180;

/// Something that circles in front of a still background 0.4 times a second, as it is at `time_s`
/// or, after `stop_s`, then.
class Circling {
 public:
  explicit Circling(double stop_s = 1e9)
      : studio_(kWidth, kHeight, 1), film_(studio_.still_film()), stop_s_(stop_s) {
    film_.objects = {studio_.object(0.08, [](double n) {
      const double angle = 360 * kDegree_rad * 0.4 * n / kTimes_Hz;
      return Eigen::Affine2d(Eigen::Translation2d(90 * std::cos(angle), 60 * std::sin(angle)));
    })};
  }

  void draw(double time_s, guint8* grey) {
    const ImageView view =
        film_.draw(static_cast<int>(std::lround(kTimes_Hz * std::min(time_s, stop_s_))));
    for (int y = 0; y < kHeight; ++y) std::copy_n(view.at(0, y), kWidth, grey + y * kWidth);
  }

 private:
  /// The times at which pictures are taken here are multiples of this.
  static constexpr double kTimes_Hz = 600;

  FilmStudio studio_;
  Film film_;
  double stop_s_;
};

/// When the picture was taken that a frame shows, by the frame's time in the stream.
using Taken = std::function<double(double time_s)>;

/// Pictures that are taken `picture_Hz` times a second; frames show the newest.
Taken every(double picture_Hz) {
  // A frame may come a nanosecond early, by rounding.
  return [=](double time_s) { return std::floor(time_s * picture_Hz + 1e-6) / picture_Hz; };
}

/// One thread: a frame is analysed when it is taken, and shown a little later, by the latency that
/// the source says it has.
const std::string kCamera = "videotestsrc is-live=true";
const std::string kFile = "videotestsrc";
constexpr size_t kQueued = 5;  ///< frames behind the element, of a file

/// A pipeline that shows it, and the force wanted at each tick: the simulated grip moves in real
/// time, and the loop would take it for stuck.
class FeltFilm {
 public:
  FeltFilm(const std::string& source, const std::string& frame_rate, Taken taken,
           double stop_s = 1e9)
      : source_(source),
        taken_(std::move(taken)),
        circling_(stop_s),
        pipeline_(
            source + " ! video/x-raw,format=GRAY8,width=" + std::to_string(kWidth) +
            ",height=" + std::to_string(kHeight) + ",framerate=" + frame_rate +
            " ! spidarmotion name=motion ! " +
            (source == kFile ? "queue max-size-buffers=" + std::to_string(kQueued) + " ! " : "") +
            "fakesink name=sink sync=true") {
    GstPad* pad = gst_element_get_static_pad(pipeline_.element(), "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, draw, this, nullptr);
    gst_object_unref(pad);
  }

  void play() {
    if (source_ == kFile) {
      pipeline_.set_state(GST_STATE_PLAYING);
    } else {
      pipeline_.play_live();
    }
  }
  void pause() {
    pipeline_.set_state(GST_STATE_PAUSED);
    pipeline_.idle(GST_MSECOND);
  }
  void seek(double rate, GstClockTime position) {
    shown_ = 0;
    pipeline_.forget_before(GST_CLOCK_TIME_NONE);
    pipeline_.seek(rate, GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE, position, 8 * GST_SECOND);
  }
  /// Paused, from the beginning.
  void step_frames(guint64 count) {
    pipeline_.set_state(GST_STATE_PAUSED);
    pipeline_.step_frames(count);
    shown_ = count;
  }

  /// Ticks every millisecond until this running time.
  void play_until(double running_s) {
    const auto end_ns = static_cast<int64_t>(1e9 * running_s);
    for (int64_t now_ns = 0; now_ns < end_ns;) {
      const GstClockTime next = pipeline_.await();
      while (pipeline_.now() + GST_MSECOND < next) keep(pipeline_.idle(GST_MSECOND));
      const TickRecord tick = pipeline_.step();
      keep(tick);
      if (tick.playing) now_ns = tick.running_ns;
      // The queue fills again before time goes on: a player's machine is fast enough.
      ++shown_;
      if (source_ == kFile) pipeline_.await_analysed(shown_ + kQueued);
    }
  }

  /// Force at each millisecond of running time, between the ticks.
  std::vector<Eigen::Vector3d> force_N() const {
    std::vector<Eigen::Vector3d> curve;
    for (size_t i = 1; i < ticks_.size(); ++i) {
      const Tick &before = ticks_[i - 1], &after = ticks_[i];
      while (static_cast<int64_t>(curve.size()) * kTick_ns <= after.running_ns) {
        const double s =
            static_cast<double>(static_cast<int64_t>(curve.size()) * kTick_ns - before.running_ns) /
            static_cast<double>(after.running_ns - before.running_ns);
        curve.emplace_back(before.force_N + std::max(s, 0.0) * (after.force_N - before.force_N));
      }
    }
    return curve;
  }

 private:
  struct Tick {
    int64_t running_ns;
    Eigen::Vector3d force_N;
  };

  void keep(const TickRecord& tick) {
    if (!tick.playing || tick.running_ns < 0) return;
    // Running time begins anew with a seek.
    if (!ticks_.empty() && tick.running_ns < ticks_.back().running_ns) ticks_.clear();
    if (!ticks_.empty() && tick.running_ns == ticks_.back().running_ns) return;
    const bool felt = tick.found != Found::kNothing && tick.found != Found::kExpired;
    ticks_.push_back({tick.running_ns, felt ? tick.wanted.force_N : Eigen::Vector3d(0, 0, 0)});
  }

  static GstPadProbeReturn draw(GstPad*, GstPadProbeInfo* info, gpointer user) {
    auto* self = static_cast<FeltFilm*>(user);
    auto* buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
    GST_PAD_PROBE_INFO_DATA(info) = buffer;
    GstMapInfo map;
    gst_buffer_map(buffer, &map, GST_MAP_WRITE);
    self->circling_.draw(self->taken_(1e-9 * static_cast<double>(GST_BUFFER_PTS(buffer))),
                         map.data);
    gst_buffer_unmap(buffer, &map);
    return GST_PAD_PROBE_OK;
  }

  const std::string source_;
  Taken taken_;
  Circling circling_;  // streaming thread
  SteppedPipeline pipeline_;
  std::vector<Tick> ticks_;
  size_t shown_ = 0;
};

void expect_same_feeling(const std::vector<Eigen::Vector3d>& force_N,
                         const std::vector<Eigen::Vector3d>& plain_N, int64_t from_ms) {
  ASSERT_GT(plain_N.size(), static_cast<size_t>(from_ms) + 500);
  const FeltDifference difference = compare_felt(force_N, plain_N, static_cast<size_t>(from_ms));
  EXPECT_NEAR(difference.strength, 1, 0.1);
  EXPECT_LT(difference.angle_rad, 15 * kDegree_rad);
  EXPECT_LT(difference.steps, 1.5);
}

TEST(RepeatedFrames, OfACameraAreFeltAsItsPictures) {
  const auto felt = [](const char* rate, const Taken& taken) {
    FeltFilm film(kCamera, rate, taken);
    film.play();
    film.play_until(3);
    return film.force_N();
  };
  expect_same_feeling(felt("60/1", every(15)), felt("15/1", every(1000)), kLearnt_ms);
}

/// Played from a file at a rate, forwards or backwards.
std::vector<Eigen::Vector3d> played(const char* frame_rate, const Taken& taken, double rate) {
  FeltFilm film(kFile, frame_rate, taken);
  film.pause();
  film.seek(rate, 0);
  film.play();
  film.play_until(3);
  return film.force_N();
}

TEST(RepeatedFrames, AreFeltAsThePlainFilmAtOtherRates) {
  for (const double rate : {0.5, 2.0, -1.0, -2.0}) {
    SCOPED_TRACE(rate);
    const auto plain_N = played("24/1", every(1000), rate);
    // Longer frames take longer to be learnt.
    const auto learnt_ms = static_cast<int64_t>(kLearnt_ms / std::min(std::abs(rate), 1.0));
    for (const auto& [frame_rate, picture_Hz] :
         {std::pair{"60/1", 24}, {"30/1", 24}, {"24/1", 12}}) {
      SCOPED_TRACE(std::to_string(picture_Hz) + " in " + frame_rate);
      expect_same_feeling(played(frame_rate, every(picture_Hz), rate), plain_N, learnt_ms);
    }
  }
}

TEST(RepeatedFrames, AreFeltAsThePlainFilmAfterASeek) {
  const auto felt = [](const char* frame_rate, const Taken& taken) {
    FeltFilm film(kFile, frame_rate, taken);
    film.play();
    film.play_until(1);
    film.pause();
    film.seek(1, 5 * GST_SECOND);
    film.play();
    film.play_until(2.5);
    return film.force_N();
  };
  const auto plain_N = felt("24/1", every(1000));
  expect_same_feeling(felt("60/1", every(24)), plain_N, kLearnt_ms);
  expect_same_feeling(felt("24/1", every(12)), plain_N, kLearnt_ms);
}

TEST(RepeatedFrames, AreFeltAsThePlainFilmAfterFrameSteps) {
  // As many steps as are 0.5 s of the film.
  const auto felt = [](const char* frame_rate, const Taken& taken, guint64 frames) {
    FeltFilm film(kFile, frame_rate, taken);
    film.step_frames(frames);
    film.play();
    film.play_until(3);
    return film.force_N();
  };
  const auto plain_N = felt("24/1", every(1000), 12);
  expect_same_feeling(felt("60/1", every(24), 30), plain_N, kLearnt_ms);
  expect_same_feeling(felt("24/1", every(12), 12), plain_N, kLearnt_ms);
}

TEST(RepeatedFrames, ThatStayAreExactRestWithin100Ms) {
  constexpr double kStop_s = 1.5;
  for (const bool live : {false, true}) {
    SCOPED_TRACE(live ? "live" : "player");
    for (const auto& [frame_rate, picture_Hz] :
         {std::pair{"24/1", 24}, {"60/1", 24}, {"30/1", 15}}) {
      SCOPED_TRACE(std::to_string(picture_Hz) + " in " + frame_rate);
      FeltFilm film(live ? kCamera : kFile, frame_rate, every(picture_Hz), kStop_s);
      film.play();
      film.play_until(2);
      const auto force_N = film.force_N();
      // kStop_s is the time of a picture at all of these rates: the last one.
      const auto last_ms = static_cast<size_t>(1000 * kStop_s);
      EXPECT_GT(force_N[last_ms].norm(), 0.1);
      for (size_t ms = last_ms + 101; ms < force_N.size(); ++ms) {
        ASSERT_EQ(force_N[ms].norm(), 0) << ms;
      }
    }
  }
}

}  // namespace
}  // namespace spidar::test::repeated_frames_test
