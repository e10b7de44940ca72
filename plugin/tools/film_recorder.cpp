// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_recorder.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <sys/stat.h>
#include <utility>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"
#include "plugin/tools/film_progress.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tracks/file_end.h"
#include "plugin/tracks/file_pipeline.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/track_file.h"

namespace spidar {
namespace {

/// Which file it is, and how it was left.
bool is_same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
}

GstPadProbeReturn move_segment(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEGMENT) return GST_PAD_PROBE_OK;
  GstSegment segment;
  gst_event_copy_segment(event, &segment);
  if (segment.format != GST_FORMAT_TIME || segment.time <= segment.base) return GST_PAD_PROBE_OK;
  // As much as possible by an earlier beginning, so that the track begins with the film.
  const GstClockTime earlier = std::min(segment.start, segment.time - segment.base);
  segment.start -= earlier;
  segment.time -= earlier;
  segment.base = segment.time;
  GstEvent* const moved = gst_event_new_segment(&segment);
  gst_event_set_seqnum(moved, gst_event_get_seqnum(event));
  gst_event_unref(event);
  GST_PAD_PROBE_INFO_DATA(info) = moved;
  return GST_PAD_PROBE_OK;
}

/// Moves the segments that pass `pad` so that running time is stream time, which the track is found
/// by when it is replayed. They differ where a film does not begin at 0: MPEG-TS, MPEG-PS, FLV.
void follow_stream_time(GstPad* pad) {
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, move_segment, nullptr, nullptr);
}

void tag(GstElement* extract, const TrackNotes& notes) {
  const Ref<GstPad> frames(gst_element_get_static_pad(extract, "sink"));
  const Ref<GstPad> wrench(gst_element_get_static_pad(extract, "wrench"));
  follow_stream_time(frames.get());
  tag_track(wrench.get(), notes);
}

}  // namespace

FilmOutcome record_film(const std::string& film, const PartFile& track,
                        const RecordProperties& properties,
                        const std::function<void(int percent)>& tell) {
  struct stat at_first {
  }, at_last{};
  stat(film.c_str(), &at_first);
  FilmProgress progress(tell);
  FilmFingerprint fingerprint;
  std::string unread;
  try {
    fingerprint = fingerprint_of(read_film(film).packets);
  } catch (const std::runtime_error& why) {
    unread = why.what();  // decoding it may reveal more
  }
  FilmWatch watch;
  StoredSound stored;
  const FilePipeline file(
      "filesrc name=source ! decodebin name=decode videoconvert name=convert ! "
      "spidarmotion name=motion device=none attach-meta=true ! "
      "spidarextract name=extract extract.wrench ! " +
          encoder_of(track.target()) +
          " ! fdsink sync=false fd=" + std::to_string(track.descriptor()),
      film, nullptr, unread.empty() ? kSlowShare : FilePipeline::kLongestSilence);
  set_properties(file.find("motion"), properties);
  watch.begin(file.pipeline(), film_end(film) == FilmEnd::kAppended);
  progress.watch(file.find("motion"));
  stored.watch(file.find("stored"));
  tag(file.find("extract"), {fingerprint, properties.settings});
  std::string error;
  try {
    file.play_until(GST_MESSAGE_EOS);
  } catch (const std::runtime_error& ended) {
    // decodebin may lose the error of a demuxer, and then waits for ever.
    error = unread.empty() ? ended.what() : unread;
  }
  file.stop();
  if (stat(film.c_str(), &at_last) != 0) {
    throw std::runtime_error("it was removed while it was read, or its share has gone");
  }
  if (!is_same_file(at_first, at_last)) {
    throw std::runtime_error("it was changed while it was read: wait until it is complete");
  }
  const std::string why = watch.why_ended(error);
  if (!why.empty()) throw std::runtime_error(why);
  if (film_end(film) == FilmEnd::kCutOff) throw std::runtime_error(kEndMissing);
  stored.check(track);
  return {watch.felt(), watch.remark()};
}

}  // namespace spidar
