// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/frame_luma.h"

#include <algorithm>
#include <iterator>

#include "core/picture/luma.h"

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

/// Luma of an unpacked pixel: alpha, then Y, U, V or R, G, B, of which the upper eight bits are
/// used. R, G and B are weighted as in luma_of_packed().
template <typename Sample>
uint8_t luma_of(const Sample* pixel, bool is_rgb) {
  constexpr int kShift = 8 * (static_cast<int>(sizeof(Sample)) - 1);
  const auto byte = [&](int component) { return pixel[component] >> kShift; };
  if (!is_rgb) return static_cast<uint8_t>(byte(1));
  constexpr int kBits = 14;
  return static_cast<uint8_t>(
      (4899 * byte(1) + 9617 * byte(2) + 1868 * byte(3) + (1 << (kBits - 1))) >> kBits);
}

template <typename Sample>
void write_luma(const Sample* pixels, int count, bool is_rgb, uint8_t* to) {
  for (int x = 0; x < count; ++x) to[x] = luma_of(pixels + 4 * x, is_rgb);
}

bool is_side_by_side(GstVideoMultiviewMode views) {
  return views == GST_VIDEO_MULTIVIEW_MODE_SIDE_BY_SIDE ||
         views == GST_VIDEO_MULTIVIEW_MODE_SIDE_BY_SIDE_QUINCUNX;
}

/// How a planar or semi-planar format stores its luma, which is the first component.
LumaSample sample_of(const GstVideoFormatInfo& format) {
  const int depth = static_cast<int>(GST_VIDEO_FORMAT_INFO_DEPTH(&format, 0));
  if (depth <= 8) return {};
  const int shift = static_cast<int>(GST_VIDEO_FORMAT_INFO_SHIFT(&format, 0)) + depth - 8;
  return {2, shift, !GST_VIDEO_FORMAT_INFO_IS_LE(&format)};
}

/// Whether a format is one of SPIDAR_UNPACKED_FORMATS and not of SPIDAR_VIDEO_FORMATS.
bool is_unpacked(const GstVideoFormatInfo& format) {
  PackedOrder order;
  if (is_packed(GST_VIDEO_FORMAT_INFO_FORMAT(&format), order)) return false;
  const int bytes = GST_VIDEO_FORMAT_INFO_DEPTH(&format, 0) > 8 ? 2 : 1;
  return GST_VIDEO_FORMAT_INFO_IS_RGB(&format) || GST_VIDEO_FORMAT_INFO_IS_COMPLEX(&format) ||
         GST_VIDEO_FORMAT_INFO_PSTRIDE(&format, 0) != bytes;
}

/// Whether the two views of a frame were squeezed into it. Demuxers of Matroska and MP4 say that
/// there are two views, but not whether they are squeezed; GStreamer guesses that from the shape.
bool has_half_views(const GstVideoInfo& info) {
  const auto flags = static_cast<int>(GST_VIDEO_INFO_MULTIVIEW_FLAGS(&info));
  return (flags & GST_VIDEO_MULTIVIEW_FLAGS_HALF_ASPECT) != 0 ||
         gst_video_multiview_guess_half_aspect(
             GST_VIDEO_INFO_MULTIVIEW_MODE(&info), static_cast<guint>(GST_VIDEO_INFO_WIDTH(&info)),
             static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&info)),
             static_cast<guint>(std::max(GST_VIDEO_INFO_PAR_N(&info), 1)),
             static_cast<guint>(std::max(GST_VIDEO_INFO_PAR_D(&info), 1)));
}

}  // namespace

PicturePart visible_part(const GstVideoFrame& frame) {
  const int width = GST_VIDEO_FRAME_WIDTH(&frame);
  const int height = GST_VIDEO_FRAME_HEIGHT(&frame);
  PicturePart part{0, 0, width, height};
  if (const GstVideoCropMeta* crop = gst_buffer_get_video_crop_meta(frame.buffer)) {
    part.x = static_cast<int>(std::min<guint>(crop->x, static_cast<guint>(width)));
    part.y = static_cast<int>(std::min<guint>(crop->y, static_cast<guint>(height)));
    part.width = static_cast<int>(std::min<guint>(crop->width, static_cast<guint>(width - part.x)));
    part.height =
        static_cast<int>(std::min<guint>(crop->height, static_cast<guint>(height - part.y)));
  }
  const GstVideoMultiviewMode views = GST_VIDEO_INFO_MULTIVIEW_MODE(&frame.info);
  if (is_side_by_side(views)) part.width /= 2;
  if (views == GST_VIDEO_MULTIVIEW_MODE_TOP_BOTTOM) part.height /= 2;
  return part;
}

double pixel_aspect(const GstVideoInfo& info) {
  double aspect = 1;
  if (GST_VIDEO_INFO_PAR_N(&info) > 0 && GST_VIDEO_INFO_PAR_D(&info) > 0) {
    aspect = static_cast<double>(GST_VIDEO_INFO_PAR_N(&info)) / GST_VIDEO_INFO_PAR_D(&info);
  }
  if (has_half_views(info)) {
    const GstVideoMultiviewMode views = GST_VIDEO_INFO_MULTIVIEW_MODE(&info);
    if (is_side_by_side(views)) aspect *= 2;
    if (views == GST_VIDEO_MULTIVIEW_MODE_TOP_BOTTOM) aspect /= 2;
  }
  return aspect <= kMaxAspect && aspect >= 1 / kMaxAspect ? aspect : 1;
}

LumaLevels luma_levels(const GstVideoInfo& info) {
  gint offset[GST_VIDEO_MAX_COMPONENTS], scale[GST_VIDEO_MAX_COMPONENTS];
  gst_video_color_range_offsets(GST_VIDEO_INFO_COLORIMETRY(&info).range, info.finfo, offset, scale);
  const auto depth = static_cast<int>(GST_VIDEO_FORMAT_INFO_DEPTH(info.finfo, 0));
  const auto eight_bits = [&](int level) { return depth > 8 ? level >> (depth - 8) : level; };
  const int white = eight_bits(offset[0] + scale[0]);
  // Formats of less than 8 bits are widened when they are unpacked.
  return depth < 8 || white <= 0 ? LumaLevels{} : LumaLevels{eight_bits(offset[0]), white};
}

bool holds_picture(const GstVideoFrame& frame) {
  GstVideoInfo tight;
  gst_video_info_set_format(&tight, GST_VIDEO_FRAME_FORMAT(&frame),
                            static_cast<guint>(GST_VIDEO_FRAME_WIDTH(&frame)),
                            static_cast<guint>(GST_VIDEO_FRAME_HEIGHT(&frame)));
  for (guint c = 0; c < GST_VIDEO_FRAME_N_COMPONENTS(&frame); ++c) {
    const auto plane = static_cast<guint>(GST_VIDEO_FRAME_COMP_PLANE(&frame, c));
    const gint64 stride = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, plane);
    const gint64 pixel = GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, c);
    // In formats like v210, in which pixels share words, a pixel has no size.
    const gint64 line = pixel > 0 ? pixel * GST_VIDEO_FRAME_COMP_WIDTH(&frame, c)
                                  : GST_VIDEO_INFO_PLANE_STRIDE(&tight, plane);
    const gint64 bytes = stride * (GST_VIDEO_FRAME_COMP_HEIGHT(&frame, c) - 1) + line;
    // With a video meta each plane is mapped separately; without one, all are in the first map.
    const GstMapInfo& map = frame.map[frame.meta ? plane : 0];
    const auto* first = static_cast<const guint8*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, plane));
    if (stride < line || first - map.data + bytes > static_cast<gint64>(map.size)) return false;
  }
  return true;
}

bool FrameLuma::supports(const GstVideoInfo& info) {
  const auto fits = [](int side) { return side >= kSmallestSide && side <= kLargestSide; };
  return fits(GST_VIDEO_INFO_WIDTH(&info)) && fits(GST_VIDEO_INFO_HEIGHT(&info));
}

ImageView FrameLuma::unpacked(const GstVideoFrame& frame, const PicturePart& shown) {
  const GstVideoFormatInfo* const format = frame.info.finfo;
  const GstVideoFormatInfo* const wide = gst_video_format_get_info(format->unpack_format);
  const bool is_rgb = GST_VIDEO_FORMAT_INFO_IS_RGB(wide);
  const bool is_deep = GST_VIDEO_FORMAT_INFO_DEPTH(wide, 0) > 8;
  const int width = GST_VIDEO_FRAME_WIDTH(&frame);
  const auto shown_width = static_cast<size_t>(shown.width);
  unpacked_row_.resize(4 * static_cast<size_t>(width));
  converted_.resize(shown_width * static_cast<size_t>(shown.height));
  gpointer planes[GST_VIDEO_MAX_PLANES];
  std::copy(std::begin(frame.data), std::end(frame.data), planes);
  for (int y = 0; y < shown.height; ++y) {
    // Whole rows are read, because not every format can be unpacked from the middle of a row.
    format->unpack_func(format, GST_VIDEO_PACK_FLAG_NONE, unpacked_row_.data(), planes,
                        frame.info.stride, 0, shown.y + y, width);
    uint8_t* const to = converted_.data() + static_cast<size_t>(y) * shown_width;
    const size_t first = 4 * static_cast<size_t>(shown.x);
    if (is_deep) {
      write_luma(unpacked_row_.data() + first, shown.width, is_rgb, to);
    } else {
      const auto* bytes = reinterpret_cast<const uint8_t*>(unpacked_row_.data());
      write_luma(bytes + first, shown.width, is_rgb, to);
    }
  }
  return {converted_.data(), shown.width, shown.height, shown.width};
}

ImageView FrameLuma::first_field(const ImageView& frame, bool top_first) {
  // Copy the lines of one field and interpolate the others, which keeps the picture's height.
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
  const PicturePart shown = visible_part(frame);
  if (shown.width < kSmallestSide || shown.height < kSmallestSide) return {};
  const ptrdiff_t stride = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0);
  const uint8_t* data = static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)) +
                        shown.y * stride + shown.x * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0);
  ImageView luma{data, shown.width, shown.height, stride, sample_of(*frame.info.finfo)};
  PackedOrder order;
  if (is_packed(GST_VIDEO_FRAME_FORMAT(&frame), order)) {
    luma = luma_of_packed(data, shown.width, shown.height, stride, order, converted_);
  } else if (is_unpacked(*frame.info.finfo)) {
    luma = unpacked(frame, shown);
  }
  if (GST_VIDEO_FRAME_IS_INTERLACED(&frame) && luma.height >= 2) {
    // If the crop begins on an odd line, its first line is one of the other field.
    luma = first_field(luma, GST_VIDEO_FRAME_IS_TFF(&frame) == (shown.y % 2 == 0));
  } else if (combing_.update(luma)) {
    // It is unknown which field is the earlier one, so the first is always used.
    luma = first_field(luma, true);
  }
  return luma;
}

}  // namespace spidar
