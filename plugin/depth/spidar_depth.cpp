// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/**
 * SECTION:element-spidardepth
 * @title: spidardepth
 * @short_description: attaches depth images to the frames of a video
 *
 * The video passes from `sink` to `src` untouched. Each frame gets the depth image of `depth_sink`
 * that is shown at the same running time, as a meta (gstspidardepthmeta.h): a reference to the
 * image, never a copy, and what its samples mean. Depth may have another size and another rate than
 * the video. It covers the whole picture.
 *
 * A frame gets the latest image that begins at most half a frame after it. An image is used until
 * its end, and #GstSpidarDepth:max-age longer when the next one is missing. Then frames pass
 * without depth, as they do while `depth_sink` is not linked.
 *
 * The video waits for the depth, in a live pipeline no longer than the latency of the slower
 * branch. Both branches need a queue when they come from one demuxer, and a stream of depth that
 * has nothing to send for a while has to send gap events, as demuxers do. A seek goes to both.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 spidardepth name=d ! videoconvert ! autovideosink
 * filesrc location=film.mkv ! decodebin ! videoconvert ! queue ! d.sink
 * filesrc location=film.depth.mkv ! decodebin ! queue ! d.depth_sink
 * ]| Plays a film whose depth is in a file of its own.
 *
 * Since: 0.1
 */
#include "plugin/depth/spidar_depth.h"

#include <algorithm>

#include <gst/video/video.h>

#include "plugin/depth/branch_latency.h"
#include "plugin/depth/depth_branch.h"
#include "plugin/depth/depth_gate.h"
#include "plugin/depth/depth_meta.h"
#include "plugin/depth/depth_properties.h"
#include "plugin/gobject/pads.h"
#include "plugin/properties/property_table.h"

GST_DEBUG_CATEGORY_STATIC(gst_spidar_depth_debug);
#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_depth_debug

using spidar::depth_properties;
using spidar::DepthGate;
using spidar::DepthProperties;

struct _GstSpidarDepth {
  GstElement parent;

  GstPad* sink;
  GstPad* depth_sink;
  GstPad* src;
  DepthGate* gate;
  DepthProperties* properties;  // object lock
  gint latency_unknown;         // atomic
  // Video thread.
  spidar::VideoStream video;
  gboolean live;
  GstClockTime latency;
  guint64 attached;
  spidar::DepthBranch* depth;
};

static GstStaticPadTemplate frame_sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw(ANY)"));
static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth_sink", GST_PAD_SINK, GST_PAD_ALWAYS,
    GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("{ GRAY16_LE, GRAY16_BE, GRAY8 }")));
static GstStaticPadTemplate frame_src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw(ANY)"));

G_DEFINE_TYPE_WITH_CODE(GstSpidarDepth, gst_spidar_depth, GST_TYPE_ELEMENT,
                        GST_DEBUG_CATEGORY_INIT(gst_spidar_depth_debug, "spidardepth", 0,
                                                "depth images for a video"))
GST_ELEMENT_REGISTER_DEFINE(spidardepth, "spidardepth", GST_RANK_NONE, GST_TYPE_SPIDAR_DEPTH)

static DepthProperties properties_of(GstSpidarDepth* self) {
  GST_OBJECT_LOCK(self);
  const DepthProperties properties = *self->properties;
  GST_OBJECT_UNLOCK(self);
  return properties;
}

// --- thread of the video -----------------------------------------------------------------------

static void update_latency(GstSpidarDepth* self) {
  if (!g_atomic_int_compare_and_exchange(&self->latency_unknown, TRUE, FALSE)) return;
  GstQuery* query = gst_query_new_latency();
  self->live = FALSE;
  if (spidar::query_latency({self->sink, self->depth_sink}, query)) {
    gst_query_parse_latency(query, &self->live, &self->latency, nullptr);
  } else {
    g_atomic_int_set(&self->latency_unknown, TRUE);
  }
  gst_query_unref(query);
}

/// Waits for the depth image of the frame and returns it.
static DepthGate::Found find_depth(GstSpidarDepth* self, const spidar::ShownTime& time,
                                   guint64 max_age) {
  update_latency(self);
  const spidar::Ref<GstClock> clock(self->live ? gst_element_get_clock(GST_ELEMENT(self))
                                               : nullptr);
  const GstClockTime base = gst_element_get_base_time(GST_ELEMENT(self));
  const auto shown = static_cast<GstClockTime>(std::max<gint64>(time.start_ns, 0));
  return self->gate->find(time, max_age, clock.get(), base + shown + self->latency);
}

static GstFlowReturn gst_spidar_depth_chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(parent);
  const auto time = spidar::shown_time(self->video.segment, buffer, self->video.frame_ns());
  if (time) {
    const DepthProperties properties = properties_of(self);
    const DepthGate::Found found = find_depth(self, *time, properties.max_age_ns);
    if (found.flow != GST_FLOW_OK) {
      gst_buffer_unref(buffer);
      return found.flow;
    }
    GstVideoInfo info;
    if (found.image.buffer && gst_video_info_from_caps(&info, found.image.caps.get())) {
      buffer = gst_buffer_make_writable(buffer);
      spidar::attach_depth_meta(buffer, found.image.buffer.get(), found.image.caps.get(),
                                found.image.time.start_ns,
                                properties.meaning(GST_VIDEO_INFO_FORMAT(&info)));
      ++self->attached;
    }
  }
  return gst_pad_push(self->src, buffer);
}

/// Warns when no depth image has ever matched a frame.
static void end_video(GstSpidarDepth* self) {
  self->gate->finish_video();
  if (self->attached > 0 || self->depth->images() == 0) return;
  GST_ELEMENT_WARNING(self, STREAM, FAILED,
                      ("There was depth, but none at the time of any frame of the video."),
                      ("The running times of 'sink' and 'depth_sink' have to overlap."));
}

static gboolean gst_spidar_depth_sink_event(GstPad*, GstObject* parent, GstEvent* event) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(parent);
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_FLUSH_START:
      self->gate->flush_video(true);
      break;
    case GST_EVENT_FLUSH_STOP:
      self->gate->flush_video(false);
      self->video.segment.format = GST_FORMAT_UNDEFINED;
      break;
    case GST_EVENT_STREAM_START:
      g_atomic_int_set(&self->latency_unknown, TRUE);
      break;
    case GST_EVENT_CAPS: {
      GstCaps* caps;
      gst_event_parse_caps(event, &caps);
      // Caps that GstVideoInfo cannot describe are passed on as well.
      if (!gst_video_info_from_caps(&self->video.info, caps))
        gst_video_info_init(&self->video.info);
      break;
    }
    case GST_EVENT_SEGMENT:
      gst_event_copy_segment(event, &self->video.segment);
      self->gate->begin_video();
      break;
    case GST_EVENT_EOS:
      end_video(self);
      break;
    default:
      break;
  }
  return gst_pad_push_event(self->src, event);
}

/// Caps and allocation are negotiated between the elements upstream and downstream.
static gboolean gst_spidar_depth_sink_query(GstPad* pad, GstObject* parent, GstQuery* query) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(parent);
  const GstQueryType type = GST_QUERY_TYPE(query);
  const bool proxied =
      type == GST_QUERY_CAPS || type == GST_QUERY_ACCEPT_CAPS || type == GST_QUERY_ALLOCATION;
  if (proxied && gst_pad_is_linked(self->src)) return gst_pad_peer_query(self->src, query);
  return gst_pad_query_default(pad, parent, query);
}

// --- thread of the depth -----------------------------------------------------------------------

static GstFlowReturn gst_spidar_depth_depth_chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  return GST_SPIDAR_DEPTH(parent)->depth->add(buffer);
}

/// No event of the depth stream goes downstream.
static gboolean gst_spidar_depth_depth_event(GstPad*, GstObject* parent, GstEvent* event) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(parent);
  if (GST_EVENT_TYPE(event) == GST_EVENT_STREAM_START)
    g_atomic_int_set(&self->latency_unknown, TRUE);
  const gboolean handled = self->depth->take(event, properties_of(self));
  gst_event_unref(event);
  return handled;
}

static gboolean gst_spidar_depth_depth_query(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (GST_QUERY_TYPE(query) == GST_QUERY_ALLOCATION) {
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
    return TRUE;
  }
  return gst_pad_query_default(pad, parent, query);
}

static GstPadLinkReturn gst_spidar_depth_depth_link(GstPad*, GstObject* parent, GstPad*) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(parent);
  g_atomic_int_set(&self->latency_unknown, TRUE);
  self->gate->set_linked(true);
  return GST_PAD_LINK_OK;
}

static void gst_spidar_depth_depth_unlink(GstPad*, GstObject* parent) {
  GST_SPIDAR_DEPTH(parent)->gate->set_linked(false);
}

// --- from downstream ---------------------------------------------------------------------------

/// Returns the result of the seek on the video pad.
static gboolean seek(GstSpidarDepth* self, GstEvent* event) {
  GstSeekFlags flags;
  gst_event_parse_seek(event, nullptr, nullptr, &flags, nullptr, nullptr, nullptr, nullptr);
  const bool flushes = (flags & GST_SEEK_FLAG_FLUSH) != 0 && gst_pad_is_linked(self->depth_sink);
  // Frames after the seek must not get depth from before it.
  if (flushes) self->gate->begin_seek();
  const gboolean done = gst_pad_push_event(self->sink, gst_event_ref(event));
  if (done && gst_pad_is_linked(self->depth_sink) &&
      !gst_pad_push_event(self->depth_sink, gst_event_ref(event))) {
    GST_WARNING_OBJECT(self, "the depth stream refused the seek");
  }
  if (flushes) self->gate->end_seek();
  gst_event_unref(event);
  return done;
}

static gboolean gst_spidar_depth_src_event(GstPad*, GstObject* parent, GstEvent* event) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(parent);
  if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK) return seek(self, event);
  if (GST_EVENT_TYPE(event) == GST_EVENT_LATENCY) {
    g_atomic_int_set(&self->latency_unknown, TRUE);
    if (gst_pad_is_linked(self->depth_sink))
      gst_pad_push_event(self->depth_sink, gst_event_ref(event));
  }
  return gst_pad_push_event(self->sink, event);
}

static gboolean gst_spidar_depth_src_query(GstPad* pad, GstObject* parent, GstQuery* query) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(parent);
  if (GST_QUERY_TYPE(query) == GST_QUERY_LATENCY)
    return spidar::query_latency({self->sink, self->depth_sink}, query);
  if (gst_pad_is_linked(self->sink)) return gst_pad_peer_query(self->sink, query);
  return gst_pad_query_default(pad, parent, query);
}

// --- object ------------------------------------------------------------------------------------

static void gst_spidar_depth_reset(GstSpidarDepth* self) {
  self->video.reset();
  self->depth->reset();
  self->live = FALSE;
  self->latency = 0;
  self->attached = 0;
  g_atomic_int_set(&self->latency_unknown, TRUE);
}

static GstStateChangeReturn gst_spidar_depth_change_state(GstElement* element,
                                                          GstStateChange transition) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(element);
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    gst_spidar_depth_reset(self);
    self->gate->open();
  } else if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    self->gate->close();
  }
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_spidar_depth_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) gst_spidar_depth_reset(self);
  return result;
}

static void gst_spidar_depth_set_property(GObject* object, guint id, const GValue* value,
                                          GParamSpec* spec) {
  GST_OBJECT_LOCK(object);
  const bool known = depth_properties().set(*GST_SPIDAR_DEPTH(object)->properties, id, value);
  GST_OBJECT_UNLOCK(object);
  if (!known) G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

static void gst_spidar_depth_get_property(GObject* object, guint id, GValue* value,
                                          GParamSpec* spec) {
  GST_OBJECT_LOCK(object);
  const bool known = depth_properties().get(*GST_SPIDAR_DEPTH(object)->properties, id, value);
  GST_OBJECT_UNLOCK(object);
  if (!known) G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

static void gst_spidar_depth_finalize(GObject* object) {
  GstSpidarDepth* self = GST_SPIDAR_DEPTH(object);
  delete self->depth;
  delete self->gate;
  delete self->properties;
  G_OBJECT_CLASS(gst_spidar_depth_parent_class)->finalize(object);
}

static void gst_spidar_depth_init(GstSpidarDepth* self) {
  self->gate = new DepthGate(GST_OBJECT(self));
  self->depth = new spidar::DepthBranch(GST_ELEMENT(self), *self->gate);
  self->properties = new DepthProperties();
  self->sink = spidar::add_pad(GST_ELEMENT(self), &frame_sink_template);
  gst_pad_set_chain_function(self->sink, gst_spidar_depth_chain);
  gst_pad_set_event_function(self->sink, gst_spidar_depth_sink_event);
  gst_pad_set_query_function(self->sink, gst_spidar_depth_sink_query);
  self->depth_sink = spidar::add_pad(GST_ELEMENT(self), &depth_template);
  gst_pad_set_chain_function(self->depth_sink, gst_spidar_depth_depth_chain);
  gst_pad_set_event_function(self->depth_sink, gst_spidar_depth_depth_event);
  gst_pad_set_query_function(self->depth_sink, gst_spidar_depth_depth_query);
  gst_pad_set_link_function(self->depth_sink, gst_spidar_depth_depth_link);
  gst_pad_set_unlink_function(self->depth_sink, gst_spidar_depth_depth_unlink);
  self->src = spidar::add_pad(GST_ELEMENT(self), &frame_src_template);
  gst_pad_set_event_function(self->src, gst_spidar_depth_src_event);
  gst_pad_set_query_function(self->src, gst_spidar_depth_src_query);
  gst_spidar_depth_reset(self);
}

static void gst_spidar_depth_class_init(GstSpidarDepthClass* klass) {
  GstElementClass* element_class = GST_ELEMENT_CLASS(klass);
  GObjectClass* object_class = G_OBJECT_CLASS(klass);
  spidar::register_depth_meta();
  object_class->set_property = gst_spidar_depth_set_property;
  object_class->get_property = gst_spidar_depth_get_property;
  object_class->finalize = gst_spidar_depth_finalize;
  depth_properties().install(object_class);
  element_class->change_state = gst_spidar_depth_change_state;
  gst_element_class_set_static_metadata(element_class, "SPIDAR depth combiner", "Filter/Video",
                                        "Attaches depth images to the frames of a video",
                                        "gst-spidar");
  for (GstStaticPadTemplate* pad_template :
       {&frame_sink_template, &depth_template, &frame_src_template})
    gst_element_class_add_static_pad_template(element_class, pad_template);
}
