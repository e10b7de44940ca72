// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The analysis beside a film.
#pragma once

#include <string>

#include "core/analysis/motion_file.h"

namespace spidar {

/// What is appended to the name of a film.
constexpr const char* kMotionEnd = ".motion";

/// FILM with `.motion`, else the same without the extension of FILM: the first of them that is
/// there; empty when none is.
std::string find_analysis(const std::string& film);

/// Throws std::runtime_error, which says what is wrong, when `path` is not a regular file or cannot
/// be read, and MotionFileError.
MotionFile read_motion_file(const std::string& path);
/// Only what it says of itself.
MotionHeader read_motion_header(const std::string& path);

}  // namespace spidar
