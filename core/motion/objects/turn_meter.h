// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "core/motion/layers/regions.h"
#include "core/motion/objects/moving_object.h"
#include "core/motion/objects/object_motion.h"

namespace spidar {

/// A value with its errors.
struct Estimate {
  double value = 0;
  /// Standard error of the part that differs from frame to frame; infinite without evidence.
  double sigma = std::numeric_limits<double>::infinity();
  double shared = 0;  ///< standard error of the lasting part: that of kSharedError_px
};

/// How an object rotates and grows against the background between two frames.
struct Turn {
  Estimate roll_rad;  ///< from x to y: clockwise on the screen
  Estimate growth;    ///< relative change of lengths
};

/// Measures how much an object rotates and grows from one frame to the next. Fits a similarity to
/// the pixels of the object by Gauss–Newton steps from its motion, with weights of Geman and
/// McClure (inverse compositional: Baker and Matthews: Lucas–Kanade 20 years on, IJCV 2004). Blocks
/// that show one edge each determine the rotation together, although each of them leaves the motion
/// along its edge open. Pixels of either picture that the background explains better are left out,
/// because parts that the object uncovers would pull its rim along.
class TurnMeter {
 public:
  TurnMeter();

  /// `found` is the motion of the object `key`, and `as_before` its present rotation and growth if
  /// it continued as before.
  Turn measure(uint32_t key, const Region& region, const ObjectMotion& found, const Turn& as_before,
               const ObjectEvidence& evidence);

  /// Limits that bound the time for a frame. If there are more blocks or pixels, an evenly spread
  /// part of them is used. With half as many pixels, the growth of a plain disc is lost
  /// (`spidar-bench turns`).
  static constexpr size_t kMaxBlocks = 32;
  static constexpr size_t kMaxPixels = 512;

 private:
  struct Place {
    int x, y;
    size_t block;  ///< index in blocks_
  };
  struct Pixel {
    size_t block;
    Eigen::Vector2f at_px;
    Eigen::Vector2f rho;
    float grey;
    Eigen::Vector2f slope;  ///< grey levels per pixel
    Eigen::Vector2f bend;   ///< half of the second differences
    float behind2;          ///< squared difference if the pixel moves with the background, grey²
  };
  /// Sums over the pixels of a block, with r = now − before and J = ∂r / ∂parameters.
  struct Sums {
    Eigen::Matrix4f information = Eigen::Matrix4f::Zero();  ///< Σ w J Jᵀ
    Eigen::Vector4f gradient = Eigen::Vector4f::Zero();     ///< Σ w J r
    float noise = 0;  ///< information on grow or turn that errors of the slopes add

    void operator+=(const Sums& other) {
      information += other.information;
      gradient += other.gradient;
      noise += other.noise;
    }
  };

  void collect_blocks(uint32_t key, const ObjectEvidence& evidence);
  void collect_slopes(const BlockField& field);
  Pixel describe(const Place& place, const Eigen::Vector4f& start,
                 const ObjectEvidence& evidence) const;
  /// Where a pixel was in the previous picture: x − (shift + (grow, turn) · ρ), where ρ is the
  /// position from the middle of the object in units of reach_px_, as complex numbers. In px of the
  /// field's picture. `motion`: shift, grow, turn.
  Eigen::Vector2f before_px(const Pixel& pixel, const Eigen::Vector4f& motion) const;
  Sums sum_up(const Eigen::Vector4f& motion, float edge_px, const PaddedImage& before);
  Eigen::Vector4d between_px2(const Sums& all, const Eigen::Vector4f& step) const;

  std::vector<size_t> blocks_;
  std::vector<Place> slopes_;
  std::vector<Pixel> pixels_;
  std::vector<Sums> sums_;                               ///< of each block
  Eigen::Vector2d middle_px_ = Eigen::Vector2d::Zero();  ///< of the blocks
  float reach_px_ = 1;                                   ///< root mean square distance from it
  float noise_grey2_ = 1;
};

/// A smoothed rate of rotation or growth, to which frames with a small error contribute more. The
/// felt rate is 0 up to the error bound, rises beyond it, and fades without evidence.
class SteadyRate {
 public:
  /// Time constant with which the rate fades.
  static constexpr double kFades_s = 0.1;

  /// Adds the change that a frame shows, `interval_s` > 0 after the previous one.
  void update(const Estimate& change, double interval_s) {
    if (!std::isfinite(change.sigma)) return miss(interval_s);
    const double variance = std::pow(change.sigma / interval_s, 2);
    const double news_1_s = change.value / interval_s - followed_1_s_;
    // Smoothing removes changes that an error explains, as in the velocity.
    const double news2 = news_1_s * news_1_s;
    const double newest = news2 / (news2 + kErrorSigmas * kErrorSigmas * variance);
    if (!std::isfinite(newest)) return;  // no news, and no error
    followed_1_s_ += newest * news_1_s;
    variance_ = std::pow(1 - newest, 2) * variance_ + newest * newest * variance;
    shared_1_s_ = change.shared / interval_s;
  }
  void miss(double interval_s) { followed_1_s_ *= std::exp(-interval_s / kFades_s); }

  /// The felt rate: 0 within the bound of its error.
  double rate_1_s() const {
    const double square = followed_1_s_ * followed_1_s_;
    const double bound2 = kErrorSigmas * kErrorSigmas * (variance_ + shared_1_s_ * shared_1_s_);
    return square > bound2 ? followed_1_s_ * (1 - bound2 / square) : 0;
  }
  /// The change in `interval_s` if the rate stays.
  Estimate expected(double interval_s) const { return {followed_1_s_ * interval_s}; }

 private:
  double followed_1_s_ = 0;
  double variance_ = 0;    ///< of the part that differs from frame to frame
  double shared_1_s_ = 0;  ///< the lasting part of its error
};

}  // namespace spidar
