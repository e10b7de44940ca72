// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The surface that an application lets the grip touch.
#pragma once

#include <atomic>
#include <memory>

#include <Eigen/Core>
#include <gst-spidar/device.h>

#include "core/touch/relief.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/touch/touch_rendering.h"

namespace gst_spidar {
inline namespace v0 {

/// Where a surface lies, and how stiff it may be.
struct SurfaceRange {
  Eigen::Vector2d half_size_m = Eigen::Vector2d::Zero();  ///< 0: there is nothing to touch
  double most_stiffness_N_m = 0;
  double drive_lag_s = 0;
};

/// The loop must not outlive this object.
class TouchedSurface {
 public:
  /// Sets the surface, see Device::set_surface(). Each call must have the same range and loop. One
  /// thread at a time.
  bool set(const Surface& surface, const SurfaceRange& range, spidar::HapticLoop& loop);
  /// Any thread, without waiting.
  void clear() noexcept;

 private:
  spidar::touch::Surface* free_slot() noexcept;

  spidar::touch::ReliefBuilder builder_;
  std::unique_ptr<spidar::touch::Mailbox> mailbox_;          ///< null before the first surface
  std::atomic<spidar::touch::Mailbox*> connected_{nullptr};  ///< the mailbox, for clear()
};

}  // namespace v0
}  // namespace gst_spidar
