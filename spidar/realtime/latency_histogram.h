// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace spidar {

/// A histogram of durations, such as the lateness of ticks, with `Bins` bins of `BinWidth_ns` and
/// one for all longer durations. One thread adds durations without a lock, and any thread reads.
template <size_t Bins, int64_t BinWidth_ns>
class DurationHistogram {
 public:
  static constexpr int64_t kBinWidth_ns = BinWidth_ns;
  static constexpr size_t kBins = Bins;

  /// Negative durations count as zero.
  void add(int64_t duration_ns) noexcept {
    const int64_t duration = duration_ns > 0 ? duration_ns : 0;
    const auto bin = static_cast<size_t>(duration / kBinWidth_ns);
    auto& counter = counters_[bin < kBins ? bin : kBins];
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (duration > max_ns_.load(std::memory_order_relaxed)) {
      max_ns_.store(duration, std::memory_order_relaxed);
    }
  }

  /// Must not be called while another thread adds.
  void reset() noexcept {
    for (auto& counter : counters_) counter.store(0, std::memory_order_relaxed);
    max_ns_.store(0, std::memory_order_relaxed);
  }

  uint64_t count() const noexcept {
    uint64_t sum = 0;
    for (const auto& counter : counters_) sum += counter.load(std::memory_order_relaxed);
    return sum;
  }

  /// The largest duration, exact.
  int64_t max_ns() const noexcept { return max_ns_.load(std::memory_order_relaxed); }

  /// Returns the quantile `q` (0 … 1): the upper end of its bin, at most 1 µs too large. Returns
  /// max_ns() when the quantile is above 2 ms, and 0 when the histogram is empty.
  int64_t quantile_ns(double q) const noexcept {
    const double rank = std::ceil(q * static_cast<double>(count()));
    uint64_t sum = 0;
    for (size_t bin = 0; bin < kBins; ++bin) {
      sum += counters_[bin].load(std::memory_order_relaxed);
      if (sum > 0 && static_cast<double>(sum) >= rank) {
        const int64_t upper = static_cast<int64_t>(bin + 1) * kBinWidth_ns;
        return upper < max_ns() ? upper : max_ns();
      }
    }
    return max_ns();
  }

 private:
  std::array<std::atomic<uint64_t>, kBins + 1> counters_{};  // the last counts all longer durations
  std::atomic<int64_t> max_ns_{0};
};

/// For a loop at 1 kHz: 1 µs bins up to 2 ms.
using LatencyHistogram = DurationHistogram<2000, 1000>;

}  // namespace spidar
