// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/film/failure.h"

#include <cstdio>
#include <gio/gio.h>

namespace {

/// The reason is in the last line of GStreamer's debug text; the lines before tell the place.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const size_t end = text.rfind('\n');
  return end == std::string::npos ? "" : text.substr(end + 1);
}

/// Why the host of a URI does not answer; empty when it does, or when the URI has no host.
std::string host_problem(const std::string& uri) {
  GUri* const parts = g_uri_parse(uri.c_str(), G_URI_FLAGS_NONE, nullptr);
  if (!parts) return {};
  std::string problem;
  const std::string scheme = g_uri_get_scheme(parts);
  const char* const host = g_uri_get_host(parts);
  const guint16 port = scheme == "http" ? 80 : scheme == "https" ? 443 : scheme == "rtsp" ? 554 : 0;
  if (host && *host && port != 0) {
    GSocketClient* const client = g_socket_client_new();
    g_socket_client_set_timeout(client, 5);
    GError* error = nullptr;
    GSocketConnection* const connection =
        g_socket_client_connect_to_uri(client, uri.c_str(), port, nullptr, &error);
    if (connection) g_object_unref(connection);
    if (error) problem = std::string("host ") + host + ": " + error->message;
    g_clear_error(&error);
    g_object_unref(client);
  }
  g_uri_unref(parts);
  return problem;
}

std::string seconds(gint64 time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", 1e-9 * static_cast<double>(time));
  return text;
}

}  // namespace

std::string failure_text(GstMessage* message, const std::string& uri) {
  GError* error = nullptr;
  char* debug = nullptr;
  gst_message_parse_error(message, &error, &debug);
  std::string text = error->message;
  const std::string reason = last_line(debug ? debug : "");
  if (!reason.empty()) text += " (" + reason + ")";
  g_error_free(error);
  g_free(debug);
  const std::string host = host_problem(uri);
  return host.empty() ? text : host + ". " + text;
}

bool misses_sound_only(GstMessage* message) {
  GError* error = nullptr;
  char* debug = nullptr;
  gst_message_parse_error(message, &error, &debug);
  // The types of all streams for which no decoder was found are in the debug text.
  const std::string streams = debug ? debug : "";
  const bool result = g_error_matches(error, GST_CORE_ERROR, GST_CORE_ERROR_MISSING_PLUGIN) &&
                      streams.find("(audio/") != std::string::npos &&
                      streams.find("(video/") == std::string::npos &&
                      streams.find("(image/") == std::string::npos;
  g_error_free(error);
  g_free(debug);
  return result;
}

bool has_no_video(GstElement* playbin) {
  if (!g_object_class_find_property(G_OBJECT_GET_CLASS(playbin), "n-video")) return false;
  int count = 0;
  g_object_get(playbin, "n-video", &count, nullptr);
  return count == 0;
}

std::string early_end_text(GstElement* pipeline) {
  constexpr gint64 kMuch_ns = 1'000'000'000;  // streams of a film end at slightly different times
  gint64 position = 0;
  gint64 duration = 0;
  if (!gst_element_query_position(pipeline, GST_FORMAT_TIME, &position) ||
      !gst_element_query_duration(pipeline, GST_FORMAT_TIME, &duration) ||
      position + kMuch_ns >= duration) {
    return {};
  }
  return "ended after " + seconds(position) + " of " + seconds(duration) +
         ": the file seems to be cut off";
}
