// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set of what is touched in the picture.
#pragma once

#include <optional>

#include "core/touch/depth_picture.h"

namespace spidar {

/// Where the relief comes from.
enum class TouchKind { kOff, kLuma, kDepth, kDepthBelow };

struct TouchProperties {
  TouchKind kind = TouchKind::kOff;
  double relief_mm = 8;  ///< from black to white, or from far to near
  double stiffness_N_m = 500;
  double friction = 0.3;    ///< μs; μd is 0.8 of it
  double texture = 0;       ///< gain of the fine detail's slope
  double motion_share = 0;  ///< of the film's motion, which is felt besides

  /// Where in its frames the film has depth that is touched; nothing where they are all picture.
  std::optional<DepthLayout> packed() const {
    if (kind == TouchKind::kDepth) return DepthLayout::kRight;
    if (kind == TouchKind::kDepthBelow) return DepthLayout::kBelow;
    return std::nullopt;
  }
};

}  // namespace spidar
