// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/page_scroll.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/picture/opencv.h"

namespace spidar {
namespace {

/// A patch looks for detail in this many lines from its place: lines of text are less far apart.
constexpr int kDetailWithin_px = 32;
/// How many of the changed patches are searched. If films have half of the patches of a page, all
/// tries fall into films in one of 64 scrolled pictures.
constexpr int kTries = 6;
/// At least this many patches must have scrolled, minus those that a step takes out of a window of
/// half the picture's height, in columns or rows where no other patches have changed. Fewer may be
/// an object before a plain wall, of which encoders make exact copies: a third of both sides
/// touches 16.
constexpr int kMinScrolled = 20;
/// The height of the picture over the largest step: the analysis does not follow a larger one
/// either, and takes the picture for a cut.
constexpr int kHeightsOfStep = 4;

/// For this many pictures, the content of a scrolling page has rested before, or has only scrolled.
/// The content of a panning camera moves in other directions, too: between two of its pictures are
/// up to five repetitions, in a film of 24 pictures a second on a screen of 144 Hz.
constexpr int kRests = 6;

/// Readable text has a contrast of at least 3:1 (WCAG 2.1, 1.4.3): from black on, 89 grey levels.
/// The traces of encoders around copied objects are below a third of that.
constexpr int kPlain_grey = 30;

/// Whether the pixels of a line of a patch differ by more than that. Otherwise every edge between
/// two plain parts would look like every other.
bool varies(const uint8_t* line, const LumaSample& sample) {
  if (sample.bytes == 1) {
    const cv::v_uint8x16 pixels = cv::v_load(line);
    return cv::v_reduce_max(pixels) - cv::v_reduce_min(pixels) > kPlain_grey;
  }
  const cv::v_uint16x8 words = cv::v_load(reinterpret_cast<const ushort*>(line));
  return (cv::v_reduce_max(words) - cv::v_reduce_min(words)) >> sample.shift > kPlain_grey;
}

uint64_t begin_of(const uint8_t* line) {
  uint64_t begin;
  std::memcpy(&begin, line, sizeof begin);
  return begin;
}

}  // namespace

void PageScroll::store(const ImageView& picture) {
  width_ = picture.width;
  height_ = picture.height;
  bytes_ = picture.sample.bytes;
  size_t i = 0;
  for (int row = 0; row < kDown; ++row) {
    const int top = row * height_ / kDown;
    const int below = std::min({(row + 1) * height_ / kDown, top + kDetailWithin_px, height_ - 1});
    for (int column = 0; column < kAcross; ++column) {
      Patch& patch = patches_[i++];
      patch.has_detail = false;
      patch.x = std::min((2 * column + 1) * width_ / (2 * kAcross), width_ - kPatch_bytes);
      for (patch.y = top; patch.y < below && !patch.has_detail; ++patch.y) {
        const uint8_t* const upper = picture.at(patch.x, patch.y);
        const uint8_t* const lower = picture.at(patch.x, patch.y + 1);
        patch.has_detail = std::memcmp(upper, lower, kPatch_bytes) != 0 &&
                           (varies(upper, picture.sample) || varies(lower, picture.sample));
      }
      if (!patch.has_detail) continue;
      --patch.y;
      std::memcpy(patch.upper.data(), picture.at(patch.x, patch.y), kPatch_bytes);
      std::memcpy(patch.lower.data(), picture.at(patch.x, patch.y + 1), kPatch_bytes);
    }
  }
}

bool PageScroll::compare(const ImageView& picture) {
  std::array<const Patch*, kAcross * kDown> changed;
  int count = 0;
  const auto is_at = [&](const Patch& patch, int y) {
    return y >= 0 && y + 1 < height_ &&
           std::memcmp(patch.upper.data(), picture.at(patch.x, y), kPatch_bytes) == 0 &&
           std::memcmp(patch.lower.data(), picture.at(patch.x, y + 1), kPatch_bytes) == 0;
  };
  const Cells rested = rests_;
  for (size_t i = 0; i < patches_.size(); ++i) {
    const Patch& patch = patches_[i];
    const bool has_changed = patch.has_detail && !is_at(patch, patch.y);
    if (has_changed) changed[static_cast<size_t>(count++)] = &patch;
    rests_[i] = has_changed ? 0 : std::min(rests_[i] + 1, kRests);
  }
  const auto scrolls = [&](int step, int least_rests) {
    const int least = kMinScrolled * (height_ - 2 * std::abs(step)) / height_;
    std::array<int, kAcross> in_column{};
    std::array<int, kDown> in_row{};
    std::array<bool, kAcross> column_differs{};
    std::array<bool, kDown> row_differs{};
    for (int i = 0; i < count; ++i) {
      const Patch& patch = *changed[static_cast<size_t>(i)];
      const int y = patch.y + step;
      if (y < 0 || y + 1 >= height_) continue;
      const auto at = static_cast<size_t>(&patch - patches_.data());
      const size_t column = at % kAcross, row = at / kAcross;
      const bool is_found = is_at(patch, y);
      in_column[column] += is_found && rested[at] >= least_rests;
      in_row[row] += is_found && rested[at] >= least_rests;
      column_differs[column] |= !is_found;
      row_differs[row] |= !is_found;
    }
    const auto sum = [](const auto& found, const auto& differs) {
      int all = 0;
      for (size_t i = 0; i < found.size(); ++i) all += differs[i] ? 0 : found[i];
      return all;
    };
    return std::max(sum(in_column, column_differs), sum(in_row, row_differs)) >= least;
  };
  for (int k = 0; k < kTries && count > 0; ++k) {
    const Patch& patch = *changed[static_cast<size_t>((2 * k + 1) * count / (2 * kTries))];
    const uint64_t begin = begin_of(patch.upper.data());
    const int reach = height_ / kHeightsOfStep;
    const int last = std::min(patch.y + reach, height_ - 2);
    for (int y = std::max(patch.y - reach, 0); y <= last; ++y) {
      if (begin_of(picture.at(patch.x, y)) != begin) continue;
      if (y == patch.y || !is_at(patch, y) || !scrolls(y - patch.y, 0)) continue;
      rests_.fill(kRests);
      return scrolls(y - patch.y, kRests);
    }
  }
  return false;
}

bool PageScroll::update(const ImageView& picture) {
  const bool is_comparable =
      picture.width == width_ && picture.height == height_ && picture.sample.bytes == bytes_;
  if (!is_comparable) rests_.fill(kRests);
  const bool scrolls = is_comparable && compare(picture);
  store(picture);
  return scrolls;
}

}  // namespace spidar
