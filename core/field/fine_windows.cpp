// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/fine_windows.h"

#include <cmath>

#include <Eigen/LU>

#include "core/picture/luma.h"

namespace spidar {
namespace {

/// Number of steps. After a motion of a whole pixel, the second step removes the error that the
/// first one leaves.
constexpr int kSteps = 2;
/// The texture that a window must have: the smaller eigenvalue of its structure tensor, per pixel,
/// (grey / px)². With less, noise of two grey levels moves the window by more than a fifth of a
/// pixel.
constexpr float kMinTexture = 0.2f;
/// The largest mean squared difference between a window and its match, as a fraction of its
/// variance. A window on the rim of an object shows the background, too, and exceeds this.
constexpr float kMaxResidual = 0.05f;

/// Reads a square of the frame whose upper left pixel is (`left`, `top`). Returns false where the
/// square is not inside the frame.
bool read_square(const ImageView& frame, int left, int top, int side, std::vector<uint8_t>& row,
                 float* to) {
  if (left < 0 || top < 0 || left + side > frame.width || top + side > frame.height) return false;
  row.resize(static_cast<size_t>(side));
  for (int y = 0; y < side; ++y) {
    copy_row(frame, left, top + y, side, row.data());
    for (int x = 0; x < side; ++x) *to++ = row[static_cast<size_t>(x)];
  }
  return true;
}

/// The block that contains a position, or the nearest one. The position is relative to the centre
/// of the field's picture.
size_t block_at(const BlockField& field, const Eigen::Vector2d& at_px) {
  const PaddedImage& picture = field.picture();
  return field.grid().block_at(at_px + Eigen::Vector2d(picture.width(), picture.height()) / 2);
}

}  // namespace

FineWindows::FineWindows() {
  windows_.reserve(kMax);
  found_.reserve(kMax);
}

/// Reads the pixels of a window whose position is set. Returns false if the window is not inside
/// the frame or has too little texture.
bool FineWindows::read(const ImageView& frame, Template& window) {
  constexpr int kAround = kSide_px + 2;
  if (!read_square(frame, window.left_px - 1, window.top_px - 1, kAround, row_, patch_.data())) {
    return false;
  }
  float sum = 0, squares = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (int j = 0; j < kSide_px; ++j) {
    const float* pixel = patch_.data() + (j + 1) * kAround + 1;
    const auto row = static_cast<size_t>(j * kSide_px);
    for (int i = 0; i < kSide_px; ++i, ++pixel) {
      const size_t k = row + static_cast<size_t>(i);
      const float gx = (pixel[1] - pixel[-1]) / 2;
      const float gy = (pixel[kAround] - pixel[-kAround]) / 2;
      window.grey[k] = *pixel;
      window.x_slope[k] = gx;
      window.y_slope[k] = gy;
      sum += *pixel;
      squares += *pixel * *pixel;
      x += gx;
      y += gy;
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  }
  // The means are removed, because a change of brightness common to all pixels is not motion.
  const auto n = static_cast<float>(kPixels);
  for (float& grey : window.grey) grey -= sum / n;
  for (float& slope : window.x_slope) slope -= x / n;
  for (float& slope : window.y_slope) slope -= y / n;
  window.structure << xx - x * x / n, xy - x * y / n, xy - x * y / n, yy - y * y / n;
  window.variance = squares / n - sum / n * sum / n;
  return smaller_eigenvalue(window.structure) > kMinTexture * n;
}

void FineWindows::store_one(const ImageView& frame, const BlockField& field,
                            const FieldPosition& position, size_t block) {
  const Eigen::Vector2d at_px =
      position.centre_px + position.scale * field.blocks()[block].centre_px.cast<double>();
  windows_.emplace_back();
  Template& window = windows_.back();
  window.block = block;
  window.left_px = static_cast<int>(std::lround(at_px.x())) - kSide_px / 2;
  window.top_px = static_cast<int>(std::lround(at_px.y())) - kSide_px / 2;
  if (!read(frame, window)) windows_.pop_back();
}

void FineWindows::store(const ImageView& frame, const BlockField& field,
                        const FieldPosition& position, const std::vector<size_t>& blocks) {
  windows_.clear();
  const size_t every = 1 + blocks.size() / (kMax + 1);
  for (size_t i = 0; i < blocks.size() && windows_.size() < kMax; i += every) {
    store_one(frame, field, position, blocks[i]);
  }
}

/// Computes one Gauss–Newton step for a window at `offset_px` from the middle of patch_. Returns
/// false if the offset is out of reach.
bool FineWindows::step(const Template& window, const Eigen::Vector2f& offset_px,
                       Eigen::Vector2f& step_px, float& residual) const {
  if (!(offset_px.cwiseAbs().maxCoeff() <= kReach_px)) return false;
  const Eigen::Vector2f from = offset_px + Eigen::Vector2f::Constant(kReach_px);
  const auto left = static_cast<int>(from.x());
  const auto top = static_cast<int>(from.y());
  const float fx = from.x() - static_cast<float>(left);
  const float fy = from.y() - static_cast<float>(top);
  float sum = 0, squares = 0, x = 0, y = 0;
  for (int j = 0; j < kSide_px; ++j) {
    const float* a = patch_.data() + (top + j) * kPatch_px + left;
    const float* b = a + kPatch_px;
    const auto row = static_cast<size_t>(j * kSide_px);
    for (int i = 0; i < kSide_px; ++i) {
      const size_t k = row + static_cast<size_t>(i);
      const float upper = a[i] + fx * (a[i + 1] - a[i]);
      const float lower = b[i] + fx * (b[i + 1] - b[i]);
      const float d = upper + fy * (lower - upper) - window.grey[k];
      sum += d;
      squares += d * d;
      x += d * window.x_slope[k];
      y += d * window.y_slope[k];
    }
  }
  const auto n = static_cast<float>(kPixels);
  residual = squares / n - sum / n * sum / n;
  step_px = -(window.structure.inverse() * Eigen::Vector2f(x, y));
  return true;
}

/// Finds a window in `frame`. On entry `moved_px` is the motion of its block, on return that of the
/// window, px of the frame. Returns false if the window is lost.
bool FineWindows::match(const ImageView& frame, const Template& window, Eigen::Vector2d& moved_px) {
  const Eigen::Vector2d whole_px(std::round(moved_px.x()), std::round(moved_px.y()));
  // Reject a motion that is not finite, or leads far outside the frame.
  if (!(whole_px.cwiseAbs().maxCoeff() < frame.width + frame.height)) return false;
  const int left = window.left_px + static_cast<int>(whole_px.x()) - kReach_px;
  const int top = window.top_px + static_cast<int>(whole_px.y()) - kReach_px;
  if (!read_square(frame, left, top, kPatch_px, row_, patch_.data())) return false;
  Eigen::Vector2f offset_px = (moved_px - whole_px).cast<float>();
  float residual = 0;
  for (int n = 0; n < kSteps; ++n) {
    Eigen::Vector2f step_px;
    if (!step(window, offset_px, step_px, residual)) return false;
    offset_px += step_px;
  }
  if (!(offset_px.cwiseAbs().maxCoeff() <= kReach_px)) return false;
  moved_px = whole_px + offset_px.cast<double>();
  return residual < kMaxResidual * window.variance;
}

const std::vector<FineMotion>& FineWindows::find(const ImageView& frame, const BlockField& field,
                                                 const FieldPosition& position) {
  found_.clear();
  const auto moved_with = [&](size_t block) -> Eigen::Vector2d {
    return field.blocks()[block].moved_px.cast<double>();
  };
  for (const Template& window : windows_) {
    // The motion of the block at the window's old position gives a first estimate of the new
    // position. The block at this estimate then gives the motion.
    const Eigen::Vector2d corner_px(window.left_px, window.top_px);
    const Eigen::Vector2d middle_px = corner_px + Eigen::Vector2d::Constant((kSide_px - 1) / 2.0);
    const Eigen::Vector2d from_px = (middle_px - position.centre_px) / position.scale;
    const size_t there = block_at(field, from_px + moved_with(block_at(field, from_px)));
    Eigen::Vector2d moved_px = position.scale * moved_with(there);
    if (!match(frame, window, moved_px)) continue;
    moved_px /= position.scale;
    found_.push_back({block_at(field, from_px + moved_px), from_px, moved_px});
  }
  return found_;
}

}  // namespace spidar
