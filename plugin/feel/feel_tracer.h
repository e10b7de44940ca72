// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tracer `spidarfeel`.
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_FEEL_TRACER (gst_spidar_feel_tracer_get_type())
GType gst_spidar_feel_tracer_get_type();
gboolean gst_spidar_feel_tracer_register(GstPlugin* plugin);

G_END_DECLS

/// The environment variable with properties of spidarmotion, a line NAME=VALUE each.
#define SPIDAR_FEEL_VARIABLE "SPIDAR_FEEL"
