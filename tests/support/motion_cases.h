// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/film_studio.h"
#include "tests/support/known_motion.h"

namespace spidar::test {

enum class CaseGroup {
  kUsual,   ///< count in the mean
  kHard,    ///< an object or a camera motion that is hard to find, evaluated separately
  kSilent,  ///< no motion may be felt
};

/// Films for measuring trackers, from easy to hard. Lengths below are at a width of 640 px; a wider
/// film shows the same with more detail.
struct MotionCase {
  std::string name;
  CaseGroup group;
  bool coded;  ///< whether it passes a video codec
  std::function<Film(int width, int height, uint32_t seed)> film;
};

/// Speeds of the usual object, px a frame: mean 13.
constexpr double kSlow_px = 2;
constexpr double kNormal_px = 11;
constexpr double kFast_px = 26;

const std::vector<MotionCase>& motion_cases();

/// Throws std::invalid_argument that lists the valid names.
const MotionCase& motion_case(const std::string& name);

}  // namespace spidar::test
