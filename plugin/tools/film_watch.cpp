// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_watch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "plugin/films/file_end.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"

namespace spidar::tools {
namespace {

constexpr auto kFlow =
    static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);

/// Returns "H.265 (Main Profile) decoder", if the message says that this decoder is missing.
std::string missing_decoder(const GstStructure* message) {
  const GstCaps* caps = nullptr;
  const GValue* const detail = gst_structure_get_value(message, "detail");
  if (detail && GST_VALUE_HOLDS_CAPS(detail)) caps = gst_value_get_caps(detail);
  const char* const name = gst_structure_get_string(message, "name");
  return caps && name && content_of(caps) == StreamContent::kVideo ? name : "";
}

}  // namespace

void FilmWatch::begin(GstElement* pipeline, const std::string& film) {
  has_appended_ = film_end(film) == FilmEnd::kAppended;
  const Ref<GstBus> bus(gst_element_get_bus(pipeline));
  gst_bus_set_sync_handler(bus.get(), handle, this, nullptr);
  const Ref<GstElement> decoder(gst_bin_get_by_name(GST_BIN(pipeline), "decode"));
  videos_.watch(decoder.get());
  g_signal_connect(decoder.get(), "no-more-pads", G_CALLBACK(choose), this);
  convert_ = gst_bin_get_by_name(GST_BIN(pipeline), "convert");
  gst_object_unref(convert_);  // the pipeline owns it
}

GstBusSyncReply FilmWatch::handle(GstBus*, GstMessage* message, gpointer user) {
  auto& self = *static_cast<FilmWatch*>(user);
  const std::lock_guard<std::mutex> lock(self.lock_);
  const GstStructure* const about = gst_message_get_structure(message);
  if (about && gst_structure_has_name(about, "spidar-motion")) {
    const char* const nick = gst_structure_get_string(about, "no-force-reason");
    if (const auto reason = no_force_reason(nick ? nick : "")) {
      ++self.frames_by_reason_[static_cast<size_t>(*reason)];
    }
    gst_message_unref(message);
    return GST_BUS_DROP;
  }
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) self.failed_ = true;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING && !self.failed_) {
    g_autoptr(GError) warning = nullptr;
    gst_message_parse_warning(message, &warning, nullptr);
    // Players play films of which spidarmotion warns: two frames of the same time, for example.
    const bool is_remark =
        g_strcmp0(G_OBJECT_TYPE_NAME(GST_MESSAGE_SRC(message)), "GstSpidarMotion") == 0;
    std::string& kept = is_remark ? self.remark_ : self.warning_;
    const bool is_appended =
        self.has_appended_ && g_error_matches(warning, GST_STREAM_ERROR, GST_STREAM_ERROR_DEMUX);
    // spidarextract warns that it gets no data of frames that spidarmotion has not measured.
    if (!is_remark && g_error_matches(warning, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_SETTINGS)) {
      self.unmeasured_ = true;
    } else if (kept.empty() && !is_appended) {
      kept = warning->message;
    }
  } else if (about && gst_structure_has_name(about, "missing-plugin") && self.missing_.empty()) {
    self.missing_ = missing_decoder(about);
  }
  return GST_BUS_PASS;
}

GstPadProbeReturn FilmWatch::decoded(GstPad*, GstPadProbeInfo* info, gpointer user) {
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    // matroskademux sends gaps while the sound continues after the pictures; they overtake the last
    // frames, which are still in the decoder.
    const bool is_gap = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_GAP;
    return is_gap ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
  }
  auto& self = *static_cast<FilmWatch*>(user);
  const std::lock_guard<std::mutex> lock(self.lock_);
  ++self.frames_;
  return GST_PAD_PROBE_OK;
}

/// Called at no-more-pads: all streams are known.
void FilmWatch::choose(GstElement* decoder, gpointer user) {
  auto& self = *static_cast<FilmWatch*>(user);
  const Ref<GstPad> into(gst_element_get_static_pad(self.convert_, "sink"));
  if (gst_pad_is_linked(into.get())) return;
  GstPad* const chosen = self.videos_.choose(decoder);
  if (chosen) gst_pad_add_probe(chosen, kFlow, decoded, user, nullptr);
  if (chosen && gst_pad_link(chosen, into.get()) == GST_PAD_LINK_OK) return;
  {
    const std::string why = why_missing(decoder);
    const std::lock_guard<std::mutex> lock(self.lock_);
    self.has_video_ = false;
    self.why_no_video_ = why;
  }
  GST_ELEMENT_ERROR(decoder, STREAM, WRONG_TYPE, ("There is no video in it."), (nullptr));
}

void FilmWatch::play(const FilePipeline& file) const {
  std::string error;
  try {
    file.play_until(GST_MESSAGE_EOS);
  } catch (const std::runtime_error& ended) {
    error = ended.what();
  }
  file.stop();
  const std::string what = why_ended(error);
  if (!what.empty()) throw std::runtime_error(what);
}

std::string FilmWatch::why_ended(const std::string& error) const {
  const std::lock_guard<std::mutex> lock(lock_);
  if (!has_video_) {
    return missing_.empty() ? "there is no video in it" + why_no_video_
                            : "its video cannot be decoded: install a " + missing_;
  }
  // An element's warning explains the error that follows: "Internal data stream error".
  if (!warning_.empty()) return warning_;
  if (unmeasured_) {
    const bool is_time = remark_.find("timestamp") != std::string::npos;
    return "its frames are not measured: " + remark_ +
           (is_time ? " In a copy made by ffmpeg -i FILM FILM.mkv they have times." : "");
  }
  if (error.rfind("Internal data stream error", 0) == 0) {
    return "it cannot be read to its end: it is damaged or cut off";
  }
  if (!error.empty()) return error;
  if (frames_ == 0) return "no picture of it can be decoded: it is damaged or cut off";
  return frames_ < 2 ? "it is a single picture, in which nothing moves" : "";
}

std::string FilmWatch::felt() const {
  const std::lock_guard<std::mutex> lock(lock_);
  const int frames = std::accumulate(frames_by_reason_.begin(), frames_by_reason_.end(), 0);
  if (frames == 0) return {};
  const auto felt = frames_by_reason_.begin();  // kNone
  const auto most = std::max_element(felt + 1, frames_by_reason_.end());
  const auto reason = static_cast<NoForceReason>(most - felt);
  const auto percent = [frames](int count) {
    return std::to_string(std::lround(100.0 * count / frames)) + " %";
  };
  std::string text = percent(*felt) + " of its frames are felt";
  if (*most > 0) text += "; " + percent(*most) + ": " + sentence(reason);
  if (text.back() == '.') text.pop_back();  // more may follow
  return text;
}

void set_properties(GstElement* motion, const RecordProperties& properties) {
  for (const auto& [name, value] : properties.values) {
    gst_util_set_object_arg(G_OBJECT(motion), name.c_str(), value.c_str());
  }
}

FilmProgress::FilmProgress(std::function<void(int percent)> report) : report_(std::move(report)) {}

void FilmProgress::watch(GstElement* motion) {
  const Ref<GstPad> frames(gst_element_get_static_pad(motion, "src"));
  gst_pad_add_probe(frames.get(), GST_PAD_PROBE_TYPE_BUFFER, on_frame, this, nullptr);
}

GstPadProbeReturn FilmProgress::on_frame(GstPad* frames, GstPadProbeInfo* info, gpointer user) {
  auto& self = *static_cast<FilmProgress*>(user);
  if (self.film_ns_ == 0) gst_pad_query_duration(frames, GST_FORMAT_TIME, &self.film_ns_);
  if (self.film_ns_ <= 0) {
    self.film_ns_ = -1;  // the container does not state the duration
    return GST_PAD_PROBE_REMOVE;
  }
  const GstClockTime at = stream_time_of(frames, GST_PAD_PROBE_INFO_BUFFER(info));
  if (!GST_CLOCK_TIME_IS_VALID(at)) return GST_PAD_PROBE_OK;
  const int percent = static_cast<int>(100 * at / static_cast<GstClockTime>(self.film_ns_));
  if (percent > self.reported_ && percent < 100) {
    self.reported_ = percent;
    self.report_(self.reported_);
  }
  return GST_PAD_PROBE_OK;
}

}  // namespace spidar::tools
