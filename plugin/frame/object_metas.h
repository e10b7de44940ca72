// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gst/video/video.h>

#include "core/choice/object_choice.h"
#include "core/orientation.h"
#include "core/touch/depth_picture.h"
#include "plugin/frame/frame_report.h"

namespace spidar {

/// The box of an object, in pixels of its frame; the box may lie partly outside the frame.
struct ObjectBox {
  std::string name;  ///< what the box contains, such as "face"
  double x, y, width, height;
};

constexpr const char* kObjectName = "spidar-object";

/// Reads the regions (GstVideoRegionOfInterestMeta) and the detections of a buffer, except those
/// without a size. Their ids number the regions of one frame and identify nothing in the next.
std::vector<ObjectBox> read_object_metas(GstBuffer* buffer);

/// Attaches the visible objects to `buffer`, which must be writable, as regions and as detections.
/// Replaces the regions of another spidarmotion.
void attach_object_metas(GstBuffer* buffer, const DrawnFrame& report, int width, int height);

/// The boxes of a frame as fractions of the displayed picture; null when there are none. If the
/// frame is `packed`, that picture is one half of it.
std::shared_ptr<const std::vector<PictureBox>> boxes_of(const GstVideoFrame& frame,
                                                        std::optional<touch::DepthLayout> packed,
                                                        const Orientation& turn);

}  // namespace spidar
