// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <string>

#include "tests/support/known_motion.h"

namespace spidar::test {

/// A film by its name, from easy to hard. Lengths in motion_cases.cpp are at a width of 640 px; a
/// wider film shows the same with more detail. Throws std::out_of_range for another name.
Film motion_case(const std::string& name, int width, int height, uint32_t seed);

}  // namespace spidar::test
