// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// For which time a wrench is sent to a device that renders it later.
#pragma once

#include <algorithm>
#include <cstdint>

namespace spidar {

/// A wrench is sent earlier by the delay of the device, as far as the film is known ahead: where it
/// is known for less time, the device renders it late, and evenly so.
class LookAhead {
 public:
  /// The time to ask for at `running_ns`, with wrenches known up to `known_ns`. It hardly ever goes
  /// back, and does not pass what is known before `running_ns` does: then the film has stopped, and
  /// the wrench expires.
  int64_t ask_for(int64_t running_ns, int64_t lag_ns, int64_t known_ns) noexcept {
    const int64_t passed_ns = std::clamp<int64_t>(running_ns - before_ns_, 0, kLongest_ns);
    before_ns_ = running_ns;
    const int64_t ahead_ns = known_ns > running_ns ? known_ns - running_ns : 0;
    ahead_ns_ = std::min(ahead_ns_ + passed_ns / kCatchUp, ahead_ns);
    const int64_t lead_ns = std::min(ahead_ns_, lag_ns);
    late_ns_ = lag_ns - lead_ns;
    return running_ns + lead_ns;
  }
  /// Nothing is known any more.
  void reset() noexcept {
    ahead_ns_ = kFarAhead_ns;
    late_ns_ = 0;
  }
  /// How much later than its frame the device renders a wrench.
  int64_t late_ns() const noexcept { return late_ns_; }

 private:
  /// Between two frames, the film is known for less and less time, and the least of these counts.
  /// After it has become more, wrenches follow one another faster by this part of their time, 10 %,
  /// until the delay is made up for.
  static constexpr int64_t kCatchUp = 10;
  /// Of a step of time that counts, so that a jump does not.
  static constexpr int64_t kLongest_ns = 10'000'000;
  static constexpr int64_t kFarAhead_ns = INT64_MAX / 2;

  int64_t before_ns_ = 0;
  int64_t ahead_ns_ = kFarAhead_ns;  // for which the film is known in any case
  int64_t late_ns_ = 0;
};

}  // namespace spidar
