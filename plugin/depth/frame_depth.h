// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The depth that spidardepth has put on a frame, as a picture that can be touched.
#pragma once

#include <gst/gst.h>

#include "core/touch/depth_picture.h"

namespace spidar {

/// Reads the depth image of `frame` into `picture`, `dt_s` after the frame before. Returns false,
/// and leaves the picture as it was, when the frame has no depth or nothing but holes. With it, a
/// relief is made by
///
///     if (read_frame_depth(frame, dt_s, picture))
///       builder.from_levels(picture.levels(), relief_settings, field);
///
/// and, of a 2D+Z film whose frames come as `packed` (an ImageView), by
///
///     if (picture.read(depth_half(packed, DepthLayout::kRight), {true}, dt_s))
///       builder.from_levels(picture.levels(), relief_settings, field);
///
/// After a seek picture.reset() lets the range begin anew. The settings on the frame are valid:
/// spidardepth does not pass others on; those of another element count as not set when they are
/// not.
bool read_frame_depth(GstBuffer* frame, double dt_s, DepthPicture& picture);

}  // namespace spidar
