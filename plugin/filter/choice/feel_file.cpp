// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/choice/feel_file.h"

#include <filesystem>
#include <stdexcept>
#include <unistd.h>

#include "plugin/tracks/sidecar.h"
#include "spidar/part_file.h"
#include "spidar/whole_file.h"

namespace spidar::filter {

namespace fs = std::filesystem;

namespace {

/// Far more than a person writes.
constexpr size_t kLargest_bytes = 1 << 20;

std::string read_rules_text(const std::string& path) {
  note_read(path);
  try {
    return read_regular_file(path, kLargest_bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

std::string file_text(const std::vector<FeelRule>& rules) {
  std::string text;
  for (const FeelRule& rule : rules) text += rule_text(rule) + '\n';
  return text;
}

std::vector<FeelRule> rules_in(const std::string& text) {
  try {
    return FeelRules(text).rules();
  } catch (const FeelRulesError&) {
    return {};
  }
}

/// Copies the file to the first free name of `path`~, `path`~~, …, and returns that name.
std::string back_up(const std::string& path) {
  std::string copy = path + "~";
  std::error_code failed;
  while (fs::exists(copy, failed)) copy += "~";
  if (!fs::copy_file(path, copy, failed)) {
    throw std::runtime_error(copy + ": cannot be written: " + failed.message());
  }
  return copy;
}

std::string name_of(const std::string& path) {
  return fs::path(path).filename().string();
}

}  // namespace

bool is_feel_file(const std::string& feel) {
  const std::string end = kFeelEnd;
  return feel.size() > end.size() && feel.compare(feel.size() - end.size(), end.size(), end) == 0;
}

NamedRules read_feel(const std::string& feel, const std::string& film) {
  const std::string path = feel == "auto"       ? find_beside(film, {kFeelEnd})
                           : is_feel_file(feel) ? feel
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

std::string save_feel(const std::string& feel, const std::string& film,
                      const std::vector<FeelEdit>& edits) {
  std::string path = is_feel_file(feel) ? feel : find_beside(film, {kFeelEnd});
  if (path.empty() && film.empty()) {
    throw std::runtime_error("what is played comes from no file, beside which rules could be kept");
  }
  if (path.empty()) path = film + kFeelEnd;
  std::error_code ignored;
  const bool is_there = fs::exists(path, ignored);
  if (is_there) path = fs::canonical(path, ignored).string();  // do not replace a symbolic link
  if (is_there && access(path.c_str(), W_OK) != 0) {
    throw std::runtime_error(path + ": is protected against writing");
  }
  const std::string before = is_there ? read_rules_text(path) : "";
  std::vector<FeelRule> rules = rules_in(before);
  const bool loses_text = before != file_text(rules);
  for (const FeelEdit& edit : edits) rules = edited(rules, edit);
  const std::string copy = loses_text ? back_up(path) : "";
  if (!rules.empty()) {
    replace_file(path, file_text(rules));
  } else if (is_there && !fs::remove(path, ignored)) {
    throw std::runtime_error(path + ": cannot be removed: " + ignored.message());
  }
  const std::string count = std::to_string(rules.size()) + (rules.size() == 1 ? " rule" : " rules");
  return name_of(path) + (rules.empty() ? " has no rules left and is removed" : " has " + count) +
         (copy.empty() ? "." : "; what it was before is in " + name_of(copy) + ".");
}

}  // namespace spidar::filter
