// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which depth image belongs to a frame of video.
#pragma once

#include <memory>
#include <optional>

#include <gst/gst.h>

namespace spidar {

/// When something is on the screen: running times, which are below 0 before the segment begins.
struct ShownTime {
  gint64 start_ns = 0;
  gint64 end_ns = 0;  ///< = start_ns where it is not known

  gint64 length_ns() const { return end_ns - start_ns; }
};

/// Of `buffer` in `segment`, whichever way it is played. `frame_ns` is the length of a frame that
/// has no duration, 0 where it is not known. Empty when it has no running time.
std::optional<ShownTime> shown_time(const GstSegment& segment, GstBuffer* buffer,
                                    GstClockTime frame_ns);

struct Unref {
  void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
  void operator()(GstCaps* caps) const { gst_caps_unref(caps); }
};

struct DepthImage {
  std::unique_ptr<GstBuffer, Unref> buffer;
  std::unique_ptr<GstCaps, Unref> caps;
  ShownTime time;
};

/// Holds the latest depth image, and the one after it. A frame of video gets the latest image that
/// begins at most half the shorter of the two lengths after the frame: the nearest one when both
/// streams have the same rate but begin at different times. Times of frames should not decrease.
class DepthMatch {
 public:
  /// There is room for a depth image again when settled() has used the one that waited.
  bool has_room() const { return !next_; }
  void add(DepthImage image) { next_ = std::move(image); }
  /// No depth image begins before `running_ns`.
  void reach(gint64 running_ns) { known_until_ns_ = running_ns; }
  /// There will be no more images.
  void finish() { finished_ = true; }
  /// There will be after all.
  void resume() { finished_ = false; }
  /// Forgets everything.
  void flush() { *this = {}; }

  /// Uses what has come. True when nothing that comes later can belong to this frame.
  bool settled(const ShownTime& frame);
  /// After settled(): what belongs to the frame, or null. An image is used until its end, and
  /// `max_age_ns` longer where the next one is missing.
  const DepthImage* find(const ShownTime& frame, guint64 max_age_ns) const;

 private:
  std::optional<DepthImage> held_;
  std::optional<DepthImage> next_;
  gint64 known_until_ns_ = G_MININT64;
  bool finished_ = false;
};

}  // namespace spidar
