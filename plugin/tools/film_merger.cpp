// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_merger.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gst/gst.h>

#include "plugin/tools/film_inventory.h"
#include "plugin/tools/matroska_flags.h"
#include "plugin/tools/plain_subtitles.h"
#include "plugin/tools/stream_time.h"
#include "plugin/track/file_pipeline.h"

namespace spidar {
namespace {

constexpr const char* kTrackName = "Haptic track";

/// The muxer waits for the stream that is furthest behind. So that none of the others has to be
/// kept in memory meanwhile, each stream has a reader of its own, which discards the others.
class FilmMerger {
 public:
  FilmMerger(const std::string& film, const std::string& track, const TrackNotes& notes,
             const std::string& out)
      : film_(film),
        notes_(notes),
        file_(
            "matroskamux name=mux ! filesink name=out filesrc name=source ! parsebin name=parse "
            "queue name=samples",
            track, nullptr),
        mux_(file_.find("mux")) {
    g_object_set(file_.find("out"), "location", out.c_str(), nullptr);
  }
  ~FilmMerger() { file_.stop(); }
  FilmMerger(const FilmMerger&) = delete;
  FilmMerger& operator=(const FilmMerger&) = delete;

  void run(const std::vector<FilmStream>& streams) {
    sources_ = {file_.find("parse"), file_.find("source")};
    for (const FilmStream& stream : streams) add_stream(stream);
    add_track();
    // What takes data is ready before anything is read.
    for (GstElement* source : sources_) gst_element_set_locked_state(source, TRUE);
    gst_element_set_state(file_.pipeline(), GST_STATE_PAUSED);
    for (GstElement* source : sources_) {
      gst_element_set_locked_state(source, FALSE);
      gst_element_sync_state_with_parent(source);
    }
    file_.play_until(GST_MESSAGE_EOS);
    file_.stop();
  }

 private:
  /// Takes one stream of a file.
  struct Reader {
    Reader(FilmMerger& owner, std::string stream, GstElement* into)
        : merger(owner), id(std::move(stream)), queue(into) {}

    FilmMerger& merger;
    const std::string id;  ///< empty: the haptic track
    GstElement* const queue;
    std::atomic<bool> is_ready{false};  ///< the muxer knows its caps, or that it is empty
  };

  GstElement* add(const char* kind) const {
    GstElement* const element = gst_element_factory_make(kind, nullptr);
    if (!element) {
      throw std::runtime_error(std::string("GStreamer has no element \"") + kind + "\"");
    }
    gst_bin_add(GST_BIN(file_.pipeline()), element);
    return element;
  }

  /// A pad of the muxer for such a stream. Throws std::runtime_error when Matroska takes none.
  GstPad* request_pad(const FilmStream& stream) const {
    // A parser converts between these, once it is linked.
    const std::shared_ptr<GstCaps> caps(gst_caps_copy(stream.caps.get()), gst_caps_unref);
    gst_structure_remove_fields(gst_caps_get_structure(caps.get(), 0), "stream-format", "alignment",
                                nullptr);
    for (const char* name : {"video_%u", "audio_%u", "subtitle_%u"}) {
      GstPadTemplate* const kind = gst_element_get_pad_template(mux_, name);
      if (gst_caps_can_intersect(caps.get(), GST_PAD_TEMPLATE_CAPS(kind))) {
        return gst_element_request_pad(mux_, kind, nullptr, nullptr);
      }
    }
    gchar* const text = gst_caps_to_string(stream.caps.get());
    const std::string refused = text;
    g_free(text);
    throw std::runtime_error("Matroska takes no stream of " + refused +
                             ": leave the track beside the film, where track=auto finds it.");
  }

  void add_stream(const FilmStream& stream) {
    GstElement* const source = add("filesrc");
    GstElement* const parser = add("parsebin");
    Reader& reader = readers_.emplace_back(*this, stream.id, add("queue"));
    sources_.push_back(parser);
    sources_.push_back(source);
    g_object_set(source, "location", film_.c_str(), nullptr);
    gst_element_link(source, parser);
    g_signal_connect(parser, "pad-added", G_CALLBACK(take_stream), &reader);
    GstElement* const plain = add_plain_subtitles(file_.pipeline(), stream.caps.get());
    if (plain) gst_element_link(reader.queue, plain);
    GstPad* const mux_pad =
        plain ? gst_element_request_pad_simple(mux_, "subtitle_%u") : request_pad(stream);
    link(plain ? plain : reader.queue, mux_pad);
    constexpr auto kFlow = static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER |
                                                        GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);
    gst_pad_add_probe(mux_pad, kFlow, note_ready, &reader, nullptr);
    gst_object_unref(mux_pad);
  }

  /// After the film's sound, because players choose the first audio stream.
  void add_track() {
    Reader& reader = readers_.emplace_back(*this, "", file_.find("samples"));
    reader.is_ready = true;
    g_signal_connect(file_.find("parse"), "pad-added", G_CALLBACK(take_stream), &reader);
    GstPad* const mux_pad = gst_element_request_pad_simple(mux_, "audio_%u");
    link(reader.queue, mux_pad);
    gst_object_unref(mux_pad);
    samples_ = gst_element_get_static_pad(reader.queue, "src");
    gst_pad_add_probe(samples_, GST_PAD_PROBE_TYPE_BUFFER, tag_samples, this, nullptr);
    gst_pad_add_probe(samples_, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, drop_tags, nullptr, nullptr);
    hold_ = gst_pad_add_probe(samples_, GST_PAD_PROBE_TYPE_BLOCK_DOWNSTREAM, hold_back, nullptr,
                              nullptr);
    gst_object_unref(samples_);
  }

  static void link(GstElement* from, GstPad* mux_pad) {
    GstPad* const pad = gst_element_get_static_pad(from, "src");
    gst_pad_link(pad, mux_pad);
    gst_object_unref(pad);
  }

  static void take_stream(GstElement* parser, GstPad* pad, gpointer user) {
    auto& reader = *static_cast<Reader*>(user);
    const FilePipeline& file = reader.merger.file_;
    GstPad* into = gst_element_get_static_pad(reader.queue, "sink");
    GstCaps* caps = caps_of(pad);
    const bool is_track = kind_of(caps) == StreamKind::kHapticTrack;
    gst_caps_unref(caps);
    const bool is_wanted = reader.id.empty() ? is_track : stream_id(pad) == reader.id;
    if (is_wanted && !gst_pad_is_linked(into)) {
      follow_stream_time(into);
    } else if (reader.id.empty()) {
      GST_ELEMENT_ERROR(parser, STREAM, WRONG_TYPE,
                        ("The track is to be a file of its own; spidartrack extract makes one."),
                        (nullptr));
    } else {
      gst_object_unref(into);
      into = gst_element_get_static_pad(file.add_fakesink(), "sink");
    }
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, note_read, user, nullptr);
    gst_pad_link(pad, into);
    gst_object_unref(into);
  }

  static GstPadProbeReturn note_read(GstPad*, GstPadProbeInfo*, gpointer user) {
    static_cast<Reader*>(user)->merger.file_.advance();
    return GST_PAD_PROBE_OK;
  }

  /// The muxer writes its header when all streams that it waits for have data, but it does not wait
  /// for subtitles, and refuses caps that come after the header. It therefore gets no sample of the
  /// track before it knows the caps of all streams: before what follows them reaches it.
  static GstPadProbeReturn note_ready(GstPad*, GstPadProbeInfo* info, gpointer user) {
    if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
      const GstEventType type = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info));
      const bool follows = type == GST_EVENT_SEGMENT || type == GST_EVENT_EOS;
      if (!follows) return GST_PAD_PROBE_OK;
    }
    auto& reader = *static_cast<Reader*>(user);
    if (!reader.is_ready.exchange(true)) reader.merger.begin_when_ready();
    return GST_PAD_PROBE_REMOVE;
  }

  void begin_when_ready() {
    const bool all = std::all_of(readers_.begin(), readers_.end(),
                                 [](const Reader& reader) { return reader.is_ready.load(); });
    if (all && !begun_.exchange(true)) gst_pad_remove_probe(samples_, hold_);
  }

  static GstPadProbeReturn hold_back(GstPad*, GstPadProbeInfo*, gpointer) {
    return GST_PAD_PROBE_OK;
  }

  /// Sends the tags of the track to the muxer right before its first sample, which is when the
  /// muxer writes the name of the track, with room for flags. Its tags are written at the end,
  /// without.
  static GstPadProbeReturn tag_samples(GstPad* pad, GstPadProbeInfo*, gpointer user) {
    auto& self = *static_cast<FilmMerger*>(user);
    const bool is_first = ++self.buffers_ == 1;
    const std::string title = is_first ? name_with_room(kTrackName) : kTrackName;
    GstTagList* tags = track_tags(self.notes_);
    gst_tag_list_add(tags, GST_TAG_MERGE_REPLACE, GST_TAG_TITLE, title.c_str(), nullptr);
    GstPad* mux_pad = gst_pad_get_peer(pad);
    gst_pad_send_event(mux_pad, gst_event_new_tag(tags));
    gst_object_unref(mux_pad);
    return is_first ? GST_PAD_PROBE_OK : GST_PAD_PROBE_REMOVE;
  }

  static GstPadProbeReturn drop_tags(GstPad*, GstPadProbeInfo* info, gpointer) {
    const bool is_tag = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_TAG;
    return is_tag ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
  }

  const std::string film_;
  const TrackNotes notes_;
  const FilePipeline file_;
  GstElement* const mux_;
  std::vector<GstElement*> sources_;  // each after what takes its data
  std::deque<Reader> readers_;
  GstPad* samples_ = nullptr;
  gulong hold_ = 0;
  std::atomic<bool> begun_{false};
  int buffers_ = 0;  // of the track
};

/// Throws std::runtime_error with the reason why a track cannot be merged into such a film.
void judge_film(const std::vector<FilmStream>& streams) {
  const auto has = [&streams](StreamKind kind) {
    return std::any_of(streams.begin(), streams.end(),
                       [kind](const FilmStream& stream) { return stream.kind == kind; });
  };
  if (has(StreamKind::kHapticTrack)) {
    throw std::runtime_error(
        "The film has a haptic track already: spidartrack extract takes it out.");
  }
  if (!has(StreamKind::kSound)) {
    throw std::runtime_error(
        "The film has no sound: players would play the haptic track through the loudspeakers. "
        "Leave it beside the film, as FILM.mp4.haptic.flac for FILM.mp4, where track=auto finds "
        "it.");
  }
}

/// In sentences; GStreamer's muxer writes neither rotations nor attachments.
std::string what_is_lost(const std::vector<FilmStream>& streams) {
  std::string turned, cover;
  for (const FilmStream& stream : streams) {
    if (turned.empty() && !stream.orientation.empty() && stream.orientation != "rotate-0") {
      turned = "The pictures are turned (" + stream.orientation +
               "), which GStreamer cannot write into Matroska: players show them unturned, and the "
               "force no longer fits. Leave the track beside the film, where track=auto finds it.";
    }
    if (stream.has_cover) {
      cover =
          "The cover art is lost, because GStreamer cannot write it into Matroska: "
          "mkvpropedit --add-attachment adds a picture.";
    }
  }
  return turned + (turned.empty() || cover.empty() ? "" : " ") + cover;
}

}  // namespace

std::string merge_film(const std::string& film, const std::string& track, const TrackNotes& notes,
                       const std::string& out) {
  const std::vector<FilmStream> streams = list_streams(film);
  judge_film(streams);
  FilmMerger(film, track, notes, out).run(streams);
  clear_track_flags(out, kTrackName);
  return what_is_lost(streams);
}

}  // namespace spidar
