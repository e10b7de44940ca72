// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/motion_rows.h"

namespace spidar {

std::vector<MotionRow> display_rows() {
  return {
      MotionRow::on_off(
          {"overlay", "Overlay",
           "Draw tracks and force as arrows into the video. Frames that other elements "
           "hold are copied first"},
          kPlaying, KEPT_IN(display.overlay)),
      MotionRow::number(
          {"arrow-scale", "Arrow scale",
           "Length of a track's arrow, as a multiple of the point's displacement since the "
           "previous frame"},
          0.1, 100, kControllable, KEPT_IN(display.arrow_scale)),
      MotionRow::on_off(
          {"debug-window", "Debug window",
           "Show picture, tracks, grip, tensions and settings in a window. Becomes false "
           "when the user closes the window"},
          kPlaying, KEPT_IN(display.debug_window)),
      MotionRow::on_off(
          {"attach-meta", "Attach meta",
           "Attach motion, tracks, wrench and the boxes of objects to each frame as metas. The "
           "picture is neither copied nor changed"},
          kPlaying, KEPT_IN(display.attach_meta)),
  };
}

}  // namespace spidar
