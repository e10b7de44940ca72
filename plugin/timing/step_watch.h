// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Steps of the sink (GST_EVENT_STEP).
#pragma once

#include <functional>
#include <utility>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"

namespace spidar {

/// A sink that steps over frames with a flush shows what follows as much earlier: it moves its own
/// segment, and nobody upstream is told. All that is to be known of it is the message that the
/// application gets (STEP_DONE), so this listens to the pipeline's bus.
class StepWatch {
 public:
  /// Calls `skipped` with the running time that a sink behind `element` has skipped, in the thread
  /// that posts the message.
  StepWatch(GstElement* element, std::function<void(GstClockTime)> skipped)
      : element_(element), skipped_(std::move(skipped)) {}

  /// State changes of the element only.
  void begin();
  void end();

 private:
  static void on_step_done(GstBus* bus, GstMessage* message, gpointer watch);

  GstElement* const element_;
  const std::function<void(GstClockTime)> skipped_;
  Ref<GstBus> bus_;
  gulong handler_ = 0;
};

}  // namespace spidar
