// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// \file
/// From pictures to a wrench, without GStreamer.
#pragma once

#include <chrono>
#include <memory>

#include <gst-spidar/export.h>
#include <gst-spidar/picture.h>
#include <gst-spidar/wrench.h>

namespace gst_spidar {
inline namespace v0 {

/// How speed becomes force: the element's property `controller`.
enum class Controller {
  kLinear,     ///< proportional to the speed; the largest speed so far is the largest force
  kNonlinear,  ///< an arc tangent of the speed
  /// An arc tangent that adapts to the scene; no force below the noise of the measurement.
  kAdaptive,
};

/// Which motion is felt: the element's property `motion`.
enum class FeltMotion {
  kMean,     ///< the mean motion of all points
  kObject,   ///< the motion of the dominant object against the background
  kCamera,   ///< the motion of the camera
  kObjects,  ///< the motions of all objects, weighted by area and nearness to the pointer
};

/// What is felt, and how strongly. The defaults are those of the GStreamer element.
struct MotionSettings {
  Controller controller = Controller::kNonlinear;  ///< how speed becomes force
  FeltMotion motion = FeltMotion::kObject;         ///< whose motion is felt
  double max_force_N = 3;                          ///< the largest force, finite and not negative
  /// How quickly force rises with speed, except with kLinear: half of the largest force is reached
  /// at 1 / `alpha_s_px` px/s in a picture of 480 rows. Finite and not negative.
  double alpha_s_px = 0.0025;
  /// Where kObjects is felt most, as a fraction of the picture's width: 0 is the left edge, 1 the
  /// right one. Finite.
  double pointer_x = 0.5;
  /// Where kObjects is felt most, as a fraction of the height: 0 is the top, 1 the bottom.
  double pointer_y = 0.5;
  /// How strongly growth is rendered as force towards the viewer. With 1, growth counts as the
  /// speed that it causes at half the picture's height from its centre; 0 turns it off. Finite, not
  /// negative.
  double depth_gain = 1;
  /// How strongly roll is rendered as torque about the view axis, in the same way as `depth_gain`.
  double roll_gain = 1;
};

/// What was found in one picture.
struct MotionResult {
  Wrench wrench;               ///< wanted, before the limits of a device; zero after a cut
  double velocity_x_px_s = 0;  ///< velocity of the felt motion, to the right
  double velocity_y_px_s = 0;  ///< downwards
  double growth_1_s = 0;       ///< relative change of lengths a second; positive comes nearer
  double roll_rad_s = 0;       ///< clockwise as seen
  bool has_picture_before =
      false;  ///< false when there is no picture to compare with; then everything above is zero
};

/// Measures the motion of a picture and computes the wrench, with the defaults of the GStreamer
/// element. Every function may be called in any thread: the library runs one call after another.
/// While the object is being moved or destroyed, no other call may run. After fork(), the child
/// must make its own object: analyze() and configure() of the copy throw std::runtime_error.
class GST_SPIDAR_API MotionToWrench {
 public:
  /// Starts with the defaults of MotionSettings.
  MotionToWrench();
  ~MotionToWrench();
  /// Afterwards, `other` may only be destroyed or assigned to.
  MotionToWrench(MotionToWrench&& other) noexcept;
  /// Afterwards, `other` may only be destroyed or assigned to.
  MotionToWrench& operator=(MotionToWrench&& other) noexcept;

  /// Analyses the next picture, shown at `time` on a clock of the caller's. The analysis starts
  /// anew, with a wrench of zero, at a cut and when the time is not after the previous one. Throws
  /// std::invalid_argument for a picture without data, a picture smaller than 16 × 16, and rows
  /// that overlap.
  MotionResult analyze(const GreyPicture& picture, std::chrono::nanoseconds time);

  /// Call this after a seek: the next picture has nothing to do with the previous one.
  void reset();

  /// Changes the settings from the next picture on. Throws std::invalid_argument and changes
  /// nothing when one of the settings is out of range.
  void configure(const MotionSettings& settings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace v0
}  // namespace gst_spidar
