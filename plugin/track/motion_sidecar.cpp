// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/motion_sidecar.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace spidar {
namespace {

namespace fs = std::filesystem;

std::ifstream open_file(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) throw std::runtime_error("there is no such file");
  if (!fs::is_regular_file(status)) throw std::runtime_error("it is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("it cannot be read");
  return file;
}

}  // namespace

std::string find_analysis(const std::string& film) {
  if (film.empty()) return {};
  for (const fs::path& name : {fs::path(film), fs::path(film).replace_extension()}) {
    const std::string path = name.string() + kMotionEnd;
    std::error_code ignored;
    if (fs::exists(path, ignored)) return path;
  }
  return {};
}

MotionFile read_motion_file(const std::string& path) {
  std::ifstream file = open_file(path);
  return MotionFile(file);
}

MotionHeader read_motion_header(const std::string& path) {
  std::ifstream file = open_file(path);
  return read_header(file);
}

}  // namespace spidar
