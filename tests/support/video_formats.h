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

/// Those that a list for caps names: SPIDAR_VIDEO_FORMATS or SPIDAR_UNPACKED_FORMATS.
inline std::vector<std::string> formats_in(std::string text) {
  for (char& c : text) {
    if (c == '{' || c == '}' || c == ',') c = ' ';
  }
  std::istringstream words(text);
  std::vector<std::string> found;
  for (std::string word; words >> word;) found.push_back(word);
  return found;
}

/// All that are read in place.
inline const std::vector<std::string>& video_formats() {
  static const std::vector<std::string> formats = formats_in(SPIDAR_VIDEO_FORMATS);
  return formats;
}

inline GstVideoFormat format_named(const std::string& name) {
  return gst_video_format_from_string(name.c_str());
}

/// Writes a component of one pixel: `level`, 0 … 255, in the eight highest of its bits and in those
/// below, if there are any, those of `rest`.
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
  // A word need not lie at an even address.
  const bool low_first = GST_VIDEO_FORMAT_INFO_IS_LE(&format);
  sample[low_first ? 0 : 1] = static_cast<guint8>(word & 0xFF);
  sample[low_first ? 1 : 0] = static_cast<guint8>(word >> 8);
}

/// Of a component of a pixel, bytes: in words V of a plane that it shares with U is the second one.
inline int component_offset(const GstVideoFormatInfo& format, guint component) {
  const bool word = GST_VIDEO_FORMAT_INFO_DEPTH(&format, component) > 8;
  if (!word) return GST_VIDEO_FORMAT_INFO_POFFSET(&format, component);
  return component == 2 && GST_VIDEO_FORMAT_INFO_N_PLANES(&format) == 2 ? 2 : 0;
}

}  // namespace spidar::test
