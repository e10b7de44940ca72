// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How far the tensions move from tick to tick of a smooth path.
#pragma once

#include <vector>

#include "spidar/profiles/profile.h"

/// The largest step of a string at 1 kHz beside the bounds of tests/support/tension_step.h, for the
/// weights of the loop. A table of all `profiles` as Markdown,
/// on standard output; the paths come from fixed seeds. Throws std::runtime_error.
void print_continuity(const std::vector<spidar::Profile>& profiles);

/// What the weight ε trades: steps against what is missing of the wanted wrench. A table as
/// Markdown, on standard output. Throws std::runtime_error.
void print_smoothing(const spidar::Profile& profile);
