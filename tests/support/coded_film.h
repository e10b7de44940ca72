// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tests/support/picture.h"

namespace spidar::test {

/// A film whose pictures hardly show how the camera moves after coding: a textured square before a
/// wall. Everything rests in the first pictures.
///
/// Encoders keep little of a faint wall, and noise least of all: HEVC and AV1 move the wall around
/// an object along with it, so that the camera seems to move.
struct CodedFilm {
  static constexpr int kPictures = 48;
  static constexpr int kRests = 8;  ///< pictures before the first motion

  enum class Wall { kPlain, kSlope, kShade, kFaint, kIce, kBlur, kDark, kMeadow };
  int width_px = 640;
  int height_px = 360;
  Wall wall = Wall::kPlain;
  std::string coding;              ///< options of ffmpeg
  Eigen::Vector2i pan_px{0, 0};    ///< motion of the wall from picture to picture
  int side_px = 0;                 ///< of the square; 0: there is none
  double radius_px = 1;            ///< of the circle of its motion
  Eigen::Vector2d step_px{0, 0};   ///< if not 0, its motion from picture to picture instead
  double speed_px = 0;             ///< on the circle
  double noise_grey = 5 / 1.7321;  ///< σ; as of ffmpeg's noise=alls=5

  /// Motion of the wall, and of the square on the screen, from picture n − 1 to n.
  Eigen::Vector2d wall_moved_px(int n) const;
  Eigen::Vector2d square_moved_px(int n) const;

  /// The pictures after coding and decoding; none if ffmpeg lacks that coding.
  std::vector<Picture> pictures() const;

 private:
  Eigen::Vector2i square_px(int n) const;
  std::vector<Picture> drawn() const;
};

/// Common codings, the fastest and others: name and options.
struct Coding {
  const char* name;
  const char* options;
};
extern const Coding kX264;
extern const Coding kX265;
extern const Coding kSvtAv1;
extern const Coding kX265Medium;
extern const Coding kSvtAv1Medium;

}  // namespace spidar::test
