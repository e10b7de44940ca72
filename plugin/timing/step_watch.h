// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Steps of the sink (GST_EVENT_STEP).
#pragma once

#include <gst/gst.h>

namespace spidar {

/// A sink that steps over frames with a flush shows what follows as much earlier: it moves its own
/// segment, and nobody upstream is told. All that is to be known of it is the message that the
/// application gets (STEP_DONE), so this listens to the pipeline's bus.
///
/// State changes of the element only; what is heard goes to its engine.
class StepWatch {
 public:
  /// `element` is a spidarmotion, and where it is to play.
  void begin(GstElement* element);
  void end();

 private:
  GstBus* bus_ = nullptr;
  gulong handler_ = 0;
};

}  // namespace spidar
