// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reports a playback as text.
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

#include "examples/play/record.h"

/// The force, whether it came in time, how long the analysis took, and the problems of the device,
/// a line for each; then how many frames were felt, and why the others were not. `stats` is the
/// element's, `shown` the number of frames on the screen.
std::string report_text(const Record& record, const GstStructure* stats, uint64_t shown);
/// Of the frame that is on the screen, null before the first: its motion, unless its force is that
/// of a haptic track, and its force or why nothing is felt.
std::string progress_line(double time_s, const FrameRow* frame);
