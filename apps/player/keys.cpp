// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/player/keys.h"

#include <algorithm>
#include <cstdlib>

Action KeyReader::take(char byte) {
  constexpr int kMaxDelay_ms = 10'000;  // of ts-offset
  if (!typed_.empty()) {
    const bool number = (byte >= '0' && byte <= '9') || (byte == '-' && typed_.size() == 1);
    if (number && typed_.size() < 8) {
      typed_ += byte;
      return {};
    }
    const int delay_ms = std::atoi(typed_.c_str() + 1);
    const bool complete = byte == '\n' && typed_.size() > 1;
    typed_.clear();
    if (!complete) return {};
    return {Command::kDelay, std::clamp(delay_ms, -kMaxDelay_ms, kMaxDelay_ms)};
  }
  if (!escape_.empty() || byte == '\033') {
    escape_ += byte;
    if (escape_.size() < 3) return {};
    const std::string key = escape_.substr(1);
    escape_.clear();
    if (key == "[C") return {Command::kSeek, 5};
    if (key == "[D") return {Command::kSeek, -5};
    if (key == "[A") return {Command::kSeek, 60};
    if (key == "[B") return {Command::kSeek, -60};
    return {};
  }
  switch (byte) {
    case ' ':
      return {Command::kPause, 0};
    case '+':
      return {Command::kSpeed, 1};
    case '-':
      return {Command::kSpeed, -1};
    case 'l':
      return {Command::kLoop, 0};
    case '.':
      return {Command::kStep, 0};
    case 'f':
      return {Command::kForce, 0};
    case 'd':
      typed_ = "d";
      return {};
    case 'q':
      return {Command::kQuit, 0};
    default:
      return {};
  }
}
