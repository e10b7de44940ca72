// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reports a playback as text and as a picture.
#pragma once

#include <string>

#include <gst/gst.h>

#include "apps/play/session_record.h"

/// Prints five lines, and why nothing was felt where that was so; `verbose` adds a table and all of
/// the element's own `stats`.
void print_report(const SessionRecord::Numbers& numbers, const GstStructure* stats, bool verbose);

/// Draws position, velocity, force and string tensions over time into a PNG; force towards the
/// viewer and torque are included only where a hand could feel them. Axes of force go to ±
/// `max_force_N`. `folder` is for the files that gnuplot reads. Throws std::runtime_error when
/// drawing fails.
void draw_report(const SessionRecord::Numbers& numbers, double max_force_N,
                 const std::string& title, const std::string& folder, const std::string& png_path);
