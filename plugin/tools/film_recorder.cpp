// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_recorder.h"

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include <gst/gst.h>

#include "plugin/tools/film_end.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/stream_time.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/film_reader.h"
#include "plugin/track/track_notes.h"

namespace spidar {
namespace {

/// A film that could not be read is hardly worth waiting for: decodebin may lose the error.
constexpr GstClockTime kUnreadStart = 10 * GST_SECOND;

/// Reports `percent` of the film as recorded, in steps of ten.
class Progress {
 public:
  explicit Progress(std::function<void(int percent)> tell) : tell_(std::move(tell)) {}

  /// Counts the buffers that come out of `extract` in `pipeline`, and gives it stream time.
  void watch(GstElement* pipeline) {
    GstElement* extract = gst_bin_get_by_name(GST_BIN(pipeline), "extract");
    sink_ = gst_element_get_static_pad(extract, "sink");
    GstPad* wrench = gst_element_get_static_pad(extract, "wrench");
    gst_pad_add_probe(wrench, GST_PAD_PROBE_TYPE_BUFFER, passes, this, nullptr);
    follow_stream_time(sink_);
    gst_object_unref(wrench);
    gst_object_unref(sink_);  // the pipeline has it
    gst_object_unref(extract);
  }

 private:
  static GstPadProbeReturn passes(GstPad*, GstPadProbeInfo* info, gpointer user) {
    auto& self = *static_cast<Progress*>(user);
    if (self.film_ns_ == 0)
      gst_pad_peer_query_duration(self.sink_, GST_FORMAT_TIME, &self.film_ns_);
    if (self.film_ns_ <= 0) {
      self.film_ns_ = -1;  // the container does not tell
      return GST_PAD_PROBE_REMOVE;
    }
    const GstClockTime at = GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info));
    const int percent = static_cast<int>(100 * at / static_cast<GstClockTime>(self.film_ns_));
    if (percent >= self.told_ + 10 && percent < 100) {
      self.told_ = percent / 10 * 10;
      self.tell_(self.told_);
    }
    return GST_PAD_PROBE_OK;
  }

  const std::function<void(int percent)> tell_;
  GstPad* sink_ = nullptr;
  gint64 film_ns_ = 0;
  int told_ = 0;
};

void set_properties(GstElement* pipeline, const RecordProperties& properties) {
  GstElement* motion = gst_bin_get_by_name(GST_BIN(pipeline), "motion");
  for (const auto& [name, value] : properties.values)
    gst_util_set_object_arg(G_OBJECT(motion), name.c_str(), value.c_str());
  gst_object_unref(motion);
}

void tag_samples(GstElement* pipeline, const TrackNotes& notes) {
  GstElement* extract = gst_bin_get_by_name(GST_BIN(pipeline), "extract");
  GstPad* wrench = gst_element_get_static_pad(extract, "wrench");
  tag_track(wrench, notes);
  gst_object_unref(wrench);
  gst_object_unref(extract);
}

}  // namespace

std::string record_film(const std::string& film, const std::string& track,
                        const RecordProperties& properties,
                        const std::function<void(int percent)>& tell) {
  if (!std::filesystem::exists(film)) throw std::runtime_error("there is no such file");
  Progress progress(tell);
  TrackNotes notes;
  notes.settings = properties.settings;
  int64_t pictures_end_ns = 0;
  std::string unread;
  try {
    const Film read = read_film(film);
    pictures_end_ns = read.end_ns.value_or(0);
    notes.film = fingerprint_of(read.packets);
  } catch (const std::runtime_error& why) {
    unread = why.what();  // recording it may tell more
  }
  FilmWatch watch;
  std::string error;
  try {
    run_pipeline(
        "filesrc name=film ! decodebin name=decode videoconvert name=convert ! "
        "spidarmotion name=motion device=none post-messages=false attach-meta=true ! "
        "spidarextract name=extract extract.wrench ! " +
            encoder_of(track) + " ! filesink name=track",
        [&](GstElement* pipeline) {
          set_location(pipeline, "film", film);
          set_location(pipeline, "track", track);
          set_properties(pipeline, properties);
          watch.begin(pipeline);
          progress.watch(pipeline);
          tag_samples(pipeline, notes);
        },
        unread.empty() ? kLongestStart : kUnreadStart);
  } catch (const SilentFailure& ended) {
    error = unread.empty() ? ended.what() : unread;
  } catch (const std::runtime_error& ended) {
    error = ended.what();
  }
  const FilmEnd end = film_end(film);
  // Where the file is whole, its duration may be that of sound that goes on after the pictures.
  std::optional<int64_t> end_ns;
  if (end == FilmEnd::kWhole) end_ns = pictures_end_ns;
  const std::string problem = watch.problem(error, end_ns);
  if (!problem.empty()) throw std::runtime_error(problem);
  if (end == FilmEnd::kCutOff) {
    throw std::runtime_error("its end is missing: it is damaged or cut off");
  }
  return watch.remark();
}

}  // namespace spidar
