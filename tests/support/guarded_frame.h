// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include <gst/video/video.h>

#include "tests/support/random_source.h"

namespace spidar::test {

/// Grey levels, line by line.
struct GreyPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> level;

  uint8_t at(int x, int y) const {
    return level[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
};

struct FrameLayout {
  guint planes = 0;
  gint stride[GST_VIDEO_MAX_PLANES] = {};
  gsize before[GST_VIDEO_MAX_PLANES] = {};  ///< in front of the plane
  bool one_memory = true;                   ///< for all planes; otherwise one each
  bool guard_in_front = false;  ///< whether the page without access is in front, not behind
};

/// A random layout that is valid for such frames.
FrameLayout random_layout(const GstVideoInfo& info, RandomSource& random);

/// A buffer with a GstVideoMeta that shows `picture`, which has the size of `info`, in luma or as
/// grey. Chroma, alpha, the bits of luma below the eight highest and the padding are noise. An
/// access to the page behind the last byte of each memory (or in front of the first one) ends the
/// program.
GstBuffer* make_guarded_frame(const GstVideoInfo& info, const GreyPicture& picture,
                              const FrameLayout& layout, RandomSource& random);

}  // namespace spidar::test
