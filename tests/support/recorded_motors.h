// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "spidar/link/emulated_transport.h"

namespace spidar::test {

/// Outputs to the motors of an emulated board, and counts of its encoders, which a test reads and
/// moves; must outlive the board. Atomics: any thread.
struct MotorBench {
  std::array<std::atomic<int>, kMaxStrings> digit{};
  std::array<std::atomic<int32_t>, kMaxStrings> count{};
  std::atomic<uint16_t> inputs{0};
  std::atomic<int> updates{0};
  /// All updates of the first motor. Read this while no board runs.
  std::vector<int> history;

  bool all_zero() const {
    for (const auto& d : digit)
      if (d != 0) return false;
    return true;
  }
};

class RecordedMotors final : public emulated::Motors {
 public:
  explicit RecordedMotors(MotorBench& bench) : bench_(bench) {}

  void set_outputs(const std::array<int, kMaxStrings>& digits) noexcept override {
    for (size_t i = 0; i < digits.size(); ++i) bench_.digit[i] = digits[i];
    bench_.history.push_back(digits[0]);
    ++bench_.updates;
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override {
    std::array<int32_t, kMaxStrings> counts{};
    for (size_t i = 0; i < counts.size(); ++i) counts[i] = bench_.count[i];
    return counts;
  }
  uint16_t inputs() noexcept override { return bench_.inputs; }

 private:
  MotorBench& bench_;
};

}  // namespace spidar::test
