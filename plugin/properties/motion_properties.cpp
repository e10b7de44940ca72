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
       "Haptic device: 'sim' (simulated SPIDAR), one that 'spidarctl list' prints, or 'none' "
       "(analysis only). Opened in the change from NULL to READY"},
      kReady, KEPT_IN(device));
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
           "File that gets a line for each frame, with motion and force: .csv, or .jsonl with "
           "background and objects too. Opened before PAUSED"},
          kReady, KEPT_IN(trace)),
      haptic_trace_row<MotionProperties>(),
      MotionRow::statistics(
          {"stats", "Statistics",
           "Statistics: frames, analysis time, state and timing of the haptic loop"}),
      MotionRow::on_off(
          {"mute", "Mute",
           "No force: it ramps to zero at once, and returns with the next frame after this is "
           "false"},
          kControllable, KEPT_IN(mute)),
      MotionRow::text(
          {"track", "Track",
           "Haptic track that is felt instead of analysing frames: a file, or 'auto' for "
           "FILM.mp4.haptic.flac, .mka or .wav, or the track inside the film"},
          kReady, KEPT_IN(track)),
  };
}

}  // namespace

const PropertyTable<MotionProperties>& motion_properties() {
  // Never destroyed: a thread may still set a property while the process ends.
  static const auto& table =
      *new PropertyTable<MotionProperties>{{device_row(), profile_row<MotionProperties>()},
                                           feel_rows(),
                                           element_rows(),
                                           display_rows(),
                                           touch_rows()};
  return table;
}

}  // namespace spidar
