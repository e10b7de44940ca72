// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A frame of video as a texture.
#pragma once

#include <cstdint>
#include <vector>

#include <gst/video/video.h>

#include "plugin/window/view/shared_pictures.h"

namespace spidar {

class PictureTexture {
 public:
  PictureTexture();
  ~PictureTexture();
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;

  /// Converts to RGB in the frame's own colorimetry, scaled down when it is more than `most_width`
  /// pixels wide, and uploads it. False when the frame cannot be converted: the texture stays.
  bool load(const SharedPicture& picture, int most_width);

  /// RGBA, rows from the top, without padding.
  void upload(const void* rgba, int width, int height);

  /// Of the frame that it was made from.
  int frame_width() const { return frame_width_; }
  int frame_height() const { return frame_height_; }
  double pixel_aspect() const { return pixel_aspect_; }

  bool empty() const { return width_ == 0; }
  /// Of what is shown, on a screen with square pixels.
  double aspect() const { return height_ > 0 ? pixel_aspect_ * width_ / height_ : 1; }
  unsigned id() const { return id_; }

 private:
  bool prepare(const GstVideoInfo& source, int width, int height);

  unsigned id_ = 0;
  int width_ = 0, height_ = 0;
  int frame_width_ = 0, frame_height_ = 0;
  double pixel_aspect_ = 1;
  GstVideoInfo source_{};
  GstVideoInfo target_{};
  GstVideoConverter* converter_ = nullptr;
  GstBuffer* converted_ = nullptr;
};

}  // namespace spidar
