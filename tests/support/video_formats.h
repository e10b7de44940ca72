// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The formats of the element's pads, and how their samples are stored.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gst/video/video.h>

#include "plugin/frame/frame_luma.h"

namespace spidar::test {

/// The formats in a list for caps: SPIDAR_VIDEO_FORMATS or SPIDAR_UNPACKED_FORMATS.
inline std::vector<std::string> formats_in(std::string text) {
  for (char& c : text) {
    if (c == '{' || c == '}' || c == ',') c = ' ';
  }
  std::istringstream words(text);
  std::vector<std::string> found;
  for (std::string word; words >> word;) found.push_back(word);
  return found;
}

/// All formats that are read in place.
inline const std::vector<std::string>& video_formats() {
  static const std::vector<std::string> formats = formats_in(SPIDAR_VIDEO_FORMATS);
  return formats;
}

/// Writes a component of one pixel: `level`, 0 … 255, into its eight highest bits, and `rest` into
/// the bits below, if there are any.
inline void write_sample(const GstVideoFormatInfo& format, guint component, guint level, guint rest,
                         guint8* sample) {
  const guint depth = GST_VIDEO_FORMAT_INFO_DEPTH(&format, component);
  if (depth <= 8) {
    *sample = static_cast<guint8>(level);
    return;
  }
  const guint below = depth - 8;
  const guint value = level << below | (rest & ((1u << below) - 1));
  const auto word = static_cast<guint16>(value << GST_VIDEO_FORMAT_INFO_SHIFT(&format, component));
  // A word may lie at an odd address.
  const bool low_first = GST_VIDEO_FORMAT_INFO_IS_LE(&format);
  sample[low_first ? 0 : 1] = static_cast<guint8>(word & 0xFF);
  sample[low_first ? 1 : 0] = static_cast<guint8>(word >> 8);
}

}  // namespace spidar::test
