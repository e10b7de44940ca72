// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_options.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

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
                                     "pointer",     "roll-gain",         "washout"};

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

/// With the properties of a preset, as it sets them after those before it, in place of its name.
/// What they are checked for, parse_record_properties() does. Throws PropertyError for an unknown
/// preset.
std::vector<std::string> without_presets(GstElement* element,
                                         const std::vector<std::string>& words) {
  std::vector<std::string> result;
  for (const std::string& word : words) {
    const std::optional<std::string> preset = preset_of(word);
    if (!preset) {
      result.push_back(word);
      continue;
    }
    load_preset(element, *preset);
    for (const std::string name : kAnalysis) {
      if (name == "feel" || name == "pointer" || name == "max-force")
        continue;  // no preset has them
      GValue value = G_VALUE_INIT;
      g_object_get_property(G_OBJECT(element), name.c_str(), &value);
      gchar* const text = gst_value_serialize(&value);
      result.push_back(name + "=" + text);
      g_free(text);
      g_value_unset(&value);
    }
  }
  return result;
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

constexpr const char* kFilmEnds[] = {".3g2", ".3gp",  ".asf", ".avi",  ".divx", ".f4v",
                                     ".flv", ".m2ts", ".m2v", ".m4v",  ".mkv",  ".mov",
                                     ".mp4", ".mpeg", ".mpg", ".mts",  ".mxf",  ".ogm",
                                     ".ogv", ".ts",   ".vob", ".webm", ".wmv"};

bool is_hidden(const fs::path& path) {
  return path.filename().string().front() == '.';
}

/// In small letters.
std::string end_of(const fs::path& path) {
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end;
}

bool has_film_name(const fs::path& path) {
  return std::find(std::begin(kFilmEnds), std::end(kFilmEnds), end_of(path)) != std::end(kFilmEnds);
}

/// Tracks of films, and rules of what is felt.
bool is_beside_film(const fs::path& path) {
  const std::string stem = path.stem().string();
  return end_of(stem) == ".haptic" || end_of(path) == ".feel";
}

struct FoundFilm {
  ListedFilm film;
  uintmax_t bytes = 0;
};

/// Finds the films in a folder and below, and counts what else is there.
class FilmSearch {
 public:
  /// Throws std::runtime_error when the folder itself cannot be read.
  explicit FilmSearch(const std::string& folder) : folder_(folder) {
    if (const std::error_code error = look_into(folder)) {
      throw std::runtime_error(folder + ": cannot be read: " + error.message());
    }
    std::sort(found_.begin(), found_.end(), [](const FoundFilm& a, const FoundFilm& b) {
      return a.bytes != b.bytes ? a.bytes > b.bytes : a.film.path < b.film.path;
    });
  }

  const std::vector<FoundFilm>& found() const { return found_; }
  /// Parts of a sentence.
  std::vector<std::string> left_out() const {
    std::vector<std::string> parts = unreadable_;
    for (const auto& [what, files] : passed_over_)
      parts.push_back(std::to_string(files) + " " + what + (files == 1 ? "" : "s"));
    size_t count = 0;
    std::vector<std::pair<size_t, std::string>> ends;
    for (const auto& [end, files] : others_) {
      count += files;
      ends.emplace_back(files, end.empty() ? "without an ending" : end);
    }
    if (count == 0) return parts;
    std::stable_sort(ends.begin(), ends.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    constexpr size_t kMostEnds = 5;
    std::string text;
    for (size_t i = 0; i < std::min(ends.size(), kMostEnds); ++i) {
      text += (i == 0 ? "" : ", ") + std::to_string(ends[i].first) + " " + ends[i].second;
    }
    parts.push_back(std::to_string(count) + (count == 1 ? " file that is" : " files that are") +
                    " no film by the name (" + text + (ends.size() > kMostEnds ? ", …" : "") + ")");
    return parts;
  }

 private:
  std::error_code look_into(const fs::path& folder) {
    std::error_code error;
    for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
      look_at(*at);
    }
    return error;
  }

  void look_at(const fs::directory_entry& entry) {
    std::error_code gone;  // it may be renamed or removed in the meantime
    const bool is_link = entry.is_symlink(gone);
    if (entry.is_directory(gone)) {
      // The trash of a desktop, and what a file server keeps for Macs under the names of the films.
      if (is_hidden(entry.path())) {
        ++passed_over_["hidden folder"];
      } else if (is_link) {
        ++passed_over_["linked folder"];
      } else if (const std::error_code error = look_into(entry.path())) {
        unreadable_.push_back(entry.path().string() + ", which cannot be read (" + error.message() +
                              ")");
      }
      return;
    }
    if (is_hidden(entry.path())) {
      if (has_film_name(entry.path())) ++passed_over_["hidden film"];
      return;
    }
    if (!entry.is_regular_file(gone)) {
      ++passed_over_[entry.exists(gone) ? "special file" : "dangling link"];
      return;
    }
    if (!has_film_name(entry.path())) {
      if (!is_beside_film(entry.path())) ++others_[end_of(entry.path())];
      return;
    }
    const uintmax_t bytes = entry.file_size(gone);
    if (gone) return;
    const fs::path subfolder = entry.path().lexically_relative(folder_).parent_path();
    found_.push_back({{entry.path().string(), subfolder}, bytes});
  }

  const fs::path folder_;
  std::vector<FoundFilm> found_;
  std::vector<std::string> unreadable_;
  std::map<std::string, size_t> passed_over_;  // by what they are
  std::map<std::string, size_t> others_;       // files, by their ending
};

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
  try {
    for (const std::string& word : without_presets(element.get(), words)) {
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
    }
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
  properties.settings = one_line(settings);
  return properties;
}

void expect_no_property(const std::string& film, const std::string& command) {
  if (film.find('=') == std::string::npos || fs::exists(film)) return;
  throw UsageError(film + ": there is no such film; properties follow --: spidartrack " + command +
                   " -- " + film);
}

FilmList list_films(const std::vector<std::string>& names) {
  FilmList list;
  for (const std::string& name : names) {
    if (!fs::is_directory(name)) {
      list.films.push_back({name, {}});
      continue;
    }
    const FilmSearch search(name);
    for (const std::string& part : search.left_out())
      list.left_out += (list.left_out.empty() ? "" : "; ") + part;
    if (search.found().empty()) {
      throw std::runtime_error(name + ": this folder has no film (names that end in .mkv, .mp4 …)" +
                               (list.left_out.empty() ? "" : "; left out: " + list.left_out));
    }
    for (const FoundFilm& one : search.found()) list.films.push_back(one.film);
  }
  return list;
}

namespace fs = std::filesystem;

fs::path RecordOptions::file_of(const ListedFilm& film) const {
  const fs::path file = film.path + ".haptic." + format;
  return folder.empty() ? file : fs::path(folder) / film.subfolder / file.filename();
}

void set_films(RecordOptions& options, const std::vector<std::string>& names,
               const std::vector<std::string>& properties) {
  for (const std::string& film : names) expect_no_property(film, "record FILM");
  FilmList list = list_films(names);
  options.films = std::move(list.films);
  options.left_out = std::move(list.left_out);
  options.properties = parse_record_properties(properties, options.films.size());
}

}  // namespace spidar
