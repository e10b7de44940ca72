// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_analyzer.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <gst/gst.h>

#include "core/analysis/motion_file.h"
#include "plugin/tools/film_decoder.h"
#include "plugin/tools/film_recorder.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/film_fingerprint.h"
#include "plugin/track/motion_sidecar.h"

namespace spidar {
namespace {

/// The element does not look at the pictures of an analysis; its caps begin at this size.
constexpr int kSide_px = 16;

std::unique_ptr<GstElement, void (*)(gpointer)> motion_of(GstElement* pipeline) {
  return {gst_bin_get_by_name(GST_BIN(pipeline), "motion"), gst_object_unref};
}

/// The element knows neither the film nor which properties are not defaults. Throws
/// std::runtime_error when the file is not whole.
void complete_header(const std::string& path, const std::string& film, const std::string& settings,
                     const MotionPiece& piece) {
  std::ifstream file(path, std::ios::binary);
  MotionHeader header = read_header(file);
  const std::string rest{std::istreambuf_iterator<char>(file), {}};
  file.close();
  header.film = film;
  header.settings = settings;
  header.piece = piece;
  std::ofstream complete(path, std::ios::binary);
  complete << write_header(header) << rest;
  complete.close();
  try {
    // The element goes on without its trace when the disk is full.
    read_motion_file(path);
  } catch (const MotionFileError&) {
    throw std::runtime_error("the analysis cannot be written; the disk may be full");
  }
}

/// Gives the frames of an analysis to an element, as if they came from the film.
class FrameFeed {
 public:
  FrameFeed(GstElement* motion, int64_t end_ns)
      : end_ns_(end_ns),
        pad_(gst_pad_new("frames", GST_PAD_SRC)),
        sink_(gst_element_get_static_pad(motion, "sink")) {
    gst_pad_set_element_private(pad_, this);
    gst_pad_set_query_function(pad_, answer);
    gst_pad_link(pad_, sink_);
    gst_pad_set_active(pad_, TRUE);
  }
  ~FrameFeed() {
    gst_pad_set_active(pad_, FALSE);
    gst_pad_unlink(pad_, sink_);
    gst_object_unref(sink_);
    gst_object_unref(pad_);
  }
  FrameFeed(const FrameFeed&) = delete;
  FrameFeed& operator=(const FrameFeed&) = delete;

  void begin() const {
    gst_pad_push_event(pad_, gst_event_new_stream_start("frames"));
    GstCaps* caps = gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, "GRAY8", "width",
                                        G_TYPE_INT, kSide_px, "height", G_TYPE_INT, kSide_px,
                                        "framerate", GST_TYPE_FRACTION, 0, 1, nullptr);
    gst_pad_push_event(pad_, gst_event_new_caps(caps));
    gst_caps_unref(caps);
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_pad_push_event(pad_, gst_event_new_segment(&segment));
  }

  /// False when the pipeline takes no more.
  bool push(const MotionMoment& moment) const {
    const auto time = static_cast<GstClockTime>(moment.stream_ns);
    if (moment.kind == MomentKind::kNothing) {
      gst_pad_push_event(pad_, gst_event_new_gap(time, GST_CLOCK_TIME_NONE));
      return true;
    }
    GstBuffer* const frame = gst_buffer_new_allocate(nullptr, kSide_px * kSide_px, nullptr);
    GST_BUFFER_PTS(frame) = time;
    if (moment.duration_ns >= 0) {
      GST_BUFFER_DURATION(frame) = static_cast<GstClockTime>(moment.duration_ns);
    }
    if (moment.empty) GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_GAP);
    return gst_pad_push(pad_, frame) == GST_FLOW_OK;
  }

  void end() const { gst_pad_push_event(pad_, gst_event_new_eos()); }

 private:
  static gboolean answer(GstPad* pad, GstObject* parent, GstQuery* query) {
    const auto* self = static_cast<const FrameFeed*>(gst_pad_get_element_private(pad));
    GstFormat format;
    if (GST_QUERY_TYPE(query) != GST_QUERY_DURATION) {
      return gst_pad_query_default(pad, parent, query);
    }
    gst_query_parse_duration(query, &format, nullptr);
    if (format != GST_FORMAT_TIME) return FALSE;
    gst_query_set_duration(query, format, self->end_ns_);
    return TRUE;
  }

  const int64_t end_ns_;
  GstPad* const pad_;
  GstPad* const sink_;
};

/// Throws std::runtime_error when the element did not take the analysis.
void require_all(GstElement* motion, const MotionFile& file) {
  GstStructure* stats = nullptr;
  g_object_get(motion, "stats", &stats, nullptr);
  guint64 taken = 0;
  gst_structure_get_uint64(stats, "analysis-frames", &taken);
  gst_structure_free(stats);
  guint64 frames = 0;
  for (size_t i = 0; i < file.size(); ++i) {
    const MotionMoment moment = file.moment(i);
    frames += moment.kind == MomentKind::kFrame && !moment.empty;
  }
  if (taken < frames) {
    throw std::runtime_error("only " + std::to_string(taken) + " of its " + std::to_string(frames) +
                             " frames were rendered");
  }
}

/// Where the last moment ends; 0 when there is none.
int64_t end_of(const MotionFile& file) {
  if (file.size() == 0) return 0;
  const MotionMoment last = file.moment(file.size() - 1);
  return last.stream_ns + std::max<int64_t>(last.duration_ns, 0);
}

/// Keeps the warnings of a pipeline. Outlives it.
GstBusSyncReply keep_warning(GstBus*, GstMessage* message, gpointer user) {
  if (GST_MESSAGE_TYPE(message) != GST_MESSAGE_WARNING) return GST_BUS_PASS;
  GError* warning = nullptr;
  gst_message_parse_warning(message, &warning, nullptr);
  static_cast<std::vector<std::string>*>(user)->emplace_back(warning->message);
  g_error_free(warning);
  return GST_BUS_PASS;
}

MotionKind motion_kind(const RecordProperties& properties) {
  MotionKind kind = MotionKind::kObject;
  for (const auto& [name, value] : properties.values) {
    if (name == "motion") kind = value == "mean" ? MotionKind::kMean : MotionKind::kObject;
  }
  return kind;
}

}  // namespace

std::string analyze_film(const std::string& film, const std::string& motion,
                         const RecordProperties& properties, const MotionPiece& piece,
                         const std::function<void(int percent)>& tell) {
  FilmFingerprint found;
  FilmPiece part(piece);
  std::string remark =
      // A piece may begin long after the key frame before it.
      decode_film({film, properties, "fakesink sync=false async=false",
                   [&](GstElement* pipeline, const FilmFingerprint& fingerprint) {
                     found = fingerprint;
                     g_object_set(motion_of(pipeline).get(), "trace", motion.c_str(), nullptr);
                   },
                   tell, piece.of > 0 ? &part : nullptr});
  complete_header(motion, to_text(found), properties.settings, part.found());
  if (piece.of > 0 && part.is_empty() && remark.empty()) {
    remark = "there is no cut in it at which it could begin: the piece before goes on in its place";
  }
  return remark;
}

std::vector<std::string> render_analysis(const std::string& motion, const std::string& track,
                                         const RecordProperties& properties) {
  const MotionFile file = read_motion_file(motion);
  const std::string film = motion.substr(0, motion.size() - std::string(kMotionEnd).size());
  const RecordProperties all = with_rules(with_settings(properties, file.header().settings),
                                          ends_with(motion, kMotionEnd) ? film : motion);
  std::vector<std::string> remarks;
  const std::string wrong = wrong_motion(file.header(), motion_kind(all));
  if (!wrong.empty()) throw std::runtime_error(wrong);
  GError* error = nullptr;
  const std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline(
      gst_parse_launch(
          ("spidarmotion name=motion device=none post-messages=false attach-meta=true ! " +
           sampling_elements(track))
              .c_str(),
          &error),
      [](GstElement* element) {
        if (!element) return;
        gst_element_set_state(element, GST_STATE_NULL);
        gst_object_unref(element);
      });
  if (error) {
    const std::string text = error->message;
    g_error_free(error);
    throw std::runtime_error(text);
  }
  const auto element = motion_of(pipeline.get());
  set_properties(element.get(), all);
  g_object_set(element.get(), "analysis", motion.c_str(), nullptr);
  take_samples(pipeline.get(), track, {parse_fingerprint(file.header().film), all.settings});
  GstBus* const bus = gst_element_get_bus(pipeline.get());
  gst_bus_set_sync_handler(bus, keep_warning, &remarks, nullptr);
  gst_object_unref(bus);
  const FrameFeed feed(element.get(), end_of(file));
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  feed.begin();
  for (size_t i = 0; i < file.size() && feed.push(file.moment(i)); ++i) {
  }
  feed.end();
  await_message(pipeline.get(), GST_MESSAGE_EOS);
  require_all(element.get(), file);
  return remarks;
}

}  // namespace spidar
