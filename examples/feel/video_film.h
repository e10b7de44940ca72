// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Films out of video files, by way of GStreamer.
#pragma once

#include <string>

#include "examples/feel/film.h"

namespace spidar {

/// Decodes the whole file or URI, as fast as it goes; after gst_init(). Throws as LumaReader does.
Film read_film(const std::string& path, const AnalyzerSettings& settings);

}  // namespace spidar
