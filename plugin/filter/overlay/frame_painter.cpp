// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/overlay/frame_painter.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

uint16_t bounded(double value, uint16_t most) {
  return static_cast<uint16_t>(std::clamp<long>(std::lround(value), 0, most));
}

/// Offset of a component from the beginning of its pixel, bytes. For V of P010 and similar formats
/// GStreamer 1.22 reports 1, although it follows a word of two bytes.
int offset_of(const GstVideoFormatInfo* format, guint component) {
  const int offset = GST_VIDEO_FORMAT_INFO_POFFSET(format, component);
  return GST_VIDEO_FORMAT_INFO_DEPTH(format, component) > 8 && offset == 1 ? 2 : offset;
}

/// First and last pixel between two coordinates, of those from `begin` on. They are clamped as
/// doubles, because coordinates may lie outside the range of an int.
int first_pixel(double low, int begin, int size) {
  return static_cast<int>(
      std::ceil(std::clamp<double>(low, begin, static_cast<double>(begin) + size)));
}
int last_pixel(double high, int begin, int size) {
  return static_cast<int>(std::floor(std::clamp(high, begin - 1.0, begin + size - 1.0)));
}

double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

FramePainter::Components FramePainter::components_of(Rgb color) const {
  const GstVideoInfo& info = frame_.info;
  if (GST_VIDEO_INFO_IS_RGB(&info)) return {color.r, color.g, color.b, 255};
  // Y'CbCr by the colorimetry of the caps, or by ITU-R BT.601 if that is unknown.
  double kr = 0.299, kb = 0.114;
  gst_video_color_matrix_get_Kr_Kb(GST_VIDEO_INFO_COLORIMETRY(&info).matrix, &kr, &kb);
  gint offset[GST_VIDEO_MAX_COMPONENTS], scale[GST_VIDEO_MAX_COMPONENTS];
  gst_video_color_range_offsets(GST_VIDEO_INFO_COLORIMETRY(&info).range, info.finfo, offset, scale);
  const double r = color.r / 255.0, g = color.g / 255.0, b = color.b / 255.0;
  const double y = kr * r + (1 - kr - kb) * g + kb * b;
  const auto most = static_cast<uint16_t>((1u << GST_VIDEO_INFO_COMP_DEPTH(&info, 0)) - 1);
  Components value{};
  value[0] = bounded(offset[0] + scale[0] * y, most);
  value[1] = bounded(offset[1] + scale[1] * (b - y) / (2 * (1 - kb)), most);
  value[2] = bounded(offset[2] + scale[2] * (r - y) / (2 * (1 - kr)), most);
  value[3] = most;
  return value;
}

void FramePainter::set(int x, int y, const Components& value) {
  const GstVideoFormatInfo* format = frame_.info.finfo;
  for (guint c = 0; c < GST_VIDEO_FRAME_N_COMPONENTS(&frame_); ++c) {
    const ptrdiff_t row = y >> GST_VIDEO_FORMAT_INFO_H_SUB(format, c);
    const ptrdiff_t column = x >> GST_VIDEO_FORMAT_INFO_W_SUB(format, c);
    const auto plane = static_cast<guint>(GST_VIDEO_FRAME_COMP_PLANE(&frame_, c));
    auto* sample = static_cast<uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame_, plane)) +
                   row * GST_VIDEO_FRAME_PLANE_STRIDE(&frame_, plane) +
                   column * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame_, c) + offset_of(format, c);
    if (GST_VIDEO_FORMAT_INFO_DEPTH(format, c) <= 8) {
      *sample = static_cast<uint8_t>(value[c]);
      continue;
    }
    // Written byte by byte because the frame's memory need not be aligned.
    const auto word = static_cast<uint16_t>(value[c] << GST_VIDEO_FORMAT_INFO_SHIFT(format, c));
    const bool low_first = GST_VIDEO_FORMAT_INFO_IS_LE(format);
    sample[low_first ? 0 : 1] = static_cast<uint8_t>(word & 0xFF);
    sample[low_first ? 1 : 0] = static_cast<uint8_t>(word >> 8);
  }
}

void FramePainter::fill(const Eigen::Vector2d* corners_px, size_t count, const Components& value) {
  Eigen::Vector2d low_px = corners_px[0], high_px = corners_px[0];
  double area = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!corners_px[i].allFinite()) return;
    low_px = low_px.cwiseMin(corners_px[i]);
    high_px = high_px.cwiseMax(corners_px[i]);
    area += cross_product(corners_px[i], corners_px[(i + 1) % count]);
  }
  const double around = area < 0 ? -1 : 1;
  constexpr double kOnBorder = 1e-9;
  const VisiblePart& on = visible_;
  const int right = last_pixel(stored_x(high_px.x()), on.x, on.width);
  const int bottom = last_pixel(high_px.y(), on.y, on.height);
  for (int y = first_pixel(low_px.y(), on.y, on.height); y <= bottom; ++y) {
    for (int x = first_pixel(stored_x(low_px.x()), on.x, on.width); x <= right; ++x) {
      const Eigen::Vector2d at_px(shown_x(x), y);
      bool inside = true;
      for (size_t i = 0; i < count && inside; ++i) {
        const Eigen::Vector2d& from_px = corners_px[i];
        const Eigen::Vector2d& to_px = corners_px[(i + 1) % count];
        inside = around * cross_product(to_px - from_px, at_px - from_px) >= -kOnBorder;
      }
      if (inside) set(x, y, value);
    }
  }
}

void FramePainter::draw(const ArrowShape& shape, Rgb color) {
  const Components value = components_of(color);
  fill(shape.shaft_px.data(), shape.shaft_px.size(), value);
  if (shape.has_head) fill(shape.head_px.data(), shape.head_px.size(), value);
}

void FramePainter::stroke(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                          double width_px, Rgb color) {
  const Eigen::Vector2d along = (to_px - from_px).normalized();
  const Eigen::Vector2d side = width_px / 2 * Eigen::Vector2d(-along.y(), along.x());
  const std::array<Eigen::Vector2d, 4> corners_px{from_px - side, to_px - side, to_px + side,
                                                  from_px + side};
  fill(corners_px.data(), corners_px.size(), components_of(color));
}

void FramePainter::cross(const Eigen::Vector2d& centre_px, double size_px, double width_px,
                         Rgb color) {
  for (const double lean : {-1.0, 1.0}) {
    const Eigen::Vector2d half_px = size_px / 2 * Eigen::Vector2d(M_SQRT1_2, lean * M_SQRT1_2);
    stroke(centre_px - half_px, centre_px + half_px, width_px, color);
  }
}

void FramePainter::disc(const Eigen::Vector2d& centre_px, double radius_px, Rgb color,
                        double hole_px) {
  if (!centre_px.allFinite() || !(radius_px >= 0)) return;
  const Components value = components_of(color);
  const VisiblePart& on = visible_;
  const int right = last_pixel(stored_x(centre_px.x() + radius_px), on.x, on.width);
  const int bottom = last_pixel(centre_px.y() + radius_px, on.y, on.height);
  for (int y = first_pixel(centre_px.y() - radius_px, on.y, on.height); y <= bottom; ++y) {
    for (int x = first_pixel(stored_x(centre_px.x() - radius_px), on.x, on.width); x <= right;
         ++x) {
      const double distance_px = (Eigen::Vector2d(shown_x(x), y) - centre_px).norm();
      if (distance_px <= radius_px && distance_px > hole_px) set(x, y, value);
    }
  }
}

}  // namespace spidar
