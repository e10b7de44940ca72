// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A rate of an object over the frames: how fast it turns, or how fast it grows.
#pragma once

#include <cmath>

#include "core/motion/objects/moving_object.h"
#include "core/motion/objects/turn_meter.h"

namespace spidar {

/// Weights what each frame shows by its error. The rate comes in from none as it exceeds the bound
/// of its error, and goes where nothing determines it any more.
class SteadyRate {
 public:
  /// Time constant with which it goes.
  static constexpr double kFades_s = 0.1;

  /// What a frame shows, `interval_s` > 0 after the one before, as a change in that time.
  void see(const Estimate& change, double interval_s) {
    if (!std::isfinite(change.sigma)) return miss(interval_s);
    const double variance = std::pow(change.sigma / interval_s, 2);
    const double news_1_s = change.value / interval_s - followed_1_s_;
    // What an error explains is smoothed away, as it is of the velocity.
    const double news2 = news_1_s * news_1_s;
    const double newest = news2 / (news2 + kErrorSigmas * kErrorSigmas * variance);
    if (!std::isfinite(newest)) return;  // no news, and no error
    followed_1_s_ += newest * news_1_s;
    variance_ = std::pow(1 - newest, 2) * variance_ + newest * newest * variance;
    shared_1_s_ = change.shared / interval_s;
  }
  void miss(double interval_s) { followed_1_s_ *= std::exp(-interval_s / kFades_s); }

  /// As it is felt.
  double rate_1_s() const {
    const double square = followed_1_s_ * followed_1_s_;
    const double bound2 = kErrorSigmas * kErrorSigmas * (variance_ + shared_1_s_ * shared_1_s_);
    return square > bound2 ? followed_1_s_ * (1 - bound2 / square) : 0;
  }
  /// The change in `interval_s` if it goes on.
  Estimate expected(double interval_s) const { return {followed_1_s_ * interval_s}; }

 private:
  double followed_1_s_ = 0;
  double variance_ = 0;    ///< of its error, what differs from frame to frame
  double shared_1_s_ = 0;  ///< what lasts
};

}  // namespace spidar
