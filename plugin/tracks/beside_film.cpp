// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/beside_film.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace spidar {

namespace fs = std::filesystem;

namespace {

/// What is there, in the order in which it is looked for.
std::vector<std::string> list_beside(const std::string& film,
                                     std::initializer_list<const char*> ends) {
  std::vector<std::string> files;
  if (film.empty()) return files;
  const std::string stem = fs::path(film).replace_extension().string();
  for (const std::string& name : {film, stem}) {
    for (const char* const end : ends) {
      std::error_code ignored;
      if (fs::exists(name + end, ignored)) files.push_back(name + end);
    }
  }
  return files;
}

}  // namespace

std::string find_beside(const std::string& film, std::initializer_list<const char*> ends) {
  const std::vector<std::string> files = list_beside(film, ends);
  return files.empty() ? std::string() : files.front();
}

std::string find_before(const std::string& film, std::initializer_list<const char*> ends,
                        const std::string& file) {
  const std::vector<std::string> files = list_beside(film, ends);
  const auto is_file = [&file](const std::string& other) {
    std::error_code ignored;
    return fs::equivalent(file, other, ignored);
  };
  const auto found = std::find_if(files.begin(), files.end(), is_file);
  return found == files.begin() || found == files.end() ? std::string() : files.front();
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
