// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the files of the element share: its fields and its debug category.
#pragma once

#include <gst/gst.h>

#include "plugin/filter/bus_warnings.h"
#include "plugin/filter/choice/motion_choice.h"
#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/engine/motion_engine.h"
#include "plugin/filter/spidar_motion.h"
#include "plugin/timing/step_watch.h"
#include "plugin/tracks/track_loader.h"

GST_DEBUG_CATEGORY_EXTERN(gst_spidar_motion_debug);

struct _GstSpidarMotion {
  GstVideoFilter parent;

  GMutex setting;                        // what is set reaches the engine in the order it was set
  spidar::MotionProperties* properties;  // object lock
  double largest_set_N;                  // object lock: max-force by others than presets
  gboolean opened;                       // object lock: READY or above
  spidar::MotionEngine* engine;
  spidar::MotionDisplay* display;
  spidar::TrackLoader* loader;
  spidar::FeltTrack* felt;
  gint unread_messages;  // atomic: that an application has not read
  gint window_changes;   // atomic: how many the window has still to follow
  spidar::StepWatch* steps;
  spidar::BusWarnings* warnings;
  spidar::MotionChoice* choice;
};

/// Class initialisation: frames and events on their way.
void gst_spidar_motion_install_stream(GstSpidarMotionClass* klass);
