// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures how much tensions change from tick to tick along a smooth path.
#pragma once

#include <vector>

#include "spidar/profiles/profile.h"

/// Prints the largest step of a string at 1 kHz, with the weights of the loop, beside the bounds of
/// tests/support/tension_step.h: a Markdown table of all `profiles` on standard output. The paths
/// come from fixed seeds. Throws std::runtime_error.
void print_continuity(const std::vector<spidar::Profile>& profiles);

/// Prints the trade-off that the weight ε makes between steps of tension and error of the wrench: a
/// Markdown table on standard output. Throws std::runtime_error.
void print_smoothing(const spidar::Profile& profile);
