// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/objects/turn_meter.h"

#include <algorithm>
#include <complex>
#include <iterator>

#include <Eigen/Cholesky>

namespace spidar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// How far an edge may be from its predicted place in each step, px of the field's picture. The
/// start is accurate to about a pixel; the result for an object that bends a little, to a quarter.
constexpr float kEdge_px[] = {1, 0.5F, 0.25F, 0.25F};
constexpr size_t kLastStep = std::size(kEdge_px) - 1;
/// After a later step that is shorter than this, px, only the last step follows, because the
/// omitted ones would hardly improve its start.
constexpr float kSettled_px = kEdge_px[kLastStep] / 2;
/// A slope of less than this many standard deviations of noise does not count.
constexpr float kSlopeSigmas = 3;
/// Standard error of the direction of a slope, rad: of central differences on the rim of a disc
/// that is one pixel soft.
constexpr float kSlopeError = 0.14F;
/// If less than this fraction of the apparent information about a parameter is real, errors of the
/// slopes determine it: the rim of a plain disc does not show how the disc rotates.
constexpr double kMinReliable = 0.75;
/// The fraction of the pixels of a rigid object that are within two standard deviations.
constexpr double kRigid = 0.95;
/// How far pixels that a similarity does not explain may be from their predicted place, px of the
/// field's picture: half of the error of a block's motion.
constexpr double kBends_px = kMaxOff_px / 2.0;

/// Grey level between pixels; nothing outside of the picture.
struct Sample {
  bool is_inside = false;
  float grey = 0;
  Vector2f fraction;

  Sample(const PaddedImage& picture, const Vector2f& at_px) {
    const auto right = static_cast<float>(picture.width() - 1);
    const auto bottom = static_cast<float>(picture.height() - 1);
    is_inside = at_px.x() >= 0 && at_px.x() <= right && at_px.y() >= 0 && at_px.y() <= bottom;
    if (!is_inside) return;
    const auto left = static_cast<int>(at_px.x());
    const auto top = static_cast<int>(at_px.y());
    fraction << at_px.x() - static_cast<float>(left), at_px.y() - static_cast<float>(top);
    const uint8_t* const a = picture.row(top) + left;
    const uint8_t* const b = a + picture.stride();
    const float a0 = a[0], a1 = a[1], b0 = b[0], b1 = b[1];
    const float upper = a0 + fraction.x() * (a1 - a0), lower = b0 + fraction.x() * (b1 - b0);
    grey = upper + fraction.y() * (lower - upper);
  }
};

/// The grey level of a pixel, blurred as interpolation blurs it at its former position.
template <typename Pixel>
float now_blurred(const Pixel& pixel, const Sample& before) {
  const Vector2f blur = before.fraction.cwiseProduct(Vector2f::Ones() - before.fraction);
  return pixel.grey + blur.dot(pixel.bend);
}

template <typename Value>
Value squared(Value value) {
  return value * value;
}

bool is_determined(const Eigen::LDLT<Eigen::Matrix4f>& equations) {
  const Eigen::Vector4f pivots = equations.vectorD();
  return pivots.minCoeff() > 1e-6F * pivots.maxCoeff();
}

/// Rotates and stretches a vector by `by`, as complex numbers.
Vector2f turned(const Vector2f& by, const Vector2f& what) {
  return {by.x() * what.x() - by.y() * what.y(), by.x() * what.y() + by.y() * what.x()};
}

/// (growth, roll) of the similarity that is nearest to a linear map A of displacements.
std::complex<double> similarity_in(const Eigen::Matrix2d& A) {
  return {(A(0, 0) + A(1, 1)) / 2, (A(1, 0) - A(0, 1)) / 2};
}

/// A of the motion of the background at a position.
Eigen::Matrix2d linear_at(const MotionModel& model, const Vector2d& at_px) {
  constexpr double kStep_px = kBlock_px;
  Eigen::Matrix2d A;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector2d step_px = kStep_px * Vector2d::Unit(axis);
    A.col(axis) =
        (model.displacement_px(at_px + step_px) - model.displacement_px(at_px - step_px)) /
        (2 * kStep_px);
  }
  return A;
}

/// Keeps at most `most` of the values, spread evenly: those whose index times the golden ratio has
/// a fractional part below the fraction that is kept. These parts fill an interval evenly and
/// without a period, whereas every n-th pixel would be in step with rows and with patterns n pixels
/// wide.
template <typename Value>
void thin_out(std::vector<Value>& values, size_t most) {
  if (values.size() <= most) return;
  constexpr double kGolden = 0.6180339887498949;  // (√5 − 1) / 2
  const double share = static_cast<double>(most) / static_cast<double>(values.size());
  size_t kept = 0;
  for (size_t i = 0; i < values.size() && kept < most; ++i) {
    const double at = kGolden * static_cast<double>(i);
    if (at - std::floor(at) < share) values[kept++] = values[i];
  }
  values.resize(kept);
}

}  // namespace

TurnMeter::TurnMeter() {
  slopes_.reserve(kMaxBlocks * kBlockArea_px);
  pixels_.reserve(kMaxPixels);
  sums_.reserve(kMaxBlocks);
}

void TurnMeter::collect_blocks(uint32_t key, const ObjectEvidence& evidence) {
  blocks_.reserve(evidence.owners.size());
  blocks_.clear();
  for (size_t i = 0; i < evidence.owners.size(); ++i) {
    if (evidence.owners[i] == key) blocks_.push_back(i);
  }
  thin_out(blocks_, kMaxBlocks);
  const auto n = static_cast<double>(blocks_.size());
  const auto centre_px = [&](size_t block) -> Vector2d {
    return evidence.field.blocks()[block].centre_px.cast<double>();
  };
  middle_px_.setZero();
  for (const size_t block : blocks_) middle_px_ += centre_px(block) / n;
  double square_px2 = kBlockArea_px / 6.0;  // of the pixels of a block
  for (const size_t block : blocks_) {
    square_px2 += (centre_px(block) - middle_px_).squaredNorm() / n;
  }
  reach_px_ = static_cast<float>(std::sqrt(square_px2));
}

/// Collects the pixels of the blocks that have a slope.
void TurnMeter::collect_slopes(const BlockField& field) {
  const PaddedImage& now = field.picture();
  noise_grey2_ = std::max(squared(kRounding_grey), field.noise_grey2());
  // The limit for twice a slope: each coordinate has the noise of a difference.
  const auto least2 = static_cast<int>(std::ceil(squared(kSlopeSigmas) * noise_grey2_));
  slopes_.clear();
  for (size_t k = 0; k < blocks_.size(); ++k) {
    const Eigen::Vector2i corner_px = field.grid().corner_of(blocks_[k]);
    for (int y = corner_px.y(); y < corner_px.y() + kBlock_px; ++y) {
      unsigned steep = steep_pixels({now.row(y) + corner_px.x(), now.stride()}, least2);
      for (int x = corner_px.x(); steep != 0; steep >>= 1, ++x) {
        if ((steep & 1U) != 0) slopes_.push_back({x, y, k});
      }
    }
  }
  thin_out(slopes_, kMaxPixels);
}

inline Vector2f TurnMeter::before_px(const Pixel& pixel, const Eigen::Vector4f& motion) const {
  return pixel.at_px - motion.head<2>() - turned(motion.tail<2>(), pixel.rho);
}

/// `start` is the approximate motion of the object.
TurnMeter::Pixel TurnMeter::describe(const Place& place, const Eigen::Vector4f& start,
                                     const ObjectEvidence& evidence) const {
  const PaddedImage& now = evidence.field.picture();
  const PaddedImage& before = evidence.field.before();
  const uint8_t* const here = now.row(place.y) + place.x;
  const int grey = *here, left = here[-1], right = here[1];
  const int above = *(here - now.stride()), below = *(here + now.stride());
  const auto half_of = [](int x, int y) -> Vector2f {
    return Eigen::Vector2i(x, y).cast<float>() / 2;
  };
  const Vector2d centre_px(now.width() - 1, now.height() - 1);
  Pixel pixel;
  pixel.block = place.block;
  pixel.at_px = Eigen::Vector2i(place.x, place.y).cast<float>();
  pixel.rho = (pixel.at_px - (middle_px_ + centre_px / 2).cast<float>()) / reach_px_;
  pixel.grey = static_cast<float>(grey);
  pixel.slope = half_of(right - left, below - above);
  pixel.bend = half_of(right + left - 2 * grey, below + above - 2 * grey);
  // The background counts both at the object's former place, and at its present place.
  const Vector2f behind_px = evidence.relative[blocks_[place.block]].background_px;
  const Vector2f from_px = before_px(pixel, start);
  const Sample there(before, pixel.at_px - behind_px), from(before, from_px);
  const Sample uncovered(now, from_px + behind_px);
  const bool is_seen = there.is_inside && from.is_inside && uncovered.is_inside;
  pixel.behind2 =
      is_seen ? std::min(squared(pixel.grey - there.grey), squared(uncovered.grey - from.grey)) : 0;
  return pixel;
}

TurnMeter::Sums TurnMeter::sum_up(const Eigen::Vector4f& motion, float edge_px,
                                  const PaddedImage& before) {
  Sums all;
  sums_.clear();
  auto pixel = pixels_.begin();
  for (size_t block = 0; block < blocks_.size(); ++block) {
    Sums sums;
    for (; pixel != pixels_.end() && pixel->block == block; ++pixel) {
      const Sample there(before, before_px(*pixel, motion));
      if (!there.is_inside) continue;
      const float r = now_blurred(*pixel, there) - there.grey;
      if (r * r > pixel->behind2) continue;
      const float slope2 = pixel->slope.squaredNorm();
      const float variance = noise_grey2_ + squared(edge_px) * slope2;
      const float w = squared(1 / (1 + r * r / (4 * variance))) / variance;
      const Vector2f& g = pixel->slope;
      const Vector2f& rho = pixel->rho;
      const Eigen::Vector4f J(g.x(), g.y(), g.dot(rho), g.y() * rho.x() - g.x() * rho.y());
      sums.information.noalias() += (w * J) * J.transpose();
      sums.gradient += w * r * J;
      sums.noise += w * (noise_grey2_ / 4 + squared(kSlopeError) * slope2) * rho.squaredNorm();
    }
    sums_.push_back(sums);
    all += sums;
  }
  return all;
}

/// The disagreement of the blocks, by a jackknife, which leaves out each block once. Infinite for a
/// parameter that one block alone determines. `step` is the result of all blocks.
Eigen::Vector4d TurnMeter::between_px2(const Sums& all, const Eigen::Vector4f& step) const {
  Eigen::Vector4d sum_px2 = Eigen::Vector4d::Zero();
  for (const Sums& sums : sums_) {
    const Eigen::LDLT<Eigen::Matrix4f> others(all.information - sums.information);
    if (!is_determined(others)) {
      return Eigen::Vector4d::Constant(std::numeric_limits<double>::infinity());
    }
    const Eigen::Vector4f off = sums.gradient - sums.information * step;
    sum_px2 += others.solve(off).cast<double>().cwiseAbs2();
  }
  const auto n = static_cast<double>(sums_.size());
  return (n - 1) / n * sum_px2;
}

Turn TurnMeter::measure(uint32_t key, const Region& region, const ObjectMotion& found,
                        const Turn& as_before, const ObjectEvidence& evidence) {
  Turn turn;
  collect_blocks(key, evidence);
  if (blocks_.empty()) return turn;
  collect_slopes(evidence.field);
  // A forward displacement a · (position before) is a backward one a / (1 + a) · (position now).
  const MotionModel& background = evidence.background.model;
  const Vector2d from_px = middle_px_ - region.relative_px - region.background_px;
  const std::complex<double> behind = similarity_in(linear_at(background, from_px));
  const std::complex<double> itself =
      found.model.kind == ModelKind::kSimilarity
          ? similarity_in(found.model.linear)
          : std::complex<double>(as_before.growth.value, as_before.roll_rad.value);
  const std::complex<double> back = (itself + behind) / (1.0 + itself + behind);
  const Vector2d moved_px =
      found.model.displacement_px(from_px) + background.displacement_px(from_px);
  const double reach_px = static_cast<double>(reach_px_);
  Eigen::Vector4f motion =
      Eigen::Vector4d(moved_px.x(), moved_px.y(), back.real() * reach_px, back.imag() * reach_px)
          .cast<float>();
  pixels_.clear();
  for (const Place& place : slopes_) pixels_.push_back(describe(place, motion, evidence));
  Sums all;
  Eigen::Matrix4f covariance;
  for (size_t step = 0; step <= kLastStep;) {
    all = sum_up(motion, kEdge_px[step], evidence.field.before());
    const Eigen::LDLT<Eigen::Matrix4f> ldlt(all.information);
    if (!is_determined(ldlt)) return turn;
    const Eigen::Vector4f by = ldlt.solve(all.gradient);
    motion -= by;
    if (step == kLastStep) covariance = ldlt.solve(Eigen::Matrix4f::Identity());
    const bool is_settled = step > 0 && step < kLastStep && by.cwiseAbs().maxCoeff() < kSettled_px;
    step = is_settled ? kLastStep : step + 1;
  }
  const auto difference2 = [&](const Pixel& pixel, const Vector2f& there_px) {
    const Sample there(evidence.field.before(), there_px);
    return there.is_inside ? squared(now_blurred(pixel, there) - there.grey) : pixel.behind2;
  };
  // Parts that bend show less of the rotation of the whole.
  int own = 0, explained = 0;
  for (const Pixel& pixel : pixels_) {
    const float most2 =
        4 * (noise_grey2_ + squared(kEdge_px[kLastStep]) * pixel.slope.squaredNorm());
    if (pixel.behind2 < most2) continue;
    ++own;
    explained += difference2(pixel, before_px(pixel, motion)) < most2;
  }
  const double bends_px = kBends_px * std::max(0.0, kRigid - explained / std::max(1.0, 1.0 * own));
  const std::complex<double> found_back = std::complex<double>(motion[2], motion[3]) / reach_px;
  const std::complex<double> forth = found_back / (1.0 - found_back) - behind;
  const Eigen::Vector4d of_blocks_px2 = between_px2(all, covariance * all.gradient);
  // The variance is that of the noise or of the disagreeing blocks, whichever is larger. If errors
  // of the slopes determine the parameter, nothing is known about it.
  const auto estimate = [&](double value, int parameter) {
    const float of_noise_px2 = covariance(parameter, parameter);
    const double reliable = 1 - static_cast<double>(all.noise * of_noise_px2);
    if (!(reliable > kMinReliable)) return Estimate{value};
    const double px2 =
        std::max(static_cast<double>(of_noise_px2), of_blocks_px2[parameter]) / squared(reliable) +
        squared(bends_px);
    return Estimate{value, std::sqrt(px2) / reach_px, kSharedError_px / reach_px};
  };
  turn.growth = estimate(forth.real(), 2);
  turn.roll_rad = estimate(std::arg(1.0 + forth), 3);
  return turn;
}

}  // namespace spidar
