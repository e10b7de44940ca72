// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An audio sink without a sound card, with the clock of a cheap one.
#pragma once

#include <gst/gst.h>

namespace spidar::bench {

/// A GstAudioSink that takes samples as a sound card with a buffer of its own does, a period at a
/// time, at their nominal rate · (1 + `drift`) by CLOCK_MONOTONIC. GStreamer makes the pipeline's
/// clock of what it says about its buffer, with all the jitter that this has. Floating.
GstElement* make_sound_card(double drift);

}  // namespace spidar::bench
