// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/learned/epipole.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace spidar {
namespace {

/// Fewer blocks that move against the background do not show an epipole.
constexpr int kLeastMoving = 12;
/// A motion of this many standard deviations is more than noise.
constexpr float kMovingSigmas = 2;
/// Share of a motion that may be across the direction towards the epipole: models of the background
/// leave as much of rotation and zoom.
constexpr float kAcrossShare = 0.3f;
/// Fits, each with the weights from the one before.
constexpr int kFits = 3;
/// Nearer to the epipole, directions are not known: units of ResidualMotion::at.
constexpr float kNearest = 0.1f;
constexpr float kLeastSigma_px = 0.02f;

float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

Eigen::Vector2f Epipole::direction(const Eigen::Vector2f& at) const {
  const Eigen::Vector2f towards = epipole_.head<2>() - epipole_.z() * at;
  const float length = towards.norm();
  return length > 0 ? Eigen::Vector2f(towards / length) : Eigen::Vector2f(1, 0);
}

/// Sets the sign of the epipole and the shares.
void Epipole::judge(const std::vector<ResidualMotion>& blocks, float least_px) {
  float along_px = 0;
  float moving = 0;
  float agreeing = 0;
  float all = 0;
  for (const ResidualMotion& block : blocks) {
    const Eigen::Vector2f towards = direction(block.at);
    along_px += block.weight * towards.dot(block.moved_px);
    all += block.weight;
    const float length_px = block.moved_px.norm();
    if (length_px <= least_px) continue;
    moving += block.weight;
    const float across_px = std::abs(cross(towards, block.moved_px));
    if (across_px < std::max(least_px, kAcrossShare * length_px)) agreeing += block.weight;
  }
  if (along_px < 0) epipole_ = -epipole_;
  agreeing_ = moving > 0 ? agreeing / moving : 0;
  moving_ = all > 0 ? moving / all : 0;
}

void Epipole::find(const std::vector<ResidualMotion>& blocks, float sigma_px) {
  sigma_px = std::max(sigma_px, kLeastSigma_px);
  const float least_px = kMovingSigmas * sigma_px;
  is_known_ = false;
  agreeing_ = moving_ = 0;
  const auto moving = std::count_if(blocks.begin(), blocks.end(), [&](const auto& block) {
    return block.moved_px.squaredNorm() > least_px * least_px;
  });
  if (moving < kLeastMoving) return;
  for (int fit = 0; fit < kFits; ++fit) {
    Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
    for (const ResidualMotion& block : blocks) {
      const Eigen::Vector2f& e = block.moved_px;
      float weight = block.weight;
      if (fit == 0) {  // each block tells a direction; how far it moves does not count
        weight /= sigma_px * sigma_px + e.squaredNorm();
      } else {
        const float across_px = cross(direction(block.at), e) / sigma_px;
        const float apart = (epipole_.head<2>() - epipole_.z() * block.at).norm();
        weight /= (1 + across_px * across_px) * std::max(apart * apart, kNearest * kNearest);
      }
      const Eigen::Vector3f line(e.y(), -e.x(), cross(e, block.at));
      sum += weight * line * line.transpose();
    }
    // Eigenvalues rise.
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(sum);
    epipole_ = solver.eigenvectors().col(0);
  }
  is_known_ = epipole_.allFinite();
  if (is_known_) judge(blocks, least_px);
}

}  // namespace spidar
