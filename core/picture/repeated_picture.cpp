// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/repeated_picture.h"

#include <algorithm>
#include <cstdlib>

#include "core/picture/opencv.h"

namespace spidar {
namespace {

constexpr int kComparedBlock_px = 16;

/// Σ |a − b| over a block.
unsigned block_change(const ImageView& a, const ImageView& b, int x, int y, int columns, int rows) {
  unsigned sum = 0;
  for (int j = 0; j < rows; ++j) {
    const uint8_t* p = a.at(x, y + j);
    const uint8_t* q = b.at(x, y + j);
    for (int i = 0; i < columns; ++i) sum += static_cast<unsigned>(std::abs(p[i] - q[i]));
  }
  return sum;
}

unsigned whole_block_change(const ImageView& a, const ImageView& b, int x, int y) {
  DifferenceSum sum;
  for (int j = 0; j < kComparedBlock_px; ++j) sum.add(a.at(x, y + j), b.at(x, y + j));
  return sum.total();
}

class LargestMean {
 public:
  void add(float value) {
    if (value <= largest_[kChangedBlocks - 1]) return;
    size_t position = kChangedBlocks - 1;
    for (; position > 0 && largest_[position - 1] < value; --position) {
      largest_[position] = largest_[position - 1];
    }
    largest_[position] = value;
  }

  /// Mean of the largest of `count` values; of all if there are fewer than kChangedBlocks.
  float mean(size_t count) const {
    float sum = 0;
    for (const float value : largest_) sum += value;
    return sum / static_cast<float>(std::clamp<size_t>(count, 1, kChangedBlocks));
  }

 private:
  std::array<float, kChangedBlocks> largest_{};  ///< in descending order
};

}  // namespace

float largest_change(const ImageView& before, const ImageView& now) {
  LargestMean most;
  size_t blocks = 0;
  for (int y = 0; y < now.height; y += kComparedBlock_px) {
    const int rows = std::min(kComparedBlock_px, now.height - y);
    for (int x = 0; x < now.width; x += kComparedBlock_px) {
      const int columns = std::min(kComparedBlock_px, now.width - x);
      const bool whole = columns == kComparedBlock_px && rows == kComparedBlock_px;
      const unsigned sum = whole ? whole_block_change(before, now, x, y)
                                 : block_change(before, now, x, y, columns, rows);
      most.add(static_cast<float>(sum) / static_cast<float>(rows * columns));
      ++blocks;
    }
  }
  return most.mean(blocks);
}

RepeatedPicture::Rhythm RepeatedPicture::rhythm(float fraction) const {
  Rhythm rhythm;
  float largest = 0;  // the largest change of the run
  size_t begin = 0;   // of the run, in frames ago
  bool in_run = false;
  for (size_t i = changes_.size(); i-- > 0;) {
    const float change = changes_[i];
    if (in_run && fraction * change > largest) {
      ++rhythm.dips;
      for (size_t k = begin; k > i; --k) rhythm.is_dip[k] = true;
      in_run = false;
    }
    if (change < fraction * rhythm.large) {
      largest = in_run ? std::max(largest, change) : change;
      if (!in_run) begin = i;
      in_run = true;
    } else {
      rhythm.large_before = rhythm.large;
      rhythm.large = change;
      rhythm.large_age = i;
      in_run = false;
    }
  }
  return rhythm;
}

/// Whether the changes one and two periods ago were in dips, and not every change since then was.
bool RepeatedPicture::is_due(const Rhythm& rhythm) const {
  for (size_t period = 2; 2 * period <= changes_.size(); ++period) {
    if (!rhythm.is_dip[period - 1] || !rhythm.is_dip[2 * period - 1]) continue;
    for (size_t i = 0; i + 1 < period; ++i) {
      if (!rhythm.is_dip[i]) return true;
    }
  }
  return false;
}

bool RepeatedPicture::is_small(float change) const {
  const Rhythm any = rhythm(kFraction);
  if (any.dips >= kMinDips && change < kFraction * any.large) return true;
  const float least =
      had_rhythm_ ? kFraction * any.large : kFractionAtOnce * std::min(any.large, any.large_before);
  if (any.large_age < kMaxAtOnce && change < least) return true;
  const Rhythm periodic = rhythm(kFractionWhenDue);
  return change < kFractionWhenDue * periodic.large && is_due(periodic);
}

RepeatedPicture::Repeats RepeatedPicture::repeats() const {
  Repeats repeats = rhythm(kFraction).is_dip;
  // The changes of the first picture have no larger change before them.
  float largest = 0;
  for (size_t i = changes_.size(); i-- > 0;) {
    if (largest < kFraction * changes_[i]) {
      std::fill(repeats.begin() + static_cast<ptrdiff_t>(i) + 1,
                repeats.begin() + static_cast<ptrdiff_t>(changes_.size()), true);
      if (i + 1 < changes_.size()) break;
    }
    largest = std::max(largest, changes_[i]);
  }
  for (auto begin = repeats.begin(); begin != repeats.end();) {
    begin = std::find(begin, repeats.end(), true);
    const auto end = std::find(begin, repeats.end(), false);
    if (end - begin > static_cast<ptrdiff_t>(kMaxAtOnce)) std::fill(begin, end, false);
    begin = end;
  }
  return repeats;
}

void RepeatedPicture::cut() {
  had_rhythm_ = had_rhythm_ || rhythm(kFraction).dips >= kMinDips;
  changes_.clear();
}

FrameComparison RepeatedPicture::compare(const ImageView& before, const ImageView& now) {
  const float change = largest_change(before, now);
  const bool alike = is_small(change);
  changes_.add(change);
  if (changes_.size() == kFrames) had_rhythm_ = false;
  if (change == 0) return FrameComparison::kSame;
  return alike ? FrameComparison::kAlike : FrameComparison::kOther;
}

}  // namespace spidar
