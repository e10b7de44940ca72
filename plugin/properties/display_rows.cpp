// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/motion_rows.h"

namespace spidar {

std::vector<MotionRow> display_rows() {
  return {
      MotionRow::choice<OverlayKind>(
          {"overlay", "Overlay",
           "What is drawn into the video. Frames that other elements hold are copied first"},
          "GstSpidarOverlay",
          {{OverlayKind::kNone, "Nothing: frames are passed on as they are", "none"},
           {OverlayKind::kForce, "The outlines of objects and the force that is felt", "force"},
           {OverlayKind::kTracks, "Small arrows of the motion, too", "tracks"}},
          kPlaying, KEPT_IN(display.overlay)),
      MotionRow::number(
          {"arrow-scale", "Arrow scale",
           "Length of a track's arrow, as a multiple of the point's displacement since the "
           "previous frame"},
          0.1, 100, kControllable, KEPT_IN(display.arrow_scale)),
      MotionRow::on_off(
          {"debug-window", "Debug window",
           "Show picture, tracks, grip, tensions and settings in a window. Becomes false "
           "when the window is closed or cannot be opened"},
          kPlaying, KEPT_IN(display.debug_window)),
      MotionRow::on_off(
          {"attach-meta", "Attach meta",
           "Attach motion, tracks, wrench and the boxes of objects to each frame as metas. The "
           "picture is neither copied nor changed"},
          kPlaying, KEPT_IN(display.attach_meta)),
  };
}

}  // namespace spidar
