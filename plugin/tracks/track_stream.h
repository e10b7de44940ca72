// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>

#include <gst/gst.h>

#include "core/track/track_format.h"
#include "core/track/track_sampler.h"

namespace spidar::tracks {

/// Caps of a haptic track as this project writes it. The channel mask of 5.1 comes first, though
/// the channels are no loudspeakers: FLAC has no other, containers return it in place of none, and
/// audioconvert does not convert between the two. A capsfilter can select mask 0x0.
#define SPIDAR_TRACK_CAPS_WITH(mask)                                                   \
  "audio/x-raw, format = (string) F32LE, layout = (string) interleaved, rate = (int) " \
  "1000, channels = (int) 6, channel-mask = (bitmask) " mask
#define SPIDAR_TRACK_CAPS SPIDAR_TRACK_CAPS_WITH("0x3f") "; " SPIDAR_TRACK_CAPS_WITH("0x0")

struct FrameWrench {
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  GstClockTime duration = GST_CLOCK_TIME_NONE;
  bool known = false;     ///< whether the frame was analysed
  bool compared = false;  ///< with an earlier frame: the wrench holds until the next frame is due
  bool repeats = false;   ///< whether the frame shows the picture of the previous one
  /// Running time between the two pictures from which the motion was measured; 0: none.
  int64_t interval_ns = 0;
  Wrench wrench;
};

/// The pad `wrench` of spidarextract: converts the wrenches of frames to buffers of samples. The
/// samples are at whole milliseconds of the running time of the video, from 0 on, whatever the
/// segments of the frames are: encoders of sound accept no step backwards, but a demuxer may move
/// the segment after the first frame (matroskademux, when the sound begins earlier than the
/// pictures), and an edit list has one segment for each edit. The segment of the samples gives
/// their stream time.
///
/// Streaming thread only. All methods that return a flow push the samples that have become known.
class Stream {
 public:
  static constexpr GstClockTime kBuffer_ns = 40 * GST_MSECOND;
  /// The curve between two frames needs the frame after them. If that frame is further away than
  /// this, the samples do not wait for it.
  static constexpr GstClockTime kLookAhead_ns = 100 * GST_MSECOND;
  /// An interval without frames has silent samples. A longer one than this has none: a timestamp is
  /// wrong, or the stream had been running for long when it was joined.
  static constexpr int64_t kLongestSilence_ns = 3600 * int64_t{1'000'000'000};

  /// `pad` belongs to the element that owns this object.
  explicit Stream(GstPad* pad);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Begins another stream, with a stream id of its own.
  void begin_stream(GstElement* element, const GstEvent* stream_start);
  /// Begins a segment of the video. The samples begin another segment only where their stream time
  /// does not continue.
  GstFlowReturn begin_segment(const GstEvent* event);
  GstFlowReturn add(const FrameWrench& frame);
  /// Call this when there are no frames from `pts` on.
  GstFlowReturn add_gap(GstClockTime pts);
  /// Pushes everything up to the end of the last frame, where the force is zero.
  GstFlowReturn finish();
  void flush();
  /// Also discards the segment.
  void reset();

  /// Whether a buffer has been pushed since the beginning, or the last flush.
  bool has_pushed() const { return pushed_; }
  const Wrench& last_wrench() const { return last_wrench_; }

  static constexpr GstClockTime latency_ns() { return kBuffer_ns + kLookAhead_ns; }

 private:
  bool negotiate();
  int64_t running_ns(guint64 time) const;
  void begin_at(int64_t time_ns);
  /// Whether a frame is so late that its time stamp may be wrong, unless the next is near it.
  bool is_alone(int64_t time_ns);
  /// Pushes everything up to the end of the last frame, or to `until_ns`, which may be later.
  GstFlowReturn settle(int64_t until_ns);
  GstFlowReturn push_until(int64_t time_ns);
  GstFlowReturn push(const TrackSample& sample, GstClockTime pts);
  GstFlowReturn push();

  GstPad* const pad_;
  GstSegment segment_{};  ///< of the video
  GstSegment sent_{};     ///< of the samples
  bool negotiated_ = false;
  bool begun_ = false;
  bool pushed_ = false;
  int64_t jumped_to_ns_ = -1;  ///< time of the last frame, if that is_alone()
  TrackSampler sampler_;
  int64_t last_frame_ns_ = 0;  ///< running time
  Wrench last_wrench_;
  int64_t interval_ns_ = 0;  ///< duration of the last frame, or the time since the previous one
  // The buffer that is being filled.
  GstBuffer* buffer_ = nullptr;
  GstMapInfo map_{};
  size_t filled_ = 0;
  bool silent_ = true;
  bool discont_ = true;
};

}  // namespace spidar::tracks
