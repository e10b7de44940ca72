// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_recorder.h"

#include <gst/gst.h>

#include "plugin/tools/film_decoder.h"
#include "plugin/tools/stored_sound.h"
#include "plugin/tools/stream_time.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tracks/track_notes.h"

namespace spidar {

namespace {

void tag(GstElement* pipeline, const TrackNotes& notes) {
  GstElement* extract = gst_bin_get_by_name(GST_BIN(pipeline), "extract");
  GstPad* frames = gst_element_get_static_pad(extract, "sink");
  GstPad* wrench = gst_element_get_static_pad(extract, "wrench");
  follow_stream_time(frames);
  tag_track(wrench, notes);
  gst_object_unref(wrench);
  gst_object_unref(frames);
  gst_object_unref(extract);
}

}  // namespace

FilmOutcome record_film(const std::string& film, const PartFile& track,
                        const RecordProperties& properties,
                        const std::function<void(int percent)>& tell) {
  StoredSound stored;
  const FilmOutcome outcome =
      decode_film({film, properties,
                   "spidarextract name=extract extract.wrench ! " + encoder_of(track.target()) +
                       " ! fdsink sync=false fd=" + std::to_string(track.descriptor()),
                   [&](GstElement* pipeline, const FilmFingerprint& fingerprint) {
                     stored.watch(pipeline, "stored");
                     tag(pipeline, {fingerprint, properties.settings});
                   },
                   tell});
  stored.check(track);
  return outcome;
}

}  // namespace spidar
