// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The true times of the haptic thread's ticks on a busy machine.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "spidar/loop/loop_thread.h"
#include "tests/support/random_motion.h"

namespace spidar::test {

/// How many microseconds each tick was late in a thread without real-time priority, with 0.06 ms a
/// tick, while compilers ran on both processors of a machine.
constexpr std::array<int, 240> kRecorded_us{
    92,   88,   97,   100,  107,  86,  98,  103, 96,    97,   91,   100, 98,  4381,  93,   108,
    115,  100,  81,   106,  83,   110, 118, 112, 545,   91,   100,  102, 108, 20384, 3384, 3362,
    1337, 1377, 3381, 3378, 2870, 100, 98,  84,  102,   4377, 1177, 100, 108, 107,   101,  108,
    122,  104,  106,  80,   96,   103, 112, 109, 105,   96,   92,   112, 115, 102,   103,  108,
    94,   102,  118,  93,   98,   107, 84,  99,  110,   79,   114,  98,  81,  97,    88,   82,
    97,   108,  85,   108,  97,   83,  107, 120, 93,    100,  107,  85,  95,  7377,  97,   100,
    114,  91,   97,   96,   80,   101, 103, 88,  108,   116,  79,   97,  93,  86,    98,   100,
    88,   105,  95,   95,   5376, 88,  108, 100, 89,    97,   104,  80,  92,  97,    83,   98,
    94,   77,   105,  1357, 90,   96,  94,  82,  15384, 86,   78,   79,  76,  75,    76,   75,
    78,   76,   76,   75,   78,   80,  78,  77,  77,    79,   76,   78,  79,  75,    79,   77,
    77,   75,   83,   76,   76,   75,  74,  78,  78,    80,   77,   81,  80,  75,    75,   78,
    87,   74,   88,   89,   92,   86,  89,  87,  80,    78,   78,   80,  79,  77,    80,   78,
    102,  79,   82,   77,   91,   79,  88,  92,  133,   96,   83,   80,  78,  92,    98,   81,
    80,   76,   78,   87,   93,   81,  102, 97,  103,   88,   82,   78,  92,  85,    81,   79,
    77,   75,   76,   75,   77,   77,  78,  87,  95,    93,   90,   106, 90,  76,    75,   80,
};

/// Ticks of a thread that keeps its deadlines, is late by up to a tick, stands still for up to 60
/// ms, or is as late as was recorded, for stretches of kStretch ticks. A late tick is followed by
/// the next deadline of the grid, which may come soon.
class LateTicks {
 public:
  static constexpr int kStretch = 200;
  /// The duration of a tick.
  static constexpr int64_t kCycle_ns = 60'000;

  enum Most { kATick, kStalls };

  /// The first deadline is `from_ns`.
  LateTicks(uint64_t seed, int64_t from_ns, Most most = kStalls)
      : random_(seed), kinds_(most == kStalls ? 4 : 2), deadline_ns_(from_ns) {}

  void advance() {
    if (began_) deadline_ns_ = next_deadline_ns(deadline_ns_, now_ns_ + kCycle_ns);
    began_ = true;
    if (ticks_++ % kStretch == 0) kind_ = random_.some(kinds_);
    now_ns_ = deadline_ns_ + std::llround(1e3 * late_us());
  }
  int64_t deadline_ns() const { return deadline_ns_; }
  int64_t now_ns() const { return now_ns_; }

 private:
  double late_us() {
    constexpr double kInTime_us = 60, kTick_us = 1e-3 * kTick_ns, kLongest_us = 60e3;
    switch (kind_) {
      case 0:
        return random_.uniform(0, kInTime_us);
      case 1:
        return random_.chance(0.05) ? random_.uniform(0.8, 0.99) * kTick_us
                                    : random_.uniform(0, kInTime_us);
      case 2:
        return random_.chance(0.03) ? 100 * std::pow(kLongest_us / 100, random_.uniform(0, 1))
                                    : random_.uniform(0, kInTime_us);
      default:
        return kRecorded_us[static_cast<size_t>(ticks_) % kRecorded_us.size()];
    }
  }

  RandomMotion random_;
  const int kinds_;
  int64_t deadline_ns_;
  int64_t now_ns_ = 0;
  bool began_ = false;
  int ticks_ = 0;
  int kind_ = 0;
};

}  // namespace spidar::test
