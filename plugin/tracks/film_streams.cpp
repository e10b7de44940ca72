// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/film_streams.h"

#include "core/track/track_format.h"
#include "plugin/tracks/track_input.h"

namespace spidar {

StreamKind kind_of(const GstCaps* caps) {
  if (!caps || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return StreamKind::kOther;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  const std::string name = gst_structure_get_name(structure);
  if (name.rfind("video/", 0) == 0 || name.rfind("image/", 0) == 0) return StreamKind::kVideo;
  if (name.rfind("audio/", 0) != 0) return StreamKind::kOther;
  int channels = 0, rate_Hz = 0;
  gst_structure_get_int(structure, "channels", &channels);
  gst_structure_get_int(structure, "rate", &rate_Hz);
  const bool haptic = channels == static_cast<int>(kTrackChannels) && rate_Hz > 0 &&
                      rate_Hz <= TrackInput::kHighestRate_Hz;
  return haptic ? StreamKind::kHapticTrack : StreamKind::kSound;
}

std::string why_missing(GstElement* bin) {
  bool is_mp4 = false;
  GstIterator* elements = gst_bin_iterate_recurse(GST_BIN(bin));
  GValue item = G_VALUE_INIT;
  while (gst_iterator_next(elements, &item) == GST_ITERATOR_OK) {
    GstElementFactory* const factory =
        gst_element_get_factory(GST_ELEMENT(g_value_get_object(&item)));
    is_mp4 = is_mp4 || (factory && g_strcmp0(GST_OBJECT_NAME(factory), "qtdemux") == 0);
    g_value_reset(&item);
  }
  g_value_unset(&item);
  gst_iterator_free(elements);
  if (!is_mp4) return {};
  return " (GStreamer leaves out what is shorter than a fifth of an MP4 or MOV film; in a copy "
         "made "
         "by ffmpeg -i FILM -c copy FILM.mkv it is there)";
}

GstCaps* caps_of(GstPad* pad) {
  GstCaps* caps = gst_pad_get_current_caps(pad);
  // Caps reach the pad of a parsebin with the first data, but its parser has them earlier.
  GstPad* target =
      !caps && GST_IS_GHOST_PAD(pad) ? gst_ghost_pad_get_target(GST_GHOST_PAD(pad)) : nullptr;
  if (target) {
    caps = gst_pad_get_current_caps(target);
    gst_object_unref(target);
  }
  return caps ? caps : gst_pad_query_caps(pad, nullptr);
}

}  // namespace spidar
