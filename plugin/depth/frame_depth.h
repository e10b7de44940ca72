// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads the depth image that spidardepth attached to a frame.
#pragma once

#include <gst/gst.h>

#include "core/touch/depth_picture.h"

namespace spidar {

/// Reads the depth image of `frame` into `picture`, `dt_s` after the previous frame. Returns false,
/// and leaves the picture unchanged, when the frame has no depth or only holes. To build a relief
/// from it:
///
///     if (read_frame_depth(frame, dt_s, picture))
///       builder.from_levels(picture.levels(), relief_settings, field);
///
/// For a 2D+Z film with frames `packed` (an ImageView):
///
///     if (picture.read(depth_half(packed, DepthLayout::kRight), {true}, dt_s))
///       builder.from_levels(picture.levels(), relief_settings, field);
///
/// After a seek, call picture.reset() to restart the estimate of the range. Frames from spidardepth
/// always have valid settings; invalid settings from another element count as not set.
bool read_frame_depth(GstBuffer* frame, double dt_s, DepthPicture& picture);

}  // namespace spidar
