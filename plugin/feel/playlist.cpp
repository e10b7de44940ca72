// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/playlist.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <libxml/HTMLparser.h>
#include <libxml/xpath.h>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <gst/gst.h>

#include "plugin/feel/follow/film_plan.h"
#include "plugin/films/film_list.h"
#include "plugin/films/text_lines.h"
#include "plugin/gobject/ref.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

/// The largest playlist: 10,000 films with long names need less.
constexpr uintmax_t kMax_bytes = uintmax_t{4} << 20;

bool ends_as(const std::string& path, const std::set<std::string>& ends) {
  const std::string end = fs::path(path).extension().string();
  return ends.count(taken(g_ascii_strdown(end.c_str(), -1))) > 0;
}

bool is_xml(const std::string& path) {
  return ends_as(path, {".xspf", ".asx", ".wax", ".wvx", ".wpl"});
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Reads other text than UTF-8 as Windows-1252; returns it unchanged if that fails.
std::string utf8_of(const std::string& text) {
  if (g_utf8_validate(text.c_str(), -1, nullptr)) return text;
  const std::string converted = taken(g_convert_with_fallback(
      text.c_str(), -1, "UTF-8", "WINDOWS-1252", nullptr, nullptr, nullptr, nullptr));
  return converted.empty() ? text : converted;
}

/// Returns the names in M3U, in lines that are not comments, or in PLS, in "File1 =" and so on, by
/// number. Returns nothing for HLS, which is one film.
std::optional<Names> named_in_lines(const std::string& path) {
  std::map<size_t, std::string> names;
  bool is_pls = ends_as(path, {".pls"});
  TextLines lines(path);
  while (const auto line = lines.next()) {
    const std::string text = taken(g_strstrip(g_strdup(line->c_str())));
    const size_t end = text.find('=');
    if (text.rfind("#EXT-X-", 0) == 0) return std::nullopt;
    if (g_ascii_strcasecmp(text.c_str(), "[playlist]") == 0) {
      is_pls = true;
    } else if (!is_pls && !text.empty() && text[0] != '#') {
      names.emplace(names.size(), *line);
    } else if (end != std::string::npos && g_ascii_strncasecmp(text.c_str(), "file", 4) == 0) {
      names[std::strtoul(text.c_str() + 4, nullptr, 10)] = text.substr(end + 1);
    }
  }
  Names in_order;
  for (auto& [number, name] : names) in_order.push_back(std::move(name));
  return in_order;
}

/// The names in XSPF, ASX and WPL. The latter two are parsed as HTML, because few are correct XML.
Names named_in_xml(const std::string& path) {
  std::string text;
  TextLines lines(path);
  while (const auto line = lines.next()) text += utf8_of(*line) + '\n';
  xmlDoc* const document = htmlReadMemory(
      text.data(), static_cast<int>(text.size()), nullptr, "UTF-8",
      HTML_PARSE_RECOVER | HTML_PARSE_NONET | HTML_PARSE_NOERROR | HTML_PARSE_NOWARNING);
  xmlXPathContext* const context = xmlXPathNewContext(document);
  // A location directly below <playlist> is that of the playlist file itself.
  xmlXPathObject* const found = xmlXPathEvalExpression(
      BAD_CAST "//location[not(parent::playlist)] | //ref/@href | //entryref/@href | //media/@src",
      context);
  Names names;
  for (int i = 0; found && i < xmlXPathNodeSetGetLength(found->nodesetval); ++i) {
    xmlChar* const name = xmlNodeGetContent(found->nodesetval->nodeTab[i]);
    names.emplace_back(reinterpret_cast<char*>(name));
    xmlFree(name);
  }
  xmlXPathFreeObject(found);
  xmlXPathFreeContext(context);
  xmlFreeDoc(document);
  return names;
}

/// Finds the file that a playlist in `folder` means by `name`: unchanged, trimmed, or with slashes,
/// each also percent-decoded. If no such file exists, returns the URI, or the path in `folder`.
std::string named_file(const fs::path& folder, const std::string& name) {
  const std::string bare = taken(g_strstrip(g_strdup(utf8_of(name).c_str())));
  if (bare.empty()) return {};
  const std::string slashed = taken(g_strdelimit(g_strdup(bare.c_str()), "\\", '/'));
  for (const std::string& written : {name, bare, slashed}) {
    const std::string decoded = taken(g_uri_unescape_string(written.c_str(), nullptr));
    if (is_there(folder / written)) return (folder / written).string();
    if (!decoded.empty() && is_there(folder / decoded)) return (folder / decoded).string();
  }
  if (bare.find("://") == std::string::npos) return (folder / bare).string();
  const std::string path = follow::path_of(bare);
  return is_there(path) ? path : bare;
}

Names read_folder(const std::string& path) {
  std::string left_out;
  std::set<std::pair<std::string, std::string>> by_key;
  for (const ListedFilm& film : list_films({path}, left_out)) {
    const std::string shown = taken(g_filename_display_name(film.path.c_str()));
    by_key.emplace(taken(g_utf8_collate_key_for_filename(shown.c_str(), -1)), film.path);
  }
  Names films;
  for (const auto& [key, film] : by_key) films.push_back(film);
  return films;
}

/// Returns nothing for HLS.
std::optional<Names> read_playlist(const std::string& path) {
  if (fs::file_size(path) > kMax_bytes) {
    throw std::runtime_error(path + ": has more than 4 MiB, which no playlist has");
  }
  std::optional<Names> names = is_xml(path) ? named_in_xml(path) : named_in_lines(path);
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  for (size_t i = 0; names && i < names->size(); ++i) (*names)[i] = named_file(folder, (*names)[i]);
  return names;
}

/// Adds the films of `word`. Each playlist is read only once, so that cycles end.
void add_films(const std::string& word, std::set<fs::path>& read, Names& films) {
  std::error_code error;
  std::optional<Names> names;
  if (fs::is_directory(word, error)) names = read_folder(word);
  if (is_playlist(word) && fs::is_regular_file(word, error)) {
    if (!read.insert(fs::canonical(word)).second) return;
    names = read_playlist(word);
  }
  for (const std::string& name : names.value_or(Names())) add_films(name, read, films);
  if (names || word.empty()) return;
  // An existing file counts even if it looks like a URI ("Alien:Romulus.avi") or an option.
  const bool looks_other = gst_uri_is_valid(word.c_str()) || word[0] == '-';
  films.push_back(looks_other && is_there(word) ? "./" + word : word);
}

}  // namespace

bool is_playlist(const std::string& path) {
  return is_xml(path) || ends_as(path, {".m3u", ".m3u8", ".pls"});
}

std::vector<std::string> films_of(const std::vector<std::string>& words) {
  Names films;
  std::set<fs::path> read;
  for (const std::string& word : words) {
    const size_t before = films.size();
    read.clear();
    add_films(word, read, films);
    if (films.size() == before) throw std::runtime_error(word + ": this playlist names no film");
  }
  return films;
}

}  // namespace spidar
