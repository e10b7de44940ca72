// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures the motion of video files, read with GStreamer.
#pragma once

#include <string>

#include "apps/feel/film.h"

namespace spidar {

/// Decodes the whole file or URI as fast as possible; call gst_init() before. Throws as LumaReader
/// does.
Film read_film(const std::string& path, const AnalyzerSettings& settings);

}  // namespace spidar
