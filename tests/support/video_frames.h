// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames in every format, with a texture that moves by known amounts.
#pragma once

#include <functional>

#include <gst/video/video.h>

namespace spidar::test {

/// Grey level 8 … 248 of the picture that make_frame() moves.
double texture(double x, double y);

/// Grey level 0 … 255 by column and row.
using GreyAt = std::function<double(int, int)>;

/// A buffer of `info` that shows these grey levels. Packed RGB is grey; chroma is neutral.
/// `plane0_extra_stride` bytes are added to each line of plane 0 (with a GstVideoMeta).
GstBuffer* make_picture(const GstVideoInfo& info, const GreyAt& grey, int plane0_extra_stride = 0);

/// texture() moved by (dx, dy).
GstBuffer* make_frame(const GstVideoInfo& info, double dx, double dy, int plane0_extra_stride = 0);

GstCaps* make_caps(const char* format, int width, int height, int fps_n = 25, int fps_d = 1);

}  // namespace spidar::test
