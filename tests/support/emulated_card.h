// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <ctime>

namespace spidar::test {

/// What the emulated sound card has played, see emulated_card.cpp. Frames × channels samples of 16
/// bits follow.
struct Heard {
  enum Kind : uint64_t { kPlayed, kStopped, kPrepared, kDry };
  uint64_t kind;
  int64_t at_ns;  ///< of the first frame; 0: at the start
  uint32_t frames, channels;
  uint32_t waiting;  ///< frames in the buffer then
};

inline int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * int64_t{1'000'000'000} + now.tv_nsec;
}

}  // namespace spidar::test
