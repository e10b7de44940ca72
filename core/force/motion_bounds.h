// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How fast anything in a picture can move at all.
#pragma once

#include <cstdint>

#include "core/motion/image_motion.h"

namespace spidar {

/// Two frames count as at least so far apart: half a tick of the haptic loop. Timestamps that
/// differ by a rounding error are no time to divide a displacement by.
constexpr int64_t kLeastInterval_ns = 500'000;

/// `motion` over `interval_s` > 0, at most what can be seen of any: a displacement of the frame's
/// width, lengths twice or half as large, half a turn. Directions are kept. What is not finite is
/// no motion.
ImageMotion bound_motion(const ImageMotion& motion, int frame_width, double interval_s);

}  // namespace spidar
