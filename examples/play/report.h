// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

#include "examples/play/record.h"

/// The text of a report, a line for each: the force, whether it was in time, how long the analysis
/// took, and the problems of the device; then how many frames were felt, and why the others were
/// not. `stats` is the element's, `shown` the number of frames on the screen.
std::string report_text(const Record& record, const GstStructure* stats, uint64_t shown);
/// A line on the frame on the screen, null before the first: its motion, unless its force is that
/// of a haptic track, and its force or why nothing is felt.
std::string progress_line(double time_s, const FrameRow* frame);
