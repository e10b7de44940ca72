// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/motion/image_motion.h"

namespace spidar {
namespace {

/// After this many pairs of pictures, the measurement of a part of the picture is complete: even an
/// object of a single block is confirmed (Track::kConfirmBlocks).
constexpr int kSettles_pairs = Track::kConfirmBlocks;

/// The mean apparent motion of the points of a picture at rest is below this: blocks are accurate
/// to a tenth of a pixel of the field.
constexpr double kFlickers_px = 0.1;
/// While the camera of a part of the reduced picture rests, the mean motion in it is below this: a
/// pixel, the distance by which its sides may seem to move.
constexpr double kRests_px = 1;

/// Whether all sides agree to within a pixel of the reduced picture, in which they were found.
bool is_near(const PicturePart& a, const PicturePart& b, int factor) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y),
                   std::abs(a.x + a.width - b.x - b.width),
                   std::abs(a.y + a.height - b.y - b.height)}) <= factor;
}

/// The mean displacement of the points, px.
Eigen::Vector2d mean_step_of(const std::vector<FollowedPoint>& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const FollowedPoint& point : points) {
    sum += Eigen::Vector2d(point.to.x_px - point.from.x_px, point.to.y_px - point.from.y_px);
  }
  return points.empty() ? sum : sum / static_cast<double>(points.size());
}

}  // namespace

void MotionAnalyzer::set_times(const Cadence::Step& step) {
  frame_.interval_ns = std::max(step.interval_ns, kMinInterval_ns);
  frame_.shown_for_ns = step.shown_for_ns;
}

/// Begins anew with the area of the settings when that area or the size of the pictures changes.
void MotionAnalyzer::update_area(const ImageView& picture) {
  FilmPlace& place = frame_.place;
  const bool is_other_size =
      place.picture_width != picture.width || place.picture_height != picture.height;
  const PicturePart set = settings_.area.of_picture(picture.width, picture.height);
  if (is_other_size) area_finder_.reset();
  if (is_other_size || (!finds_area() && set != now_->area)) {
    now_->begin(set);
    next_->area = {};
    page_scroll_.reset();
  }
  place = {now_->area, picture.width, picture.height};
}

/// Reads the film area of a picture, before compare().
FrameComparison MotionAnalyzer::read(Measured& measured, const ImageView& film,
                                     bool may_wait) const {
  return by_points() ? measured.tracker.track(film, may_wait).picture
                     : measured.reduced.read(film, may_wait);
}

/// Measures the motion in the film area. Returns false if there is no picture to compare with.
bool MotionAnalyzer::compare(Measured& measured, const ImageView& film, MeasuredFrame& frame,
                             uint32_t felt) const {
  bool is_compared = false;
  if (by_points()) {
    const OpenCvTracker::Result& tracked = measured.tracker.result();
    frame.features = tracked.features;
    is_compared = tracked.picture != FrameComparison::kFirst;
    if (is_compared) {
      frame.points = tracked.points;
      frame.mean = mean_motion(tracked.points, frame.interval_ns);
    }
  } else {
    is_compared = measured.motion.estimate(film, measured.reduced, frame, felt);
  }
  measured.pairs = is_compared ? measured.pairs + 1 : 0;
  return is_compared;
}

/// Passes the reduced picture to the area finder; it exists already if the film fills the picture.
void MotionAnalyzer::look_for_film(const ImageView& picture, const ImageView& film,
                                   int64_t running_ns) {
  const bool scrolls = page_scroll_.update(film);
  const bool is_reduced =
      !by_points() && frame_.place == FilmPlace::whole(picture.width, picture.height);
  if (!is_reduced) {
    reduce_blocks(picture, halving_factor(picture.width, picture.height), whole_);
  }
  area_finder_.observe((is_reduced ? now_->reduced.base() : whole_).view(), running_ns, scrolls);
  frame_.place.is_known = !area_finder_.is_searching();
  frame_.place.is_page = !frame_.place.is_known && area_finder_.is_page();
}

/// The part of the picture in which the area finder sees or suspects the film.
PicturePart MotionAnalyzer::film_in(const ImageView& picture) const {
  const std::optional<PicturePart> part = area_finder_.film();
  const int width = picture.width, height = picture.height;
  if (!part) return {0, 0, width, height};
  const int factor = halving_factor(width, height);
  // The last columns and rows may not fill a pixel of the reduced picture.
  const int right = part->x + part->width, bottom = part->y + part->height;
  const int x = factor * part->x, y = factor * part->y;
  return {x, y, (right == width / factor ? width : factor * right) - x,
          (bottom == height / factor ? height : factor * bottom) - y};
}

/// Measures the part where the film is found or suspected, first in parallel with the current part,
/// then instead of it. Returns whether the frame has motion that may be felt.
bool MotionAnalyzer::follow_film(const ImageView& picture, bool is_compared, int64_t running_ns) {
  const int factor = halving_factor(picture.width, picture.height);
  const PicturePart film = film_in(picture);
  const bool may_be_felt = is_compared && frame_.place.is_known;
  if (is_near(film, now_->area, factor)) {
    next_->area = {};
    return may_be_felt;
  }
  if (!is_near(film, next_->area, factor)) next_->begin(film);
  const ImageView view = part_of(picture, next_->area);
  next_frame_.clear_motion();
  next_frame_.interval_ns = frame_.interval_ns;
  next_frame_.shown_for_ns = frame_.shown_for_ns;
  read(*next_, view);
  const bool is_next_compared = compare(*next_, view, next_frame_, next_frame_.dominant);
  const Eigen::Vector2d step_px = mean_step_of(next_frame_.points) / factor;
  if (is_next_compared) {
    const bool moves = next_frame_.dominant != 0 || step_px.norm() > kFlickers_px;
    area_finder_.observe_motion(moves, step_px.x(), step_px.y(), running_ns);
  }
  // Until the switch, a film whose camera moves is wrongly felt as an object. After two pairs, most
  // of the objects in the film are confirmed.
  const bool shows_as_much = is_next_compared
                                 ? next_frame_.dominant != 0 || frame_.dominant == 0 ||
                                       (step_px.norm() > kRests_px && next_->pairs > 1) ||
                                       next_->pairs >= std::min(kSettles_pairs, now_->pairs)
                                 : !is_compared;
  if (area_finder_.is_guess() || film != film_in(picture) || !shows_as_much) return may_be_felt;
  std::swap(now_, next_);
  next_->area = {};
  next_frame_.place = frame_.place;
  next_frame_.place.area = now_->area;
  std::swap<MeasuredFrame>(frame_, next_frame_);
  page_scroll_.reset();
  return is_next_compared && frame_.place.is_known;
}

/// Reads the picture and measures its motion. Returns false without measuring while it waits.
bool MotionAnalyzer::measure(const ImageView& picture, int64_t running_ns) {
  update_area(picture);
  const ImageView film = part_of(picture, now_->area);
  const FrameComparison comparison = read(*now_, film, cadence_.would_wait(running_ns));
  if (finds_area()) look_for_film(picture, film, running_ns);
  const bool has_before = comparison != FrameComparison::kFirst && last_running_ns_;
  last_running_ns_ = running_ns;
  Cadence::Step step;
  if (has_before) {
    step = cadence_.update(comparison, running_ns,
                           by_points() ? RepeatedPicture::Repeats() : now_->reduced.repeats());
  } else {
    now_->motion.reset();
  }
  if (step.waits && frame_.place.is_known) {
    frame_.picture = FrameComparison::kWaiting;
    return false;
  }
  frame_.clear_motion();
  set_times(step);
  if (!frame_.place.is_known) {  // the film may have moved
    now_->motion.reset();
    now_->pairs = 0;
  }
  bool is_compared = compare(*now_, film, frame_, frame_.felt_object);
  if (finds_area()) is_compared = follow_film(picture, is_compared, running_ns);
  if (is_compared && has_before) {
    frame_.picture = comparison;
  } else {
    cadence_.cut(running_ns);
    if (!by_points()) now_->reduced.cut();
    frame_.clear_motion();
  }
  return true;
}

void MotionAnalyzer::configure(const AnalyzerSettings& settings) {
  renderer_.configure(settings);  // validates all settings
  now_->tracker.configure(settings.tracker);
  next_->tracker.configure(settings.tracker);
  const bool was_by_points = by_points();
  if (settings.area.kind != settings_.area.kind) {
    area_finder_.reset();
    frame_.place = {};
  }
  settings_ = settings;
  // The method used from now on has not seen the last picture.
  if (was_by_points != by_points()) {
    now_->reset();
    next_->area = {};
  }
}

const Frame& MotionAnalyzer::analyze(const ImageView& image, int64_t running_ns, int64_t stream_ns,
                                     const Orientation& turn) {
  if (last_running_ns_ && running_ns <= *last_running_ns_) reset();
  stream_ns_ = stream_ns;
  turn_ = turn;
  const bool is_anew = std::exchange(anew_, false);
  if (is_anew) renderer_.reset();
  if (measure(image, running_ns)) renderer_.render(frame_, settings_, stream_ns, turn);
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
  const Cadence::Step step = cadence_.update(FrameComparison::kSame, running_ns);
  frame_.picture = step.waits ? FrameComparison::kWaiting : FrameComparison::kSame;
  if (!step.waits) {
    set_times(step);
    renderer_.render(frame_, settings_, stream_ns_, turn_);
  }
  return &frame_;
}

void MotionAnalyzer::reset() {
  area_finder_.reset();
  page_scroll_.reset();
  frame_.place = {};
  cadence_.reset();
  last_running_ns_.reset();
  anew_ = true;
}

}  // namespace spidar
