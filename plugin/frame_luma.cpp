#include "plugin/frame_luma.h"

#include <algorithm>
#include <cstring>

#include "core/tracking/luma_row.h"
#include "core/tracking/packed_luma.h"

namespace spidar {
namespace {

bool is_packed(GstVideoFormat format, PackedOrder& order) {
  switch (format) {
    case GST_VIDEO_FORMAT_RGB:
      order = PackedOrder::kRgb;
      return true;
    case GST_VIDEO_FORMAT_BGR:
      order = PackedOrder::kBgr;
      return true;
    case GST_VIDEO_FORMAT_RGBx:
    case GST_VIDEO_FORMAT_RGBA:
      order = PackedOrder::kRgbx;
      return true;
    case GST_VIDEO_FORMAT_BGRx:
    case GST_VIDEO_FORMAT_BGRA:
      order = PackedOrder::kBgrx;
      return true;
    default:
      return false;
  }
}

/// Of the luma of a planar or semi-planar format, whose first component it is.
LumaSample sample_of(const GstVideoFormatInfo& format) {
  const int depth = static_cast<int>(GST_VIDEO_FORMAT_INFO_DEPTH(&format, 0));
  if (depth <= 8) return {};
  const int shift = static_cast<int>(GST_VIDEO_FORMAT_INFO_SHIFT(&format, 0)) + depth - 8;
  return {2, shift, !GST_VIDEO_FORMAT_INFO_IS_LE(&format)};
}

}  // namespace

VisiblePart visible_part(const GstVideoFrame& frame) {
  const int width = GST_VIDEO_FRAME_WIDTH(&frame);
  const int height = GST_VIDEO_FRAME_HEIGHT(&frame);
  const GstVideoCropMeta* crop = gst_buffer_get_video_crop_meta(frame.buffer);
  if (!crop) return {0, 0, width, height};
  const int x = static_cast<int>(std::min<guint>(crop->x, static_cast<guint>(width)));
  const int y = static_cast<int>(std::min<guint>(crop->y, static_cast<guint>(height)));
  return {x, y, static_cast<int>(std::min<guint>(crop->width, static_cast<guint>(width - x))),
          static_cast<int>(std::min<guint>(crop->height, static_cast<guint>(height - y)))};
}

bool holds_picture(const GstVideoFrame& frame) {
  for (guint c = 0; c < GST_VIDEO_FRAME_N_COMPONENTS(&frame); ++c) {
    const auto plane = static_cast<guint>(GST_VIDEO_FRAME_COMP_PLANE(&frame, c));
    const gint64 stride = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, plane);
    const gint64 line = static_cast<gint64>(GST_VIDEO_FRAME_COMP_WIDTH(&frame, c)) *
                        GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, c);
    const gint64 bytes = stride * (GST_VIDEO_FRAME_COMP_HEIGHT(&frame, c) - 1) + line;
    // With a meta each plane is mapped by itself; else they all are in the first.
    const GstMapInfo& map = frame.map[frame.meta ? plane : 0];
    const auto* first = static_cast<const guint8*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, plane));
    if (stride < line || first - map.data + bytes > static_cast<gint64>(map.size)) return false;
  }
  return true;
}

ImageView FrameLuma::first_field(const ImageView& frame, bool top_first) {
  // The field's own lines, and between them their mean: the picture keeps its shape.
  const size_t width = static_cast<size_t>(frame.width);
  const int first = top_first ? 0 : 1;
  field_.resize(width * static_cast<size_t>(frame.height));
  const auto line = [&](int y) { return field_.data() + static_cast<size_t>(y) * width; };
  const int last = first + (frame.height - 1 - first) / 2 * 2;
  for (int y = first; y <= last; y += 2) copy_row(frame, 0, y, frame.width, line(y));
  for (int y = 1 - first; y < frame.height; y += 2) {
    const uint8_t* above = line(std::max(y - 1, first));
    const uint8_t* below = line(std::min(y + 1, last));
    uint8_t* out = line(y);
    for (size_t x = 0; x < width; ++x) {
      out[x] = static_cast<uint8_t>((above[x] + below[x] + 1) / 2);
    }
  }
  return {field_.data(), frame.width, frame.height, static_cast<ptrdiff_t>(width)};
}

ImageView FrameLuma::view(const GstVideoFrame& frame) {
  const VisiblePart shown = visible_part(frame);
  if (shown.width < kSmallestSide || shown.height < kSmallestSide) return {};
  const ptrdiff_t stride = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0);
  const uint8_t* data = static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)) +
                        shown.y * stride + shown.x * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0);
  ImageView luma{data, shown.width, shown.height, stride, sample_of(*frame.info.finfo)};
  PackedOrder order;
  if (is_packed(GST_VIDEO_FRAME_FORMAT(&frame), order)) {
    luma = luma_of_packed(data, shown.width, shown.height, stride, order, converted_);
  }
  if (GST_VIDEO_FRAME_IS_INTERLACED(&frame) && luma.height >= 2) {
    // A crop that begins on an odd line begins with the other field.
    luma = first_field(luma, GST_VIDEO_FRAME_IS_TFF(&frame) == (shown.y % 2 == 0));
  } else if (combing_.see(luma)) {
    // Nobody says which field is the earlier one: always the same will do.
    luma = first_field(luma, true);
  }
  return luma;
}

}  // namespace spidar
