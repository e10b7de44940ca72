// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much later than its running time a frame is on the screen.
#pragma once

#include <vector>

#include <gst/gst.h>

#include "plugin/gobject/downstream.h"

namespace spidar {

/// What is behind an element and delays its frames: the latency that the sink was told, `ts-offset`
/// of the sink (playbin: av-offset), offsets of the pads on the way, and elements on the way that
/// wait for the clock themselves (`clocksync`, `identity sync=true`). The sink shows a frame when
/// the last of those that wait has let it go.
///
/// Only the latency is told by an event, and that one is not repeated for an element that is put
/// into a pipeline which plays already: so this looks at the way to the sink itself.
///
/// Not thread-safe: the owner holds one lock around it.
class PresentationDelay {
 public:
  PresentationDelay() = default;
  ~PresentationDelay() { forget(); }
  PresentationDelay(const PresentationDelay&) = delete;
  PresentationDelay& operator=(const PresentationDelay&) = delete;

  /// Looks downstream of `element`, through bins, for the first sink that waits for the clock, and
  /// keeps the way to it until told to forget it. Again whenever it may be another one.
  void follow(GstElement* element);
  void forget();

  /// From the LATENCY event; counts where no sink is found that waits.
  void set_latency(GstClockTime latency);

  /// As it is now, in ns; > 0: shown later.
  GstClockTimeDiff value_ns() const;

 private:
  DownstreamPath path_;
  std::vector<GstClockTimeDiff> latency_ns_;  // of live sources before each element of the path
  GstClockTimeDiff told_ns_ = 0;
};

}  // namespace spidar
