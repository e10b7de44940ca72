// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/choice/feel_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "plugin/track/beside_film.h"

namespace spidar {
namespace {

/// Far more than a person writes.
constexpr uintmax_t kLargest_bytes = 1 << 20;

bool is_path(const std::string& feel) {
  const std::string end = kFeelEnd;
  return feel.size() > end.size() && feel.compare(feel.size() - end.size(), end.size(), end) == 0;
}

std::string read_rules_text(const std::string& path) {
  std::ifstream file;
  try {
    file = open_regular_file(path);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  std::error_code ignored;
  if (std::filesystem::file_size(path, ignored) > kLargest_bytes) {
    throw std::runtime_error(path + ": it has more than a megabyte, and is no file of rules");
  }
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) throw std::runtime_error(path + ": it cannot be read");
  return text;
}

}  // namespace

NamedRules read_feel(const std::string& feel, const std::string& film) {
  const std::string path = feel == "auto"  ? find_beside(film, {kFeelEnd})
                           : is_path(feel) ? feel
                                           : "";
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
