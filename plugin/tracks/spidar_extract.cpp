// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/**
 * SECTION:element-spidarextract
 * @title: spidarextract
 * @short_description: a haptic track from a video that spidarmotion has analysed
 *
 * The video passes from `sink` to `src` unchanged. The pad `wrench` sends the wanted wrench of
 * `spidarmotion attach-meta=true`, before the limits, as six channels of sound: force x, y, z and
 * torque x, y, z, 1000 samples a second, F32. A sample of 1.0 is 10 N or 1 N m. Between two
 * frames the samples follow the curve that the haptic loop renders.
 *
 * Samples lie in running time from 0 on, whatever segments the video has; the segment of the
 * samples gives their stream time. Without frames, samples are zero. If the timestamps of the video
 * jump forward by more than an hour, a warning is posted, there are no samples in between, and a
 * single frame there is left out.
 *
 * Buffers are 40 ms long, and marked as gaps where there is no force. A sample is known when the
 * frame after the next one is: `wrench` reports that latency. Either source pad may be left
 * unlinked. Where both lead to sinks that wait for their first buffer, the video needs a queue;
 * otherwise the pipeline waits for ever, and a warning says so after a second.
 *
 * In reverse playback, `wrench` sends gap events instead of samples.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 filesrc location=film.mp4 ! decodebin ! spidarmotion device=none attach-meta=true
 * ! spidarextract name=x x.wrench ! matroskamux ! filesink location=film.haptic.mka
 * ]| Records the haptic track of a film as fast as it can be decoded.
 *
 * Since: 0.1
 */
#include <gst-spidar/gstspidarmotionmeta.h>
#include <gst/base/gstflowcombiner.h>

#include "plugin/gobject/downstream.h"
#include "plugin/gobject/ref.h"
#include "plugin/tracks/track_elements.h"
#include "plugin/tracks/track_stream.h"

GST_DEBUG_CATEGORY_STATIC(gst_spidar_extract_debug);
#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_extract_debug

using spidar::Wrench;
using spidar::tracks::FrameWrench;
using spidar::tracks::Stream;

struct _GstSpidarExtract {
  GstElement parent;

  GstPad* sink;
  GstPad* src;
  GstPad* wrench;
  // Streaming thread.
  Stream* track;
  GstFlowCombiner* flows;
  gint without_meta;     // atomic: successive frames without a meta
  gint warned;           // atomic: a warning of missing metas was posted
  gint warned_of_queue;  // atomic: sinks that wait for each other were reported
};

static GstStaticPadTemplate track_sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw(ANY)"));
static GstStaticPadTemplate track_src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw(ANY)"));
static GstStaticPadTemplate wrench_template = GST_STATIC_PAD_TEMPLATE(
    "wrench", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(SPIDAR_TRACK_CAPS));

G_DEFINE_TYPE_WITH_CODE(GstSpidarExtract, gst_spidar_extract, GST_TYPE_ELEMENT,
                        GST_DEBUG_CATEGORY_INIT(gst_spidar_extract_debug, "spidarextract", 0,
                                                "haptic track of a video"))
GST_ELEMENT_REGISTER_DEFINE(spidarextract, "spidarextract", GST_RANK_NONE, GST_TYPE_SPIDAR_EXTRACT)

// --- streaming thread --------------------------------------------------------------------------

/// `last` is the wrench of the previous frame.
static FrameWrench read_frame(GstBuffer* buffer, const Wrench& last) {
  FrameWrench frame;
  frame.pts = GST_BUFFER_PTS(buffer);
  frame.duration = GST_BUFFER_DURATION(buffer);
  GstSpidarFrameMotion motion;
  if (gst_buffer_get_spidar_motion(buffer, &motion)) {
    frame.known = true;
    frame.compared = motion.interval > 0;
    frame.interval_ns = static_cast<int64_t>(motion.interval);
    frame.wrench = {{motion.force_x, motion.force_y, motion.force_z},
                    {motion.torque_x, motion.torque_y, motion.torque_z}};
    // A picture that has been repeated for long has no force, so its wrench differs.
    frame.repeats =
        gst_buffer_repeats_spidar_motion(buffer) && frame.wrench.stacked() == last.stacked();
  }
  return frame;
}

/// Combines the flow return of a pad with that of the others.
static GstFlowReturn combined(GstSpidarExtract* self, GstPad* pad, GstFlowReturn flow) {
  return gst_flow_combiner_update_pad_flow(self->flows, pad, flow);
}

static bool is_motion(GstElement* element) {
  return g_strcmp0(G_OBJECT_TYPE_NAME(element), "GstSpidarMotion") == 0;
}

static bool is_silent_motion(GstElement* element) {
  gboolean attaches = TRUE;
  if (is_motion(element)) g_object_get(element, "attach-meta", &attaches, nullptr);
  return !attaches;
}

/// Warns once that frames have no data, and what is wrong with the pipeline.
static void warn_of_data(GstSpidarExtract* self) {
  if (g_atomic_int_exchange(&self->warned, TRUE)) return;
  const char* why = "there is no spidarmotion in front of spidarextract";
  if (spidar::is_upstream(self->sink, is_silent_motion)) {
    why = "spidarmotion has attach-meta=false";
  } else if (spidar::is_upstream(self->sink, is_motion)) {
    why =
        "spidarmotion does not measure them, and says why, or what is between takes the data away";
  } else if (!spidar::find_path_downstream(self->src, is_motion).empty()) {
    why = "spidarmotion is behind spidarextract, and belongs in front of it";
  }
  GST_ELEMENT_WARNING(
      self, RESOURCE, SETTINGS,
      ("Frames come without the data of spidarmotion, and the haptic track is silent where they "
       "do: %s. Right is: … ! spidarmotion attach-meta=true ! spidarextract name=x x.src ! queue ! "
       "VIDEOSINK x.wrench ! …",
       why),
      (nullptr));
}

/// How much of a stream a queue holds by default. If the pipeline still prerolls after this time,
/// the video sink that blocks the push waits for the sink of the track.
static constexpr GstClockTime kQueue = GST_SECOND;

/// The clock calls this while the video is being pushed.
static gboolean warn_of_queue(GstClock*, GstClockTime, GstClockID, gpointer user) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(user);
  const spidar::Ref<GstObject> pipeline = spidar::root_of(self);
  const bool waits = GST_STATE_PENDING(pipeline.get()) != GST_STATE_VOID_PENDING;
  if (!waits) return TRUE;
  if (g_atomic_int_get(&self->without_meta) > 0) {
    warn_of_data(self);  // the queue is missing in the pipeline
    return TRUE;
  }
  if (g_atomic_int_exchange(&self->warned_of_queue, TRUE)) return TRUE;
  GST_ELEMENT_WARNING(
      self, STREAM, FAILED,
      ("The sink of the video waits for that of the haptic track, which gets nothing as long as "
       "it waits: put a queue between spidarextract and the sink of the video."),
      ("The first samples are known some frames later: spidarextract name=x x.src ! queue ! …"));
  return TRUE;
}

/// Until there are samples, the sinks may wait for each other.
static GstFlowReturn push_video(GstSpidarExtract* self, GstBuffer* buffer) {
  const bool may_wait = !self->track->has_pushed() && gst_pad_is_linked(self->wrench);
  if (!may_wait) return gst_pad_push(self->src, buffer);
  const spidar::Ref<GstClock> clock(gst_system_clock_obtain());
  GstClockID alarm =
      gst_clock_new_single_shot_id(clock.get(), gst_clock_get_time(clock.get()) + kQueue);
  gst_clock_id_wait_async(alarm, warn_of_queue, gst_object_ref(self), gst_object_unref);
  const GstFlowReturn flow = gst_pad_push(self->src, buffer);
  gst_clock_id_unschedule(alarm);
  gst_clock_id_unref(alarm);
  return flow;
}

static GstFlowReturn gst_spidar_extract_chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(parent);
  const FrameWrench frame = read_frame(buffer, self->track->last_wrench());
  // A frame without a picture needs no warning, nor does a single one: when two frames have the
  // same time, spidarmotion analyses only the first, and reports that.
  const bool is_missing = !frame.known && !GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP);
  if (!is_missing) {
    g_atomic_int_set(&self->without_meta, 0);
  } else if (g_atomic_int_add(&self->without_meta, 1) == 1) {
    warn_of_data(self);
  }
  const GstFlowReturn track_flow = self->track->add(frame);
  combined(self, self->wrench, track_flow);
  return combined(self, self->src, push_video(self, buffer));
}

static gboolean gst_spidar_extract_sink_event(GstPad*, GstObject* parent, GstEvent* event) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(parent);
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_FLUSH_START:
    case GST_EVENT_SEGMENT_DONE:
      gst_pad_push_event(self->wrench, gst_event_ref(event));
      break;
    case GST_EVENT_FLUSH_STOP:
      self->track->flush();
      gst_flow_combiner_reset(self->flows);
      gst_pad_push_event(self->wrench, gst_event_ref(event));
      break;
    case GST_EVENT_STREAM_START:
      self->track->begin_stream(GST_ELEMENT(self), event);
      break;
    case GST_EVENT_SEGMENT:
      combined(self, self->wrench, self->track->begin_segment(event));
      break;
    case GST_EVENT_GAP: {
      GstClockTime time;
      gst_event_parse_gap(event, &time, nullptr);
      combined(self, self->wrench, self->track->add_gap(time));
      break;
    }
    case GST_EVENT_EOS:
      combined(self, self->wrench, self->track->finish());
      gst_pad_push_event(self->wrench, gst_event_ref(event));
      break;
    default:
      break;
  }
  return gst_pad_push_event(self->src, event) || GST_EVENT_TYPE(event) == GST_EVENT_EOS;
}

/// Caps and allocation are negotiated between the elements upstream and downstream.
static gboolean gst_spidar_extract_sink_query(GstPad* pad, GstObject* parent, GstQuery* query) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(parent);
  switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_CAPS:
    case GST_QUERY_ACCEPT_CAPS:
    case GST_QUERY_ALLOCATION:
      if (gst_pad_is_linked(self->src)) return gst_pad_peer_query(self->src, query);
      break;
    default:
      break;
  }
  return gst_pad_query_default(pad, parent, query);
}

// --- from downstream ---------------------------------------------------------------------------

static gboolean gst_spidar_extract_src_query(GstPad* pad, GstObject* parent, GstQuery* query) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(parent);
  if (GST_QUERY_TYPE(query) == GST_QUERY_CAPS || GST_QUERY_TYPE(query) == GST_QUERY_ACCEPT_CAPS) {
    if (gst_pad_is_linked(self->sink)) return gst_pad_peer_query(self->sink, query);
  }
  return gst_pad_query_default(pad, parent, query);
}

static gboolean gst_spidar_extract_wrench_query(GstPad* pad, GstObject* parent, GstQuery* query) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(parent);
  if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY) return gst_pad_query_default(pad, parent, query);
  if (!gst_pad_peer_query(self->sink, query)) return FALSE;
  gboolean live;
  GstClockTime min, max;
  gst_query_parse_latency(query, &live, &min, &max);
  min += Stream::latency_ns();
  if (GST_CLOCK_TIME_IS_VALID(max)) max += Stream::latency_ns();
  gst_query_set_latency(query, live, min, max);
  return TRUE;
}

/// The decoder must not drop frames because samples are late, nor renegotiate for their caps.
static gboolean gst_spidar_extract_wrench_event(GstPad* pad, GstObject* parent, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_QOS || GST_EVENT_TYPE(event) == GST_EVENT_RECONFIGURE) {
    gst_event_unref(event);
    return TRUE;
  }
  return gst_pad_event_default(pad, parent, event);
}

// --- object ------------------------------------------------------------------------------------

static GstStateChangeReturn gst_spidar_extract_change_state(GstElement* element,
                                                            GstStateChange transition) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(element);
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    for (gint* value : {&self->without_meta, &self->warned, &self->warned_of_queue}) {
      g_atomic_int_set(value, 0);
    }
  }
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_spidar_extract_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    self->track->reset();
    gst_flow_combiner_reset(self->flows);
  }
  return result;
}

static void gst_spidar_extract_finalize(GObject* object) {
  GstSpidarExtract* self = GST_SPIDAR_EXTRACT(object);
  delete self->track;
  gst_flow_combiner_unref(self->flows);
  G_OBJECT_CLASS(gst_spidar_extract_parent_class)->finalize(object);
}

/// Adds a pad of this template to the element, which owns it.
static GstPad* add_pad(GstElement* element, GstStaticPadTemplate* pad_template) {
  GstPad* pad = gst_pad_new_from_static_template(pad_template, pad_template->name_template);
  gst_element_add_pad(element, pad);
  return pad;
}

static void gst_spidar_extract_init(GstSpidarExtract* self) {
  self->sink = add_pad(GST_ELEMENT(self), &track_sink_template);
  gst_pad_set_chain_function(self->sink, gst_spidar_extract_chain);
  gst_pad_set_event_function(self->sink, gst_spidar_extract_sink_event);
  gst_pad_set_query_function(self->sink, gst_spidar_extract_sink_query);
  self->src = add_pad(GST_ELEMENT(self), &track_src_template);
  gst_pad_set_query_function(self->src, gst_spidar_extract_src_query);
  self->wrench = add_pad(GST_ELEMENT(self), &wrench_template);
  gst_pad_set_query_function(self->wrench, gst_spidar_extract_wrench_query);
  gst_pad_set_event_function(self->wrench, gst_spidar_extract_wrench_event);
  self->track = new Stream(self->wrench);
  self->flows = gst_flow_combiner_new();
  gst_flow_combiner_add_pad(self->flows, self->src);
  gst_flow_combiner_add_pad(self->flows, self->wrench);
}

static void gst_spidar_extract_class_init(GstSpidarExtractClass* klass) {
  GstElementClass* element_class = GST_ELEMENT_CLASS(klass);
  G_OBJECT_CLASS(klass)->finalize = gst_spidar_extract_finalize;
  element_class->change_state = gst_spidar_extract_change_state;
  gst_element_class_set_static_metadata(
      element_class, "SPIDAR track extractor", "Extracter/Video/Metadata",
      "Outputs the force and torque of spidarmotion as a track of six channels",
      "The gst-spidar authors");
  for (GstStaticPadTemplate* pad_template :
       {&track_sink_template, &track_src_template, &wrench_template}) {
    gst_element_class_add_static_pad_template(element_class, pad_template);
  }
}
