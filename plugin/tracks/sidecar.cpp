// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/sidecar.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "plugin/films/file_pipeline.h"
#include "plugin/gobject/ref.h"
#include "plugin/tracks/name_form.h"
#include "spidar/folders.h"

namespace spidar {
namespace {

/// How much the ends of track and film may differ if the fingerprint is found in the film.
constexpr int64_t kMaxMissing_ns = 500'000'000;

constexpr std::initializer_list<const char*> kTrackSuffixes = {".haptic.flac", ".haptic.mka",
                                                               ".haptic.wav"};

namespace fs = std::filesystem;

/// Lists the existing files, in the order of the search.
std::vector<std::string> list_beside(const std::string& film,
                                     std::initializer_list<const char*> ends) {
  std::vector<std::string> files;
  if (film.empty()) return files;
  const std::string stem = fs::path(film).replace_extension().string();
  for (const std::string& name : {film, stem}) {
    for (const char* const end : ends) {
      std::string file = tracks::existing(name + end);
      if (!file.empty()) files.push_back(std::move(file));
    }
  }
  return files;
}

/// Folders of tracks in the order of the search: those of the variable, and that of the user.
std::vector<fs::path> track_folders() {
  std::vector<fs::path> folders = listed_folders(kTrackPathVariable);
  folders.push_back(fs::path(g_get_user_data_dir()) / "gst-spidar" / "tracks");
  return folders;
}

/// Lists the tracks of a film: beside the film, then in folders of tracks, in which `spidartrack
/// record` repeats the subfolders of the films. It is unknown below which folder these subfolders
/// were, so the track whose path has the most folders in common with that of the film comes first.
std::vector<std::string> list_tracks(const std::string& film) {
  std::vector<std::string> files = list_beside(film, kTrackSuffixes);
  if (film.empty()) return files;
  std::error_code ignored;
  const fs::path path = fs::absolute(film, ignored).lexically_normal();
  for (const fs::path& folder : track_folders()) {
    if (!fs::is_directory(folder, ignored)) continue;
    for (auto from = std::next(path.begin()); from != path.end(); ++from) {
      fs::path below;
      for (auto part = from; part != path.end(); ++part) below /= *part;
      for (const std::string& file : list_beside((folder / below).string(), kTrackSuffixes)) {
        files.push_back(file);
      }
    }
  }
  return files;
}

/// Returns the first of `files` if that is not `file`, which is one of them; else an empty text.
std::string first_before(const std::vector<std::string>& files, const std::string& file) {
  const auto is_file = [&file](const std::string& other) {
    std::error_code ignored;
    return fs::equivalent(file, other, ignored);
  };
  const auto found = std::find_if(files.begin(), files.end(), is_file);
  return found == files.begin() || found == files.end() ? std::string() : files.front();
}

}  // namespace

const char* const kTrackPathVariable = "SPIDAR_TRACK_PATH";

std::string find_beside(const std::string& film, std::initializer_list<const char*> ends) {
  const std::vector<std::string> files = list_beside(film, ends);
  return files.empty() ? std::string() : files.front();
}

const char* const kOtherPictures =
    "it was recorded from other pictures, or from these before they were encoded anew";

std::string film_of(GstPad* pad) {
  const Ref<GstQuery> query(gst_query_new_uri());
  g_autofree gchar* uri = nullptr;
  if (gst_pad_peer_query(pad, query.get())) gst_query_parse_uri(query.get(), &uri);
  return taken(uri ? g_filename_from_uri(uri, nullptr, nullptr) : nullptr);
}

std::string find_sidecar(const std::string& film) {
  const std::vector<std::string> files = list_tracks(film);
  return files.empty() ? std::string() : files.front();
}

std::string why_not_played(const std::string& film, const std::string& track) {
  const std::vector<std::string> files = list_tracks(film);
  const std::string other = first_before(files, track);
  std::error_code ignored;
  if (other.empty() && !files.empty() && fs::equivalent(files.front(), track, ignored)) {
    std::string after;
    for (const std::string& file : list_beside(film, kTrackSuffixes)) {
      if (!fs::equivalent(file, track, ignored)) after += (after.empty() ? "" : ", ") + file;
    }
    return after.empty() ? "" : after + " is not played as long as " + track + " is there";
  }
  if (other.empty()) return {};
  return "warning: track=auto and spidartrack play " + other + " in place of " + track +
         "; remove it, or use track=" + track;
}

FilmMatch match_film(const Film& film, int64_t track_ns, const tracks::Notes& notes) {
  const FilmFingerprint& fingerprint = notes.film;
  FilmMatch match;
  // A millisecond is added because many containers round durations to milliseconds.
  int64_t tolerance_ns = film.frame_ns + static_cast<int64_t>(GST_MSECOND);
  if (!fingerprint.empty()) {
    const std::optional<int64_t> later_ns = find_picture(fingerprint, film.packets);
    if (!later_ns) {
      match.mismatch = kOtherPictures;
      return match;
    }
    match.later_ns = *later_ns;
    tolerance_ns += kMaxMissing_ns;
  } else {
    tolerance_ns += film.begin_ns;  // the track may begin with the first picture
  }
  if (!notes.origin.empty()) return match;
  const int64_t end_ns = film.end_ns.value_or(film.duration_ns);
  const int64_t missing_ns = end_ns - match.later_ns - track_ns;
  // Sound may be longer than the pictures.
  const bool is_short = film.end_ns && missing_ns > tolerance_ns;
  if (end_ns != 0 && (is_short || -missing_ns > tolerance_ns)) {
    match.mismatch =
        "the track lasts " + seconds_text(track_ns) + ", the film " + seconds_text(end_ns);
  }
  return match;
}

std::string why_other_film(GstPad* pad, int64_t track_ns, int64_t frame_ns) {
  gint64 film_ns = 0;
  if (!gst_pad_peer_query_duration(pad, GST_FORMAT_TIME, &film_ns) || film_ns <= 0) return {};
  // A millisecond is added because many containers round durations to milliseconds.
  if (std::llabs(film_ns - track_ns) <= frame_ns + GST_MSECOND) return {};
  return "the track lasts " + seconds_text(track_ns) + ", the film " + seconds_text(film_ns);
}

}  // namespace spidar
