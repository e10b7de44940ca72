// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/video/video.h>

#include "core/orientation.h"
#include "plugin/gobject/downstream.h"

namespace spidar {

inline Orientation turn_of(GstVideoOrientationMethod method) {
  switch (method) {
    case GST_VIDEO_ORIENTATION_90R:
      return Orientation(1);
    case GST_VIDEO_ORIENTATION_180:
      return Orientation(2);
    case GST_VIDEO_ORIENTATION_90L:
      return Orientation(3);
    case GST_VIDEO_ORIENTATION_HORIZ:
      return Orientation(0, true);
    case GST_VIDEO_ORIENTATION_UR_LL:  // exchanges upper left and lower right
      return Orientation(1, true);
    case GST_VIDEO_ORIENTATION_VERT:
      return Orientation(2, true);
    case GST_VIDEO_ORIENTATION_UL_LR:  // exchanges upper right and lower left
      return Orientation(3, true);
    default:
      return Orientation();
  }
}

/// The orientation in which the frames of a stream are shown. Follows the tag `image-orientation`
/// by the rules of videoflip: the tag of the stream has priority over that of the whole film.
class StreamOrientation {
 public:
  /// Begins another stream, whose tags are not known yet.
  void begin_stream() { *this = {}; }
  /// Returns whether the tags contain an orientation.
  bool update(const GstTagList* tags) {
    const bool of_film = gst_tag_list_get_scope(tags) == GST_TAG_SCOPE_GLOBAL;
    // The cast is safe because the function does not change the tags.
    return gst_video_orientation_from_tag(const_cast<GstTagList*>(tags),
                                          of_film ? &of_film_ : &of_stream_) != FALSE;
  }
  GstVideoOrientationMethod method() const {
    const auto method = of_stream_ == GST_VIDEO_ORIENTATION_AUTO ? of_film_ : of_stream_;
    return method == GST_VIDEO_ORIENTATION_AUTO ? GST_VIDEO_ORIENTATION_IDENTITY : method;
  }
  Orientation turn() const { return turn_of(method()); }

 private:
  // GST_VIDEO_ORIENTATION_AUTO: no tag.
  GstVideoOrientationMethod of_stream_ = GST_VIDEO_ORIENTATION_AUTO;
  GstVideoOrientationMethod of_film_ = GST_VIDEO_ORIENTATION_AUTO;
};

/// Whether an element before `sink` turns the picture by the tag. The videoflip of GStreamer 1.22
/// still passes the tag on, where newer ones replace it by "rotate-0".
inline bool follows_tag_upstream(GstPad* sink) {
  return is_upstream(sink, [](GstElement* element) {
    if (!GST_IS_VIDEO_DIRECTION(element)) return false;
    GstVideoOrientationMethod method;
    g_object_get(element, "video-direction", &method, nullptr);
    return method == GST_VIDEO_ORIENTATION_AUTO;
  });
}

}  // namespace spidar
