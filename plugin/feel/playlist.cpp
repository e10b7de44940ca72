// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/playlist.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <gst/gst.h>

#include "plugin/films/film_list.h"
#include "spidar/whole_file.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// 10,000 films with long names have less.
constexpr size_t kMax_bytes = size_t{4} << 20;

bool ends_as(const std::string& path, const char* end) {
  const std::string extension = fs::path(path).extension().string();
  return g_ascii_strcasecmp(extension.c_str(), end) == 0;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

/// Lines that are no comment.
std::vector<std::string> named_in_m3u(const std::string& text) {
  std::vector<std::string> names = lines_of(text);
  names.erase(std::remove_if(names.begin(), names.end(),
                             [](const std::string& line) { return line.front() == '#'; }),
              names.end());
  return names;
}

/// File1=NAME and so on, by their numbers.
std::vector<std::string> named_in_pls(const std::string& text) {
  std::map<long, std::string> by_number;
  for (const std::string& line : lines_of(text)) {
    const size_t end = line.find('=');
    if (end == std::string::npos || g_ascii_strncasecmp(line.c_str(), "file", 4) != 0) continue;
    by_number[std::strtol(line.c_str() + 4, nullptr, 10)] = line.substr(end + 1);
  }
  std::vector<std::string> names;
  for (auto& [number, name] : by_number) names.push_back(std::move(name));
  return names;
}

/// URIs, which may be relative to that of the playlist, in elements `location` of XML.
std::vector<std::string> named_in_xspf(const std::string& text, const std::string& path) {
  GMarkupParser parser{};
  parser.text = [](GMarkupParseContext* context, const gchar* words, gsize size, gpointer found,
                   GError**) {
    if (g_strcmp0(g_markup_parse_context_get_element(context), "location") != 0) return;
    g_autofree gchar* word = g_strndup(words, size);
    static_cast<std::vector<std::string>*>(found)->emplace_back(g_strstrip(word));
  };
  std::vector<std::string> names;
  GMarkupParseContext* const context =
      g_markup_parse_context_new(&parser, G_MARKUP_DEFAULT_FLAGS, &names, nullptr);
  g_markup_parse_context_parse(context, text.data(), static_cast<gssize>(text.size()), nullptr);
  g_markup_parse_context_free(context);
  g_autofree gchar* base = gst_filename_to_uri(path.c_str(), nullptr);
  for (std::string& name : names) {
    g_autofree gchar* whole =
        base ? g_uri_resolve_relative(base, name.c_str(), G_URI_FLAGS_ENCODED, nullptr) : nullptr;
    if (whole) name = whole;
  }
  return names;
}

std::vector<std::string> read_playlist(const std::string& path) {
  std::string text = read_regular_file(path, kMax_bytes);
  constexpr const char* kByteOrderMark = "\xef\xbb\xbf";
  if (text.rfind(kByteOrderMark, 0) == 0) text.erase(0, 3);
  if (text.find("#EXT-X-") != std::string::npos) return {path};  // HLS
  std::vector<std::string> names = ends_as(path, ".pls")    ? named_in_pls(text)
                                   : ends_as(path, ".xspf") ? named_in_xspf(text, path)
                                                            : named_in_m3u(text);
  if (names.empty()) throw std::runtime_error(path + ": this playlist names no film");
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  for (std::string& name : names) {
    if (!gst_uri_is_valid(name.c_str())) name = (folder / name).string();
  }
  return names;
}

std::vector<std::string> read_folder(const std::string& path) {
  std::string left_out;
  std::vector<std::pair<std::string, std::string>> by_key;
  for (const ListedFilm& film : list_films({path}, left_out)) {
    g_autofree gchar* shown = g_filename_display_name(film.path.c_str());
    g_autofree gchar* key = g_utf8_collate_key_for_filename(shown, -1);
    by_key.emplace_back(key, film.path);
  }
  std::sort(by_key.begin(), by_key.end());
  std::vector<std::string> films;
  for (auto& [key, film] : by_key) films.push_back(std::move(film));
  return films;
}

}  // namespace

bool is_playlist(const std::string& path) {
  constexpr const char* kEnds[] = {".m3u", ".m3u8", ".pls", ".xspf"};
  return std::any_of(std::begin(kEnds), std::end(kEnds),
                     [&](const char* end) { return ends_as(path, end); });
}

std::vector<std::string> films_of(const std::vector<std::string>& words) {
  std::vector<std::string> films;
  for (const std::string& word : words) {
    std::error_code error;
    std::vector<std::string> found{word};
    if (fs::is_directory(word, error)) found = read_folder(word);
    if (is_playlist(word) && fs::is_regular_file(word, error)) found = read_playlist(word);
    std::move(found.begin(), found.end(), std::back_inserter(films));
  }
  return films;
}

}  // namespace spidar
