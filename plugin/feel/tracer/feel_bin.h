// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_SPIDAR_FEEL_BIN (gst_spidar_feel_bin_get_type())
/// A video filter for players that do not know it: videoconvert ! spidarmotion ! videoconvert,
/// where spidarmotion appears only once the video has begun to play: programs that examine films
/// without playing them (thumbnails, tags) open no device. A device that cannot be opened is a
/// warning, and the video plays without it. Of several bins in a process, the first that plays has
/// the device, until it leaves PAUSED for READY. Frames in GPU memory stay there, unless an overlay
/// is wanted: spidarmotion gets small copies.
G_DECLARE_FINAL_TYPE(GstSpidarFeelBin, gst_spidar_feel_bin, GST, SPIDAR_FEEL_BIN, GstBin)

G_END_DECLS

/// The environment variable with properties of spidarmotion, a line NAME=VALUE each.
#define SPIDAR_FEEL_VARIABLE "SPIDAR_FEEL"

/// `properties` are those of spidarmotion, a line NAME=VALUE each; null: none. `turns` says that
/// the player shows pictures as they are stored, so those whose tag image-orientation says
/// otherwise are turned here, unless its sink does so. Returns a floating reference, or null when
/// an element is missing, which is printed.
GstElement* gst_spidar_feel_bin_new(const char* properties, bool turns = false);
