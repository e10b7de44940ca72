// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A video sink that reports when it shows a frame.
#pragma once

#include <cstdint>
#include <functional>

#include <gst/gst.h>

namespace spidar::bench {

struct ShownFrame {
  int64_t running_ns;
  int64_t monotonic_ns;  ///< CLOCK_MONOTONIC when the sink had waited for it and began to draw it
  int64_t due_ns;        ///< and when it would have been in time by the pipeline's clock
};

/// In the sink's streaming thread.
using OnShown = std::function<void(const ShownFrame&)>;

/// A GstVideoSink with the properties that every one has by default (drops what is 5 ms late, tells
/// upstream of it), without a window. Floating.
GstElement* make_screen(OnShown on_shown);

}  // namespace spidar::bench
