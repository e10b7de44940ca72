/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/* The plugin is a part of this program: the elements are there without a plugin file, and one plays. */
#include <stdio.h>

#include <gst/gst.h>

GST_PLUGIN_STATIC_DECLARE(spidar);

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  GST_PLUGIN_STATIC_REGISTER(spidar);
  GstElementFactory* factory = gst_element_factory_find("spidarmotion");
  GstPlugin* plugin = factory ? gst_plugin_feature_get_plugin(GST_PLUGIN_FEATURE(factory)) : NULL;
  if (!plugin || gst_plugin_get_filename(plugin)) {
    fprintf(stderr, "spidarmotion does not come from this program\n");
    return 1;
  }
  gst_object_unref(plugin);
  gst_object_unref(factory);

  GstElement* pipeline = gst_parse_launch(
      "videotestsrc pattern=ball num-buffers=5 ! spidarmotion device=none ! fakesink", NULL);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message =
      gst_bus_timed_pop_filtered(bus, GST_CLOCK_TIME_NONE, GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
  const int status = GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS ? 0 : 1;
  gst_message_unref(message);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return status;
}
