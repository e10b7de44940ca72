// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reports a playback as a picture.
#pragma once

#include <string>

#include "examples/play/record.h"

/// A script of gnuplot that draws position, velocity, force and the strings' tensions over time,
/// and when and why nothing was felt. Force towards the viewer and torque are in it where a hand
/// could feel them. Axes of force go to ± `max_force_N`.
std::string picture_script(const Record& record, double max_force_N, const std::string& title);
