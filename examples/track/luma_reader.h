// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The luma of a video's frames, by GStreamer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/image_view.h"

/// Decodes as fast as it is asked to. Of a format with luma in a plane of its own nothing is
/// converted or copied.
class LumaReader {
 public:
  struct Frame {
    spidar::ImageView luma;  ///< valid until the next call
    int64_t running_time_ns = 0;
    int64_t stream_time_ns = 0;
  };

  /// `video` is a file or a URI. Throws std::invalid_argument for a name that can be no film, and
  /// std::runtime_error that says why it cannot be played.
  explicit LumaReader(const std::string& video);
  ~LumaReader();

  /// False at the end. Throws std::runtime_error when the video is broken, there is none in the
  /// file, or a frame of it has no time.
  bool next(Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
