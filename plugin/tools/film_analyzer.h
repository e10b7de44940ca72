// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures a film once, and makes tracks of what was measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/analysis/motion_file.h"
#include "plugin/tools/record_properties.h"

namespace spidar {

/// Writes what is measured of `film`, or of a piece of it (`of` > 0), into the file `motion`
/// (MotionFile), whose name ends in `.motion`. Else as record_film().
std::string analyze_film(const std::string& film, const std::string& motion,
                         const RecordProperties& properties, const MotionPiece& piece,
                         const std::function<void(int percent)>& tell);

/// Writes the track that record_film() would write with the same properties, without the film.
/// Returns what is to be known of the track, a sentence each; usually nothing. Throws
/// std::runtime_error.
std::vector<std::string> render_analysis(const std::string& motion, const std::string& track,
                                         const RecordProperties& properties);

}  // namespace spidar
