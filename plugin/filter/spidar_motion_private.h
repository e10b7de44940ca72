// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the files of the element share: its fields and its debug category.
#pragma once

#include <gst/gst.h>

#include "plugin/filter/motion_state.h"
#include "plugin/filter/spidar_motion.h"

GST_DEBUG_CATEGORY_EXTERN(gst_spidar_motion_debug);

struct _GstSpidarMotion {
  GstVideoFilter parent;

  spidar::filter::MotionState* state;
};

/// Class initialisation: frames and events on their way.
void gst_spidar_motion_install_stream(GstSpidarMotionClass* klass);
