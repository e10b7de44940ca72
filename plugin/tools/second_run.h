// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What another run finds in the same frames.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include <gst/gst.h>

#include "core/analysis/measured_frame.h"
#include "plugin/tools/record_properties.h"

namespace spidar {

/// What a spidarmotion says of a frame.
struct FoundFrame {
  Shown shown = Shown::kFirst;  ///< kSame also for kWaiting and kAlike
  uint64_t interval_ns = 0;
  unsigned features = 0;

  bool operator==(const FoundFrame& other) const {
    return shown == other.shown && interval_ns == other.interval_ns && features == other.features;
  }
};

/// Hears what one element posts of each frame, before it passes the frame on.
class RunMessages {
 public:
  void listen(GstElement* pipeline, GstElement* motion);
  /// Of the frame that passes now, which has its meta; nothing when it was not measured.
  std::optional<FoundFrame> take(GstBuffer* frame);

 private:
  static void hears(GstBus* bus, GstMessage* message, gpointer self);

  GstElement* motion_ = nullptr;
  std::mutex lock_;
  std::optional<FoundFrame> found_;
};

/// A second spidarmotion, which takes frames that the first one has measured.
class SecondRun {
 public:
  SecondRun(GstElement* pipeline, const RecordProperties& properties);
  ~SecondRun();
  SecondRun(const SecondRun&) = delete;
  SecondRun& operator=(const SecondRun&) = delete;

  /// Takes a frame that `pad` sends, of the piece of this number; it begins with its first frame.
  /// Nothing when it does not measure it.
  std::optional<FoundFrame> measure(GstPad* pad, GstBuffer* frame, int part);

 private:
  static GstFlowReturn take(GstPad* pad, GstObject* parent, GstBuffer* frame);

  GstPad* const in_;
  GstPad* const out_;
  int part_ = 0;
  RunMessages messages_;
  std::optional<FoundFrame> found_;
};

}  // namespace spidar
