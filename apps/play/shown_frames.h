// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tells when a video sink really shows its frames.
#pragma once

#include <cstdint>
#include <functional>

#include <gst/gst.h>

/// Calls `on_shown` in the sink's streaming thread with a frame's running time and the time
/// (CLOCK_MONOTONIC) at which the sink had shown it: a push into a sink returns after the wait for
/// the clock and after the drawing. Frames that the sink drops because they are late are left out,
/// if it is a GstBaseSink: other sinks do not tell. `sink` is not a bin. Call this once in a
/// process, before the pipeline starts; it remains in effect until the process ends, because
/// GStreamer cannot remove a tracer hook.
void watch_shown_frames(GstElement* sink,
                        std::function<void(int64_t running_ns, int64_t monotonic_ns)> on_shown);
