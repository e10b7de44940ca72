// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/feel_bin.h"

#include <atomic>

#include "plugin/feel/feel_caps.h"
#include "plugin/gobject/downstream.h"

using spidar::Ref;

GST_DEBUG_CATEGORY_STATIC(gst_spidar_feel_debug);
#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_feel_debug

struct _GstSpidarFeelBin {
  GstBin parent;

  gchar* properties;
  GstCaps* felt;   // what spidarmotion accepts
  GstCaps* shown;  // the same in any size
  // The elements of the bin, in this order.
  GstElement* before;
  GstElement*
      middle;  // accepts the caps of spidarmotion in any size; kept while it is not in the bin
  GstElement* after;
  // The spidarmotion that has the device; nullptr: nothing is felt. It is in the place of the
  // middle while it is in the bin. Read by the streaming thread and written in state changes,
  // atomically.
  GstElement* motion;
  // Of the streaming thread:
  const GstElement* considered;  // the `motion` for which it was last decided what is in the bin
  bool said;                     // why it is not
};

G_DEFINE_FINAL_TYPE(GstSpidarFeelBin, gst_spidar_feel_bin, GST_TYPE_BIN)

/// The bin of this process that has the device.
static std::atomic<GstSpidarFeelBin*> device_owner{nullptr};

static bool take_device(GstSpidarFeelBin* self) {
  GstSpidarFeelBin* nobody = nullptr;
  return device_owner.compare_exchange_strong(nobody, self);
}

static void leave_device(GstSpidarFeelBin* self) {
  device_owner.compare_exchange_strong(self, nullptr);
}

/// Whether the application has put a spidarmotion into the pipeline itself.
static bool is_felt_already(GstSpidarFeelBin* self) {
  const Ref<GstObject> top = spidar::root_of(self);
  GstIterator* all =
      gst_bin_iterate_all_by_element_factory_name(GST_BIN(top.get()), "spidarmotion");
  GValue found = G_VALUE_INIT;
  GstIteratorResult result;
  // The application may add or remove elements meanwhile.
  while ((result = gst_iterator_next(all, &found)) == GST_ITERATOR_RESYNC) gst_iterator_resync(all);
  const bool felt = result == GST_ITERATOR_OK;
  g_value_unset(&found);
  gst_iterator_free(all);
  return felt;
}

static void set_properties(GstElement* motion, const char* properties) {
  gchar** lines = g_strsplit(properties, "\n", -1);
  for (gchar** line = lines; *line; ++line) {
    gchar* value = strchr(*line, '=');
    if (!value) continue;
    *value++ = '\0';
    if (g_object_class_find_property(G_OBJECT_GET_CLASS(motion), *line))
      gst_util_set_object_arg(G_OBJECT(motion), *line, value);
    else
      GST_WARNING_OBJECT(motion, "spidarmotion has no property %s", *line);
  }
  g_strfreev(lines);
}

/// The video continues: an error of the device becomes a warning in the player. Players may hide
/// warnings and information, so they are also printed on standard error.
static void pass_on(GstSpidarFeelBin* self, GstMessage* message) {
  GError* error = nullptr;
  gchar* details = nullptr;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR)
    gst_message_parse_error(message, &error, &details);
  else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING)
    gst_message_parse_warning(message, &error, &details);
  else
    gst_message_parse_info(message, &error, &details);
  g_printerr("spidar-feel: %s\n", error->message);
  const char* text = details ? details : "";
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_INFO)
    GST_ELEMENT_INFO(self, RESOURCE, SETTINGS, ("%s", error->message), ("%s", text));
  else
    GST_ELEMENT_WARNING(self, RESOURCE, OPEN_READ_WRITE, ("%s", error->message), ("%s", text));
  g_clear_error(&error);
  g_free(details);
}

/// Returns a spidarmotion that has opened its device, or nullptr when it could not. It is in no bin
/// yet, so its messages are collected on a bus of its own.
static Ref<GstElement> open_motion(GstSpidarFeelBin* self) {
  Ref<GstElement> motion = spidar::sunk(gst_element_factory_make("spidarmotion", nullptr));
  if (!motion) return nullptr;
  set_properties(motion.get(), self->properties);
  const Ref<GstBus> bus(gst_bus_new());
  gst_element_set_bus(motion.get(), bus.get());
  // Without a device, no spidarmotion is to look at the frames, whatever is asked for while it
  // plays.
  gint while_playing = 0;
  g_object_get(motion.get(), "on-device-error", &while_playing, nullptr);
  gst_util_set_object_arg(G_OBJECT(motion.get()), "on-device-error", "error");
  const bool opened =
      gst_element_set_state(motion.get(), GST_STATE_READY) != GST_STATE_CHANGE_FAILURE;
  g_object_set(motion.get(), "on-device-error", while_playing, nullptr);
  const auto kinds =
      static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_WARNING | GST_MESSAGE_INFO);
  while (GstMessage* message = gst_bus_pop_filtered(bus.get(), kinds)) {
    pass_on(self, message);
    gst_message_unref(message);
  }
  gst_element_set_bus(motion.get(), nullptr);
  gst_bus_set_flushing(bus.get(), TRUE);
  if (opened) return motion;
  gst_element_set_state(motion.get(), GST_STATE_NULL);
  return nullptr;
}

/// Without asking the elements upstream to negotiate again: `to` accepts what was accepted before.
/// theoradec fails when it has to during a seek.
static void link_quietly(GstElement* from, GstElement* to) {
  gst_element_link_pads_full(from, "src", to, "sink", kLinkQuietly);
}

/// Replaces `out` by `in` while no data flow between `before` and `after`.
static void replace_element(GstSpidarFeelBin* self, GstElement* out, GstElement* in) {
  gst_element_unlink_many(self->before, out, self->after, nullptr);
  // Not NULL: a spidarmotion keeps its device, at rest, for the next frames that it can measure.
  gst_element_set_state(out, GST_STATE_READY);
  gst_bin_remove(GST_BIN(self), out);
  gst_bin_add(GST_BIN(self), in);
  link_quietly(in, self->after);
  link_quietly(self->before, in);
  spidar::follow_state(GST_ELEMENT(self), in);
}

static bool has(GstSpidarFeelBin* self, GstElement* element) {
  return gst_object_has_as_parent(GST_OBJECT(element), GST_OBJECT(self));
}

/// Puts spidarmotion into the bin if it accepts `caps`, and takes it out if it does not. Called in
/// the streaming thread, before the data reach `before`.
static void consider(GstSpidarFeelBin* self, GstElement* motion, const GstCaps* caps) {
  self->considered = motion;
  if (!motion) return;
  const bool fits = spidar::fits_size(caps, self->felt);
  if (fits != has(self, motion))
    replace_element(self, fits ? self->middle : motion, fits ? motion : self->middle);
  if (fits || self->said) return;
  self->said = true;
  g_printerr("spidar-feel: %s\n", spidar::say_sizes(caps, self->felt).c_str());
}

/// The probe stays on the pad: data may flow at any time, also while the bin begins to play.
static GstPadProbeReturn before_data(GstPad* pad, GstPadProbeInfo* info, gpointer data) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(data);
  auto* motion = static_cast<GstElement*>(g_atomic_pointer_get(&self->motion));
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) != GST_EVENT_CAPS) return GST_PAD_PROBE_OK;
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    consider(self, motion, caps);
  } else if (motion != self->considered) {
    GstCaps* caps = gst_pad_get_current_caps(pad);
    if (caps) consider(self, motion, caps);
    gst_clear_caps(&caps);
  }
  return GST_PAD_PROBE_OK;
}

/// Answers for spidarmotion like for the middle. Otherwise an element before the bin would find
/// that frames of another size do not fit, before their caps reach the bin.
static GstPadProbeReturn answer_query(GstPad*, GstPadProbeInfo* info, gpointer data) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(data);
  GstQuery* query = GST_PAD_PROBE_INFO_QUERY(info);
  if (GST_QUERY_TYPE(query) != GST_QUERY_CAPS) return GST_PAD_PROBE_OK;
  GstCaps* filter = nullptr;
  gst_query_parse_caps(query, &filter);
  const Ref<GstCaps> wanted(
      filter ? gst_caps_intersect_full(filter, self->shown, GST_CAPS_INTERSECT_FIRST)
             : gst_caps_ref(self->shown));
  const Ref<GstPad> pad(gst_element_get_static_pad(self->after, "sink"));
  const Ref<GstCaps> accepted(gst_pad_query_caps(pad.get(), wanted.get()));
  gst_query_set_caps_result(query, accepted.get());
  return GST_PAD_PROBE_HANDLED;
}

/// After an element was replaced, `before` negotiates and sends caps and segment again. When a seek
/// flushes the bin meanwhile, that fails, and the player would stop with an error. The frame is one
/// that the seek drops anyway. The flush has marked the pad of the bin before it reaches the
/// elements in it.
static GstFlowReturn failed_or_flushed(GstPad* pad, GstFlowReturn result) {
  if (result != GST_FLOW_NOT_NEGOTIATED && result != GST_FLOW_ERROR) return result;
  GST_OBJECT_LOCK(pad);
  const bool flushing = GST_PAD_IS_FLUSHING(pad);
  GST_OBJECT_UNLOCK(pad);
  return flushing ? GST_FLOW_FLUSHING : result;
}

static GstFlowReturn chain(GstPad* pad, GstObject* parent, GstBuffer* buffer) {
  return failed_or_flushed(pad, gst_proxy_pad_chain_default(pad, parent, buffer));
}

static GstFlowReturn chain_list(GstPad* pad, GstObject* parent, GstBufferList* list) {
  return failed_or_flushed(pad, gst_proxy_pad_chain_list_default(pad, parent, list));
}

static void begin_to_feel(GstSpidarFeelBin* self) {
  if (self->motion || is_felt_already(self) || !take_device(self)) return;
  if (Ref<GstElement> motion = open_motion(self))
    g_atomic_pointer_set(&self->motion, motion.release());
  else
    leave_device(self);
}

/// Called while the pads of all elements are inactive.
static void stop_feeling(GstSpidarFeelBin* self) {
  if (!self->motion) return;
  if (has(self, self->motion)) replace_element(self, self->motion, self->middle);
  const Ref<GstElement> motion(self->motion);
  g_atomic_pointer_set(&self->motion, static_cast<GstElement*>(nullptr));
  self->considered = nullptr;
  self->said = false;
  gst_element_set_state(motion.get(), GST_STATE_NULL);
  leave_device(self);
}

static GstStateChangeReturn gst_spidar_feel_bin_change_state(GstElement* element,
                                                             GstStateChange transition) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(element);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING) begin_to_feel(self);
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_spidar_feel_bin_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) stop_feeling(self);
  return result;
}

static void gst_spidar_feel_bin_finalize(GObject* object) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(object);
  if (self->middle) gst_element_set_state(self->middle, GST_STATE_NULL);
  gst_clear_object(&self->middle);
  gst_clear_caps(&self->felt);
  gst_clear_caps(&self->shown);
  g_free(self->properties);
  G_OBJECT_CLASS(gst_spidar_feel_bin_parent_class)->finalize(object);
}

static void gst_spidar_feel_bin_init(GstSpidarFeelBin*) {}

static void gst_spidar_feel_bin_class_init(GstSpidarFeelBinClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_spidar_feel_debug, "spidarfeel", 0, "players that are felt");
  G_OBJECT_CLASS(klass)->finalize = gst_spidar_feel_bin_finalize;
  GST_ELEMENT_CLASS(klass)->change_state = gst_spidar_feel_bin_change_state;
  gst_element_class_set_static_metadata(
      GST_ELEMENT_CLASS(klass), "Felt video", "Filter/Analyzer/Video/Hardware",
      "spidarmotion for players that offer no way to add a filter", "The gst-spidar authors");
}

static void add_probe(GstSpidarFeelBin* self, const char* name, int what,
                      GstPadProbeCallback callback) {
  const Ref<GstPad> pad(gst_element_get_static_pad(self->before, name));
  gst_pad_add_probe(pad.get(), static_cast<GstPadProbeType>(what), callback, self, nullptr);
}

static GstPad* add_ghost_pad(GstSpidarFeelBin* self, GstElement* element, const char* name) {
  const Ref<GstPad> target(gst_element_get_static_pad(element, name));
  GstPad* pad = gst_ghost_pad_new(name, target.get());
  gst_element_add_pad(GST_ELEMENT(self), pad);
  return pad;
}

GstElement* gst_spidar_feel_bin_new(const char* properties) {
  GstCaps* caps = spidar::motion_caps();
  GstElement* before = gst_element_factory_make("videoconvert", nullptr);
  GstElement* middle = gst_element_factory_make("capsfilter", nullptr);
  GstElement* after = gst_element_factory_make("videoconvert", nullptr);
  GstElement* result = nullptr;
  if (caps && before && middle && after) {
    auto* self = static_cast<GstSpidarFeelBin*>(g_object_new(GST_TYPE_SPIDAR_FEEL_BIN, nullptr));
    self->properties = g_strdup(properties ? properties : "");
    self->before = before;
    self->middle = GST_ELEMENT(gst_object_ref_sink(middle));
    self->after = after;
    self->felt = gst_caps_ref(caps);
    self->shown = spidar::in_any_size(caps);
    g_object_set(middle, "caps", self->shown, nullptr);
    gst_bin_add_many(GST_BIN(self), before, middle, after, nullptr);
    gst_element_link_many(before, middle, after, nullptr);
    add_probe(self, "sink",
              GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM | GST_PAD_PROBE_TYPE_BUFFER |
                  GST_PAD_PROBE_TYPE_BUFFER_LIST,
              before_data);
    add_probe(self, "src", GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM | GST_PAD_PROBE_TYPE_PUSH,
              answer_query);
    GstPad* sink = add_ghost_pad(self, before, "sink");
    gst_pad_set_chain_function(sink, chain);
    gst_pad_set_chain_list_function(sink, chain_list);
    add_ghost_pad(self, after, "src");
    result = GST_ELEMENT(self);
  } else {
    gst_clear_object(&before);
    gst_clear_object(&middle);
    gst_clear_object(&after);
    g_printerr(
        "spidar-feel: the elements videoconvert or capsfilter are missing; nothing is felt\n");
  }
  gst_clear_caps(&caps);
  return result;
}

gboolean gst_spidar_feel_bin_is_felt(GstSpidarFeelBin* self) {
  GST_STATE_LOCK(self);
  const gboolean felt = self->motion != nullptr;
  GST_STATE_UNLOCK(self);
  return felt;
}

gboolean gst_spidar_feel_bin_passes(GstSpidarFeelBin* self, GstCaps* caps) {
  GstCaps* accepted = nullptr;
  g_object_get(self->middle, "caps", &accepted, nullptr);
  const gboolean passes = gst_caps_is_subset(caps, accepted);
  gst_caps_unref(accepted);
  return passes;
}
