// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The elements `spidarsink` and `spidarextract`.
#pragma once

#include <gst/base/gstbasesink.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_SINK (gst_spidar_sink_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarSink, gst_spidar_sink, GST, SPIDAR_SINK, GstBaseSink)

GST_ELEMENT_REGISTER_DECLARE(spidarsink)

#define GST_TYPE_SPIDAR_EXTRACT (gst_spidar_extract_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarExtract, gst_spidar_extract, GST, SPIDAR_EXTRACT, GstElement)

GST_ELEMENT_REGISTER_DECLARE(spidarextract)

G_END_DECLS

namespace spidar {
class HapticOutput;
}

/// The output of `self`, for tests that step the element.
spidar::HapticOutput& gst_spidar_sink_output(GstSpidarSink* self);
