// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include "examples/play/record.h"

/// Returns a script of gnuplot that draws position, velocity, force and the strings' tensions over
/// time, and when and why nothing was felt. Force towards the viewer and torque are shown where a
/// hand could feel them. Axes of force go to ± `max_force_N`.
std::string picture_script(const Record& record, double max_force_N, const std::string& title);
