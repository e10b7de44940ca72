// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>

namespace spidar {

/// Decides whether a device still counts as connected. Each answer cancels one missing answer, so a
/// device is lost after kMax exchanges in a row without an answer, and also if more than half of
/// its exchanges remain unanswered for long.
class MissingAnswers {
 public:
  static constexpr int kMax = 20;

  void count(bool answered) noexcept {
    missing_ = answered ? std::max(missing_ - 1, 0) : missing_ + 1;
  }
  bool is_lost() const noexcept { return missing_ >= kMax; }
  void reset() noexcept { missing_ = 0; }

 private:
  int missing_ = 0;
};

}  // namespace spidar
