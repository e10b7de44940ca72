// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Stands for another version of the plugin that is installed.
#include <gst/gst.h>

static gboolean plugin_init(GstPlugin* plugin) {
  return gst_element_register(plugin, "spidarmotion", GST_RANK_NONE, GST_TYPE_BIN);
}

#define PACKAGE "gst-spidar"
GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, spidar, "an old version", plugin_init,
                  "0.0", "LGPL", "gst-spidar", "Unknown package origin")
