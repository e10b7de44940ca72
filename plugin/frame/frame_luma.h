// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include <gst/video/video.h>

#include "core/field/combing.h"
#include "core/picture/image_view.h"
#include "core/picture/picture_part.h"

namespace spidar {

/// Formats that FrameLuma reads, for the pad templates: the cheapest ones first.
#define SPIDAR_VIDEO_FORMATS                                                      \
  "{ GRAY8, I420, YV12, NV12, NV21, Y42B, NV16, NV61, Y444, NV24, Y41B, A420, "   \
  "P010_10LE, P012_LE, P016_LE, I420_10LE, I420_12LE, I422_10LE, I422_12LE, "     \
  "Y444_10LE, Y444_12LE, Y444_16LE, A420_10LE, A422_10LE, A444_10LE, GRAY16_LE, " \
  "P010_10BE, P012_BE, P016_BE, I420_10BE, I420_12BE, I422_10BE, I422_12BE, "     \
  "Y444_10BE, Y444_12BE, Y444_16BE, A420_10BE, A422_10BE, A444_10BE, GRAY16_BE, " \
  "BGR, RGB, BGRx, RGBx, BGRA, RGBA }"

/// Further formats, which FrameLuma reads after GStreamer has unpacked (converted) each row.
#define SPIDAR_UNPACKED_FORMATS                                          \
  "{ YUY2, UYVY, YVYU, VYUY, AYUV, VUYA, v308, ARGB, xRGB, ABGR, xBGR, " \
  "GBR, GBR_10LE, GBR_12LE, GBR_10BE, GBR_12BE, Y210, Y212_LE, Y410, "   \
  "v210, v216, BGR10A2_LE, RGB10A2_LE, r210 }"

/// How each field of GstVideoInfo is used:
///
/// - finfo, stride, offset: FrameLuma reads every format above as its caps and video meta describe.
/// - interlace_mode, field order: FrameLuma takes the first field.
/// - width, height: visible_part().
/// - par_n, par_d: pixel_aspect(); motion is measured in square pixels (SquarePixelResampler).
/// - multiview_mode, HALF_ASPECT of its flags, or the shape of the frame where the flag is not set:
///   visible_part() and pixel_aspect(). Of two pictures in one frame the first is analysed, since
///   both show the same motion; where views alternate from frame to frame, a frame with the time of
///   the previous one is left out.
/// - other multiview flags say which eye a picture is for, and not where it is.
/// - views counts pictures in planes or buffers of their own, of which the first one is mapped.
/// - colorimetry: luma_levels() reads the range, which gives black and white for touch=luma. Motion
///   does not depend on contrast, which in limited range is 0.86 of that in full range. Matrix,
///   transfer and primaries are the same in all frames, and motion needs none of them.
/// - chroma_site: chroma is not read.
/// - fps_n, fps_d: nominal_duration(), where a frame has no duration of its own.
/// - size, flags: holds_picture() looks at the memory itself. The flags announce variable rates,
///   which the timestamps show, and alpha, which is not read.

/// The part of a frame that is shown, and therefore analysed: its crop meta, else the whole frame;
/// of two views beside or above each other, the first.
PicturePart visible_part(const GstVideoFrame& frame);

/// Width over height of a shown pixel; 1 where the caps say nothing. A ratio above kMaxAspect or
/// below its inverse also counts as 1, because the header must be damaged: the widest pixels of any
/// format have 2.84 (half of a side-by-side picture of PAL, 64:45).
constexpr double kMaxAspect = 4;
double pixel_aspect(const GstVideoInfo& info);

/// The brightness of black and white among the eight bits that are read.
struct LumaLevels {
  int black = 0;
  int white = 255;
};
LumaLevels luma_levels(const GstVideoInfo& info);

/// Whether the mapped memory holds every line of every plane, one after the other from the top.
/// GStreamer does not check a GstVideoMeta.
bool holds_picture(const GstVideoFrame& frame);

/// Returns the luma of a video frame for the analysis. Reads plane 0 of planar and semi-planar
/// formats in place, with its stride and its depth in bits, and computes luma from packed RGB and
/// from formats that must be unpacked. Applies a crop meta. Uses only the first field of interlaced
/// frames, flagged or not, because the two fields are of two moments. With interlace-mode=mixed,
/// the flags of each frame say whether it is interlaced.
class FrameLuma {
 public:
  /// In pixels; a crop may leave less.
  static constexpr int kSmallestSide = 16;
  static constexpr int kLargestSide = 8192;
  static bool supports(const GstVideoInfo& info);

  /// The view is valid until the next call and for as long as the frame is mapped. It is empty (no
  /// data) when the crop leaves too little.
  ImageView view(const GstVideoFrame& frame);

 private:
  ImageView unpacked(const GstVideoFrame& frame, const PicturePart& shown);
  ImageView first_field(const ImageView& frame, bool top_first);

  Combing combing_;
  std::vector<uint8_t> converted_;
  std::vector<uint8_t> field_;
  std::vector<uint16_t> unpacked_row_;
};

}  // namespace spidar
