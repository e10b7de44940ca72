// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/choice/frame_boxes.h"

#include <utility>

#include "plugin/filter/frame/frame_luma.h"
#include "plugin/filter/frame/object_metas.h"

namespace spidar {

std::shared_ptr<const PictureBoxes> boxes_of(const GstVideoFrame& frame,
                                             std::optional<DepthLayout> packed,
                                             const PictureTurn& turn) {
  std::vector<ObjectBox> found = read_object_metas(frame.buffer);
  VisiblePart part = visible_part(frame);
  if (packed) (*packed == DepthLayout::kRight ? part.width : part.height) /= 2;
  if (found.empty() || part.width <= 0 || part.height <= 0) return nullptr;
  const auto place = [&](double x_px, double y_px) {
    return turn.place_shown({(x_px - part.x) / part.width, (y_px - part.y) / part.height});
  };
  auto boxes = std::make_shared<PictureBoxes>();
  for (ObjectBox& box : found) {
    const Eigen::Vector2d a = place(box.x, box.y);
    const Eigen::Vector2d b = place(box.x + box.width, box.y + box.height);
    boxes->push_back({std::move(box.name), box.track, a.cwiseMin(b), a.cwiseMax(b)});
  }
  return boxes;
}

}  // namespace spidar
