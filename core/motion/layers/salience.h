// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tells objects from layers of the scene by how they move over several frames.
#pragma once

#include <limits>

#include <Eigen/Core>

#include "core/motion/layers/regions.h"

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

  /// Adds how far the region moved against the background in this frame, and how far the blocks
  /// around it do in this direction, as a standard deviation; 0 while the camera rests.
  void add_contrast(double moved_px, double noise_px, double interval_s);

  /// Motion over the noise around it, both as root mean squares over the last frames: in a scene
  /// with depth, parts of it that are further away than the background move against it like
  /// something that the camera follows, and stand out now and then. Infinite without noise.
  double contrast() const;

  /// Speed on the screen over speed relative to the background: above 1 for a layer, below 1 for
  /// what the camera follows, 1 while the camera rests or shakes in place. A layer keeps its ratio
  /// for as long as the camera travels, an object does not: the lowest mean over a whole kMean_s
  /// remains.
  double ratio() const;

  /// The same over the last frames only.
  double mean_ratio() const;

  /// Longer than a swing of a hand-held camera, which shakes at 2 … 10 Hz; from 0.2 to 0.8 s the
  /// results on real films are the same.
  static constexpr double kMean_s = 0.3;

 private:
  Eigen::Vector2d relative_px_s_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d background_px_s_ = Eigen::Vector2d::Zero();
  double seen_s_ = 0;
  double moved_px2_ = 0;  ///< mean square, against the background
  double noise_px2_ = 0;
  bool has_contrast_ = false;
  double least_ratio_ = std::numeric_limits<double>::infinity();
};

struct CameraMotion {
  bool moves = false;
  double blocks = 0;  ///< number of blocks that follow the background
};

/// √area × speed, px² of the field's picture. While the camera moves, the score is lower for what
/// looks like an effect of its translation in a scene with depth: a layer nearer than the
/// background extends over the border of the picture, and moves on the screen more than it moves
/// relative to the background. 0 for what clearly does so, is as large as the background, or hardly
/// differs from the noise around its model, for the edge of graphics, and for a single edge.
/// `was_followed`: it was an object before and may look a little more like a layer, and stand out a
/// little less from the noise.
double salience(const Region& region, const LayerEvidence& evidence, const CameraMotion& camera,
                bool was_followed);

}  // namespace spidar
