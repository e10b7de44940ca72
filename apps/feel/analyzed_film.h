// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The motion of a film from the file that `spidartrack analyze` has made of it.
#pragma once

#include <string>

#include "apps/feel/film.h"

namespace spidar {

/// Whether the name is that of an analysis.
bool is_analysis(const std::string& path);

/// What read_film() would measure, without the film. Throws std::runtime_error, whose sentence
/// begins with the path.
Film read_analysis(const std::string& path, const AnalyzerSettings& settings);

}  // namespace spidar
