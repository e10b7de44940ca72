// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Detects changes of brightness and contrast between two pictures.
#pragma once

#include "core/tracking/gray_pyramid.h"

namespace spidar {

/// Ratio of the contrast of `now` to that of `before`; 1 if the difference is small enough to come
/// from objects that appear or disappear.
float contrast_gain(const GrayPyramid& before, const GrayPyramid& now);

/// Whether `now` equals `before` up to a gain, an offset and rounding, which means that nothing
/// moved. Returns false, at little cost, if brightness and contrast are unchanged.
bool only_light_changed(const GrayPyramid& before, const GrayPyramid& now);

}  // namespace spidar
