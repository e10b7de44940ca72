// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What spidarmotion accepts, and what the filter for players accepts: the same formats in any
/// size, so that a film whose frames are too small or too large for spidarmotion plays without it.
#pragma once

#include <string>

#include <gst/gst.h>

namespace spidar {

/// Caps that spidarmotion accepts; nullptr when the element does not exist.
GstCaps* motion_caps();

/// `caps` without limits of width and height.
GstCaps* in_any_size(const GstCaps* caps);

/// Whether `accepted` has the frame size of `video`, whatever their formats.
bool fits_size(const GstCaps* video, const GstCaps* accepted);

/// The size of `video` and the sizes that `accepted` allows, for a message.
std::string say_sizes(const GstCaps* video, const GstCaps* accepted);

}  // namespace spidar
