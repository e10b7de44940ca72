// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reports a playback as text.
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

#include "examples/play/record.h"

/// What was felt, whether it came in time, how long the analysis took, and the problems of the
/// device, a line for each; then how often and why nothing was felt. `stats` is the element's,
/// `shown` the number of frames on the screen.
std::string report_text(const Record& record, const GstStructure* stats, uint64_t shown);
