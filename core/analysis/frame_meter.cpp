// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/frame_meter.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/field/reduced_frame.h"
#include "core/force/motion_bounds.h"
#include "core/motion/cadence.h"
#include "core/motion/motion_estimator.h"
#include "core/tracking/opencv_tracker.h"

namespace spidar {
namespace {

/// Number of points in addition to the field of blocks, by quality.
constexpr int kFewPoints = 64;
constexpr int kManyPoints = 200;

Cadence::Picture picture_of(bool repeated, bool alike) {
  if (repeated) return Cadence::Picture::kSame;
  return alike ? Cadence::Picture::kAlike : Cadence::Picture::kOther;
}

Shown shown_by(Cadence::Picture picture) {
  switch (picture) {
    case Cadence::Picture::kSame:
      return Shown::kSame;
    case Cadence::Picture::kAlike:
      return Shown::kAlike;
    case Cadence::Picture::kOther:
      break;
  }
  return Shown::kOther;
}

}  // namespace

struct FrameMeter::Impl {
  explicit Impl(const Settings& given) : settings(given), tracker(given.tracker) {}

  FieldPoints::Settings field_points() const {
    const TrackerQuality quality = settings.tracker.quality;
    return {std::min(settings.tracker.max_features,
                     quality == TrackerQuality::kFine ? kManyPoints : kFewPoints),
            quality != TrackerQuality::kFast};
  }
  void take(const Cadence::Step& step) {
    found.interval_ns = std::max(step.interval_ns, kLeastInterval_ns);
    found.shown_for_ns = step.shown_for_ns;
  }
  bool take_points(const TrackedFrame& tracked);
  bool take_scene(const SceneMotion& scene);
  void forget_motion();

  Settings settings;
  ReducedFrame reduced;
  OpenCvTracker tracker;   // for the mean
  MotionEstimator motion;  // for all else
  Cadence cadence;
  std::optional<int64_t> last_running_time_ns;
  bool anew = true;
  MeasuredFrame found;
};

/// Nothing is known to move.
void FrameMeter::Impl::forget_motion() {
  found.shown = Shown::kFirst;
  found.interval_ns = found.shown_for_ns = 0;
  found.mean = {};
  found.background.reset();
  found.votes = 0;
  found.objects.clear();
  found.dominant = 0;
}

/// The paper's motion: the mean over all points. False when there is nothing to compare with.
bool FrameMeter::Impl::take_points(const TrackedFrame& tracked) {
  found.features = tracked.features;
  found.tracks = &tracked.tracks;
  if (tracked.restarted) return false;
  found.mean = mean_motion(tracked.tracks, std::max(found.interval_ns, kLeastInterval_ns));
  return true;
}

bool FrameMeter::Impl::take_scene(const SceneMotion& scene) {
  found.features = scene.features;
  found.tracks = scene.tracks;
  if (scene.restarted) return false;
  found.background = *scene.background;
  found.votes = scene.votes;
  found.objects = *scene.object_list;
  found.dominant = scene.dominant ? scene.dominant->id : 0;
  return true;
}

FrameMeter::FrameMeter(const Settings& settings) : impl_(std::make_unique<Impl>(settings)) {}

FrameMeter::~FrameMeter() = default;

void FrameMeter::configure(const Settings& settings) {
  impl_->tracker.configure(settings.tracker);
  if (settings.mean_of_points != impl_->settings.mean_of_points) {
    // What will be used next has not seen the last picture.
    impl_->tracker.restart();
    impl_->reduced.restart();
    impl_->motion.reset();
  }
  impl_->settings = settings;
}

const MeasuredFrame& FrameMeter::measure(const ImageView& frame, int64_t running_time_ns) {
  if (impl_->last_running_time_ns && running_time_ns <= *impl_->last_running_time_ns) restart();
  const bool has_last = impl_->last_running_time_ns.has_value();
  const bool may_wait = impl_->cadence.would_wait(running_time_ns);
  const Repeats repeats = may_wait ? Repeats::kAlike : Repeats::kSame;
  const bool by_points = impl_->settings.mean_of_points;
  const TrackedFrame* tracked = nullptr;
  if (by_points)
    tracked = &impl_->tracker.track(frame, repeats);
  else
    impl_->reduced.read(frame, repeats);
  impl_->last_running_time_ns = running_time_ns;

  MeasuredFrame& found = impl_->found;
  const bool comparable = by_points ? !tracked->restarted : impl_->reduced.is_comparable();
  const Cadence::Picture picture =
      by_points ? picture_of(tracked->repeated, tracked->alike)
                : picture_of(impl_->reduced.is_repeated(), impl_->reduced.is_alike());
  Cadence::Step step;
  if (comparable && has_last) {
    step = impl_->cadence.see(picture, running_time_ns);
    if (step.waits) {
      found.shown = Shown::kWaiting;
      found.anew = false;
      return found;
    }
  } else {
    impl_->motion.reset();
  }
  impl_->forget_motion();
  found.anew = std::exchange(impl_->anew, false);
  found.width = frame.width;
  found.height = frame.height;
  if (comparable && has_last) impl_->take(step);
  const int64_t interval_ns = std::max(found.interval_ns, kLeastInterval_ns);
  const bool compared = by_points ? impl_->take_points(*tracked)
                                  : impl_->take_scene(impl_->motion.estimate(
                                        frame, impl_->reduced, impl_->field_points(), interval_ns));
  if (comparable && has_last && compared) {
    found.shown = shown_by(picture);
  } else {
    impl_->cadence.cut(running_time_ns);
    impl_->forget_motion();
  }
  return found;
}

const MeasuredFrame* FrameMeter::repeat(int64_t running_time_ns) {
  const std::optional<int64_t> last_ns = impl_->last_running_time_ns;
  if (!last_ns || running_time_ns <= *last_ns ||
      running_time_ns - impl_->cadence.picture_ns() > Cadence::kLongest_ns) {
    restart();
    return nullptr;
  }
  impl_->last_running_time_ns = running_time_ns;
  const Cadence::Step step = impl_->cadence.see(Cadence::Picture::kSame, running_time_ns);
  impl_->found.anew = false;
  impl_->found.shown = step.waits ? Shown::kWaiting : Shown::kSame;
  if (!step.waits) impl_->take(step);
  return &impl_->found;
}

void FrameMeter::restart() {
  impl_->reduced.restart();
  impl_->tracker.restart();
  impl_->motion.reset();
  impl_->cadence.restart();
  impl_->last_running_time_ns.reset();
  impl_->anew = true;
}

}  // namespace spidar
