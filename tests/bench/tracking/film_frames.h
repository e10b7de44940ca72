// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The frames of a film, drawn before the time is measured.
#pragma once

#include <string>
#include <vector>

#include "tests/support/known_motion.h"
#include "tests/support/picture.h"

namespace spidar::bench {

std::vector<test::Picture> draw_all(test::Film& film, int frames);

enum class Coder { kX264, kOpenH264 };

/// Through H.264 and back, at the bit rate of a film: .06 bit a pixel at 30 frames a second. Throws
/// std::runtime_error when GStreamer has not what it needs, and says what.
std::vector<test::Picture> coded(const std::vector<test::Picture>& frames,
                                 Coder coder = Coder::kX264);

/// The luma of a picture file. Throws std::runtime_error as coded() does.
test::Picture read_picture(const std::string& file);

}  // namespace spidar::bench
