// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the files of the element share: its fields, its log, and how errors reach the bus.
#pragma once

#include <exception>

#include <gst/gst.h>

#include "plugin/display/motion_display.h"
#include "plugin/motion_engine.h"
#include "plugin/reports/complaints.h"
#include "plugin/spidar_motion.h"
#include "plugin/timing/step_watch.h"

GST_DEBUG_CATEGORY_EXTERN(gst_spidar_motion_debug);

struct _GstSpidarMotion {
  GstVideoFilter parent;

  GMutex setting;                        // what is set reaches the engine in the order it was set
  spidar::MotionProperties* properties;  // object lock
  gboolean opened;                       // object lock: READY or above
  spidar::MotionEngine* engine;
  spidar::MotionDisplay* display;
  gboolean track_chosen;  // streaming thread: for this stream
  gint window_changes;    // atomic: how many the window has still to follow
  spidar::StepWatch* steps;
  spidar::Complaints* complaints;
};

/// Class initialisation: frames and events on their way.
void gst_spidar_motion_install_stream(GstSpidarMotionClass* klass);

/// C++ ends here: whatever is thrown becomes an error on the bus.
template <typename Function>
bool guarded(GstSpidarMotion* self, const char* doing, Function&& function) {
  try {
    function();
    return true;
  } catch (const spidar::ProfileError& e) {
    GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", e.what()), ("while %s", doing));
  } catch (const spidar::DeviceError& e) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ_WRITE, ("%s", e.what()), ("while %s", doing));
  } catch (const std::exception& e) {
    GST_ELEMENT_ERROR(self, LIBRARY, FAILED, ("%s", e.what()), ("while %s", doing));
  }
  return false;
}
