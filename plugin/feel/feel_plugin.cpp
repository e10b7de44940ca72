// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A plugin of its own, so that GStreamer loads the tracer only for spidar-feel.
#include <gst/gst.h>

#include "plugin/feel/feel_tracer.h"

#define PACKAGE "gst-spidar"
GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, spidarfeel,
                  "Lets the videos of any GStreamer player be felt",
                  gst_spidar_feel_tracer_register, PACKAGE_VERSION, "LGPL", "gst-spidar",
                  "https://journal.icter.org/index.php/ICTer/article/view/155")
