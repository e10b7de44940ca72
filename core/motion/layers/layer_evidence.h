// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tells layers of the scene from objects by how they move over several frames.
#pragma once

#include <limits>

#include <Eigen/Core>

namespace spidar {

/// The motion of one region over its last frames, in px of the field's picture in a second.
///
/// A part of the scene that is nearer than the background also moves against it when the camera
/// travels. But it moves with the background, and the more, the faster the camera is, so that its
/// motion on the screen is larger than its motion relative to the background. An object that a
/// camera follows is nearer to rest on the screen than to the background. Both are compared as
/// means over kMean_s: in a single frame, errors of the camera's model and the swings of a
/// hand-held camera are as large as either motion.
class LayerEvidence {
 public:
  /// Adds a frame: motion relative to the background, and motion of the background at that place.
  void add(const Eigen::Vector2d& relative_px_s, const Eigen::Vector2d& background_px_s,
           double interval_s);

  /// Adds whether the region stood out from the noise around it in this frame.
  void add_contrast(bool stands_out);

  /// Speed on the screen over speed relative to the background: above 1 for a layer, below 1 for
  /// what the camera follows, 1 while the camera rests or shakes in place. A layer keeps its ratio
  /// for as long as the camera travels, an object does not: the lowest mean over a whole kMean_s
  /// remains.
  double ratio() const;

  /// The same over the last frames only.
  double mean_ratio() const;

  /// Whether it rests on the screen while the camera shakes or changes its speed, as only graphics
  /// do: what is in the scene shakes with it, and what a camera follows drifts on the screen.
  bool is_on_screen() const;

  /// Whether it stood out from the noise in most frames so far, as an object does. In a scene with
  /// depth, parts of it that are further away than the background move against it like something
  /// that the camera follows, and stand out now and then.
  bool mostly_stood_out() const;

  /// Longer than a swing of a hand-held camera, which shakes at 2 … 10 Hz; from 0.2 to 0.8 s the
  /// results on real films are the same.
  static constexpr double kMean_s = 0.3;

 private:
  Eigen::Vector2d relative_px_s_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d background_px_s_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d newest_px_s_ = Eigen::Vector2d::Zero();  ///< relative to the background
  double screen_px_s_ = 0;                                 ///< mean speed on the screen
  double changes_px_s_ = 0;  ///< and of the change of the relative velocity from frame to frame
  double seen_s_ = 0;
  int contrasts_ = 0;  ///< frames in which it is known whether it stood out
  int stood_out_ = 0;  ///< and those of them in which it did
  double least_ratio_ = std::numeric_limits<double>::infinity();
};

}  // namespace spidar
