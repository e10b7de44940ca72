// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/feel_bin.h"

#include <atomic>

#include "plugin/feel/follow_state.h"

GST_DEBUG_CATEGORY_STATIC(spidar_feel_debug);
#define GST_CAT_DEFAULT spidar_feel_debug

struct _GstSpidarFeelBin {
  GstBin parent;

  gchar* properties;
  // The elements of the bin, in this order.
  GstElement* before;
  GstElement* middle;  // accepts the caps of spidarmotion; kept while it is not in the bin
  GstElement* after;
  GstElement* motion;  // the spidarmotion that has the device; nullptr: nothing is felt
  gulong probe;        // on the pad before the middle, until `motion` is in its place
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
  GstObject* top = GST_OBJECT(gst_object_ref(self));
  while (GstObject* above = gst_object_get_parent(top)) {
    gst_object_unref(top);
    top = above;
  }
  GstIterator* all = gst_bin_iterate_all_by_element_factory_name(GST_BIN(top), "spidarmotion");
  GValue found = G_VALUE_INIT;
  const bool felt = gst_iterator_next(all, &found) == GST_ITERATOR_OK;
  g_value_unset(&found);
  gst_iterator_free(all);
  gst_object_unref(top);
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
static GstElement* open_motion(GstSpidarFeelBin* self) {
  GstElement* motion = gst_element_factory_make("spidarmotion", nullptr);
  if (!motion) return nullptr;
  gst_object_ref_sink(motion);
  set_properties(motion, self->properties);
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(motion, bus);
  const bool opened = gst_element_set_state(motion, GST_STATE_READY) != GST_STATE_CHANGE_FAILURE;
  const auto kinds =
      static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_WARNING | GST_MESSAGE_INFO);
  while (GstMessage* message = gst_bus_pop_filtered(bus, kinds)) {
    pass_on(self, message);
    gst_message_unref(message);
  }
  gst_element_set_bus(motion, nullptr);
  gst_bus_set_flushing(bus, TRUE);
  gst_object_unref(bus);
  if (opened) return motion;
  gst_element_set_state(motion, GST_STATE_NULL);
  gst_object_unref(motion);
  return nullptr;
}

/// Without asking the elements upstream to negotiate again: `to` accepts what was accepted before.
/// theoradec fails when it has to during a seek.
static void link_quietly(GstElement* from, GstElement* to) {
  gst_element_link_pads_full(from, "src", to, "sink", kLinkQuietly);
}

/// Replaces `out` by `in` while no data flow between `before` and `after`.
static void exchange(GstSpidarFeelBin* self, GstElement* out, GstElement* in) {
  gst_element_unlink_many(self->before, out, self->after, nullptr);
  gst_element_set_state(out, GST_STATE_NULL);
  gst_bin_remove(GST_BIN(self), out);
  gst_bin_add(GST_BIN(self), in);
  link_quietly(in, self->after);
  link_quietly(self->before, in);
  spidar::follow_state(GST_ELEMENT(self), in);
}

static GstPadProbeReturn put_in(GstPad*, GstPadProbeInfo*, gpointer data) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(data);
  exchange(self, self->middle, self->motion);
  self->probe = 0;
  return GST_PAD_PROBE_REMOVE;
}

static void begin_to_feel(GstSpidarFeelBin* self) {
  if (self->motion || is_felt_already(self) || !take_device(self)) return;
  self->motion = open_motion(self);
  if (!self->motion) {
    leave_device(self);
    return;
  }
  GstPad* pad = gst_element_get_static_pad(self->before, "src");
  self->probe = gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BLOCK_DOWNSTREAM, put_in, self, nullptr);
  gst_object_unref(pad);
}

/// Called while the pads of all elements are inactive.
static void stop_feeling(GstSpidarFeelBin* self) {
  if (!self->motion) return;
  if (self->probe != 0) {
    GstPad* pad = gst_element_get_static_pad(self->before, "src");
    gst_pad_remove_probe(pad, self->probe);
    gst_object_unref(pad);
    self->probe = 0;
    gst_element_set_state(self->motion, GST_STATE_NULL);
  } else {
    exchange(self, self->motion, self->middle);
  }
  gst_clear_object(&self->motion);
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
  gst_clear_object(&self->middle);
  g_free(self->properties);
  G_OBJECT_CLASS(gst_spidar_feel_bin_parent_class)->finalize(object);
}

static void gst_spidar_feel_bin_init(GstSpidarFeelBin*) {}

static void gst_spidar_feel_bin_class_init(GstSpidarFeelBinClass* klass) {
  GST_DEBUG_CATEGORY_INIT(spidar_feel_debug, "spidarfeel", 0, "players that are felt");
  G_OBJECT_CLASS(klass)->finalize = gst_spidar_feel_bin_finalize;
  GST_ELEMENT_CLASS(klass)->change_state = gst_spidar_feel_bin_change_state;
  gst_element_class_set_static_metadata(
      GST_ELEMENT_CLASS(klass), "Felt video", "Filter/Effect/Video",
      "spidarmotion for players that offer no way to add a filter", "gst-spidar");
}

static void add_ghost_pad(GstSpidarFeelBin* self, GstElement* element, const char* name) {
  GstPad* pad = gst_element_get_static_pad(element, name);
  gst_element_add_pad(GST_ELEMENT(self), gst_ghost_pad_new(name, pad));
  gst_object_unref(pad);
}

/// Caps that spidarmotion accepts; nullptr when the element does not exist.
static GstCaps* motion_caps() {
  GstElementFactory* factory = gst_element_factory_find("spidarmotion");
  if (!factory) return nullptr;
  GstCaps* caps = nullptr;
  for (const GList* item = gst_element_factory_get_static_pad_templates(factory); item;
       item = item->next) {
    auto* pad = static_cast<GstStaticPadTemplate*>(item->data);
    if (pad->direction == GST_PAD_SINK && !caps) caps = gst_static_pad_template_get_caps(pad);
  }
  gst_object_unref(factory);
  return caps;
}

GstElement* gst_spidar_feel_bin_new(const char* properties) {
  GstCaps* caps = motion_caps();
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
    g_object_set(middle, "caps", caps, nullptr);
    gst_bin_add_many(GST_BIN(self), before, middle, after, nullptr);
    gst_element_link_many(before, middle, after, nullptr);
    add_ghost_pad(self, before, "sink");
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
