// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/feel/video_film.h"

#include <filesystem>

#include "apps/track/luma_reader.h"

namespace spidar {

Film read_film(const std::string& path, const AnalyzerSettings& settings) {
  LumaReader video(path);
  FilmRecorder recorder(std::filesystem::path(path).filename().string(), settings);
  LumaReader::Frame frame;
  while (video.next(frame)) recorder.add(frame.luma, frame.running_time_ns);
  return recorder.film();
}

}  // namespace spidar
