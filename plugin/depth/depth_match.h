// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Matches depth images to video frames.
#pragma once

#include <optional>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"

namespace spidar {

/// Time interval on the screen, in running time; negative before the segment begins.
struct ShownTime {
  gint64 start_ns = 0;
  gint64 end_ns = 0;  ///< equal to start_ns if unknown

  gint64 length_ns() const { return end_ns - start_ns; }
};

/// The interval of `buffer` in `segment`, for either playback direction. `frame_ns` is the duration
/// to use for a buffer without one, 0 if unknown. Empty when the buffer has no running time.
std::optional<ShownTime> shown_time(const GstSegment& segment, GstBuffer* buffer,
                                    GstClockTime frame_ns);

struct DepthImage {
  Ref<GstBuffer> buffer;
  Ref<GstCaps> caps;
  ShownTime time;
};

/// Holds the current depth image and the next one. A video frame gets the latest image that begins
/// no later than the start of the frame plus half the shorter of the two durations. This is the
/// nearest image when both streams have the same rate but a different offset. The times of frames
/// should not decrease.
class DepthMatch {
 public:
  /// Whether a depth image can be added. settled() makes room by consuming the waiting one.
  bool has_room() const { return !next_; }
  void add(DepthImage image) { next_ = std::move(image); }
  /// Announces that no further depth image begins before `running_ns`.
  void reach(gint64 running_ns) { known_until_ns_ = running_ns; }
  /// Announces that no more images will come.
  void finish() { finished_ = true; }
  /// Revokes finish().
  void resume() { finished_ = false; }
  /// Forgets everything.
  void flush() { *this = {}; }

  /// Consumes a waiting image if it is due. Returns true if no later image can belong to this
  /// frame.
  bool settled(const ShownTime& frame);
  /// Call after settled(). Returns the image for the frame, or null. An image is valid until its
  /// end, and `max_age_ns` longer if the next one is missing.
  const DepthImage* find(const ShownTime& frame, guint64 max_age_ns) const;

 private:
  std::optional<DepthImage> held_;
  std::optional<DepthImage> next_;
  gint64 known_until_ns_ = G_MININT64;
  bool finished_ = false;
};

}  // namespace spidar
