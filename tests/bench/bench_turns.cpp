// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Roll and growth of balls that turn and grow by ±1.2 a second, or do neither, over 240 frames.
//   error    of half of the frames, and of 99 %
//   jumps    how much the change from frame to frame is off, of 99 % of the frames
//   switches how often there is none after some, or some after none; 10 would be those through zero
#include <cstdio>

#include "tests/bench/benchmarks.h"
#include "tests/support/turning_ball.h"

namespace {

using spidar::test::FollowedAxis;
using spidar::test::FollowedBall;
using spidar::test::TurningBall;

void print(const FollowedAxis& axis) {
  std::printf(" | %.3f | %.3f | %.3f | %d", axis.error(0.5), axis.error(0.99), axis.jump(),
              axis.switches());
}

}  // namespace

int spidar::bench::turns(int, char**) {
  constexpr double kSwing = 1.2;
  std::puts(
      "| film | roll: error, rad/s | 99 % | jumps | switches | growth: error, 1/s | 99 % | "
      "jumps | switches |\n|---|---|---|---|---|---|---|---|---|");
  for (const bool in_hand : {false, true}) {
    for (const bool is_textured : {false, true}) {
      for (const double radius_px : {36.0, 72.0}) {
        for (const auto& [turn, growth] : {std::pair(1, 0), {0, 1}, {1, 1}, {0, 0}}) {
          const TurningBall ball{is_textured, radius_px, kSwing * turn, kSwing * growth, in_hand};
          const FollowedBall followed = follow(ball);
          std::printf("| %s", ball.name().c_str());
          print(followed.roll_rad_s);
          print(followed.growth_1_s);
          std::puts(" |");
        }
      }
    }
  }
  return 0;
}
