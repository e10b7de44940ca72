// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_recorder.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include <gst/gst.h>

#include "plugin/tools/track_samples.h"

namespace spidar {
namespace {

/// Reports `percent` of the film as recorded, in steps of ten.
class Progress {
 public:
  explicit Progress(std::function<void(int percent)> tell) : tell_(std::move(tell)) {}

  /// Counts the buffers that come out of `extract` in `pipeline`.
  void watch(GstElement* pipeline) {
    GstElement* extract = gst_bin_get_by_name(GST_BIN(pipeline), "extract");
    sink_ = gst_element_get_static_pad(extract, "sink");
    GstPad* wrench = gst_element_get_static_pad(extract, "wrench");
    gst_pad_add_probe(wrench, GST_PAD_PROBE_TYPE_BUFFER, passes, this, nullptr);
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

}  // namespace

void record_film(const std::string& film, const std::string& track, const std::string& properties,
                 const std::function<void(int percent)>& tell) {
  if (!std::filesystem::exists(film)) throw std::runtime_error("there is no such file");
  Progress progress(tell);
  run_pipeline("filesrc location=" + quoted(film) +
                   " ! decodebin ! video/x-raw ! videoconvert ! spidarmotion device=none "
                   "post-messages=false attach-meta=true" +
                   properties + " ! spidarextract name=extract extract.wrench ! " +
                   encoder_of(track) + " ! filesink location=" + quoted(track),
               [&progress](GstElement* pipeline) { progress.watch(pipeline); });
}

}  // namespace spidar
