// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/cadence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantile.h"

namespace spidar {
namespace {

/// Intervals that differ by less than this fraction count as equal: rounding and jitter of a clock.
/// So do speeds.
constexpr double kSameInterval = 0.2;
/// An interval that is unlike the others and the only one in so many is an accident. In a rhythm,
/// one in five is unlike the others, as with 25 pictures a second in 30 frames, or more are. (With
/// 24 in 25 it is one in 24, and the interval without it is only 4 % too short.)
constexpr size_t kAccident = 2 * 5;
/// Fewer pictures do not show a rhythm: two periods of the shortest one, in which two pictures are
/// shown for different times.
constexpr size_t kEnough = 2 * 2;
/// Fewer intervals have no majority from which one could differ.
constexpr size_t kMajority = 3;

}  // namespace

void Cadence::remember(const Shown& shown) {
  // At another rate of playback, or with frames of irregular length, earlier intervals are not
  // comparable.
  if (!shown_.empty()) {
    const double before = static_cast<double>(shown_[0].interval_ns) / shown_[0].frames;
    const double now = static_cast<double>(shown.interval_ns) / shown.frames;
    if (std::abs(now - before) > kSameInterval * before) shown_.clear();
  }
  shown_.add(shown);
}

/// The first repetitions of a coded film pass for pictures, and cut the intervals of these in
/// pieces.
void Cadence::join_pieces(const RepeatedPicture::Repeats& repeats) {
  const History<Shown, kPictures> pieces = shown_;
  shown_.clear();
  Shown whole{0, 0};
  for (size_t i = pieces.size(); i-- > 0;) {
    whole.interval_ns += pieces[i].interval_ns;
    whole.frames += pieces[i].frames;
    // The frame with which this piece ended.
    const size_t age = i + 1;
    if (age < repeats.size() && repeats[age]) continue;
    if (whole.interval_ns <= kLongest_ns) shown_.add(whole);
    whole = {0, 0};
  }
  picture_ns_ -= whole.interval_ns;
  frames_ += whole.frames;
}

bool Cadence::knows_repeats() const {
  for (size_t i = 0; i < shown_.size(); ++i) {
    if (shown_[i].frames > 1) return true;
  }
  return false;
}

int64_t Cadence::median_ns() const {
  std::array<int64_t, kPictures> sorted{};
  for (size_t i = 0; i < shown_.size(); ++i) sorted[i] = shown_[i].interval_ns;
  return median(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(shown_.size()));
}

/// How long the next picture may be shown: as long as the one before, or the second longest of the
/// latest intervals, because a single long one may have been a pause.
int64_t Cadence::expected_ns() const {
  int64_t longest = 0;
  int64_t second = 0;
  for (size_t i = 0; i < shown_.size(); ++i) {
    const int64_t interval_ns = shown_[i].interval_ns;
    second = std::max(second, std::min(longest, interval_ns));
    longest = std::max(longest, interval_ns);
  }
  return std::max(second, shown_[0].interval_ns);
}

/// Interval of the latest `pictures` if they were taken at even intervals and each of them is shown
/// from the next frame on: the slope of the line through the times at which they were first shown.
/// 0 when one of them is further from the line than a frame.
double Cadence::even_interval_ns(size_t pictures) const {
  std::array<double, kPictures + 1> time{};
  double frames = 0;
  for (size_t i = 0; i < pictures; ++i) {
    const Shown& shown = shown_[pictures - 1 - i];
    time[i + 1] = time[i] + static_cast<double>(shown.interval_ns);
    frames += shown.frames;
  }
  const auto n = static_cast<double>(pictures + 1);
  const double middle = (n - 1) / 2;
  double moment = 0;
  for (size_t i = 0; i <= pictures; ++i) moment += (static_cast<double>(i) - middle) * time[i];
  const double slope = moment / (n * (n * n - 1) / 12);
  double least = 0;
  double most = 0;
  for (size_t i = 0; i <= pictures; ++i) {
    const double off = time[i] - slope * static_cast<double>(i);
    least = std::min(least, off);
    most = std::max(most, off);
  }
  const double frame_ns = time[pictures] / frames;
  return most - least <= (1 + kSameInterval) * frame_ns ? slope : 0;
}

/// The same for as many of the latest pictures as have kept one rhythm.
double Cadence::even_interval_ns() const {
  for (size_t pictures = shown_.size(); pictures >= kEnough; pictures /= 2) {
    if (const double even_ns = even_interval_ns(pictures); even_ns > 0) return even_ns;
  }
  return 0;
}

bool Cadence::would_wait(int64_t time_ns) const {
  if (!has_changed_ || time_ns <= frame_ns_) return false;
  const int64_t frame_ns = time_ns - frame_ns_;
  // The next frame could be the first to show the next picture.
  const int64_t next_ns = time_ns - picture_ns_ + frame_ns;
  return next_ns <= std::max(kRest_ns, expected_ns() + frame_ns / 2);
}

Cadence::Step Cadence::see(Likeness picture, int64_t time_ns,
                           const RepeatedPicture::Repeats& repeats) {
  const bool repeated = picture == Likeness::kSame;
  const bool waits = repeated && would_wait(time_ns);
  const int64_t frame_ns = begun_ ? std::max<int64_t>(time_ns - frame_ns_, 1) : 0;
  frame_ns_ = time_ns;
  if (repeated) {
    if (!knows_repeats()) join_pieces(repeats);
    ++frames_;
  }
  if (waits) return {true, 0, 0};

  Step step{false, frame_ns, frame_ns};
  if (repeated) {
    return step;  // measured frame by frame from now on
  }

  const int64_t between_ns = begun_ ? time_ns - picture_ns_ : frame_ns;
  const Shown shown{between_ns, frames_};
  picture_ns_ = time_ns;
  frames_ = 1;
  begun_ = has_changed_ = true;
  if (between_ns <= kLongest_ns) {
    if (picture == Likeness::kOther) remember(shown);
    step.interval_ns = step.shown_for_ns = between_ns;
  }
  if (!knows_repeats()) return step;
  size_t unlike = 0;
  const int64_t median = median_ns();
  for (size_t i = 0; i < shown_.size(); ++i) {
    const int64_t interval_ns = shown_[i].interval_ns;
    const bool is_alike = std::abs(static_cast<double>(interval_ns - median)) <
                          kSameInterval * static_cast<double>(median);
    if (i < kAccident && !is_alike) ++unlike;
  }
  if (shown_.size() >= kMajority && unlike <= 1) {
    // This also holds when the picture begins to move again after a rest.
    step.interval_ns = median;
  } else if (const double even_ns = even_interval_ns(); even_ns > 0) {
    step.interval_ns = std::llround(even_ns);
  }
  return step;
}

double LostFrames::correction(int64_t interval_ns, int64_t shown_for_ns, double speed_px_s) {
  double factor = 1;
  if (interval_ns > 0 && shown_for_ns != interval_ns && speed_px_s > 0 && speed_px_s_ > 0) {
    const double other = static_cast<double>(interval_ns) / static_cast<double>(shown_for_ns);
    const double off = std::abs(std::log(speed_px_s / speed_px_s_));
    const double other_off = std::abs(std::log(speed_px_s * other / speed_px_s_));
    if (other_off + std::log(1 + kSameInterval) < off) factor = other;
  }
  speed_px_s_ = factor * speed_px_s;
  return factor;
}

void Cadence::cut(int64_t time_ns) {
  begun_ = true;
  picture_ns_ = frame_ns_ = time_ns;
  frames_ = 1;
  has_changed_ = false;
}

}  // namespace spidar
