// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_merger.h"

#include <optional>
#include <stdexcept>

#include <gst/gst.h>

#include "plugin/tools/matroska_flags.h"
#include "plugin/tools/plain_subtitles.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/film_streams.h"

namespace spidar {
namespace {

constexpr const char* kTrackName = "Haptic track";

struct Merge {
  GstElement* mux = nullptr;
  GstElement* queue = nullptr;    // for the streams of the film
  GstElement* samples = nullptr;  // for the samples of the track
  GstPad* track = nullptr;        // blocked until the streams of the film are known
  gulong hold = 0;
  TrackNotes notes;
  int buffers = 0;  // of the track
};

void refuse(GstElement* element, const std::string& reason) {
  GST_ELEMENT_ERROR(element, STREAM, WRONG_TYPE, ("%s", reason.c_str()), ("spidartrack merge"));
}

/// Links `pad` to the muxer through the queue. Returns false when Matroska does not accept such a
/// stream.
bool link_to_mux(Merge& merge, GstPad* pad, GstCaps* caps) {
  GstPad* into = gst_element_request_pad_simple(merge.queue, "sink_%u");
  gchar* name = gst_pad_get_name(into);
  const std::string out_name = "src_" + std::string(name).substr(5);
  g_free(name);
  GstPad* out = gst_element_get_static_pad(merge.queue, out_name.c_str());
  GstObject* pipeline = gst_object_get_parent(GST_OBJECT(merge.mux));
  GstElement* plain = add_plain_subtitles(GST_ELEMENT(pipeline), caps);
  if (plain) {
    GstPad* plain_sink = gst_element_get_static_pad(plain, "sink");
    gst_pad_link(out, plain_sink);
    gst_object_unref(plain_sink);
    gst_object_unref(out);
    out = gst_element_get_static_pad(plain, "src");
  }
  gst_object_unref(pipeline);
  GstPad* mux_pad = plain ? gst_element_request_pad_simple(merge.mux, "subtitle_%u")
                          : gst_element_get_compatible_pad(merge.mux, pad, caps);
  const bool linked = mux_pad && gst_pad_link(pad, into) == GST_PAD_LINK_OK &&
                      gst_pad_link(out, mux_pad) == GST_PAD_LINK_OK;
  if (mux_pad) gst_object_unref(mux_pad);
  gst_object_unref(out);
  gst_object_unref(into);
  return linked;
}

void add_stream(GstElement* parser, GstPad* pad, gpointer user) {
  auto& merge = *static_cast<Merge*>(user);
  GstCaps* caps = caps_of(pad);
  const bool linked = link_to_mux(merge, pad, caps);
  if (!linked) {
    gchar* const text = gst_caps_to_string(caps);
    refuse(parser, std::string("Matroska takes no stream of ") + text +
                       ": leave the track beside the film, where track=auto finds it.");
    g_free(text);
  }
  gst_caps_unref(caps);
}

/// Lets the film and the track continue, or stops with the reason why they cannot be merged.
void judge_film(const Merge& merge, GstElement* parser) {
  bool has_sound = false, has_track = false;
  for (GList* i = parser->srcpads; i; i = i->next) {
    GstCaps* caps = caps_of(static_cast<GstPad*>(i->data));
    has_sound = has_sound || kind_of(caps) == StreamKind::kSound;
    has_track = has_track || kind_of(caps) == StreamKind::kHapticTrack;
    gst_caps_unref(caps);
  }
  if (has_track) {
    refuse(parser, "The film has a haptic track already: spidartrack extract takes it out.");
  } else if (!has_sound) {
    refuse(
        parser,
        "The film has no sound: players would play the haptic track through the loudspeakers. "
        "Leave it beside the film, as FILM.haptic.flac for FILM.mp4, where track=auto finds it.");
  } else {
    // Added after the film's sound, because players choose the first audio stream.
    GstPad* mux_pad = gst_element_request_pad_simple(merge.mux, "audio_%u");
    gst_pad_link(merge.track, mux_pad);
    gst_object_unref(mux_pad);
    gst_pad_remove_probe(merge.track, merge.hold);
  }
}

GstPadProbeReturn hold_back(GstPad*, GstPadProbeInfo*, gpointer) {
  return GST_PAD_PROBE_OK;
}

void send_tags(GstPad* mux_pad, const TrackNotes& notes, const std::string& title) {
  GstTagList* tags = track_tags(notes);
  gst_tag_list_add(tags, GST_TAG_MERGE_REPLACE, GST_TAG_TITLE, title.c_str(), nullptr);
  gst_pad_send_event(mux_pad, gst_event_new_tag(tags));
}

/// Sends the tags of the track to the muxer right before its first sample, which is when the muxer
/// writes the name of the track, with room for flags. Its tags are written at the end, without.
GstPadProbeReturn tag_samples(GstPad* pad, GstPadProbeInfo*, gpointer user) {
  auto& merge = *static_cast<Merge*>(user);
  GstPad* mux_pad = gst_pad_get_peer(pad);
  const bool is_first = ++merge.buffers == 1;
  send_tags(mux_pad, merge.notes, is_first ? name_with_room(kTrackName) : kTrackName);
  gst_object_unref(mux_pad);
  return is_first ? GST_PAD_PROBE_OK : GST_PAD_PROBE_REMOVE;
}

GstPadProbeReturn drop_tags(GstPad*, GstPadProbeInfo* info, gpointer) {
  const bool is_tag = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_TAG;
  return is_tag ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
}

void add_track(GstElement* parser, GstPad* pad, gpointer user) {
  const auto& merge = *static_cast<Merge*>(user);
  GstCaps* caps = caps_of(pad);
  GstPad* into = gst_element_get_static_pad(merge.samples, "sink");
  if (kind_of(caps) != StreamKind::kHapticTrack || gst_pad_is_linked(into) ||
      gst_pad_link(pad, into) != GST_PAD_LINK_OK) {
    refuse(parser, "The track is to be a file of its own; spidartrack extract makes one.");
  }
  gst_object_unref(into);
  gst_caps_unref(caps);
}

}  // namespace

void merge_film(const std::string& film, const std::string& track, const TrackNotes& notes,
                const std::string& out) {
  Merge merge;
  merge.notes = notes;
  std::optional<StreamsWatch> streams;
  run_pipeline(
      "matroskamux name=mux ! filesink location=" + quoted(out) +
          " filesrc location=" + quoted(film) +
          " ! parsebin name=film multiqueue name=streams max-size-bytes=0 max-size-buffers=0 "
          "max-size-time=10000000000 filesrc location=" +
          quoted(track) + " ! parsebin name=track queue name=samples",
      [&](GstElement* pipeline) {
        const auto find = [pipeline](const char* name) {
          GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline), name);
          gst_object_unref(element);  // the pipeline has it
          return element;
        };
        merge.mux = find("mux");
        merge.queue = find("streams");
        merge.samples = find("samples");
        merge.track = gst_element_get_static_pad(merge.samples, "src");
        gst_pad_add_probe(merge.track, GST_PAD_PROBE_TYPE_BUFFER, tag_samples, &merge, nullptr);
        gst_pad_add_probe(merge.track, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, drop_tags, nullptr,
                          nullptr);
        merge.hold = gst_pad_add_probe(merge.track, GST_PAD_PROBE_TYPE_BLOCK_DOWNSTREAM, hold_back,
                                       nullptr, nullptr);
        gst_object_unref(merge.track);
        g_signal_connect(find("track"), "pad-added", G_CALLBACK(add_track), &merge);
        g_signal_connect(find("film"), "pad-added", G_CALLBACK(add_stream), &merge);
        GstElement* const parser = find("film");
        streams.emplace(parser, [&merge, parser] { judge_film(merge, parser); });
      });
  clear_track_flags(out, kTrackName);
}

}  // namespace spidar
