// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// From pictures to a wrench, by libgst-spidar.
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gst-spidar/motion.h>
#include <gtest/gtest.h>

namespace gst_spidar {
namespace {

using namespace std::chrono_literals;

// A change here changes the binary interface, as in test_api.cpp.
static_assert(sizeof(MotionResult) == sizeof(Wrench) + 5 * sizeof(double));
static_assert(sizeof(MotionSettings) == 7 * sizeof(double));
static_assert(sizeof(MotionToWrench) == sizeof(void*));
static_assert(static_cast<int>(Controller::kAdaptive) == 2);
static_assert(static_cast<int>(FeltMotion::kCamera) == 2);
static_assert(static_cast<int>(FeltMotion::kObjects) == 3);

/// Spots of 4 × 4 pixels that move by whole pixels.
class MovingPicture {
 public:
  GreyPicture at(int shift) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        // Not negative before the division, which would round towards zero.
        const unsigned spot = static_cast<unsigned>((x - shift + kSide) / 4 * 73 + y / 4 * 151);
        pixels_[static_cast<size_t>(y * kSide + x)] =
            static_cast<uint8_t>((spot * 2654435761u) >> 24);
      }
    }
    return {pixels_.data(), kSide, kSide, kSide};
  }

 private:
  static constexpr int kSide = 240;
  std::vector<uint8_t> pixels_ = std::vector<uint8_t>(size_t{kSide} * kSide);
};

MotionSettings mean() {
  MotionSettings settings;
  settings.motion = FeltMotion::kMean;
  return settings;
}

MotionResult after_ten(MotionToWrench& motion) {
  MovingPicture picture;
  MotionResult found;
  for (int i = 0; i < 10; ++i) found = motion.analyze(picture.at(4 * i), 40ms * i);
  return found;
}

TEST(MotionToWrench, SettingsAreThoseOfTheElement) {
  MotionToWrench motion;
  motion.configure(mean());
  const double before_N = after_ten(motion).wrench.force_N.x;
  motion.reset();
  MotionSettings settings = mean();
  settings.max_force_N = 1.5;  // half the default
  motion.configure(settings);
  EXPECT_NEAR(after_ten(motion).wrench.force_N.x, before_N / 2, 1e-9);
  motion.reset();
  settings.controller = Controller::kLinear;  // the largest speed is the largest force
  motion.configure(settings);
  EXPECT_GT(after_ten(motion).wrench.force_N.x, 1.4);
  motion.reset();
  settings = mean();
  settings.alpha_s_px = 0;
  motion.configure(settings);
  EXPECT_EQ(after_ten(motion).wrench.force_N.x, 0);
  motion.reset();
  settings.alpha_s_px = 0.02;
  motion.configure(settings);
  const double expected_N = 2 * 3 / M_PI * std::atan(0.02 * 200);
  EXPECT_NEAR(after_ten(motion).wrench.force_N.x, expected_N,
              2 * 3 / M_PI * 0.02 * 2 * 0.03 / 0.04);
}

TEST(MotionToWrench, WhatIsWrongIsNamed) {
  MotionToWrench motion;
  MovingPicture picture;
  const GreyPicture good = picture.at(0);
  EXPECT_THROW(motion.analyze({}, 0ms), std::invalid_argument);
  EXPECT_THROW(motion.analyze({good.data, 8, 8, 8}, 0ms), std::invalid_argument);
  EXPECT_THROW(motion.analyze({good.data, good.width, good.height, good.width - 1}, 0ms),
               std::invalid_argument);
  EXPECT_NO_THROW(motion.analyze(good, 0ms));
}

}  // namespace
}  // namespace gst_spidar
