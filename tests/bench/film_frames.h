// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The frames of a film, drawn before the time is measured.
#pragma once

#include <vector>

#include "tests/support/known_motion.h"
#include "tests/support/picture.h"

namespace spidar::bench {

std::vector<test::Picture> draw_all(test::Film& film, int frames);

}  // namespace spidar::bench
