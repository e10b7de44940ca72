// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/script_set.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <glib.h>

#include "plugin/tracks/name_form.h"
#include "plugin/tracks/track_summary.h"
#include "spidar/text.h"
#include "spidar/whole_file.h"

namespace spidar::tracks {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnd = ".funscript";
/// The upward force: the channel of a script whose name has no axis.
constexpr size_t kMainChannel = 1;
/// 12 h of positions every 40 ms take half of this.
constexpr size_t kMax_bytes = size_t{64} << 20;

/// A file of a set.
struct ScriptFile {
  std::string path;
  std::string axis;  ///< in its name; empty: none
};

/// FILM.AXIS.funscript without FILM: "AXIS"; nothing when it is another file.
std::optional<std::string> axis_in(const std::string& name, const std::string& film) {
  if (!is_script(name) || name.compare(0, film.size(), film) != 0) return std::nullopt;
  const std::string axis =
      name.substr(film.size(), name.size() - std::string(kEnd).size() - film.size());
  if (axis.empty()) return axis;
  const bool is_axis =
      axis.front() == '.' && (channel_of_axis(axis.substr(1)) || is_other_axis(axis.substr(1)));
  return is_axis ? std::optional(axis.substr(1)) : std::nullopt;
}

/// Lists the scripts for `film`, a path without an extension; the main one first, then by name.
std::vector<ScriptFile> list_set(const std::string& film) {
  const fs::path path = film;
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::vector<ScriptFile> files;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const auto axis = axis_in(composed(name), composed(path.filename().string()));
    if (axis) files.push_back({(path.parent_path() / name).string(), *axis});
  }
  std::sort(files.begin(), files.end(), [](const ScriptFile& a, const ScriptFile& b) {
    return std::pair(a.axis, a.path) < std::pair(b.axis, b.path);
  });
  return files;
}

bool is_felt(const ScriptFile& file) {
  return file.axis.empty() || channel_of_axis(file.axis);
}

/// Lists the scripts of a film, by its whole name, else by that without the extension.
std::vector<ScriptFile> set_of(const std::string& film) {
  std::vector<ScriptFile> files = list_set(film);
  if (std::any_of(files.begin(), files.end(), is_felt)) return files;
  return list_set(fs::path(film).replace_extension().string());
}

/// Splits a script's path into the path for list_set(), and the axis of its name.
ScriptFile without_end(const std::string& path) {
  const std::string whole = path.substr(0, path.size() - std::string(kEnd).size());
  const std::string end = fs::path(whole).extension().string();
  if (end.size() < 2 || !(channel_of_axis(end.substr(1)) || is_other_axis(end.substr(1)))) {
    return {whole, ""};
  }
  return {whole.substr(0, whole.size() - end.size()), end.substr(1)};
}

void add_axis(const std::string& path, ScriptAxis axis, const ScriptChoice& choice,
              ScriptSet& set) {
  if (choice.channel) axis.channel = *choice.channel;
  if (choice.gain) axis.gain = *choice.gain;
  const std::string what = path + (axis.name.empty() ? "" : " (" + axis.name + ")");
  const auto same = std::find_if(set.axes.begin(), set.axes.end(), [&](const ScriptAxis& other) {
    return other.channel == axis.channel;
  });
  if (axis.points.empty()) {
    set.about.push_back(what + ": has no actions; " + channel_name(axis.channel) + " is at rest");
  } else if (same != set.axes.end()) {
    set.unfelt.push_back(what + ", another one for " + channel_name(axis.channel));
  } else {
    set.about.push_back(what + ": " + channel_name(axis.channel) + ", gain " + rounded(axis.gain) +
                        " taken back: 100 % is " + rounded(full_scale(axis.channel) / axis.gain) +
                        channel_unit(axis.channel));
    set.axes.push_back(std::move(axis));
  }
}

void add_file(const ScriptFile& file, const ScriptChoice& choice, ScriptSet& set) {
  if (!is_felt(file) && !choice.channel) {
    set.unfelt.push_back(file.path);
    return;
  }
  const size_t channel =
      choice.channel.value_or(file.axis.empty() ? kMainChannel : *channel_of_axis(file.axis));
  Funscript script;
  note_read(file.path);
  try {
    script = parse_funscript(read_regular_file(file.path, kMax_bytes), channel);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.path + ": " + error.what());
  }
  for (const std::string& other : script.others) {
    set.unfelt.push_back(other + " of " + file.path);
  }
  for (ScriptAxis& axis : script.axes) {
    if (choice.channel && !axis.name.empty()) {
      set.unfelt.push_back(axis.name + " of " + file.path);
    } else {
      add_axis(file.path, std::move(axis), choice, set);
    }
  }
}

}  // namespace

bool is_script(const std::string& path) {
  const size_t length = std::string(kEnd).size();
  return path.size() >= length &&
         g_ascii_strcasecmp(path.c_str() + path.size() - length, kEnd) == 0;
}

std::string find_script(const std::string& film) {
  const std::vector<ScriptFile> files = film.empty() ? std::vector<ScriptFile>() : set_of(film);
  const auto found = std::find_if(files.begin(), files.end(), is_felt);
  return found == files.end() ? std::string() : found->path;
}

int64_t ScriptSet::length_ms() const {
  int64_t length_ms = 0;
  for (const ScriptAxis& axis : axes) {
    length_ms = std::max(length_ms, axis.points.back().at_ms + 1);
  }
  return length_ms;
}

TrackSample ScriptSet::at(int64_t time_ms) const {
  TrackSample sample{};
  for (const ScriptAxis& axis : axes) sample[axis.channel] = axis.at(time_ms);
  return sample;
}

ScriptSet read_scripts(const std::string& path, const ScriptChoice& choice) {
  const ScriptFile file = without_end(path);
  std::vector<ScriptFile> files;
  if (!choice.film.empty()) {
    files = set_of(choice.film);
  } else if (!choice.channel && file.axis.empty()) {
    files = list_set(file.path);
  }
  if (files.empty()) files.push_back({path, file.axis});
  ScriptSet set;
  for (const ScriptFile& one : files) add_file(one, choice, set);
  if (set.axes.empty()) throw std::runtime_error(path + ": it has no actions");
  return set;
}

}  // namespace spidar::tracks
