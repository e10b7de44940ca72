// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_options.h"

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include <gst/gst.h>

#include "plugin/filter/choice/feel_file.h"
#include "plugin/gobject/ref.h"
#include "plugin/programs/typed_property.h"
#include "plugin/properties/property_table.h"
#include "spidar/tools/command_line.h"

namespace spidar::tools {

namespace fs = std::filesystem;

namespace {

/// Characters that no shell changes.
constexpr const char* kPlainLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";

/// The properties that are marked with analysis_mark(), in alphabetical order.
std::vector<std::string> names_of_analysis(GstElement* element) {
  guint count = 0;
  g_autofree GParamSpec** all = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  std::vector<std::string> names;
  for (guint i = 0; i < count; ++i) {
    if (g_param_spec_get_qdata(all[i], analysis_mark())) names.emplace_back(all[i]->name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Returns why the property is refused, as the rest of a sentence; empty if it is not.
std::string why_refused(const TypedProperty& property, const std::vector<std::string>& of_analysis,
                        size_t films) {
  const std::string name = property.name();
  if (name == "touch") {
    return "what is touched depends on the hand, and a track is the same for all";
  }
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
  std::string list;
  for (const std::string& other : of_analysis) {
    if (other == name) return {};
    list += (list.empty() ? "" : ", ") + other;
  }
  return "changes nothing in a track; these properties do: " + list;
}

/// Replaces the name of a preset by its properties, as the preset sets them after those before it.
/// parse_record_properties() checks them. Throws UsageError for an unknown preset.
std::vector<std::string> without_presets(GstElement* element,
                                         const std::vector<std::string>& of_analysis,
                                         const std::vector<std::string>& words) {
  std::vector<std::string> result;
  for (const std::string& word : words) {
    const std::optional<std::string> preset = preset_of(word);
    if (!preset) {
      result.push_back(word);
      continue;
    }
    load_preset(element, *preset);
    for (const std::string& name : of_analysis) {
      if (name == "feel" || name == "pointer" || name == "max-force") {
        continue;  // no preset has these
      }
      g_auto(GValue) value = G_VALUE_INIT;
      g_object_get_property(G_OBJECT(element), name.c_str(), &value);
      result.push_back(name + "=" + taken(gst_value_serialize(&value)));
    }
  }
  return result;
}

/// Splits one line of settings; a value with spaces is in quotes.
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

bool ends_as_track(const std::string& name) {
  const std::string end = fs::path(name).extension().string();
  return end == ".flac" || end == ".mka" || end == ".wav";
}

}  // namespace

void refuse_output(const std::string& film, const std::string& output) {
  const auto quoted = [](const std::string& word) {
    const bool is_plain = word.find_first_not_of(kPlainLetters) == std::string::npos;
    return is_plain ? word : taken(g_shell_quote(word.c_str()));
  };
  const std::string format =
      ends_as_track(output) ? fs::path(output).extension().string() : ".flac";
  std::string line = "spidartrack record " + quoted(film);
  std::error_code none;
  if (output.back() == '/' || fs::is_directory(output, none)) {
    line += " --folder " + quoted(output);
  } else {
    const bool converts = !ends_as_track(output) && fs::path(output).has_extension();
    line += (format == ".flac" ? "" : " --format " + format.substr(1)) +
            (converts ? " && spidartrack convert " : " && mv ") +
            quoted(film + ".haptic" + format) + " " + quoted(output);
  }
  throw UsageError(output + ": a track is named after its film; type: " + line);
}

RecordProperties with_rules(const RecordProperties& properties, const std::string& film) {
  RecordProperties result = properties;
  std::map<std::string, std::string> settings = split(properties.settings);
  for (auto& [name, value] : result.values) {
    if (name != "feel") continue;
    const filter::NamedRules named = filter::read_feel(value, film);
    value = named.rules ? named.rules->text() : "";
    settings.erase(name);
    if (!value.empty()) settings[name] = '"' + value + '"';
  }
  result.settings = one_line(settings);
  return result;
}

RecordProperties parse_record_properties(const std::vector<std::string>& words, size_t films) {
  RecordProperties properties;
  const Ref<GstElement> element(gst_element_factory_make("spidarmotion", nullptr));
  if (!element) {
    throw std::runtime_error(
        "GStreamer finds no spidarmotion; set GST_PLUGIN_PATH to the folder of libgstspidar.so");
  }
  const std::vector<std::string> of_analysis = names_of_analysis(element.get());
  std::map<std::string, std::string> settings;  // the last value of a name counts
  std::string alpha;
  try {
    for (const std::string& word : without_presets(element.get(), of_analysis, words)) {
      const TypedProperty property(G_OBJECT(element.get()), word);
      const std::string refused = why_refused(property, of_analysis, films);
      if (!refused.empty()) throw UsageError(word + ": " + refused);
      properties.values.emplace_back(property.name(), word.substr(word.find('=') + 1));
      settings.erase(property.name());
      if (property.name() == "alpha") alpha = property.canonical_value();
      if (property.is_default() || property.name() == "trace") continue;
      settings[property.name()] = property.canonical_value();
      if (property.name() == "feel" && properties.values.back().second != "auto") {
        // In one form for all ways to type them; a file is replaced by its content.
        properties.settings = one_line(settings);
        properties = with_rules(properties, "");
        settings = split(properties.settings);
      }
    }
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
  // With motion=mean, alpha has another default.
  const auto motion = settings.find("motion");
  if (!alpha.empty() && motion != settings.end() && motion->second == "mean") {
    settings["alpha"] = alpha;
  }
  properties.settings = one_line(settings);
  return properties;
}

RecordProperties properties_of(const std::string& settings) {
  std::vector<std::string> words;
  for (auto [name, value] : split(settings)) {
    value.erase(std::remove(value.begin(), value.end(), '"'), value.end());
    words.push_back(name + '=' + value);
  }
  return parse_record_properties(words, 1);
}

void expect_no_property(const std::string& film, const std::string& command) {
  if (film.find('=') == std::string::npos || fs::exists(film)) return;
  throw UsageError(film + ": there is no such film; properties follow --: spidartrack " + command +
                   " -- " + film);
}

fs::path RecordOptions::file_of(const ListedFilm& film) const {
  const fs::path file = film.path + ".haptic." + format;
  return folder.empty() ? file : fs::path(folder) / film.subfolder / file.filename();
}

void set_films(RecordOptions& options, const std::vector<std::string>& names,
               const std::vector<std::string>& properties) {
  for (const std::string& film : names) {
    expect_no_property(film, "record FILM");
    // In other programs, the output follows the input.
    if (film != names.front() && ends_as_track(film) && !fs::exists(film)) {
      refuse_output(names.front(), film);
    }
  }
  options.films = list_films(names, options.left_out);
  options.properties = parse_record_properties(properties, options.films.size());
}

}  // namespace spidar::tools
