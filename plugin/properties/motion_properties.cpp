// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/motion_properties.h"

#include "plugin/properties/device_rows.h"
#include "plugin/properties/motion_rows.h"

namespace spidar {
namespace {

MotionRow device_row() {
  return MotionRow::text(
      {"device", "Device",
       "Haptic device: 'sim' (simulated SPIDAR), a board that 'spidarctl list' prints "
       "('usb', 'usb:ID', 'uart:PATH', 'mouse', 'ff', 'falcon', 'inverse3'), or 'none' (analysis "
       "only). "
       "Opened in the change from NULL to READY"},
      kReady, KEPT_IN(device));
}

std::vector<MotionRow> point_rows() {
  return {
      MotionRow::choice<TrackerQuality>(
          {"quality", "Quality",
           "Trade-off between computing time and error of the points that refine the motion of "
           "blocks; no effect with motion=mean"},
          "GstSpidarMotionQuality",
          {{TrackerQuality::kFast, "Only in the reduced picture: least time, largest error",
            "fast"},
           {TrackerQuality::kBalanced, "Refined in the frame", "balanced"},
           {TrackerQuality::kFine, "More points", "fine"}},
          kControllable, KEPT_IN(analyzer.tracker.quality)),
      MotionRow::count(
          {"max-features", "Maximum features", "Largest number of points that are tracked at once"},
          1, 10000, kControllable, KEPT_IN(analyzer.tracker.max_features)),
      MotionRow::number(
          {"quality-level", "Quality level",
           "With motion=mean: weakest corner that is tracked, as a share of the strongest "
           "corner's smaller eigenvalue (Shi-Tomasi)"},
          1e-6, 1, kControllable, KEPT_IN(analyzer.tracker.quality_level)),
      MotionRow::number(
          {"min-distance", "Minimum distance",
           "With motion=mean: smallest distance between two tracked points, in pixels of a "
           "frame 480 lines high"},
          0, 480, kControllable, KEPT_IN(analyzer.tracker.min_distance_px)),
  };
}

/// From `ts-offset` to `track`: what an application asks of the element as a whole.
std::vector<MotionRow> element_rows() {
  return {
      MotionRow::offset(
          {"ts-offset", "Timestamp offset",
           "Render the force later (positive) or earlier (negative) than the frame is "
           "shown, in nanoseconds"},
          -10 * GST_SECOND, 10 * GST_SECOND, kControllable, KEPT_IN(ts_offset_ns)),
      on_device_error_row<MotionProperties>(),
      MotionRow::on_off(
          {"post-messages", "Post messages",
           "Post a 'spidar-motion' element message for each frame, as long as fewer than "
           "1000 of them wait on the bus"},
          kPlaying, KEPT_IN(post_messages)),
      MotionRow::text(
          {"trace", "Trace",
           "Write one line for each frame with motion and force to this file: CSV, or JSON "
           "with background and objects if the name ends in .jsonl. Opened in the change from "
           "READY to PAUSED"},
          kReady, KEPT_IN(trace)),
      haptic_trace_row<MotionProperties>(),
      MotionRow::statistics(
          {"stats", "Statistics",
           "Statistics: frames, analysis time, state and timing of the haptic loop"}),
      MotionRow::on_off(
          {"mute", "Mute",
           "While true, no force: it ramps to zero at once, and returns with the next "
           "frame after the property is set to false"},
          kControllable, KEPT_IN(mute)),
      MotionRow::text(
          {"track", "Track",
           "Play this haptic track by stream time instead of analysing frames: a file, or "
           "'auto' for the one beside the film (FILM.mp4.haptic.flac, .mka or .wav). Read "
           "with the first frame of a stream"},
          kReady, KEPT_IN(track)),
  };
}

}  // namespace

const PropertyTable<MotionProperties>& motion_properties() {
  // Never destroyed: a thread may still set a property while the process ends.
  static const auto& table =
      *new PropertyTable<MotionProperties>{{device_row(), profile_row<MotionProperties>()},
                                           feel_rows(),
                                           point_rows(),
                                           element_rows(),
                                           display_rows(),
                                           touch_rows()};
  return table;
}

}  // namespace spidar
