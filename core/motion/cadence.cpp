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
constexpr double kSameInterval = 0.2;
/// A single different interval among this many is an outlier, not part of a cadence. In a cadence,
/// at least one interval in five differs, as with 25 pictures a second in 30 frames. (With 24
/// pictures in 25 frames, one interval in 24 differs; to ignore that one makes the result only 4 %
/// too short.)
constexpr size_t kOutlierIn = 2 * 5;
/// Fewer pictures do not show a cadence. In the shortest cadence, two pictures are shown for
/// different times; kMinPictures are two of its periods.
constexpr size_t kMinPictures = 2 * 2;
/// Fewer intervals have no majority from which one could differ.
constexpr size_t kMinMajority = 3;

/// The slope of the line through `times` at 0, 1, 2 …, by least squares.
double slope_of(const double* times, size_t count) {
  const auto n = static_cast<double>(count);
  const double middle = (n - 1) / 2;
  double moment = 0;
  for (size_t i = 0; i < count; ++i) moment += (static_cast<double>(i) - middle) * times[i];
  return moment / (n * (n * n - 1) / 12);
}

}  // namespace

void Cadence::add_interval(const Shown& shown) {
  // At another playback rate, or with irregular frames, earlier intervals are not comparable.
  if (!shown_.empty()) {
    const double before = static_cast<double>(shown_[0].interval_ns) / shown_[0].frames;
    const double now = static_cast<double>(shown.interval_ns) / shown.frames;
    if (std::abs(now - before) > kSameInterval * before) shown_.clear();
  }
  shown_.add(shown);
}

/// Merges intervals that were split because the first repeated pictures of a coded film were taken
/// for new ones.
void Cadence::merge_split_intervals(const RepeatedPicture::Repeats& repeats) {
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

bool Cadence::has_repeats() const {
  for (size_t i = 0; i < shown_.size(); ++i) {
    if (shown_[i].frames > 1) return true;
  }
  return false;
}

/// How long the next picture may be shown: as long as the one before, or the second longest of the
/// latest intervals, because a single long one may have been a pause.
int64_t Cadence::expected_ns() const {
  int64_t longest_ns = 0, second_ns = 0;
  for (size_t i = 0; i < shown_.size(); ++i) {
    const int64_t interval_ns = shown_[i].interval_ns;
    second_ns = std::max(second_ns, std::min(longest_ns, interval_ns));
    longest_ns = std::max(longest_ns, interval_ns);
  }
  return std::max(second_ns, shown_[0].interval_ns);
}

int64_t Cadence::median_ns() const {
  std::array<int64_t, kPictures> sorted{};
  for (size_t i = 0; i < shown_.size(); ++i) sorted[i] = shown_[i].interval_ns;
  return median(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(shown_.size()));
}

/// Whether at most one of the latest intervals differs from this one.
bool Cadence::is_alike_but_for_one(int64_t interval_ns) const {
  size_t unlike = 0;
  for (size_t i = 0; i < std::min(shown_.size(), kOutlierIn); ++i) {
    const double off_ns = std::abs(static_cast<double>(shown_[i].interval_ns - interval_ns));
    if (off_ns >= kSameInterval * static_cast<double>(interval_ns)) ++unlike;
  }
  return shown_.size() >= kMinMajority && unlike <= 1;
}

/// The interval of the latest `pictures`, provided that they were taken at even intervals and that
/// each is first shown by the frame that follows it: the slope of the line through the times at
/// which the pictures were first shown. 0 when one of these times is further from the line than a
/// frame.
double Cadence::even_interval_ns(size_t pictures) const {
  std::array<double, kPictures + 1> first_shown_ns{};
  double frames = 0;
  for (size_t i = 0; i < pictures; ++i) {
    const Shown& shown = shown_[pictures - 1 - i];
    first_shown_ns[i + 1] = first_shown_ns[i] + static_cast<double>(shown.interval_ns);
    frames += shown.frames;
  }
  const double slope_ns = slope_of(first_shown_ns.data(), pictures + 1);
  double earliest_ns = 0, latest_ns = 0;
  for (size_t i = 0; i <= pictures; ++i) {
    const double off_ns = first_shown_ns[i] - slope_ns * static_cast<double>(i);
    earliest_ns = std::min(earliest_ns, off_ns);
    latest_ns = std::max(latest_ns, off_ns);
  }
  const double frame_ns = first_shown_ns[pictures] / frames;
  return latest_ns - earliest_ns <= (1 + kSameInterval) * frame_ns ? slope_ns : 0;
}

/// The time between two pictures in the cadence that as many as possible of the latest pictures
/// share; 0 if they share none.
int64_t Cadence::cadence_ns() const {
  if (!has_repeats()) return 0;
  // The interval that may differ can be a rest, after which the picture moves again.
  if (const int64_t median = median_ns(); is_alike_but_for_one(median)) return median;
  for (size_t pictures = shown_.size(); pictures >= kMinPictures; pictures /= 2) {
    if (const double even_ns = even_interval_ns(pictures); even_ns > 0) {
      return std::llround(even_ns);
    }
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

Cadence::Step Cadence::update(FrameComparison picture, int64_t time_ns,
                              const RepeatedPicture::Repeats& repeats) {
  const bool repeated = picture == FrameComparison::kSame;
  const bool waits = repeated && would_wait(time_ns);
  const int64_t frame_ns = std::max<int64_t>(time_ns - frame_ns_, 1);
  frame_ns_ = time_ns;
  if (repeated) {
    if (!has_repeats()) merge_split_intervals(repeats);
    ++frames_;
    // A picture at rest is measured frame by frame.
    return waits ? Step{true, 0, 0} : Step{false, frame_ns, frame_ns};
  }
  const Shown before{time_ns - picture_ns_, frames_};
  picture_ns_ = time_ns;
  frames_ = 1;
  has_changed_ = true;
  const bool is_compared = before.interval_ns <= kLongest_ns;
  if (is_compared && picture == FrameComparison::kOther) add_interval(before);
  const int64_t shown_for_ns = is_compared ? before.interval_ns : frame_ns;
  const int64_t learnt = cadence_ns();
  return {false, learnt > 0 ? learnt : shown_for_ns, shown_for_ns};
}

void Cadence::cut(int64_t time_ns) {
  picture_ns_ = frame_ns_ = time_ns;
  frames_ = 1;
  has_changed_ = false;
}

}  // namespace spidar
