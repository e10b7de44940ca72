// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A frame of video as a texture.
#pragma once

#include <cstdint>
#include <vector>

#include <gst/video/video.h>

#include "plugin/window/frame_feed.h"

namespace spidar {

/// Of the GL context that is current when it is used, made and destroyed.
class PictureTexture {
 public:
  PictureTexture();
  ~PictureTexture();
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;

  /// Converts to RGB in the frame's own colorimetry, scaled down when it is more than `most_width`
  /// pixels wide, and uploads it. False when the frame cannot be converted: the texture stays.
  bool load(const PictureCopy& picture, int most_width);

  bool empty() const { return width_ == 0; }
  unsigned id() const { return id_; }

 private:
  bool prepare(const GstVideoInfo& source, int width, int height);

  unsigned id_ = 0;
  int width_ = 0, height_ = 0;
  GstVideoInfo source_{};
  GstVideoInfo target_{};
  GstVideoConverter* converter_ = nullptr;
  GstBuffer* converted_ = nullptr;
};

}  // namespace spidar
