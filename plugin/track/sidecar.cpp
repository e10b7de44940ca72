// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/sidecar.h"

#include <cstdlib>
#include <filesystem>

namespace spidar {
namespace {

std::string seconds(int64_t ns) {
  gchar* const text = g_strdup_printf("%.3f s", 1e-9 * static_cast<double>(ns));
  std::string result = text;
  g_free(text);
  return result;
}

}  // namespace

std::string film_of(GstPad* pad) {
  std::string film;
  GstQuery* query = gst_query_new_uri();
  if (gst_pad_peer_query(pad, query)) {
    gchar* uri = nullptr;
    gst_query_parse_uri(query, &uri);
    gchar* const path = uri ? g_filename_from_uri(uri, nullptr, nullptr) : nullptr;
    if (path) film = path;
    g_free(path);
    g_free(uri);
  }
  gst_query_unref(query);
  return film;
}

std::string find_sidecar(const std::string& film) {
  if (film.empty()) return {};
  for (const char* extension : {".haptic.flac", ".haptic.mka", ".haptic.wav"}) {
    std::filesystem::path path(film);
    path.replace_extension(extension);
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return path.string();
  }
  return {};
}

std::string other_film(GstPad* pad, int64_t track_ns, int64_t frame_ns) {
  gint64 film_ns = 0;
  if (!gst_pad_peer_query_duration(pad, GST_FORMAT_TIME, &film_ns) || film_ns <= 0) return {};
  // Plus a millisecond, because many containers round durations to milliseconds.
  if (std::llabs(film_ns - track_ns) <= frame_ns + GST_MSECOND) return {};
  return "the track lasts " + seconds(track_ns) + ", the film " + seconds(film_ns);
}

}  // namespace spidar
