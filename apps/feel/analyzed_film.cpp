// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/feel/analyzed_film.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/analysis/motion_replay.h"

namespace spidar {
namespace {

std::shared_ptr<const MotionFile> open_analysis(const std::string& path, MotionKind motion) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error(path + ": it cannot be opened");
  std::shared_ptr<const MotionFile> file;
  try {
    file = std::make_shared<const MotionFile>(stream);
  } catch (const MotionFileError& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  const std::string wrong = wrong_motion(file->header(), motion);
  if (!wrong.empty()) throw std::runtime_error(path + ": " + wrong);
  return file;
}

}  // namespace

bool is_analysis(const std::string& path) {
  return std::filesystem::path(path).extension() == ".motion";
}

Film read_analysis(const std::string& path, const AnalyzerSettings& settings) {
  const std::shared_ptr<const MotionFile> file = open_analysis(path, settings.motion);
  MotionReplay replay;
  replay.set_file(file, 0);
  replay.configure(settings);
  Film film;
  film.name = std::filesystem::path(path).stem().string();
  for (size_t i = 0; i < file->size(); ++i) {
    if (file->moment(i).kind != MomentKind::kFrame) continue;
    const std::optional<FrameAnalysis> frame = replay.at(file->moment(i).stream_ns, 1);
    if (!frame) continue;
    film.height = frame->height;
    film.frames.push_back({static_cast<double>(frame->interval_ns) * 1e-9, frame->motion});
  }
  return film;
}

}  // namespace spidar
