// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The element `spidardepth`.
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_DEPTH (gst_spidar_depth_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarDepth, gst_spidar_depth, GST, SPIDAR_DEPTH, GstElement)

GST_ELEMENT_REGISTER_DECLARE(spidardepth)

G_END_DECLS
