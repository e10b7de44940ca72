// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Boxes of objects in a picture, as elements of other projects attach them to frames.
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

/// In pixels of the frame that has it; it may lie partly outside.
struct ObjectBox {
  std::string name;  ///< of what is in it, "face"
  double x, y, width, height;
};

/// The name of our objects.
constexpr const char* kObjectName = "spidar-object";

/// Regions (GstVideoRegionOfInterestMeta) and detections. Those without a size are left out. Ids of
/// regions count them within a frame, so that they do not tell which is which in the next one.
std::vector<ObjectBox> read_object_metas(GstBuffer* buffer);

/// Attaches the objects in sight to `buffer`, which is writable, as both. Regions that another
/// spidarmotion has attached are replaced.
void attach_object_metas(GstBuffer* buffer, const DrawnFrame& report, int width, int height);

/// Null when the frame has none. Of a `packed` frame, the half that is the picture is meant.
std::shared_ptr<const std::vector<PictureBox>> boxes_of(const GstVideoFrame& frame,
                                                        std::optional<touch::DepthLayout> packed,
                                                        const Orientation& turn);

}  // namespace spidar
