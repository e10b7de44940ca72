// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads the luma of a video's frames with GStreamer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/image_view.h"

/// Decodes frames on demand. A format that has luma in a plane of its own is neither converted nor
/// copied.
class LumaReader {
 public:
  struct Frame {
    spidar::ImageView luma;  ///< valid until the next call
    int64_t running_time_ns = 0;
    int64_t stream_time_ns = 0;
  };

  /// `video` is a file or a URI. Throws std::invalid_argument for a name that cannot be a film, and
  /// std::runtime_error that says why it cannot be played.
  explicit LumaReader(const std::string& video);
  ~LumaReader();

  /// Returns false at the end. Throws std::runtime_error when the video is broken, the file has no
  /// video, or a frame has no timestamp.
  bool next(Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
