// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The analysis beside a film.
#pragma once

#include <string>

#include "core/analysis/motion_file.h"

namespace spidar {

/// What is appended to the name of a film.
constexpr const char* kMotionEnd = ".motion";

/// The same for a piece: ".2of5.motion".
std::string motion_end(const MotionPiece& piece);

/// `.motion` beside the film, see find_beside().
std::string find_analysis(const std::string& film);

/// Throws std::runtime_error, which says what is wrong, when `path` is not a regular file or cannot
/// be read, and MotionFileError.
MotionFile read_motion_file(const std::string& path);
/// Only what it says of itself.
MotionHeader read_motion_header(const std::string& path);

}  // namespace spidar
