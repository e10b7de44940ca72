// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The frames of a film, drawn before the time is measured.
#pragma once

#include <vector>

#include "tests/support/known_motion.h"
#include "tests/support/picture.h"

namespace spidar::bench {

std::vector<test::Picture> draw_all(test::Film& film, int frames);

/// Through H.264 and back, at the bit rate of a film: .06 bit a pixel at 30 frames a second. Throws
/// std::runtime_error when GStreamer has not what it needs, and says what.
std::vector<test::Picture> coded(const std::vector<test::Picture>& frames);

}  // namespace spidar::bench
