// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/film_list.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFilmEnds[] = {".3g2", ".3gp",  ".asf", ".avi",  ".divx", ".f4v",
                                     ".flv", ".m2ts", ".m2v", ".m4v",  ".mkv",  ".mov",
                                     ".mp4", ".mpeg", ".mpg", ".mts",  ".mxf",  ".ogm",
                                     ".ogv", ".ts",   ".vob", ".webm", ".wmv"};

bool is_hidden(const fs::path& path) {
  return path.filename().string().front() == '.';
}

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

/// Finds the films in a folder and below, and counts everything else.
class FilmSearch {
 public:
  /// Throws std::runtime_error when the folder itself cannot be read.
  explicit FilmSearch(const std::string& folder) : folder_(folder) {
    if (const std::error_code error = search_folder(folder)) {
      throw std::runtime_error(folder + ": cannot be read: " + error.message());
    }
    std::sort(found_.begin(), found_.end(), [](const ListedFilm& a, const ListedFilm& b) {
      return a.bytes != b.bytes ? a.bytes > b.bytes : a.path < b.path;
    });
  }

  const std::vector<ListedFilm>& found() const { return found_; }
  /// Parts of a sentence.
  std::vector<std::string> left_out() const {
    std::vector<std::string> parts = unreadable_;
    for (const auto& [what, files] : passed_over_) {
      parts.push_back(std::to_string(files) + " " + what + (files == 1 ? "" : "s"));
    }
    size_t count = 0;
    std::vector<std::pair<size_t, std::string>> ends;
    for (const auto& [end, files] : others_) {
      count += files;
      ends.emplace_back(files, end.empty() ? "without an ending" : end);
    }
    if (count == 0) return parts;
    std::stable_sort(ends.begin(), ends.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    constexpr size_t kMaxEnds = 5;
    std::string text;
    for (size_t i = 0; i < std::min(ends.size(), kMaxEnds); ++i) {
      text += (i == 0 ? "" : ", ") + std::to_string(ends[i].first) + " " + ends[i].second;
    }
    parts.push_back(std::to_string(count) + (count == 1 ? " file that is" : " files that are") +
                    " no film by the name (" + text + (ends.size() > kMaxEnds ? ", …" : "") + ")");
    return parts;
  }

 private:
  std::error_code search_folder(const fs::path& folder) {
    std::error_code error;
    for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
      add_entry(*at);
    }
    return error;
  }

  void add_entry(const fs::directory_entry& entry) {
    std::error_code gone;  // it may be renamed or removed in the meantime
    const bool is_link = entry.is_symlink(gone);
    if (entry.is_directory(gone)) {
      // Such as the trash of a desktop, or the files with the names of films that a file server
      // keeps for Macs.
      if (is_hidden(entry.path())) {
        ++passed_over_["hidden folder"];
      } else if (is_link) {
        ++passed_over_["linked folder"];
      } else if (const std::error_code error = search_folder(entry.path())) {
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
    found_.push_back({entry.path().string(), subfolder, bytes});
  }

  const fs::path folder_;
  std::vector<ListedFilm> found_;
  std::vector<std::string> unreadable_;
  std::map<std::string, size_t> passed_over_;  ///< by what they are
  std::map<std::string, size_t> others_;       ///< files, by their ending
};

}  // namespace

std::vector<ListedFilm> list_films(const std::vector<std::string>& names, std::string& left_out) {
  left_out.clear();
  std::vector<ListedFilm> films;
  for (const std::string& name : names) {
    if (!fs::is_directory(name)) {
      films.push_back({name, {}, 0});
      continue;
    }
    const FilmSearch search(name);
    for (const std::string& part : search.left_out()) {
      left_out += (left_out.empty() ? "" : "; ") + part;
    }
    if (search.found().empty()) {
      throw std::runtime_error(name + ": this folder has no film (names that end in .mkv, .mp4 …)" +
                               (left_out.empty() ? "" : "; left out: " + left_out));
    }
    films.insert(films.end(), search.found().begin(), search.found().end());
  }
  return films;
}

}  // namespace spidar
