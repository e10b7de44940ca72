// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/feel_decoder.h"

#include <cstring>

#include "plugin/feel/feel_bin.h"
#include "plugin/feel/feel_tracer.h"
#include "plugin/feel/follow_state.h"
#include "plugin/feel/video_notice.h"
#include "plugin/timing/downstream.h"

namespace spidar {
namespace {

const char* factory_name(GstElement* element) {
  GstElementFactory* factory = gst_element_get_factory(element);
  return factory ? GST_OBJECT_NAME(factory) : "";
}

bool is_decoder(GstElement* element) {
  static const char* const kNames[] = {"decodebin", "decodebin3", "uridecodebin", "uridecodebin3",
                                       nullptr};
  return g_strv_contains(kNames, factory_name(element));
}

/// Whether what is inside `element` is left alone: players have a filter of their own, a decoder
/// has its own at its end, and inside a timeline the time of a frame is not that of the screen.
bool has_other_filters(GstElement* element) {
  const char* name = factory_name(element);
  return is_decoder(element) || strcmp(name, "playbin") == 0 || strcmp(name, "playbin3") == 0 ||
         g_str_has_prefix(name, "nle");
}

bool is_outermost_decoder(GstElement* element) {
  if (!is_decoder(element)) return false;
  bool outermost = true;
  GstObject* above = gst_object_get_parent(GST_OBJECT(element));
  while (above) {
    if (GST_IS_ELEMENT(above) && has_other_filters(GST_ELEMENT(above))) outermost = false;
    GstObject* next = gst_object_get_parent(above);
    gst_object_unref(above);
    above = next;
  }
  return outermost;
}

bool is_screen(GstElement* element) {
  const char* kind = gst_element_get_metadata(element, GST_ELEMENT_METADATA_KLASS);
  return kind && strstr(kind, "Sink") && strstr(kind, "Video");
}

/// Whether `pad` has video that software can read.
bool has_raw_video(GstPad* pad) {
  GstCaps* caps = gst_pad_get_current_caps(pad);
  if (!caps) return false;
  const bool raw = gst_structure_has_name(gst_caps_get_structure(caps, 0), "video/x-raw");
  const bool readable = gst_caps_features_is_equal(gst_caps_get_features(caps, 0),
                                                   GST_CAPS_FEATURES_MEMORY_SYSTEM_MEMORY);
  if (raw && !readable) {
    gchar* text = gst_caps_features_to_string(gst_caps_get_features(caps, 0));
    g_printerr(
        "spidar-feel: the video is not felt, because its frames are not in system memory but in "
        "%s; let the player ask the decoder for video/x-raw\n",
        text);
    g_free(text);
  }
  gst_caps_unref(caps);
  return raw && readable;
}

/// The filter of a pad, with a reference to it.
GQuark filter_of_pad() {
  return g_quark_from_static_string("spidar-feel-filter");
}

gpointer with_reference(gpointer object, gpointer) {
  return object ? gst_object_ref(object) : nullptr;
}

/// The filter that `pad` has, with a new reference, or nullptr.
GstElement* get_filter(GstPad* pad) {
  return static_cast<GstElement*>(
      g_object_dup_qdata(G_OBJECT(pad), filter_of_pad(), with_reference, nullptr));
}

/// A ghost pad of a decoder and the filter that goes before it.
struct Place {
  GstGhostPad* pad;
  GstElement* filter;  ///< nullptr: not made yet
};

Place* place_new(GstGhostPad* pad, GstElement* filter) {
  return new Place{GST_GHOST_PAD(gst_object_ref(pad)),
                   filter ? GST_ELEMENT(gst_object_ref(filter)) : nullptr};
}

void place_free(gpointer data) {
  Place* place = static_cast<Place*>(data);
  gst_object_unref(place->pad);
  gst_clear_object(&place->filter);
  delete place;
}

/// Calls `found` when the next buffer is about to leave the target of `pad`, and none is between
/// them.
void at_next_frame(GstGhostPad* pad, GstElement* filter, GstPadProbeCallback found) {
  GstPad* target = gst_ghost_pad_get_target(pad);
  if (!target) return;
  gst_pad_add_probe(
      target,
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_BUFFER |
                                   GST_PAD_PROBE_TYPE_BUFFER_LIST),
      found, place_new(pad, filter), place_free);
  gst_object_unref(target);
}

/// Links `target` to `in`, which is that of the filter. False when its video does not fit.
bool link_filter(GstPad* target, GstPad* in, GstElement* filter) {
  GstCaps* caps = gst_pad_get_current_caps(target);
  if (!caps) return false;
  // The decoder need not allocate its frames in another way.
  const bool quietly = gst_spidar_feel_bin_passes(GST_SPIDAR_FEEL_BIN(filter), caps);
  const bool linked =
      gst_pad_link_full(target, in, quietly ? kLinkQuietly : GST_PAD_LINK_CHECK_DEFAULT) ==
      GST_PAD_LINK_OK;
  GstCaps* accepted = gst_pad_query_caps(in, caps);
  const bool fits = linked && !gst_caps_is_empty(accepted);
  gst_caps_unref(accepted);
  gst_caps_unref(caps);
  return fits;
}

/// Puts the filter between `target` and `pad`, whose target it is. Leaves them as they were and
/// returns false when their video does not fit through the filter.
bool insert(GstGhostPad* pad, GstPad* target, GstElement* filter) {
  GstPad* in = gst_element_get_static_pad(filter, "sink");
  GstPad* out = gst_element_get_static_pad(filter, "src");
  const bool inserted = gst_ghost_pad_set_target(pad, out) && link_filter(target, in, filter);
  if (!inserted) {
    gst_pad_unlink(target, in);
    gst_ghost_pad_set_target(pad, target);
  }
  gst_object_unref(in);
  gst_object_unref(out);
  return inserted;
}

/// Whether the filter was behind `target` before. Then the decoder has undone it, as decodebin3
/// does with streams that it need not decode, and would again. Remembers `target`, which may be
/// gone.
bool was_undone(GstElement* filter, GstPad* target) {
  const GQuark last = g_quark_from_static_string("spidar-feel-target");
  const bool undone = g_object_get_qdata(G_OBJECT(filter), last) == target;
  g_object_set_qdata(G_OBJECT(filter), last, target);
  return undone;
}

/// Closes the device, too.
void remove_filter(GstElement* filter) {
  gst_element_set_state(filter, GST_STATE_NULL);
  GstObject* decoder = gst_object_get_parent(GST_OBJECT(filter));
  if (!decoder) return;
  gst_bin_remove(GST_BIN(decoder), filter);
  gst_object_unref(decoder);
}

/// Removes the filter of `pad`, if it has one.
void forget(GstPad* pad) {
  auto* filter = static_cast<GstElement*>(g_object_steal_qdata(G_OBJECT(pad), filter_of_pad()));
  if (!filter) return;
  remove_filter(filter);
  gst_object_unref(filter);
}

GstPadProbeReturn put_in(GstPad* target, GstPadProbeInfo*, gpointer data) {
  const Place* place = static_cast<Place*>(data);
  // Meanwhile, the pad may have been removed, or the decoder may have given it another target.
  GstElement* filter = get_filter(GST_PAD(place->pad));
  GstPad* now = gst_ghost_pad_get_target(place->pad);
  if (filter == place->filter && now == target &&
      (was_undone(filter, target) || !insert(place->pad, target, filter))) {
    g_printerr("spidar-feel: the video does not fit through the filter and is not felt\n");
    forget(GST_PAD(place->pad));
  }
  gst_clear_object(&now);
  gst_clear_object(&filter);
  return GST_PAD_PROBE_REMOVE;
}

/// Adds a filter for `pad` to `decoder`, opens the device, and lets the next frame put the filter
/// in. Without a device nothing is added.
void add_filter(GstElement* decoder, GstPad* pad) {
  GstElement* filter = gst_spidar_feel_bin_new(g_getenv(SPIDAR_FEEL_VARIABLE));
  if (!filter) return;
  gst_object_ref_sink(filter);
  if (g_object_replace_qdata(G_OBJECT(pad), filter_of_pad(), nullptr, gst_object_ref(filter),
                             gst_object_unref, nullptr)) {
    gst_bin_add(GST_BIN(decoder), filter);
    follow_state(decoder, filter);
    if (gst_spidar_feel_bin_is_felt(GST_SPIDAR_FEEL_BIN(filter)))
      at_next_frame(GST_GHOST_PAD(pad), filter, put_in);
    else
      forget(pad);
  } else {
    gst_object_unref(filter);
  }
  gst_object_unref(filter);
}

bool is_shown(GstPad* pad) {
  return !find_path_downstream(pad, is_screen).steps().empty();
}

void feel_pad(GstElement* decoder, GstPad* pad) {
  if (!GST_IS_GHOST_PAD(pad)) return;
  GstElement* filter = get_filter(pad);
  if (!filter && is_shown(pad)) {
    notice_video();
    if (has_raw_video(pad)) add_filter(decoder, pad);
  }
  gst_clear_object(&filter);
}

/// The pad of a decoder that was linked while the decoder plays.
GstPadProbeReturn feel_late(GstPad*, GstPadProbeInfo*, gpointer data) {
  GstPad* pad = GST_PAD(static_cast<Place*>(data)->pad);
  if (GstElement* decoder = gst_pad_get_parent_element(pad)) {
    feel_pad(decoder, pad);
    gst_object_unref(decoder);
  }
  return GST_PAD_PROBE_REMOVE;
}

/// `source` was linked by the application, or has a new target.
void feel_linked(GstObject* source, bool new_target) {
  if (!GST_IS_GHOST_PAD(source) || !GST_PAD_IS_SRC(source)) return;
  GstPad* pad = GST_PAD(source);
  GstElement* decoder = gst_pad_get_parent_element(pad);
  if (!decoder) return;
  if (is_outermost_decoder(decoder) && state_of(decoder) == GST_STATE_PLAYING) {
    GstElement* filter = get_filter(pad);
    if (!filter)
      at_next_frame(GST_GHOST_PAD(pad), nullptr, feel_late);
    else if (new_target)
      at_next_frame(GST_GHOST_PAD(pad), filter, put_in);
    gst_clear_object(&filter);
  }
  gst_object_unref(decoder);
}

}  // namespace

void feel_decoder(GstElement* element) {
  if (!is_outermost_decoder(element)) return;
  gst_element_foreach_src_pad(
      element,
      [](GstElement* decoder, GstPad* pad, gpointer) -> gboolean {
        feel_pad(decoder, pad);
        return TRUE;
      },
      nullptr);
}

void feel_linked_pad(GstPad* source, GstPad* sink) {
  feel_linked(GST_OBJECT(source), false);
  // The pad inside a ghost pad is linked to the target: by the decoder, or by insert().
  GstObject* inserted = gst_object_get_parent(GST_OBJECT(source));
  GstObject* outer = gst_object_get_parent(GST_OBJECT(sink));
  if (outer && !(inserted && GST_IS_SPIDAR_FEEL_BIN(inserted))) feel_linked(outer, true);
  gst_clear_object(&inserted);
  gst_clear_object(&outer);
}

void free_unlinked_target(GstPad* source) {
  GstObject* filter = gst_object_get_parent(GST_OBJECT(source));
  if (filter && GST_IS_SPIDAR_FEEL_BIN(filter)) {
    GstPad* in = gst_element_get_static_pad(GST_ELEMENT(filter), "sink");
    if (GstPad* target = gst_pad_get_peer(in)) {
      gst_pad_unlink(target, in);
      gst_object_unref(target);
    }
    gst_object_unref(in);
  }
  gst_clear_object(&filter);
}

void forget_removed_pad(GstElement* element, GstPad* pad) {
  if (is_decoder(element)) forget(pad);
}

}  // namespace spidar
