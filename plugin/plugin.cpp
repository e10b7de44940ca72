// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <gst/gst.h>

#include "plugin/filter/spidar_motion.h"
#include "plugin/tracks/track_elements.h"

static gboolean plugin_init(GstPlugin* plugin) {
  return GST_ELEMENT_REGISTER(spidarmotion, plugin) &&
         GST_ELEMENT_REGISTER(spidarextract, plugin) && GST_ELEMENT_REGISTER(spidarsink, plugin);
}

#define PACKAGE "gst-spidar"
GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, spidar,
                  "Feel the motion of a video with a SPIDAR haptic device", plugin_init,
                  PACKAGE_VERSION, "LGPL", "gst-spidar",
                  "https://journal.icter.org/index.php/ICTer/article/view/155")
