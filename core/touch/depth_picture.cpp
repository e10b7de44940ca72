// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/depth_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "core/require.h"

namespace spidar::touch {
namespace {

constexpr int kMaxSample = 65535;
constexpr auto kCells = static_cast<size_t>(HeightField::kCells);
constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// Index of the n-th of `wanted` evenly spaced lines out of `count`.
int chosen(int nth, int wanted, int count) noexcept {
  return static_cast<int>((2LL * nth + 1) * count / (2LL * wanted));
}

}  // namespace

ImageView picture_half(const ImageView& packed, DepthLayout layout) noexcept {
  ImageView half = packed;
  (layout == DepthLayout::kRight ? half.width : half.height) /= 2;
  return half;
}

ImageView depth_half(const ImageView& packed, DepthLayout layout) noexcept {
  ImageView half = picture_half(packed, layout);
  if (packed.data == nullptr || half.width == 0 || half.height == 0) return {};
  half.data = packed.at(packed.width - half.width, packed.height - half.height);
  return half;
}

void validate(const DepthSettings& s) {
  require(std::isfinite(s.near_sample) && s.near_sample <= kMaxSample, "Depth", "near",
          "at most 65535, or -1 to be found", s.near_sample);
  require(std::isfinite(s.far_sample) && s.far_sample <= kMaxSample, "Depth", "far",
          "at most 65535, or -1 to be found", s.far_sample);
  if (s.near_sample < 0 || s.far_sample < 0) return;
  const std::string far = "far (" + std::to_string(s.far_sample) + ")";
  if (s.disparity) {
    require(s.near_sample > s.far_sample, "Depth", "near",
            ("more than " + far + " in a disparity").c_str(), s.near_sample);
  } else {
    require(s.near_sample < s.far_sample, "Depth", "near",
            ("less than " + far + " in a distance").c_str(), s.near_sample);
  }
}

DepthPicture::DepthPicture() : cells_(kCells, kHole), levels_(kCells, kHole) {
  sorted_.reserve(kCells);
}

bool DepthPicture::read(const ImageView& depth, const DepthSettings& settings, double dt_s) {
  if (depth.data == nullptr || depth.width <= 0 || depth.height <= 0) return false;
  if (!average(depth, settings.has_holes)) return false;
  const bool same = settings.disparity == settings_.disparity &&
                    settings.near_sample == settings_.near_sample &&
                    settings.far_sample == settings_.far_sample;
  if (!same) has_range_ = false;
  settings_ = settings;
  follow(settings, dt_s);
  const auto far = static_cast<float>(far_);
  const auto scale = static_cast<float>(1 / (near_ - far_));
  for (size_t i = 0; i < kCells; ++i) {
    const float level = (cells_[i] - far) * scale;
    // These comparisons keep NaN.
    levels_[i] = level < 0 ? 0 : level > 1 ? 1 : level;
  }
  return true;
}

/// Returns false if all cells are holes.
bool DepthPicture::average(const ImageView& depth, bool has_holes) {
  const int width = std::min(depth.width, kSamplesAcross * HeightField::kColumns);
  const int height = std::min(depth.height, kSamplesAcross * HeightField::kRows);
  if (width != read_width_ || depth.width != from_width_) {
    column_.resize(static_cast<size_t>(width));
    for (int x = 0; x < width; ++x) column_[static_cast<size_t>(x)] = chosen(x, width, depth.width);
    read_width_ = width;
    from_width_ = depth.width;
  }
  average_.read(
      width, height,
      [&](int y, float* values) {
        read_row(depth, chosen(y, height, depth.height), has_holes, values);
      },
      cells_.data());
  return std::any_of(cells_.begin(), cells_.end(), [](float cell) { return !std::isnan(cell); });
}

void DepthPicture::read_row(const ImageView& depth, int y, bool has_holes,
                            float* values) const noexcept {
  const uint8_t* const row = depth.data + y * depth.stride_bytes;
  const size_t count = column_.size();
  if (depth.sample.bytes == 1) {
    for (size_t x = 0; x < count; ++x) values[x] = row[column_[x]];
  } else {
    const int high = depth.sample.big_endian ? 0 : 1;
    for (size_t x = 0; x < count; ++x) {
      const uint8_t* const word = row + 2 * column_[x];
      values[x] = static_cast<float>(word[high] * 256 + word[1 - high]);
    }
  }
  if (!has_holes) return;
  const float most = depth.sample.bytes == 1 ? kMaxSample + 1.0F : kMaxSample;
  for (size_t x = 0; x < count; ++x) {
    if (values[x] == 0 || values[x] == most) values[x] = kHole;
  }
}

/// The lower and the upper percentile, rounded to whole samples. At least one cell must not be a
/// hole.
std::pair<double, double> DepthPicture::percentiles() noexcept {
  sorted_.clear();
  std::copy_if(cells_.begin(), cells_.end(), std::back_inserter(sorted_),
               [](float cell) { return !std::isnan(cell); });
  const auto outside = static_cast<ptrdiff_t>(kOutside * static_cast<double>(sorted_.size()));
  const auto nth = [&](auto at) {
    std::nth_element(sorted_.begin(), at, sorted_.end());
    return std::floor(static_cast<double>(*at + 0.5F));
  };
  return {nth(sorted_.begin() + outside), nth(sorted_.end() - 1 - outside)};
}

/// Whether more than kCut of the cells lie beyond the estimated ends.
bool DepthPicture::is_cut(const DepthSettings& settings) const noexcept {
  const double sign = settings.disparity ? -1 : 1;
  const double nearest = settings.near_sample < 0 ? sign * near_ : -HUGE_VAL;
  const double farthest = settings.far_sample < 0 ? sign * far_ : HUGE_VAL;
  int cells = 0;
  int outside = 0;
  for (const float cell : cells_) {
    if (std::isnan(cell)) continue;
    ++cells;
    outside += sign * cell < nearest || sign * cell > farthest ? 1 : 0;
  }
  return outside > kCut * cells;
}

void DepthPicture::follow(const DepthSettings& settings, double dt_s) noexcept {
  const bool finds_near = settings.near_sample < 0;
  const bool finds_far = settings.far_sample < 0;
  double near = settings.near_sample;
  double far = settings.far_sample;
  if (finds_near || finds_far) {
    const auto [low, high] = percentiles();
    if (finds_near) near = settings.disparity ? high : low;
    if (finds_far) far = settings.disparity ? low : high;
    // Widens a narrow range about its middle, or away from the end that is set.
    const double sign = settings.disparity ? -1 : 1;
    const double least = std::max(kMinSpan, kMinFraction * std::max(near, far));
    const double lacking = least - sign * (far - near);
    if (lacking > 0) {
      const double fraction = finds_near && finds_far ? 0.5 : 1;
      if (finds_near) near -= sign * fraction * lacking;
      if (finds_far) far += sign * fraction * lacking;
    }
    if (has_range_ && !is_cut(settings)) {
      const double step = dt_s > 0 ? 1 - std::exp(-dt_s / kRange_s) : 0;
      if (finds_near) near = near_ + step * (near - near_);
      if (finds_far) far = far_ + step * (far - far_);
    }
  }
  near_ = near;
  far_ = far;
  has_range_ = true;
}

}  // namespace spidar::touch
