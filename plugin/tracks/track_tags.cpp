// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_tags.h"

#include <sstream>

#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"

namespace spidar::tracks {
namespace {

constexpr const char* kDescription =
    "Wrench on the grip: fx fy fz tx ty tz; x right, y up, z towards the viewer. Full scale is 10 "
    "N and 1 N m.\n";
// Lines of the comment after the description.
constexpr const char* kFilm = "HAPTIC_FILM=";
constexpr const char* kSettings = "HAPTIC_SETTINGS=";
constexpr const char* kOrigin = "HAPTIC_ORIGIN=";

std::string comment_of(const Notes& notes) {
  std::string comment = std::string(kDescription) + kTrackMark;
  if (!notes.film.empty()) comment += std::string("\n") + kFilm + to_text(notes.film);
  if (!notes.origin.empty()) comment += std::string("\n") + kOrigin + notes.origin;
  if (notes.settings) comment += std::string("\n") + kSettings + *notes.settings;
  return comment;
}

struct Tagging {
  Notes notes;
  bool done = false;
};

/// Replaces all tags, which GStreamer may send again later, and sends some before the first buffer
/// if none has come.
GstPadProbeReturn replace_tags(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  auto& tagging = *static_cast<Tagging*>(user);
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_TAG) return GST_PAD_PROBE_OK;
    GstEvent* const event = gst_event_new_tag(tags(tagging.notes));
    gst_event_unref(GST_PAD_PROBE_INFO_EVENT(info));
    GST_PAD_PROBE_INFO_DATA(info) = event;
  } else if (!tagging.done) {
    gst_pad_send_event(pad, gst_event_new_tag(tags(tagging.notes)));
  }
  tagging.done = true;
  return GST_PAD_PROBE_OK;
}

}  // namespace

GstTagList* tags(const Notes& notes) {
  GstTagList* tags =
      gst_tag_list_new(GST_TAG_TITLE, "Haptic track", GST_TAG_COMMENT, comment_of(notes).c_str(),
                       GST_TAG_EXTENDED_COMMENT, kTrackMark, nullptr);
  gst_tag_list_set_scope(tags, GST_TAG_SCOPE_STREAM);
  return tags;
}

void read_notes(const GstTagList* tags, Notes& notes) {
  const guint count = gst_tag_list_get_tag_size(tags, GST_TAG_COMMENT);
  for (guint i = 0; i < count; ++i) {
    g_autofree gchar* comment = nullptr;
    if (!gst_tag_list_get_string_index(tags, GST_TAG_COMMENT, i, &comment)) continue;
    std::istringstream lines(comment);
    for (std::string line; std::getline(lines, line);) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.rfind(kFilm, 0) == 0) {
        notes.film = parse_fingerprint(line.substr(std::string(kFilm).size()));
      } else if (line.rfind(kSettings, 0) == 0) {
        notes.settings = line.substr(std::string(kSettings).size());
      } else if (line.rfind(kOrigin, 0) == 0) {
        notes.origin = line.substr(std::string(kOrigin).size());
      }
    }
  }
}

void tag(GstPad* pad, const Notes& notes) {
  constexpr auto kAll =
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST |
                                   GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);
  const Ref<GstPad> into(gst_pad_get_peer(pad));
  gst_pad_add_probe(into.get(), kAll, replace_tags, new Tagging{notes},
                    [](gpointer owned) { delete static_cast<Tagging*>(owned); });
}

}  // namespace spidar::tracks
