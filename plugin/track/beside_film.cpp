// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/beside_film.h"

#include <filesystem>
#include <stdexcept>

namespace spidar {

namespace fs = std::filesystem;

std::string find_beside(const std::string& film, std::initializer_list<const char*> ends) {
  if (film.empty()) return {};
  const std::string stem = fs::path(film).replace_extension().string();
  for (const std::string& name : {film, stem}) {
    for (const char* const end : ends) {
      std::error_code ignored;
      if (fs::exists(name + end, ignored)) return name + end;
    }
  }
  return {};
}

std::ifstream open_regular_file(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) throw std::runtime_error("there is no such file");
  if (!fs::is_regular_file(status)) throw std::runtime_error("it is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("it cannot be read");
  return file;
}

}  // namespace spidar
