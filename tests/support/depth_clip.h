// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/support/picture.h"

namespace spidar::test {

/// A short film of a scene with depth, in which only the camera moves: textured planes before a
/// pinhole camera, at several depths, and repeating patterns.
class DepthClip {
 public:
  static constexpr int kWidth = 424;
  static constexpr int kHeight = 240;
  static constexpr int kPictures = 10;

  enum class Kind {
    kRelief,    ///< cards before a wall; the camera travels
    kOrbit,     ///< the same, nearer; the camera circles and faces them
    kFacade,    ///< windows of a slanted house
    kRoof,      ///< rows of tiles, slanted
    kRailing,   ///< bars before a wall
    kSleepers,  ///< of the rails on which the camera travels
    kBricks,    ///< a wall that the camera pans over or shakes before
  };
  static constexpr int kKinds = 7;
  static const char* to_string(Kind kind);

  /// The same seed gives the same film.
  DepthClip(Kind kind, uint32_t seed);

  /// Picture n, with noise of 1.5 grey levels.
  Picture picture(int n) const;

 private:
  /// Grey level and opacity of a plane, each level at half the size of the one before.
  struct Skin {
    int width = 0, height = 0;
    std::vector<float> grey, opacity;
  };
  /// A rectangle: a texel is a unit of length. At depth kFocus_px, a texel covers a pixel.
  struct Plane {
    std::vector<Skin> skins;
    Eigen::Vector3d centre;
    Eigen::Vector3d right, down;  ///< of length 1
  };
  /// Position and rotation of the camera: world to camera.
  struct View {
    Eigen::Vector3d from;
    Eigen::Matrix3d turned;
  };
  static constexpr double kFocus_px = 400;

  template <typename Grey, typename Opacity>
  void add_plane(int width, int height, const Eigen::Vector3d& centre, double yaw_rad,
                 double pitch_rad, Grey&& grey, Opacity&& opacity);
  void draw(const Plane& plane, const View& view, std::vector<float>& greys) const;

  std::vector<Plane> planes_;  ///< the furthest first
  std::vector<View> views_;
  uint32_t seed_;
};

}  // namespace spidar::test
