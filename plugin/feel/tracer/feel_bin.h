// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_FEEL_BIN (gst_spidar_feel_bin_get_type())
/// A video filter for unmodified players: videoconvert ! spidarmotion ! videoconvert. spidarmotion
/// is added only when the video begins to play, so that programs that only examine films
/// (thumbnails, tags) open no device. If the device cannot be opened, the bin posts a warning, and
/// the video plays without it. Of several bins in a process, the first that plays has the device,
/// until it goes from PAUSED to READY. Frames in GPU memory stay there, unless there is an overlay:
/// spidarmotion gets small copies.
G_DECLARE_FINAL_TYPE(GstSpidarFeelBin, gst_spidar_feel_bin, GST, SPIDAR_FEEL_BIN, GstBin)

G_END_DECLS

/// The environment variable with properties of spidarmotion, one NAME=VALUE per line.
#define SPIDAR_FEEL_VARIABLE "SPIDAR_FEEL"

/// `properties` are those of spidarmotion, one NAME=VALUE per line; null: none. If `turns`, the
/// player ignores the tag image-orientation, so this bin turns the pictures, unless the sink does.
/// Returns a floating reference, or null when an element is missing, which is printed.
GstElement* gst_spidar_feel_bin_new(const char* properties, bool turns = false);
