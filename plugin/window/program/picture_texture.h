// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>
#include <gst/video/video.h>

#include "core/touch/height_field.h"
#include "plugin/gobject/ref.h"
#include "plugin/window/view/shared_pictures.h"

namespace spidar::window {

class PictureTexture {
 public:
  PictureTexture() {
    glGenTextures(1, &id_);
    glBindTexture(GL_TEXTURE_2D, id_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  ~PictureTexture() {
    glDeleteTextures(1, &id_);
    if (converter_) gst_video_converter_free(converter_);
  }
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;

  /// Converts a frame to RGB in its own colorimetry, scaled down to at most `most_width` pixels,
  /// and uploads it. Returns false when the frame cannot be converted: the texture stays.
  bool load(const SharedPicture& picture, int most_width) {
    const GstVideoInfo& info = picture.info();
    const int frame_width = GST_VIDEO_INFO_WIDTH(&info),
              frame_height = GST_VIDEO_INFO_HEIGHT(&info);
    const int width = std::clamp(most_width, 1, frame_width);
    const int height =
        std::max(1, static_cast<int>(static_cast<int64_t>(frame_height) * width / frame_width));
    GstVideoFrame source, target;
    if (!prepare(info, width, height)) return false;
    const gsize bytes = GST_VIDEO_INFO_SIZE(&info);
    // Read-only, so that the pixels stay as they are.
    const Ref<GstBuffer> buffer(gst_buffer_new_wrapped_full(GST_MEMORY_FLAG_READONLY,
                                                            const_cast<uint8_t*>(picture.pixels()),
                                                            bytes, 0, bytes, nullptr, nullptr));
    if (!gst_video_frame_map(&source, &source_, buffer.get(), GST_MAP_READ)) return false;
    if (!gst_video_frame_map(&target, &target_, converted_.get(), GST_MAP_READWRITE)) {
      gst_video_frame_unmap(&source);
      return false;
    }
    gst_video_converter_frame(converter_, &source, &target);
    upload(GST_VIDEO_FRAME_PLANE_DATA(&target, 0), width, height);
    frame_width_ = frame_width;
    frame_height_ = frame_height;
    pixel_aspect_ = static_cast<double>(GST_VIDEO_INFO_PAR_N(&info)) / GST_VIDEO_INFO_PAR_D(&info);
    gst_video_frame_unmap(&target);
    gst_video_frame_unmap(&source);
    return true;
  }

  /// Loads the shading of a relief, whose shadow darkens and whose light brightens a picture.
  void load_shading(const std::string& shading) {
    constexpr int kLevel = 128, kPictureStays = 3;  // a third of the picture always shows
    std::vector<uint8_t> rgba;
    rgba.reserve(4 * shading.size());
    for (const char cell : shading) {
      const int above = static_cast<uint8_t>(cell) - kLevel;
      const auto grey = static_cast<uint8_t>(above < 0 ? 0 : 255);
      const int opacity = std::min(255, 2 * std::abs(above)) * (kPictureStays - 1) / kPictureStays;
      rgba.insert(rgba.end(), {grey, grey, grey, static_cast<uint8_t>(opacity)});
    }
    upload(rgba.data(), touch::HeightField::kColumns, touch::HeightField::kRows);
  }

  /// Uploads RGBA, rows from the top, without padding.
  void upload(const void* rgba, int width, int height) {
    glBindTexture(GL_TEXTURE_2D, id_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (width == width_ && height == height_) {
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    } else {
      glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    }
    width_ = width;
    height_ = height;
  }

  /// Properties of the frame of the texture.
  int frame_width() const { return frame_width_; }
  int frame_height() const { return frame_height_; }
  double pixel_aspect() const { return pixel_aspect_; }

  bool empty() const { return width_ == 0; }
  unsigned id() const { return id_; }

 private:
  bool prepare(const GstVideoInfo& source, int width, int height) {
    if (converter_ && gst_video_info_is_equal(&source, &source_) &&
        GST_VIDEO_INFO_WIDTH(&target_) == width && GST_VIDEO_INFO_HEIGHT(&target_) == height) {
      return true;
    }
    if (converter_) gst_video_converter_free(converter_);
    source_ = source;
    gst_video_info_set_format(&target_, GST_VIDEO_FORMAT_RGBA, static_cast<guint>(width),
                              static_cast<guint>(height));
    converter_ = gst_video_converter_new(
        &source_, &target_,
        gst_structure_new("options", GST_VIDEO_CONVERTER_OPT_RESAMPLER_METHOD,
                          GST_TYPE_VIDEO_RESAMPLER_METHOD, GST_VIDEO_RESAMPLER_METHOD_LINEAR,
                          nullptr));
    converted_.reset(gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&target_), nullptr));
    return converter_ && converted_;
  }

  unsigned id_ = 0;
  int width_ = 0, height_ = 0;
  int frame_width_ = 0, frame_height_ = 0;
  double pixel_aspect_ = 1;
  GstVideoInfo source_{};
  GstVideoInfo target_{};
  GstVideoConverter* converter_ = nullptr;
  Ref<GstBuffer> converted_;
};

}  // namespace spidar::window
