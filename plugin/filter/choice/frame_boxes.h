// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Boxes that elements before ours attached to a frame.
#pragma once

#include <memory>
#include <optional>

#include <gst/video/video.h>

#include "core/choice/chosen.h"
#include "core/picture_turn.h"
#include "core/touch/depth_picture.h"

namespace spidar {

/// Null when the frame has none. Of a `packed` frame, the half that is the picture is meant.
std::shared_ptr<const PictureBoxes> boxes_of(const GstVideoFrame& frame,
                                             std::optional<DepthLayout> packed,
                                             const PictureTurn& turn);

}  // namespace spidar
