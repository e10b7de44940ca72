// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Status lines of a player on a terminal.
#pragma once

#include <array>
#include <string>
#include <vector>

/// "[######..............]  1.2 N  right +0.9  up -0.8  near +0.0" for a force in N: x right, y up,
/// z towards the viewer. The bar is full at `max_force_N`.
std::string force_line(const std::array<double, 3>& force_N, double max_force_N);

/// Lines at the bottom of a terminal that are overwritten in place. If the output is not a
/// terminal, only the first line is written, each time on a new line.
class StatusLines {
 public:
  StatusLines();

  void show(const std::vector<std::string>& lines);
  /// Moves the cursor below the lines, where further output continues.
  void leave();
  bool is_terminal() const { return is_terminal_; }

 private:
  const bool is_terminal_;
  size_t below_ = 0;  // lines from the cursor down to the last one
};
