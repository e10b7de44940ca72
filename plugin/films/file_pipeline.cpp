// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/file_pipeline.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "plugin/gobject/ref.h"
#include "spidar/whole_file.h"

namespace spidar {
namespace {

void stop_and_unref(GstElement* pipeline) {
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

/// Adds what a demuxer or decoder has reported as missing: "H.264 (High Profile) decoder".
void note_missing(GstMessage* message, std::string& missing) {
  const GstStructure* const about = gst_message_get_structure(message);
  if (!about || !gst_structure_has_name(about, "missing-plugin")) return;
  const char* const name = gst_structure_get_string(about, "name");
  if (name) missing += (missing.empty() ? "" : ", ") + std::string(name);
}

/// The text of an error; `missing` is the plug-in that GStreamer does not name in it.
std::string text_of(GstMessage* message, const std::string& missing = "") {
  g_autoptr(GError) error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  std::string text = error->message;
  const bool is_missing =
      g_error_matches(error, GST_CORE_ERROR, GST_CORE_ERROR_MISSING_PLUGIN) ||
      g_error_matches(error, GST_STREAM_ERROR, GST_STREAM_ERROR_CODEC_NOT_FOUND);
  if (is_missing && !missing.empty()) text = "a plug-in of GStreamer is missing: " + missing;
  if (g_error_matches(error, GST_STREAM_ERROR, GST_STREAM_ERROR_TYPE_NOT_FOUND)) {
    text = "it is damaged, or of a format that GStreamer does not know";
  }
  return text;
}

}  // namespace

FilePipeline::FilePipeline(const std::string& line, const std::string& path,
                           const std::atomic<bool>* stopped, GstClockTime longest_silence)
    : stopped_(stopped), longest_silence_(longest_silence), pipeline_(nullptr, stop_and_unref) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) throw std::runtime_error("there is no such file");
  if (!std::filesystem::is_regular_file(status)) {
    throw std::runtime_error("it is not a regular file");
  }
  g_autoptr(GError) error = nullptr;
  pipeline_.reset(gst_parse_launch(line.c_str(), &error));
  if (error) throw std::runtime_error(error->message);
  note_read(path);
  GstElement* const source = find("source");
  g_object_set(source, "location", path.c_str(), nullptr);
  const Ref<GstPad> pad(gst_element_get_static_pad(source, "src"));
  const auto count = [](GstPad*, GstPadProbeInfo*, gpointer read) {
    ++*static_cast<std::atomic<uint64_t>*>(read);
    return GST_PAD_PROBE_OK;
  };
  gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_BUFFER, count, &read_, nullptr);
}

GstElement* FilePipeline::find(const char* name) const {
  GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline_.get()), name);
  gst_object_unref(element);
  return element;
}

GstElement* FilePipeline::add_fakesink() const {
  GstElement* sink = gst_element_factory_make("fakesink", nullptr);
  g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
  gst_bin_add(GST_BIN(pipeline_.get()), sink);
  gst_element_sync_state_with_parent(sink);
  return sink;
}

void FilePipeline::link_streams(std::function<GstElement*(GstPad*)> take) {
  take_ = std::move(take);
  const auto add = +[](GstElement*, GstPad* pad, gpointer self) {
    constexpr auto kFlow =
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST |
                                     GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);
    gst_pad_add_probe(pad, kFlow, link, self, nullptr);
  };
  g_signal_connect(find("parse"), "pad-added", G_CALLBACK(add), this);
}

GstPadProbeReturn FilePipeline::link(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  const auto& self = *static_cast<FilePipeline*>(user);
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    const GstEventType type = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info));
    if (type != GST_EVENT_EOS && type != GST_EVENT_GAP) return GST_PAD_PROBE_OK;
  }
  if (gst_pad_is_linked(pad)) return GST_PAD_PROBE_OK;
  GstElement* const taker = self.take_(pad);
  const Ref<GstPad> into(gst_element_get_static_pad(taker ? taker : self.add_fakesink(), "sink"));
  gst_pad_link(pad, into.get());
  return GST_PAD_PROBE_OK;
}

void FilePipeline::pause() const {
  gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
  const std::unique_ptr<GstBus, void (*)(gpointer)> messages = bus();
  gst_bus_set_flushing(messages.get(), TRUE);
  gst_bus_set_flushing(messages.get(), FALSE);
}

void FilePipeline::on_error(std::function<void(const std::string&)> take) {
  take_error_ = std::move(take);
  gst_bus_set_sync_handler(bus().get(), handle, this, nullptr);
}

GstBusSyncReply FilePipeline::handle(GstBus*, GstMessage* message, gpointer user) {
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    static_cast<FilePipeline*>(user)->take_error_(text_of(message));
  }
  return GST_BUS_PASS;
}

void FilePipeline::check(Progress& progress) const {
  progress.silent = progress.read == read_ ? progress.silent + kLook : 0;
  progress.read = read_;
  if (progress.silent >= longest_silence_) {
    throw std::runtime_error("there is nothing more to read, but no end: it may be damaged");
  }
  if (stopped_ && *stopped_) throw std::runtime_error("reading was stopped");
}

GstMessageType FilePipeline::play_until(GstMessageType awaited, GstClockTime limit) const {
  const auto types = static_cast<GstMessageType>(awaited | GST_MESSAGE_EOS | GST_MESSAGE_ERROR |
                                                 GST_MESSAGE_ELEMENT);
  std::string missing;  // plug-in
  const std::unique_ptr<GstBus, void (*)(gpointer)> messages = bus();
  bool failed =
      gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE;
  Progress progress{read_, 0};
  for (GstClockTime waited = 0; waited < limit;) {
    GstMessage* message = gst_bus_timed_pop_filtered(messages.get(), kLook, types);
    if (message) {
      const GstMessageType type = GST_MESSAGE_TYPE(message);
      const std::string reason = type == GST_MESSAGE_ERROR ? text_of(message, missing) : "";
      if (type == GST_MESSAGE_ELEMENT) note_missing(message, missing);
      gst_message_unref(message);
      if (type == GST_MESSAGE_ERROR) throw std::runtime_error(reason);
      if (type != GST_MESSAGE_ELEMENT) return type;
      continue;
    }
    if (failed) throw std::runtime_error("GStreamer cannot read it, and does not say why");
    check(progress);
    waited += kLook;
  }
  return GST_MESSAGE_UNKNOWN;
}

bool seek_before(GstElement* sink, int64_t time_ns) {
  constexpr auto kFlags = static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_KEY_UNIT |
                                                    GST_SEEK_FLAG_SNAP_BEFORE);
  return gst_element_seek_simple(sink, GST_FORMAT_TIME, kFlags, time_ns) != FALSE;
}

std::string seconds_text(int64_t ns) {
  return taken(g_strdup_printf("%.3f s", 1e-9 * static_cast<double>(ns)));
}

}  // namespace spidar
