// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"

#include <algorithm>
#include <utility>

#include "core/motion/image_motion.h"

namespace spidar {

void MotionAnalyzer::take(const Cadence::Step& step) {
  frame_.interval_ns = std::max(step.interval_ns, kMinInterval_ns);
  frame_.shown_for_ns = step.shown_for_ns;
}

/// The paper's motion: the mean over all points. False when there is nothing to compare with.
bool MotionAnalyzer::find_mean(const OpenCvTracker::Result& tracked) {
  frame_.features = tracked.features;
  if (tracked.picture == Likeness::kFirst) return false;
  frame_.points = tracked.points;
  frame_.mean = mean_motion(tracked.points, frame_.interval_ns);
  return true;
}

/// Finds what moves, unless the picture waits. Returns whether it does not.
bool MotionAnalyzer::measure(const ImageView& image, int64_t running_ns) {
  const bool may_wait = cadence_.would_wait(running_ns);
  const OpenCvTracker::Result* const tracked =
      by_points() ? &tracker_.track(image, may_wait) : nullptr;
  const Likeness picture = tracked ? tracked->picture : reduced_.read(image, may_wait);
  const bool is_comparable = picture != Likeness::kFirst && last_running_ns_;
  last_running_ns_ = running_ns;
  Cadence::Step step;
  if (is_comparable) {
    step = cadence_.see(picture, running_ns,
                        tracked ? RepeatedPicture::Repeats() : reduced_.repeats());
    if (step.waits) {
      frame_.picture = Likeness::kWaiting;
      return false;
    }
  } else {
    motion_.reset();
  }
  frame_.clear_motion();
  frame_.width = image.width;
  frame_.height = image.height;
  take(step);
  const bool is_compared =
      tracked ? find_mean(*tracked) : motion_.estimate(image, reduced_, frame_);
  if (is_comparable && is_compared) {
    frame_.picture = picture;
  } else {
    cadence_.cut(running_ns);
    if (!tracked) reduced_.cut();
    frame_.clear_motion();
  }
  return true;
}

void MotionAnalyzer::reset_measuring() {
  tracker_.reset();
  reduced_.reset();
  motion_.reset();
}

void MotionAnalyzer::configure(const AnalyzerSettings& settings) {
  renderer_.configure(settings);  // validates all of them
  tracker_.configure(settings.tracker);
  const bool was_by_points = by_points();
  settings_ = settings;
  // What will be used next has not seen the last picture.
  if (was_by_points != by_points()) reset_measuring();
}

const Frame& MotionAnalyzer::analyze(const ImageView& image, int64_t running_ns, int64_t stream_ns,
                                     const Orientation& turn) {
  if (last_running_ns_ && running_ns <= *last_running_ns_) reset();
  frame_.stamp.running_ns = running_ns;
  frame_.stamp.stream_ns = stream_ns;
  turn_ = turn;
  const bool is_anew = std::exchange(anew_, false);
  if (is_anew) renderer_.reset();
  if (measure(image, running_ns)) renderer_.render(frame_, turn);
  return frame_;
}

const Frame* MotionAnalyzer::repeat(int64_t running_ns) {
  const std::optional<int64_t> last_ns = last_running_ns_;
  if (!last_ns || running_ns <= *last_ns ||
      running_ns - cadence_.picture_ns() > Cadence::kLongest_ns) {
    reset();
    return nullptr;
  }
  last_running_ns_ = running_ns;
  frame_.stamp.running_ns = running_ns;
  const Cadence::Step step = cadence_.see(Likeness::kSame, running_ns);
  frame_.picture = step.waits ? Likeness::kWaiting : Likeness::kSame;
  if (!step.waits) {
    take(step);
    renderer_.render(frame_, turn_);
  }
  return &frame_;
}

void MotionAnalyzer::reset() {
  reset_measuring();
  cadence_.reset();
  last_running_ns_.reset();
  anew_ = true;
}

}  // namespace spidar
