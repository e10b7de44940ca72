// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Changes of light from one picture to the next.
#pragma once

#include "core/tracking/gray_pyramid.h"

namespace spidar {

/// Contrast of `now` over that of `before`; 1 when they differ by less than what things that come
/// and go change.
float contrast_gain(const GrayPyramid& before, const GrayPyramid& now);

/// Whether one gain and one offset explain `now` by `before` up to rounding: then nothing moved.
/// False when the light is the same, which costs next to nothing.
bool only_light_changed(const GrayPyramid& before, const GrayPyramid& now);

}  // namespace spidar
