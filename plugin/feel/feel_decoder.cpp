// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/feel_decoder.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "plugin/feel/feel_bin.h"
#include "plugin/feel/feel_tracer.h"
#include "plugin/gobject/downstream.h"

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
  const std::vector<Ref<GstObject>> bins = bins_around(element);
  return std::none_of(bins.begin(), bins.end(), [](const Ref<GstObject>& bin) {
    return GST_IS_ELEMENT(bin.get()) && has_other_filters(GST_ELEMENT(bin.get()));
  });
}

bool is_screen(GstElement* element) {
  const char* kind = gst_element_get_metadata(element, GST_ELEMENT_METADATA_KLASS);
  return kind && strstr(kind, "Sink") && strstr(kind, "Video");
}

/// Whether `pad` has video that software can read.
bool has_raw_video(GstPad* pad) {
  const Ref<GstCaps> caps(gst_pad_get_current_caps(pad));
  if (!caps) return false;
  const bool raw = gst_structure_has_name(gst_caps_get_structure(caps.get(), 0), "video/x-raw");
  const bool readable = gst_caps_features_is_equal(gst_caps_get_features(caps.get(), 0),
                                                   GST_CAPS_FEATURES_MEMORY_SYSTEM_MEMORY);
  if (raw && !readable) {
    gchar* text = gst_caps_features_to_string(gst_caps_get_features(caps.get(), 0));
    g_printerr(
        "spidar-feel: the video is not felt, because its frames are not in system memory but in "
        "%s; let the player ask the decoder for video/x-raw\n",
        text);
    g_free(text);
  }
  return raw && readable;
}

/// The filter of a pad, with a reference to it.
GQuark filter_of_pad() {
  return g_quark_from_static_string("spidar-feel-filter");
}

gpointer with_reference(gpointer object, gpointer) {
  return object ? gst_object_ref(object) : nullptr;
}

/// The filter that `pad` has, or none.
Ref<GstElement> get_filter(GstPad* pad) {
  return Ref<GstElement>(static_cast<GstElement*>(
      g_object_dup_qdata(G_OBJECT(pad), filter_of_pad(), with_reference, nullptr)));
}

/// A ghost pad of a decoder and the filter that goes before it.
struct Place {
  Ref<GstGhostPad> pad;
  Ref<GstElement> filter;     ///< null: not made yet
  GstPadProbeCallback found;  ///< what the next frame calls
};

void place_free(gpointer data) {
  delete static_cast<Place*>(data);
}

/// Adds a probe of the target of `pad`, whose data is a Place.
void add_probe(GstGhostPad* pad, GstElement* filter, int type, GstPadProbeCallback callback,
               GstPadProbeCallback found) {
  const Ref<GstPad> target(gst_ghost_pad_get_target(pad));
  if (!target) return;
  gst_pad_add_probe(target.get(), static_cast<GstPadProbeType>(type), callback,
                    new Place{new_ref(pad), new_ref(filter), found}, place_free);
}

/// Calls `found` when the next buffer is about to leave the target of `pad`, and none is between
/// them.
void at_next_frame(GstGhostPad* pad, GstElement* filter, GstPadProbeCallback found) {
  add_probe(pad, filter,
            GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST,
            found, found);
}

GstPadProbeReturn begin_to_wait(GstPad*, GstPadProbeInfo* info, gpointer data) {
  const bool is_query = (info->type & GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM) != 0;
  if (is_query && GST_QUERY_TYPE(GST_PAD_PROBE_INFO_QUERY(info)) != GST_QUERY_ALLOCATION)
    return GST_PAD_PROBE_OK;
  const Place* place = static_cast<Place*>(data);
  at_next_frame(place->pad.get(), place->filter.get(), place->found);
  return GST_PAD_PROBE_REMOVE;
}

/// As at_next_frame(), for a pad that its decoder may still block. decodebin blocks a pad until it
/// has added it to itself, and a decoder that has a frame then waits in its allocation query.
/// GStreamer wakes it when the last blocking probe is removed. A blocking probe that waits for the
/// frame would keep it waiting for good, so that probe is added when the query has passed.
void at_next_frame_of_new_pad(GstGhostPad* pad, GstElement* filter, GstPadProbeCallback found) {
  add_probe(pad, filter,
            GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST |
                GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM,
            begin_to_wait, found);
}

/// Links `target` to `in`, which is that of the filter. False when its video does not fit.
bool link_filter(GstPad* target, GstPad* in, GstElement* filter) {
  const Ref<GstCaps> caps(gst_pad_get_current_caps(target));
  if (!caps) return false;
  // The decoder need not allocate its frames in another way.
  const bool quietly = gst_spidar_feel_bin_passes(GST_SPIDAR_FEEL_BIN(filter), caps.get());
  const bool linked =
      gst_pad_link_full(target, in, quietly ? kLinkQuietly : GST_PAD_LINK_CHECK_DEFAULT) ==
      GST_PAD_LINK_OK;
  const Ref<GstCaps> accepted(gst_pad_query_caps(in, caps.get()));
  return linked && !gst_caps_is_empty(accepted.get());
}

/// Puts the filter between `target` and `pad`, whose target it is. Leaves them as they were and
/// returns false when their video does not fit through the filter.
bool insert(GstGhostPad* pad, GstPad* target, GstElement* filter) {
  const Ref<GstPad> in(gst_element_get_static_pad(filter, "sink"));
  const Ref<GstPad> out(gst_element_get_static_pad(filter, "src"));
  const bool inserted =
      gst_ghost_pad_set_target(pad, out.get()) && link_filter(target, in.get(), filter);
  if (!inserted) {
    gst_pad_unlink(target, in.get());
    gst_ghost_pad_set_target(pad, target);
  }
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
  const Ref<GstObject> decoder(gst_object_get_parent(GST_OBJECT(filter)));
  if (decoder) gst_bin_remove(GST_BIN(decoder.get()), filter);
}

/// Removes the filter of `pad`, if it has one.
void forget(GstPad* pad) {
  const Ref<GstElement> filter(
      static_cast<GstElement*>(g_object_steal_qdata(G_OBJECT(pad), filter_of_pad())));
  if (filter) remove_filter(filter.get());
}

GstPadProbeReturn put_in(GstPad* target, GstPadProbeInfo*, gpointer data) {
  const Place* place = static_cast<Place*>(data);
  // Meanwhile, the pad may have been removed, or the decoder may have given it another target.
  const Ref<GstElement> filter = get_filter(GST_PAD(place->pad.get()));
  const Ref<GstPad> now(gst_ghost_pad_get_target(place->pad.get()));
  if (filter == place->filter && now.get() == target &&
      (was_undone(filter.get(), target) || !insert(place->pad.get(), target, filter.get()))) {
    g_printerr("spidar-feel: the video does not fit through the filter and is not felt\n");
    forget(GST_PAD(place->pad.get()));
  }
  return GST_PAD_PROBE_REMOVE;
}

/// Adds a filter for `pad` to `decoder`, opens the device, and lets the next frame put the filter
/// in. Without a device nothing is added.
void add_filter(GstElement* decoder, GstPad* pad) {
  const Ref<GstElement> filter = sunk(gst_spidar_feel_bin_new(g_getenv(SPIDAR_FEEL_VARIABLE)));
  if (!filter) return;
  Ref<GstElement> of_pad = new_ref(filter.get());
  if (!g_object_replace_qdata(G_OBJECT(pad), filter_of_pad(), nullptr, of_pad.get(),
                              gst_object_unref, nullptr))
    return;
  of_pad.release();
  gst_bin_add(GST_BIN(decoder), filter.get());
  follow_state(decoder, filter.get());
  if (gst_spidar_feel_bin_is_felt(GST_SPIDAR_FEEL_BIN(filter.get())))
    at_next_frame(GST_GHOST_PAD(pad), filter.get(), put_in);
  else
    forget(pad);
}

bool is_shown(GstPad* pad) {
  return !find_path_downstream(pad, is_screen).empty();
}

void feel_pad(GstElement* decoder, GstPad* pad) {
  if (!GST_IS_GHOST_PAD(pad)) return;
  if (get_filter(pad) || !is_shown(pad)) return;
  if (has_raw_video(pad)) add_filter(decoder, pad);
}

/// The pad of a decoder that was linked while the decoder plays.
GstPadProbeReturn feel_late(GstPad*, GstPadProbeInfo*, gpointer data) {
  GstPad* pad = GST_PAD(static_cast<Place*>(data)->pad.get());
  const Ref<GstElement> decoder(gst_pad_get_parent_element(pad));
  if (decoder) feel_pad(decoder.get(), pad);
  return GST_PAD_PROBE_REMOVE;
}

/// `source` was linked by the application, or has a new target.
void feel_linked(GstObject* source, bool new_target) {
  if (!GST_IS_GHOST_PAD(source) || !GST_PAD_IS_SRC(source)) return;
  GstPad* pad = GST_PAD(source);
  const Ref<GstElement> decoder(gst_pad_get_parent_element(pad));
  if (!decoder || !is_outermost_decoder(decoder.get()) ||
      state_of(decoder.get()) != GST_STATE_PLAYING)
    return;
  const Ref<GstElement> filter = get_filter(pad);
  if (!filter)
    at_next_frame_of_new_pad(GST_GHOST_PAD(pad), nullptr, feel_late);
  else if (new_target)
    at_next_frame_of_new_pad(GST_GHOST_PAD(pad), filter.get(), put_in);
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
  const Ref<GstObject> inserted(gst_object_get_parent(GST_OBJECT(source)));
  const Ref<GstObject> outer(gst_object_get_parent(GST_OBJECT(sink)));
  if (outer && !(inserted && GST_IS_SPIDAR_FEEL_BIN(inserted.get())))
    feel_linked(outer.get(), true);
}

void free_unlinked_target(GstPad* source) {
  const Ref<GstObject> filter(gst_object_get_parent(GST_OBJECT(source)));
  if (!filter || !GST_IS_SPIDAR_FEEL_BIN(filter.get())) return;
  const Ref<GstPad> in(gst_element_get_static_pad(GST_ELEMENT(filter.get()), "sink"));
  const Ref<GstPad> target(gst_pad_get_peer(in.get()));
  if (target) gst_pad_unlink(target.get(), in.get());
}

void forget_removed_pad(GstElement* element, GstPad* pad) {
  if (is_decoder(element)) forget(pad);
}

}  // namespace spidar
