// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/film_plan.h"

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <gst/gst.h>

#include "plugin/films/film_reader.h"
#include "plugin/tracks/exchange_file.h"
#include "plugin/tracks/open_track.h"
#include "plugin/tracks/sidecar.h"

namespace spidar::follow {
namespace {

constexpr const char* kFile = "file://";

bool exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

/// Returns an empty string if the URI has another form, or names another machine.
std::string path_of_uri(const std::string& uri) {
  g_autofree gchar* host = nullptr;
  g_autofree gchar* path = g_filename_from_uri(uri.c_str(), &host, nullptr);
  const bool is_here = !host || g_ascii_strcasecmp(host, "localhost") == 0 ||
                       g_ascii_strcasecmp(host, g_get_host_name()) == 0;
  return path && is_here ? path : "";
}

/// Escapes literal characters: each '#', and each '%' that does not precede two hex digits.
std::string escaped(const std::string& uri) {
  std::string result;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool is_code = i + 2 < uri.size() && g_ascii_isxdigit(uri[i + 1]) != 0 &&
                         g_ascii_isxdigit(uri[i + 2]) != 0;
    if (uri[i] == '#') {
      result += "%23";
    } else if (uri[i] == '%' && !is_code) {
      result += "%25";
    } else {
      result += uri[i];
    }
  }
  return result;
}

/// Throws std::runtime_error when there is a track that belongs to another film.
void find_track(const std::string& path, const Film& film, const std::atomic<bool>* stopped,
                FilmPlan& plan) {
  const std::string beside = find_sidecar(path);
  if (beside.empty()) {
    plan.track = film.has_track ? path : tracks::find_exchange_file(path);
    return;
  }
  try {
    const std::unique_ptr<tracks::OpenTrack> track = tracks::open_track(beside, stopped);
    const int64_t end_ns = track->duration_ns() ? *track->duration_ns() : tracks::find_end(*track);
    const FilmMatch match = match_film(film, end_ns, track->notes());
    if (!match.mismatch.empty()) throw std::runtime_error(beside + ": " + match.mismatch);
    plan.track = beside;
    plan.later_ns = match.later_ns;
  } catch (const std::runtime_error& error) {
    plan.remark = std::string(error.what()) + "; the film is analysed";
  }
}

}  // namespace

std::string path_of(const std::string& address) {
  if (!address.empty() && address[0] == '/') return address;
  if (!g_str_has_prefix(address.c_str(), kFile)) return {};
  const std::string path = path_of_uri(address);
  if (!path.empty() && exists(path)) return path;
  // The address is not escaped at all, such as file:///films/100%25.avi for "100%25.avi".
  const std::string as_it_is = address.substr(std::string(kFile).size());
  if (!as_it_is.empty() && as_it_is[0] == '/' && exists(as_it_is)) return as_it_is;
  return path.empty() ? path_of_uri(escaped(address)) : path;
}

FilmPlan plan_film(const std::string& address, const std::atomic<bool>* stopped) {
  FilmPlan plan;
  plan.name = address;
  const std::string path = path_of(address);
  if (path.empty()) {
    g_autofree gchar* scheme = g_uri_parse_scheme(address.c_str());
    const bool is_web = scheme && (g_str_equal(scheme, "http") || g_str_equal(scheme, "https"));
    if (is_web) {
      plan.uri = address;
    } else {
      plan.refused = "only files of this machine, http and https are followed";
    }
    return plan;
  }
  plan.name = path;
  g_autofree gchar* uri = gst_filename_to_uri(path.c_str(), nullptr);
  plan.uri = uri ? uri : "";
  try {
    const Film film = read_film(path, stopped);
    if (film.is_still) throw std::runtime_error("it is a single picture, in which nothing moves");
    plan.frame_ns = film.frame_ns;
    find_track(path, film, stopped, plan);
  } catch (const std::runtime_error& error) {
    plan.refused = error.what();
  }
  return plan;
}

}  // namespace spidar::follow
