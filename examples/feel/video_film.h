/// Films out of video files, by way of GStreamer.
#pragma once

#include <string>

#include "examples/feel/film.h"

namespace spidar {

/// Decodes the whole file, as fast as it goes. Throws std::runtime_error when that fails, with what
/// GStreamer says of it.
Film read_film(const std::string& path, const AnalyzerSettings& settings);

}  // namespace spidar
