// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/choice/feel_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// Far more than a person writes.
constexpr uintmax_t kLargest_bytes = 1 << 20;

bool is_path(const std::string& feel) {
  const std::string end = kFeelEnd;
  return feel.size() > end.size() && feel.compare(feel.size() - end.size(), end.size(), end) == 0;
}

std::string read_rules_text(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) throw std::runtime_error(path + ": there is no such file");
  if (!fs::is_regular_file(status)) throw std::runtime_error(path + ": it is not a regular file");
  if (fs::file_size(path, ignored) > kLargest_bytes) {
    throw std::runtime_error(path + ": it has more than a megabyte, and is no file of rules");
  }
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad()) throw std::runtime_error(path + ": it cannot be read");
  return text;
}

}  // namespace

std::string find_feel(const std::string& film) {
  if (film.empty()) return {};
  for (const fs::path& name : {fs::path(film), fs::path(film).replace_extension()}) {
    const std::string path = name.string() + kFeelEnd;
    std::error_code ignored;
    if (fs::exists(path, ignored)) return path;
  }
  return {};
}

NamedRules read_feel(const std::string& feel, const std::string& film) {
  const std::string path = feel == "auto" ? find_feel(film) : is_path(feel) ? feel : "";
  if (feel.empty() || (feel == "auto" && path.empty())) return {};
  const std::string name = path.empty() ? "feel" : path;
  const std::string text = path.empty() ? feel : read_rules_text(path);
  try {
    return {std::make_shared<FeelRules>(text), name};
  } catch (const FeelRulesError& error) {
    throw std::runtime_error(name + ", " + error.what());
  }
}

}  // namespace spidar
