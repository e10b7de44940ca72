// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/open_track.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <gst/gst.h>

#include "plugin/films/file_end.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/films/stream_content.h"
#include "plugin/gobject/ref.h"

namespace spidar::tracks {
namespace {

/// Which stream of a file is the track.
enum class Wanted { kHapticTrack, kFirstSound };

/// How much is read before the track counts as open.
constexpr int64_t kFirstPart_ns = 1'000'000'000;

void read_tags(GstPad* pad, Notes& notes) {
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    GstTagList* tags = nullptr;
    gst_event_parse_tag(event, &tags);
    read_notes(tags, notes);
    gst_event_unref(event);
  }
}

/// The type of a file that has no demuxer, so that its stream is the file itself: Wave64, whose
/// only decoder gives other values. Empty for all others.
std::string unparsed_type(GstPad* pad) {
  const Ref<GstPad> inner(gst_ghost_pad_get_target(GST_GHOST_PAD(pad)));
  const Ref<GstElement> source(inner ? gst_pad_get_parent_element(inner.get()) : nullptr);
  GstElementFactory* const factory = source ? gst_element_get_factory(source.get()) : nullptr;
  if (!factory || g_strcmp0(GST_OBJECT_NAME(factory), "typefind") != 0) return {};
  const Ref<GstCaps> caps(caps_of(pad));
  return gst_structure_get_name(gst_caps_get_structure(caps.get(), 0));
}

/// Explains sound that could be a track: six channels, at some rate.
std::string why_unmarked(const GstCaps* caps) {
  int rate_Hz = 0;
  gst_structure_get_int(gst_caps_get_structure(caps, 0), "rate", &rate_Hz);
  return "Nothing says that this sound of " + std::to_string(rate_Hz) +
         " Hz is a haptic track: a track has " + std::to_string(kTrackRate_Hz) +
         " samples a second, or the tag HAPTIC_FULL_SCALE. If it is one, mark it: " +
         how_to_mark() + ".";
}

class TrackOfFile : public OpenTrack {
 public:
  TrackOfFile(const std::string& path, bool only_notes, const std::atomic<bool>* stopped,
              Wanted wanted)
      : path_(path),
        only_notes_(only_notes),
        wanted_(wanted),
        file_(
            "filesrc name=source ! parsebin name=parse decodebin name=decode ! audio/x-raw ! "
            "fakesink name=out signal-handoffs=true sync=false",
            path, stopped),
        parser_(file_.find("parse")) {
    GstElement* const out = file_.find("out");
    pad_.reset(gst_element_get_static_pad(out, "sink"));
    g_signal_connect(out, "handoff", G_CALLBACK(on_buffer), this);
    gst_pad_add_probe(pad_.get(),
                      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM |
                                                   GST_PAD_PROBE_TYPE_EVENT_FLUSH),
                      follow, this, nullptr);
    file_.link_streams([this](GstPad* stream) { return select_stream(stream); });
    g_signal_connect(parser_, "pad-added", G_CALLBACK(add_stream), this);
    file_.on_error([this](const std::string& error) { blocks_->end(error); });
  }
  /// Reads the first part. Throws as open_track().
  void begin() {
    file_.play_until(GST_MESSAGE_APPLICATION);
    if (const std::string error = blocks_->error(); !error.empty()) {
      throw std::runtime_error(error);
    }
    if (is_chosen_ && !only_notes_ && first_ns_ == INT64_MAX) {
      throw std::runtime_error("there are no samples in it.");
    }
    read_tags(pad_.get(), notes_);
    bytes_ = file_bytes();
    length_ = file_length(path_);
    gint64 length_ns = 0;
    // For a film this is the duration of its longest stream.
    if (parser_->numsrcpads != 1) {
      length_ = {};
    } else if (!length_.by_samples &&
               gst_element_query_duration(file_.pipeline(), GST_FORMAT_TIME, &length_ns)) {
      length_.declared_ns = length_ns;
      if (!length_.is_cut_off) length_.available_ns = length_ns;
    }
    is_open_ = true;
  }
  ~TrackOfFile() override {
    blocks_->stop();  // wakes the streaming threads, for which file_.stop() waits
    file_.stop();
  }
  TrackOfFile(const TrackOfFile&) = delete;
  TrackOfFile& operator=(const TrackOfFile&) = delete;

  bool is_chosen() const { return is_chosen_; }
  bool has_sound() const { return has_sound_; }

  const Notes& notes() const override { return notes_; }
  std::optional<int64_t> duration_ns() const override { return length_.available_ns; }
  std::string missing(int64_t end_ns) const override {
    // Containers round durations, to milliseconds or samples.
    if (length_.declared_ns - static_cast<int64_t>(GST_MSECOND) > end_ns) {
      return "it is cut off: " + seconds_text(end_ns) + " of " + seconds_text(length_.declared_ns) +
             " are there";
    }
    return length_.is_cut_off ? "it is cut off: its end is missing" : "";
  }
  const std::shared_ptr<ReadAhead>& blocks() const override { return blocks_; }

  bool next(TrackBlock& block) override {
    FilePipeline::Progress progress;
    for (;;) {
      const ReadAhead::Found found = blocks_->pop(
          block, std::chrono::steady_clock::now() + std::chrono::nanoseconds(FilePipeline::kLook));
      if (found == ReadAhead::Found::kBlock) return true;
      const std::string error = blocks_->error();
      if (!error.empty()) throw std::runtime_error(error);
      if (found == ReadAhead::Found::kEnd) return false;
      file_.check(progress);
    }
  }

  void seek(int64_t time_ns) override {
    sought_ns_ = time_ns;
    if (seek_before(file_.find("out"), std::max<int64_t>(time_ns, 0))) return;
    blocks_->end("it can only be read from its beginning to its end");
  }

 private:
  static void stop_waiting(GstElement* element) {
    gst_element_post_message(element, gst_message_new_application(
                                          GST_OBJECT(element), gst_structure_new_empty("enough")));
  }

  /// Stops reading before the end of the file, because of `error`.
  void fail(GstElement* element, const std::string& error) {
    blocks_->end(error);
    stop_waiting(element);
  }

  bool is_wanted(StreamContent content) const {
    if (is_chosen_) return false;
    return content == StreamContent::kHapticTrack ||
           (wanted_ == Wanted::kFirstSound && content == StreamContent::kSound);
  }

  /// Decodes the first wanted stream, and ignores all others.
  GstElement* select_stream(GstPad* pad) {
    const StreamContent content = content_of(pad);
    if (content == StreamContent::kSound) has_sound_ = true;
    if (!is_wanted(content)) return nullptr;
    is_chosen_ = true;
    const std::string unparsed = unparsed_type(pad);
    if (unparsed.empty()) return file_.find("decode");
    fail(GST_PAD_PARENT(pad),
         "GStreamer cannot take " + unparsed +
             " apart, for which it has no plug-in; make WAV, FLAC or Matroska of it, with ffmpeg "
             "for example.");
    return nullptr;
  }

  /// Ends reading when all streams have ended, and none was wanted.
  static GstPadProbeReturn count_end(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
    auto& self = *static_cast<TrackOfFile*>(user);
    if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_EOS) return GST_PAD_PROBE_OK;
    GstElement* const parser = GST_PAD_PARENT(pad);
    if (++self.ended_ == parser->numsrcpads && !self.is_chosen_) stop_waiting(parser);
    return GST_PAD_PROBE_OK;
  }
  static void add_stream(GstElement*, GstPad* pad, gpointer user) {
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, count_end, user, nullptr);
  }

  static GstPadProbeReturn follow(GstPad*, GstPadProbeInfo* info, gpointer user) {
    auto& self = *static_cast<TrackOfFile*>(user);
    switch (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info))) {
      case GST_EVENT_FLUSH_STOP:
        self.input_.reset();
        self.blocks_->begin_pass();
        self.end_ns_ = self.sought_ns_;
        break;
      case GST_EVENT_EOS:
        self.blocks_->end_pass(self.why_short());
        break;
      default:
        break;
    }
    return GST_PAD_PROBE_OK;
  }

  uint64_t file_bytes() const {
    std::error_code gone;
    const uintmax_t bytes = std::filesystem::file_size(path_, gone);
    return gone ? 0 : bytes;
  }

  /// Returns why a pass has not ended where the file ended when it was opened, or an empty string.
  /// The demuxers do not report that.
  std::string why_short() const {
    if (!is_open_) return {};  // missing() reports this
    const int64_t end_ns = end_ns_ + static_cast<int64_t>(GST_MSECOND);
    const bool is_early = length_.available_ns && end_ns < *length_.available_ns;
    const bool has_shrunk = file_bytes() < bytes_;
    if (!has_shrunk && !(is_early && length_.by_samples)) return {};
    const std::string was = length_.available_ns ? seconds_text(*length_.available_ns)
                                                 : std::to_string(bytes_) + " bytes";
    return "its file was cut off while it was played: it ends at " + seconds_text(end_ns_) +
           ", and was " + was + " long";
  }

  /// Runs in the streaming thread of the pipeline that reads the file.
  static void on_buffer(GstElement*, GstBuffer* buffer, GstPad* pad, gpointer user) {
    auto& self = *static_cast<TrackOfFile*>(user);
    if (!self.blocks_->error().empty()) return;
    const Ref<GstEvent> segment(gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0));
    if (!segment) {  // otherwise wavparse goes on for ever
      return self.fail(GST_PAD_PARENT(pad), "its head is damaged: no chunk of samples is found");
    }
    const Ref<GstCaps> caps(gst_pad_get_current_caps(pad));
    if (caps.get() != self.caps_.get()) {  // caps may change in the middle of a stream
      std::string error = self.input_.set_caps(caps.get());
      if (error.empty() && self.wanted_ == Wanted::kFirstSound) error = why_unmarked(caps.get());
      self.caps_.reset(gst_caps_ref(caps.get()));
      if (!error.empty()) return self.fail(GST_PAD_PARENT(pad), error);
      if (self.only_notes_) return stop_waiting(GST_PAD_PARENT(pad));
    }
    if (self.only_notes_) return;
    self.add_buffer(buffer, pad);
  }

  void add_buffer(GstBuffer* buffer, GstPad* pad) {
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    input_.read(buffer, segment, 1, [this, pad](const TrackBlock& block) {
      if (end_of(block) > kLongest_ns) {
        fail(GST_PAD_PARENT(pad),
             "its samples reach to " + std::to_string(block.begin_ns / GST_SECOND) +
                 " s, and a track lasts at most 24 h: is a timestamp in it wrong?");
        return GST_FLOW_EOS;
      }
      if (!has_begun_ &&
          end_of(block) - std::exchange(first_ns_, std::min(first_ns_, block.begin_ns)) >=
              kFirstPart_ns) {
        has_begun_ = true;
        stop_waiting(GST_PAD_PARENT(pad));
      }
      end_ns_ = std::max(end_ns_, end_of(block));
      return blocks_->push(block, input_.faults()) ? GST_FLOW_OK : GST_FLOW_EOS;
    });
  }

  const std::string path_;
  const bool only_notes_;
  const Wanted wanted_;
  FileLength length_;
  uint64_t bytes_ = 0;
  std::atomic<bool> is_open_{false};
  std::atomic<int64_t> sought_ns_{0};
  const std::shared_ptr<ReadAhead> blocks_ = std::make_shared<ReadAhead>();
  FilePipeline file_;
  GstElement* const parser_;
  Ref<GstPad> pad_;
  Notes notes_;
  std::atomic<bool> is_chosen_{false}, has_sound_{false};
  std::atomic<int> ended_{0};  ///< number of streams that have ended
  // Streaming thread.
  Input input_;
  Ref<GstCaps> caps_;
  int64_t first_ns_ = INT64_MAX;
  int64_t end_ns_ = 0;  ///< end of what has been read in this pass
  bool has_begun_ = false;
};

std::unique_ptr<TrackOfFile> open_file(const std::string& path, bool only_notes,
                                       const std::atomic<bool>* stopped) {
  for (const Wanted wanted : {Wanted::kHapticTrack, Wanted::kFirstSound}) {
    auto track = std::make_unique<TrackOfFile>(path, only_notes, stopped, wanted);
    track->begin();
    if (track->is_chosen()) return track;
    if (!track->has_sound()) break;
    // The error of the other attempt explains why the file is no track.
  }
  throw std::runtime_error("There is no haptic track in it, and no sound.");
}

}  // namespace

std::unique_ptr<OpenTrack> open_track(const std::string& path, const std::atomic<bool>* stopped) {
  try {
    return open_file(path, false, stopped);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

int64_t find_end(OpenTrack& track) {
  int64_t end_ns = 0;
  for (TrackBlock block; track.next(block);) end_ns = end_of(block);
  track.blocks()->seek(0);
  if (const auto begin_ns = track.blocks()->await_seek()) track.seek(*begin_ns);
  return end_ns;
}

Notes notes_of(const std::string& path) {
  try {
    return open_file(path, true, nullptr)->notes();
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace spidar::tracks
