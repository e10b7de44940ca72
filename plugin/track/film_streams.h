// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What kind of stream it is that a film has.
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include <gst/gst.h>

namespace spidar {

enum class StreamKind {
  kVideo,
  kSound,        ///< for ears
  kHapticTrack,  ///< six channels, at a rate that no sound has
  kOther,
};

/// Of the caps of a parsed or decoded stream.
StreamKind kind_of(const GstCaps* caps);

/// "2 channels, 48000 Hz"; empty when the caps do not say so.
std::string describe_sound(const GstCaps* caps);

/// Calls `known` once, in a streaming thread, when all streams that a parsebin has found have
/// become pads and the first of them begins to flow. What is linked then loses nothing.
class StreamsWatch {
 public:
  /// Outlived by this.
  StreamsWatch(GstElement* parsebin, std::function<void()> known);
  StreamsWatch(const StreamsWatch&) = delete;
  StreamsWatch& operator=(const StreamsWatch&) = delete;

 private:
  static void added(GstElement* parsebin, GstPad* pad, gpointer self);
  static GstPadProbeReturn flows(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  const std::function<void()> known_;
  std::once_flag once_;
};

/// Current caps, else what the pad could have. Owned by the caller.
GstCaps* caps_of(GstPad* pad);

}  // namespace spidar
