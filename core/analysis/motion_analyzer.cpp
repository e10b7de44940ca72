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

/// Reads the film in a picture, in which compare() then finds what moves.
Likeness MotionAnalyzer::read(const ImageView& film, bool may_wait) {
  return by_points() ? tracker_.track(film, may_wait).picture : reduced_.read(film, may_wait);
}

/// Returns false when there is nothing to compare the film with.
bool MotionAnalyzer::compare(const ImageView& film) {
  if (!by_points()) return motion_.estimate(film, reduced_, frame_, frame_.felt_object);
  const OpenCvTracker::Result& tracked = tracker_.result();
  frame_.features = tracked.features;
  if (tracked.picture == Likeness::kFirst) return false;
  frame_.points = tracked.points;
  frame_.mean = mean_motion(tracked.points, frame_.interval_ns);
  return true;
}

/// The part of the picture that shows the film, as far as earlier pictures have told.
PicturePart MotionAnalyzer::area_of(const ImageView& picture) {
  const PicturePart all = settings_.area.of_picture(picture.width, picture.height);
  if (!finds_area()) return all;
  const FilmPlace& before = frame_.place;
  if (before.picture_width != picture.width || before.picture_height != picture.height) {
    area_finder_.reset();
  }
  const std::optional<PicturePart>& found = area_finder_.area();
  if (!found) return all;
  const int factor = halving_factor(picture.width, picture.height);
  // The last columns and rows may not fill a pixel of the reduced picture.
  const int right = found->x + found->width, bottom = found->y + found->height;
  const bool is_at_right = right == picture.width / factor;
  const bool is_at_bottom = bottom == picture.height / factor;
  const int x = factor * found->x, y = factor * found->y;
  return {x, y, (is_at_right ? picture.width : factor * right) - x,
          (is_at_bottom ? picture.height : factor * bottom) - y};
}

/// Shows the reduced picture to the finder. Where the film fills it, the analysis has made it.
void MotionAnalyzer::look_for_film(const ImageView& picture, const ImageView& film,
                                   int64_t running_ns) {
  const bool scrolls = page_scroll_.look(film);
  const bool is_reduced =
      !by_points() && frame_.place == FilmPlace::whole(picture.width, picture.height);
  if (!is_reduced) {
    reduce_blocks(picture, halving_factor(picture.width, picture.height), whole_);
  }
  area_finder_.look((is_reduced ? reduced_.base() : whole_).view(), running_ns, scrolls);
  frame_.place.is_known = !area_finder_.is_searching();
  frame_.place.is_page = !frame_.place.is_known && area_finder_.is_page();
}

/// Tells the finder how what may be the film moves on an average. What else is there, such as an
/// object that does not move with it, makes that less.
void MotionAnalyzer::tell_of_candidate(int64_t running_ns) {
  const std::optional<PicturePart> part = area_finder_.candidate();
  if (!part) return;
  const double factor = halving_factor(frame_.place.picture_width, frame_.place.picture_height);
  double across_px = 0, down_px = 0;
  int count = 0;
  for (const FollowedPoint& point : frame_.points) {
    const double x = point.to.x_px / factor - part->x, y = point.to.y_px / factor - part->y;
    if (x < 0 || y < 0 || x >= part->width || y >= part->height) continue;
    across_px += point.to.x_px - point.from.x_px;
    down_px += point.to.y_px - point.from.y_px;
    ++count;
  }
  if (count == 0) return;
  area_finder_.tell(across_px / factor / count, down_px / factor / count, running_ns);
}

/// Measures this area from this picture on. If the previous frame showed another one, there is
/// nothing to compare it with.
void MotionAnalyzer::enter(const PicturePart& area, const ImageView& picture) {
  if (area != frame_.place.area) {
    reset_measuring();
    page_scroll_.reset();
  }
  frame_.place = {area, picture.width, picture.height};
}

/// Begins anew in the part of the picture that has just been found to be the film. Returns false if
/// there is none, or it is the one that is measured.
bool MotionAnalyzer::begins_in_part(const ImageView& picture) {
  const PicturePart found = area_of(picture);
  if (found == frame_.place.area) return false;
  enter(found, picture);
  const ImageView film = part_of(picture, found);
  read(film);
  if (!by_points()) motion_.estimate(film, reduced_, frame_);
  return true;
}

/// Finds what moves in the film that was read, in the time of `step`. Returns false when there is
/// nothing to compare it with.
bool MotionAnalyzer::find_motion(const ImageView& picture, const ImageView& film,
                                 const Cadence::Step& step, int64_t running_ns) {
  if (!frame_.place.is_known) {
    reset_measuring();
    return false;
  }
  take(step);
  const bool is_compared = compare(film);
  if (finds_area()) tell_of_candidate(running_ns);
  return !begins_in_part(picture) && is_compared;
}

/// Reads the picture and finds what moves. Returns false, and finds nothing, while it waits.
bool MotionAnalyzer::measure(const ImageView& picture, int64_t running_ns) {
  const PicturePart area = area_of(picture);
  enter(area, picture);
  const ImageView film = part_of(picture, area);
  const Likeness likeness = read(film, cadence_.would_wait(running_ns));
  if (finds_area()) look_for_film(picture, film, running_ns);
  const bool has_before = likeness != Likeness::kFirst && last_running_ns_;
  last_running_ns_ = running_ns;
  Cadence::Step step;
  if (has_before) {
    step = cadence_.see(likeness, running_ns,
                        by_points() ? RepeatedPicture::Repeats() : reduced_.repeats());
  } else {
    motion_.reset();
  }
  if (step.waits && frame_.place.is_known) {
    frame_.picture = Likeness::kWaiting;
    return false;
  }
  frame_.clear_motion();
  if (find_motion(picture, film, step, running_ns) && has_before) {
    frame_.picture = likeness;
  } else {
    cadence_.cut(running_ns);
    if (!by_points()) reduced_.cut();
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
  if (settings.area.kind != settings_.area.kind) area_finder_.reset();
  settings_ = settings;
  // What will be used next has not seen the last picture.
  if (was_by_points != by_points()) reset_measuring();
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
  const Cadence::Step step = cadence_.see(Likeness::kSame, running_ns);
  frame_.picture = step.waits ? Likeness::kWaiting : Likeness::kSame;
  if (!step.waits) {
    take(step);
    renderer_.render(frame_, settings_, stream_ns_, turn_);
  }
  return &frame_;
}

void MotionAnalyzer::reset() {
  area_finder_.reset();
  page_scroll_.reset();
  reset_measuring();
  cadence_.reset();
  last_running_ns_.reset();
  anew_ = true;
}

}  // namespace spidar
