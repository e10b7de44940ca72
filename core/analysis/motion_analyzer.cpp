// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/analysis/force_renderer.h"
#include "core/motion/cadence.h"
#include "core/motion/image_motion.h"
#include "core/motion/motion_estimator.h"
#include "core/picture/reduced_frame.h"
#include "core/tracking/tracker.h"

namespace spidar {

struct MotionAnalyzer::Impl {
  explicit Impl(const AnalyzerSettings& given)
      : settings(given), tracker(given.tracker), renderer(given) {}

  bool by_points() const { return settings.motion == MotionKind::kMean; }
  void take(const Cadence::Step& step) {
    frame.interval_ns = std::max(step.interval_ns, kLeastInterval_ns);
    frame.shown_for_ns = step.shown_for_ns;
  }
  bool measure(const ImageView& image, int64_t running_ns);
  bool find_mean(const TrackedFrame& tracked);
  void restart_measuring();

  AnalyzerSettings settings;
  ReducedFrame reduced;
  OpenCvTracker tracker;   // for the mean
  MotionEstimator motion;  // for all else
  Cadence cadence;
  ForceRenderer renderer;
  std::optional<int64_t> last_running_ns;
  bool anew = true;
  FilmPlace film;
  Frame frame;
};

/// The paper's motion: the mean over all points. False when there is nothing to compare with.
bool MotionAnalyzer::Impl::find_mean(const TrackedFrame& tracked) {
  frame.features = tracked.features;
  if (tracked.picture == PictureKind::kFirst) return false;
  frame.tracks = tracked.tracks;
  frame.mean = mean_motion(tracked.tracks, frame.interval_ns);
  return true;
}

/// Finds what moves, unless the picture waits. Returns whether it does not.
bool MotionAnalyzer::Impl::measure(const ImageView& image, int64_t running_ns) {
  const bool may_wait = cadence.would_wait(running_ns);
  const TrackedFrame* const tracked = by_points() ? &tracker.track(image, may_wait) : nullptr;
  const PictureKind picture = tracked ? tracked->picture : reduced.read(image, may_wait);
  const bool is_comparable = picture != PictureKind::kFirst && last_running_ns;
  last_running_ns = running_ns;
  Cadence::Step step;
  if (is_comparable) {
    step = cadence.see(picture, running_ns);
    if (step.waits) {
      frame.picture = PictureKind::kWaiting;
      return false;
    }
  } else {
    motion.reset();
  }
  frame.forget_motion();
  frame.width = image.width;
  frame.height = image.height;
  take(step);
  const bool is_compared = tracked ? find_mean(*tracked) : motion.estimate(image, reduced, frame);
  if (is_comparable && is_compared) {
    frame.picture = picture;
  } else {
    cadence.cut(running_ns);
    frame.forget_motion();
  }
  return true;
}

void MotionAnalyzer::Impl::restart_measuring() {
  tracker.restart();
  reduced.restart();
  motion.reset();
}

MotionAnalyzer::MotionAnalyzer(const AnalyzerSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {}

MotionAnalyzer::~MotionAnalyzer() = default;

void MotionAnalyzer::configure(const AnalyzerSettings& settings) {
  impl_->renderer.configure(settings);  // validates all of them
  impl_->tracker.configure(settings.tracker);
  const bool was_by_points = impl_->by_points();
  impl_->settings = settings;
  // What will be used next has not seen the last picture.
  if (was_by_points != impl_->by_points()) impl_->restart_measuring();
}

const Frame& MotionAnalyzer::analyze(const ImageView& image, int64_t running_ns,
                                     const FilmPlace& film) {
  if (impl_->last_running_ns && running_ns <= *impl_->last_running_ns) restart();
  Frame& frame = impl_->frame;
  frame.running_ns = running_ns;
  frame.stream_ns = film.stream_ns;
  impl_->film = film;
  const bool is_anew = std::exchange(impl_->anew, false);
  if (is_anew) impl_->renderer.restart();
  if (impl_->measure(image, running_ns)) impl_->renderer.render(frame, film);
  return frame;
}

const Frame* MotionAnalyzer::repeat(int64_t running_ns) {
  const std::optional<int64_t> last_ns = impl_->last_running_ns;
  if (!last_ns || running_ns <= *last_ns ||
      running_ns - impl_->cadence.picture_ns() > Cadence::kLongest_ns) {
    restart();
    return nullptr;
  }
  impl_->last_running_ns = running_ns;
  Frame& frame = impl_->frame;
  frame.running_ns = running_ns;
  const Cadence::Step step = impl_->cadence.see(PictureKind::kSame, running_ns);
  frame.picture = step.waits ? PictureKind::kWaiting : PictureKind::kSame;
  if (!step.waits) {
    impl_->take(step);
    impl_->renderer.render(frame, impl_->film);
  }
  return &frame;
}

void MotionAnalyzer::restart() {
  impl_->restart_measuring();
  impl_->cadence.restart();
  impl_->last_running_ns.reset();
  impl_->anew = true;
}

}  // namespace spidar
