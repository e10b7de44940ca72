// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "core/history.h"

namespace spidar {

/// Leaves out single wrong readings, such as those with a bit flipped in transmission. Judges
/// readings of N lengths or coordinates, m, by extrapolating the last two. A reading that no motion
/// of a hand explains is left out once; the next one counts, so that a true change is seen one tick
/// later. To a brake, a grip that is 1 mm off for one tick seems to move at 1 m/s.
template <int N>
class ReadingGate {
 public:
  using Values = Eigen::Matrix<double, N, 1>;

  /// The acceleration of a held grip, or of the lightest one, 34 g, at 10 N. An impact exceeds it.
  static constexpr double kMax_m_s2 = 300;
  /// The error of the time of a reading: half of an exchange.
  static constexpr double kTimeError_s = 0.3e-3;

  /// `error_m` bounds the error of a reading.
  explicit ReadingGate(double error_m) noexcept : error_m_(error_m) {}

  void reset() noexcept {
    accepted_.clear();
    left_out_ = false;
  }

  /// Whether the reading counts. `unreliable` is the index of a value that is not judged; −1: none.
  bool accept(const Values& now_m, int64_t read_ns, int unreliable = -1) noexcept {
    const bool plausible = is_plausible(now_m, read_ns, unreliable);
    left_out_ = !plausible && !left_out_;
    if (left_out_) return false;
    if (!plausible) accepted_.clear();  // the earlier readings do not lead to this one
    // A reading in a burst replaces the one before, because their difference is mostly error.
    if (accepted_.size() > 1 && read_ns - accepted_[1].read_ns < kApart_ns) {
      accepted_[0] = {now_m, read_ns};
    } else {
      accepted_.add({now_m, read_ns});
    }
    return true;
  }

 private:
  struct Accepted {
    Values m;
    int64_t read_ns;
  };
  static constexpr int64_t kApart_ns = 500'000;

  bool is_plausible(const Values& now_m, int64_t read_ns, int unreliable) const noexcept {
    if (accepted_.size() < 3) return true;
    const Accepted& last = accepted_[0];
    const Accepted& before =
        last.read_ns - accepted_[1].read_ns < kApart_ns ? accepted_[2] : accepted_[1];
    const double passed_s = 1e-9 * static_cast<double>(last.read_ns - before.read_ns);
    const double ahead_s = 1e-9 * static_cast<double>(read_ns - last.read_ns);
    if (!(passed_s > 0)) return true;
    const double ratio = ahead_s / passed_s;
    const double margin_m =
        2 * error_m_ * (1 + ratio) + 0.5 * kMax_m_s2 * ahead_s * (ahead_s + passed_s);
    for (Eigen::Index i = 0; i < N; ++i) {
      const double moved_m = last.m[i] - before.m[i];
      const double off_m = now_m[i] - last.m[i] - ratio * moved_m;
      const double late_m = kTimeError_s / passed_s * (1 + ratio) * std::fabs(moved_m);
      if (i != unreliable && std::fabs(off_m) > margin_m + late_m) return false;
    }
    return true;
  }

  const double error_m_;
  History<Accepted, 3> accepted_;
  bool left_out_ = false;  ///< whether the last reading was left out
};

}  // namespace spidar
