// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_options.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <stdexcept>

#include <gst/gst.h>

#include "plugin/filter/choice/feel_file.h"
#include "plugin/properties/typed_property.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

/// What changes the force that the frames of a film give. All others are for a device, for a viewer
/// or for a pipeline, of which there is none.
constexpr const char* kAnalysis[] = {"alpha",       "controller",        "depth-gain", "feel",
                                     "filter-beta", "filter-min-cutoff", "max-force",  "motion",
                                     "pointer",     "roll-gain"};

template <size_t kCount>
bool contains(const char* const (&names)[kCount], const std::string& name) {
  return std::any_of(std::begin(names), std::end(names),
                     [&](const char* other) { return name == other; });
}

std::string list_of_analysis() {
  std::string list;
  for (const char* name : kAnalysis) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

/// Why it is refused, as the rest of a sentence; empty if it is not.
std::string why_refused(const TypedProperty& property, size_t films) {
  const std::string name = property.name();
  if (name == "touch")
    return "what is touched depends on the hand, and a track is the same for all";
  if (name == "pointer" &&
      (property.canonical_value() == "grip" || property.canonical_value() == "mouse")) {
    return "a track has neither a hand nor a mouse: pointer=X,Y";
  }
  if (name == "track") return "a film is analysed for its track, and a track is not recorded again";
  if (name == "trace") {
    return films == 1 ? "" : "all films would be written to one file; record them one by one";
  }
  if (name == "max-force" && property.canonical_value() == "0") {
    return "the whole track would be at rest";
  }
  if (contains(kAnalysis, name)) return {};
  return "changes nothing in a track; these properties do: " + list_of_analysis();
}

/// One line of settings; a value with spaces is in quotes.
std::map<std::string, std::string> split(const std::string& line) {
  std::map<std::string, std::string> settings;
  bool quoted = false;
  std::string word;
  for (const char c : line + ' ') {
    if (c == '"') quoted = !quoted;
    if (c != ' ' || quoted) {
      word += c;
      continue;
    }
    const size_t equals = word.find('=');
    if (equals != std::string::npos) settings[word.substr(0, equals)] = word.substr(equals + 1);
    word.clear();
  }
  return settings;
}

std::string one_line(const std::map<std::string, std::string>& settings) {
  std::string line;
  for (const auto& [name, value] : settings) {
    line += (line.empty() ? "" : " ") + name + "=" + value;
  }
  return line;
}

namespace fs = std::filesystem;

constexpr const char* kFilmEnds[] = {".3gp", ".avi", ".flv",  ".m2ts", ".m4v", ".mkv",
                                     ".mov", ".mp4", ".mpeg", ".mpg",  ".mts", ".mxf",
                                     ".ogv", ".ts",  ".vob",  ".webm", ".wmv"};

bool has_film_name(const fs::path& path) {
  if (path.filename().string().front() == '.') return false;
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(std::begin(kFilmEnds), std::end(kFilmEnds), end) != std::end(kFilmEnds);
}

struct FoundFilm {
  ListedFilm film;
  uintmax_t bytes = 0;
};

std::vector<FoundFilm> films_below(const std::string& folder) {
  std::vector<FoundFilm> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::error_code gone;  // it may be renamed or removed in the meantime
    if (!entry.is_regular_file(gone) || !has_film_name(entry.path())) continue;
    const uintmax_t bytes = entry.file_size(gone);
    if (gone) continue;
    const fs::path subfolder = entry.path().lexically_relative(folder).parent_path();
    found.push_back({{entry.path().string(), subfolder}, bytes});
  }
  std::sort(found.begin(), found.end(), [](const FoundFilm& a, const FoundFilm& b) {
    return a.bytes != b.bytes ? a.bytes > b.bytes : a.film.path < b.film.path;
  });
  return found;
}

}  // namespace

RecordProperties with_rules(const RecordProperties& properties, const std::string& film) {
  RecordProperties result = properties;
  std::map<std::string, std::string> settings = split(properties.settings);
  for (auto& [name, value] : result.values) {
    if (name != "feel") continue;
    const NamedRules named = read_feel(value, film);
    value = named.rules ? named.rules->text() : "";
    settings.erase(name);
    if (!value.empty()) settings[name] = '"' + value + '"';
  }
  result.settings = one_line(settings);
  return result;
}

RecordProperties parse_record_properties(const std::vector<std::string>& words, size_t films) {
  RecordProperties properties;
  const std::unique_ptr<GstElement, void (*)(gpointer)> element(
      gst_element_factory_make("spidarmotion", nullptr), gst_object_unref);
  if (!element) {
    throw std::runtime_error(
        "GStreamer finds no spidarmotion; set GST_PLUGIN_PATH to the folder of libgstspidar.so");
  }
  std::map<std::string, std::string> settings;  // the last one of a name counts
  for (const std::string& word : words) {
    try {
      const TypedProperty property(G_OBJECT(element.get()), word);
      const std::string refused = why_refused(property, films);
      if (!refused.empty()) throw UsageError(word + ": " + refused);
      properties.values.emplace_back(property.name(), word.substr(word.find('=') + 1));
      settings.erase(property.name());
      if (property.is_default() || property.name() == "trace") continue;
      settings[property.name()] = property.canonical_value();
      if (property.name() == "feel" && properties.values.back().second != "auto") {
        // In one form for all ways to type them, and of a file, what it says now.
        properties.settings = one_line(settings);
        properties = with_rules(properties, "");
        settings = split(properties.settings);
      }
    } catch (const std::runtime_error& error) {
      throw UsageError(error.what());
    }
  }
  properties.settings = one_line(settings);
  return properties;
}

std::vector<ListedFilm> list_films(const std::vector<std::string>& names) {
  std::vector<ListedFilm> films;
  for (const std::string& name : names) {
    if (!fs::is_directory(name)) {
      films.push_back({name, {}});
      continue;
    }
    try {
      const std::vector<FoundFilm> found = films_below(name);
      if (found.empty()) {
        throw std::runtime_error(name +
                                 ": this folder has no film (names that end in .mkv, .mp4 …)");
      }
      for (const FoundFilm& one : found) films.push_back(one.film);
    } catch (const fs::filesystem_error& error) {
      throw std::runtime_error(error.path1().string() +
                               ": cannot be read: " + error.code().message());
    }
  }
  return films;
}

namespace fs = std::filesystem;

fs::path RecordOptions::file_of(const ListedFilm& film) const {
  const fs::path file = film.path + ".haptic." + format;
  return folder.empty() ? file : fs::path(folder) / film.subfolder / file.filename();
}

void set_films(RecordOptions& options, const std::vector<std::string>& names,
               const std::vector<std::string>& properties) {
  for (const std::string& film : names) {
    if (film.find('=') == std::string::npos || fs::exists(film)) continue;
    throw UsageError(
        film + ": there is no such film; properties follow --: spidartrack record FILM -- " + film);
  }
  options.films = list_films(names);
  options.properties = parse_record_properties(properties, options.films.size());
}

}  // namespace spidar
