// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a player writes on a terminal.
#pragma once

#include <array>
#include <string>
#include <vector>

/// "[######..............]  1.2 N  right +0.9  up -0.8  near +0.0" for a force in N: x right, y up,
/// z towards the viewer. The bar is full at `max_force_N`.
std::string force_line(const std::array<double, 3>& force_N, double max_force_N);

/// Lines at the foot of a terminal that are written over each other. On something else than a
/// terminal only the first line is written, each time anew.
class StatusLines {
 public:
  StatusLines();

  void show(const std::vector<std::string>& lines);
  /// The cursor goes below the lines: what is written next follows them.
  void leave();
  bool is_terminal() const { return is_terminal_; }

 private:
  const bool is_terminal_;
  size_t below_ = 0;  // lines from the one with the cursor to the last
};
