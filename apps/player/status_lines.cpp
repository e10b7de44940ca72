// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/player/status_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace {

constexpr int kBarWidth = 20;

/// Width of the terminal, in characters.
size_t columns() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string force_line(const std::array<double, 3>& force_N, double max_force_N) {
  const double size_N = std::hypot(force_N[0], force_N[1], force_N[2]);
  const double share = max_force_N > 0 ? std::clamp(size_N / max_force_N, 0.0, 1.0) : 0;
  const auto filled = static_cast<size_t>(std::lround(share * kBarWidth));
  const auto unsigned_zero = [](double value) { return std::abs(value) < 0.05 ? 0.0 : value; };
  char numbers[96];
  std::snprintf(numbers, sizeof(numbers), "]  %.1f N  right %+.1f  up %+.1f  near %+.1f", size_N,
                unsigned_zero(force_N[0]), unsigned_zero(force_N[1]), unsigned_zero(force_N[2]));
  return "[" + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + numbers;
}

StatusLines::StatusLines() : is_terminal_(isatty(STDOUT_FILENO) != 0) {}

void StatusLines::show(const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  if (!is_terminal_) {
    std::printf("%s\n", lines.front().c_str());
    std::fflush(stdout);
    return;
  }
  // A line that is too long would occupy two, and the others would be misplaced.
  const size_t most = columns() - 1;
  std::string text = "\r";
  for (size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) text += "\n";
    text += "\033[K" + lines[i].substr(0, most);
  }
  if (lines.size() > 1) text += "\033[" + std::to_string(lines.size() - 1) + "A";
  text += "\r";
  below_ = lines.size() - 1;
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

void StatusLines::leave() {
  if (!is_terminal_) return;
  for (size_t i = 0; i < below_ + 1; ++i) std::fputs("\n", stdout);
  below_ = 0;
  std::fflush(stdout);
}
