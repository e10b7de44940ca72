// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstdint>

namespace spidar {

/// Distinguishes a lost frame from a repeated picture. A frame may have been repeated because the
/// next one was lost. The film has then moved on in the meantime: the interval between the frames
/// is right, and the interval of the cadence is wrong. The right interval is the one that gives a
/// speed closer to the previous speed.
class LostFrames {
 public:
  /// Returns a factor for `speed_px_s`, which was computed with the interval of a Cadence::Step: 1,
  /// or the factor for `shown_for_ns` in place of that interval. Call this once for each frame that
  /// does not wait.
  double correction(int64_t interval_ns, int64_t shown_for_ns, double speed_px_s) {
    double factor = 1;
    if (interval_ns > 0 && shown_for_ns != interval_ns && speed_px_s > 0 && last_px_s_ > 0) {
      const double if_lost = static_cast<double>(interval_ns) / static_cast<double>(shown_for_ns);
      const double change = std::abs(std::log(speed_px_s / last_px_s_));
      const double change_if_lost = std::abs(std::log(speed_px_s * if_lost / last_px_s_));
      if (change_if_lost + std::log(1 + kCloserBy) < change) factor = if_lost;
    }
    last_px_s_ = factor * speed_px_s;
    return factor;
  }

  /// Call this after a cut.
  void reset() { last_px_s_ = 0; }

 private:
  /// The other speed must be closer by more than this fraction, because noise would decide between
  /// two speeds that are about equally close. The value is a judgement; it is not derived.
  static constexpr double kCloserBy = 0.2;

  double last_px_s_ = 0;  ///< the previous speed, corrected
};

}  // namespace spidar
