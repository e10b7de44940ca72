// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/parallax.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/motion/camera/robust_fit.h"
#include "core/quantile.h"

namespace spidar {
namespace {

/// The direction in which most blocks move. A block that moves little says little about it, and one
/// that moves far no more than any other.
Eigen::Vector2f direction_of(const std::vector<Eigen::Vector2f>& moved_px, float middle_px2) {
  float unequal = 0;
  float mixed = 0;
  for (const Eigen::Vector2f& px : moved_px) {
    const float size_px2 = px.squaredNorm() + middle_px2;
    if (size_px2 == 0) continue;
    unequal += (px.x() * px.x() - px.y() * px.y()) / size_px2;
    mixed += 2 * px.x() * px.y() / size_px2;
  }
  const float angle_rad = std::atan2(mixed, unequal) / 2;
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

}  // namespace

/// Medians, because of the blocks that move by themselves.
void Parallax::measure(const std::vector<Eigen::Vector2f>& moved_px) {
  covariance_px2_.setZero();
  if (moved_px.empty()) return;
  sizes_.reserve(moved_px.capacity());
  sizes_.clear();
  for (const Eigen::Vector2f& px : moved_px) sizes_.push_back(px.squaredNorm());
  const Eigen::Vector2f along = direction_of(moved_px, median(sizes_.begin(), sizes_.end()));
  for (const Eigen::Vector2f& axis : {along, Eigen::Vector2f(-along.y(), along.x())}) {
    for (size_t i = 0; i < moved_px.size(); ++i) sizes_[i] = std::abs(axis.dot(moved_px[i]));
    const double middle_px = static_cast<double>(median(sizes_.begin(), sizes_.end()));
    const auto sigma_px = static_cast<float>(std::max(middle_px / kNormalMedian, kSharedError_px));
    covariance_px2_ += sigma_px * sigma_px * axis * axis.transpose();
  }
}

double Parallax::sigma_px(const Eigen::Vector2d& motion) const {
  const Eigen::Matrix2d covariance_px2 = covariance_px2_.cast<double>();
  if (!(covariance_px2.determinant() > 0) || motion.isZero()) return 0;
  const Eigen::Vector2d direction = motion.normalized();
  return 1 / std::sqrt(direction.dot(covariance_px2.inverse() * direction));
}

}  // namespace spidar
