// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The element `spidarextract`.
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_EXTRACT (gst_spidar_extract_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarExtract, gst_spidar_extract, GST, SPIDAR_EXTRACT, GstElement)

GST_ELEMENT_REGISTER_DECLARE(spidarextract)

G_END_DECLS
