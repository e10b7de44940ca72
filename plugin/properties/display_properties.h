// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set of how motion and force are shown.
#pragma once

namespace spidar {

/// What is drawn into the video.
enum class OverlayKind {
  kNone,
  kForce,   ///< outlines of objects, the force, finger and contact
  kTracks,  ///< arrows of the motion, too
};

struct DisplayProperties {
  OverlayKind overlay = OverlayKind::kNone;
  double arrow_scale = 4;
  bool debug_window = false;
  bool attach_meta = false;
};

}  // namespace spidar
