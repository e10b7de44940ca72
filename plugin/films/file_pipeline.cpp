// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/file_pipeline.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/track/track_format.h"
#include "plugin/gobject/ref.h"
#include "plugin/timing/frame_pacer.h"

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

/// Of an error; `missing` is the plug-in that GStreamer does not name in it.
std::string text_of(GstMessage* message, const std::string& missing = "") {
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  std::string text = error->message;
  const bool is_missing =
      g_error_matches(error, GST_CORE_ERROR, GST_CORE_ERROR_MISSING_PLUGIN) ||
      g_error_matches(error, GST_STREAM_ERROR, GST_STREAM_ERROR_CODEC_NOT_FOUND);
  if (is_missing && !missing.empty()) text = "a plug-in of GStreamer is missing: " + missing;
  if (g_error_matches(error, GST_STREAM_ERROR, GST_STREAM_ERROR_TYPE_NOT_FOUND)) {
    text = "it is damaged, or of a format that GStreamer does not know";
  }
  g_error_free(error);
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
  GError* error = nullptr;
  pipeline_.reset(gst_parse_launch(line.c_str(), &error));
  if (error) {
    const std::string reason = error->message;
    g_error_free(error);
    throw std::runtime_error(reason);
  }
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

void FilePipeline::link_streams(Take take) {
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
  const Bus messages = bus();
  gst_bus_set_flushing(messages.get(), TRUE);
  gst_bus_set_flushing(messages.get(), FALSE);
}

void FilePipeline::hear_errors(std::function<void(const std::string&)> take) {
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
  const Bus messages = bus();
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

std::string seconds_text(int64_t ns) {
  gchar* const text = g_strdup_printf("%.3f s", 1e-9 * static_cast<double>(ns));
  std::string result = text;
  g_free(text);
  return result;
}

namespace {

bool has_line(const std::string& text, const std::string& wanted) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line == wanted) return true;
  }
  return false;
}

}  // namespace

const char* const kTrackMark = "HAPTIC_FULL_SCALE=10 N, 1 N m";

bool is_marked_track(const GstTagList* tags) {
  if (gst_tag_list_get_scope(tags) != GST_TAG_SCOPE_STREAM) return false;
  for (const char* tag : {GST_TAG_COMMENT, GST_TAG_EXTENDED_COMMENT}) {
    const guint count = gst_tag_list_get_tag_size(tags, tag);
    for (guint i = 0; i < count; ++i) {
      const gchar* text = nullptr;
      if (gst_tag_list_peek_string_index(tags, tag, i, &text) && has_line(text, kTrackMark)) {
        return true;
      }
    }
  }
  return false;
}

void TrackMark::follow(GstEvent* event) {
  GstTagList* tags = nullptr;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
      if (std::exchange(has_caps_, false)) is_set_ = false;
      break;
    case GST_EVENT_CAPS:
      has_caps_ = true;
      break;
    case GST_EVENT_TAG:
      gst_event_parse_tag(event, &tags);
      is_set_ = is_set_ || is_marked_track(tags);
      break;
    default:
      break;
  }
}

bool is_marked_track(GstPad* pad) {
  TrackMark mark;
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    mark.follow(event);
    gst_event_unref(event);
  }
  return mark.is_set();
}

bool has_form_of_track(const GstCaps* caps) {
  int channels = 0, rate_Hz = 0;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  gst_structure_get_int(structure, "channels", &channels);
  gst_structure_get_int(structure, "rate", &rate_Hz);
  return channels == static_cast<int>(kTrackChannels) && rate_Hz == kTrackRate_Hz;
}

std::string how_to_mark() {
  return std::string("ffmpeg -i FILE -metadata comment=\"") + kTrackMark +
         "\" -c:a pcm_f32le MARKED.wav";
}

StreamContent content_of(const GstCaps* caps) {
  if (!caps || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return StreamContent::kOther;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  const std::string name = gst_structure_get_name(structure);
  if (name.rfind("video/", 0) == 0 || name.rfind("image/", 0) == 0) return StreamContent::kVideo;
  if (name.rfind("audio/", 0) != 0) return StreamContent::kOther;
  return has_form_of_track(caps) ? StreamContent::kHapticTrack : StreamContent::kSound;
}

StreamContent content_of(GstPad* pad) {
  const Ref<GstCaps> caps(caps_of(pad));
  const StreamContent content = content_of(caps.get());
  return content == StreamContent::kSound && is_marked_track(pad) ? StreamContent::kHapticTrack
                                                                  : content;
}

bool is_picture(const GstCaps* caps) {
  if (!caps || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return false;
  return g_str_has_prefix(gst_structure_get_name(gst_caps_get_structure(caps, 0)), "image/");
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

GstClockTime stream_time_of(GstPad* pad, GstBuffer* buffer) {
  GstEvent* const event = gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0);
  if (!event) return GST_CLOCK_TIME_NONE;
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event, &segment);
  const GstClockTime time = stream_time_of(*segment, GST_BUFFER_PTS(buffer));
  gst_event_unref(event);
  return time;
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
