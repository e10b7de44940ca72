// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <utility>

namespace spidar {

/// Approximates a curve by few of its points: chooses values, including the first and the last one,
/// so that straight lines between them pass all others within a tolerance. Each line is as long as
/// possible: the slopes that pass all values so far form a cone, and the last value inside the cone
/// ends the line. Keeps only the values behind that one.
class KeyframeChooser {
 public:
  KeyframeChooser(double tolerance, std::function<void(size_t index, double value)> take)
      : tolerance_(tolerance), take_(std::move(take)) {}

  void add(double value) {
    if (count_++ == 0) {
      begin(0, value);
      return;
    }
    behind_.push_back(value);
    extend_line();
  }

  void finish() {
    while (count_ > 0 && end_ != begin_) {
      end_line();
      extend_line();
    }
  }

 private:
  void begin(size_t index, double value) {
    take_(index, value);
    begin_ = end_ = seen_ = index;
    begin_value_ = value;
    lowest_ = -std::numeric_limits<double>::infinity();
    highest_ = std::numeric_limits<double>::infinity();
  }

  /// Ends the line at its last value inside the cone, where the next line begins.
  void end_line() { begin(end_, end_value_); }

  /// Examines the values that have been added since the line began.
  void extend_line() {
    while (seen_ - end_ < behind_.size()) {
      const double value = behind_[seen_ - end_];
      ++seen_;
      const double distance = static_cast<double>(seen_ - begin_);
      const double rise = value - begin_value_;
      const double slope = rise / distance;
      if (slope >= lowest_ && slope <= highest_) {
        behind_.erase(behind_.begin(), behind_.begin() + static_cast<std::ptrdiff_t>(seen_ - end_));
        end_ = seen_;
        end_value_ = value;
      }
      lowest_ = std::max(lowest_, (rise - tolerance_) / distance);
      highest_ = std::min(highest_, (rise + tolerance_) / distance);
      if (lowest_ > highest_) end_line();
    }
  }

  const double tolerance_;
  const std::function<void(size_t index, double value)> take_;
  size_t count_ = 0;
  // Indices on the line: of its first value, its last one so far, and the last examined one.
  size_t begin_ = 0, end_ = 0, seen_ = 0;
  double begin_value_ = 0, end_value_ = 0;
  double lowest_ = 0, highest_ = 0;  ///< slopes
  std::deque<double> behind_;        ///< the values behind end_
};

}  // namespace spidar
