// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tests/support/picture.h"
#include "tests/support/spline_sheet.h"

namespace spidar::test {

/// A position over time, in frames: maps the sheet's own pixels to those of the picture, both
/// relative to the centre of the frame, x right, y down.
using SheetPath = std::function<Eigen::Affine2d(double frame)>;

/// A textured ellipse.
struct FilmObject {
  std::shared_ptr<const SplineSheet> sheet;
  Eigen::Vector2d radii_px;
  SheetPath pose;
};

struct FilmBackground {
  std::shared_ptr<const SplineSheet> sheet;
  SheetPath pose;
};

struct Light {
  double gain = 1;
  double offset = 0;
};

class Film {
 public:
  Film(int width, int height) : picture_(width, height) {}

  FilmBackground background;
  std::vector<FilmObject> objects;  ///< the last ones are in front
  /// The first frame of another scene; < 0: none.
  int cut_at = -1;
  FilmBackground after_cut;
  double shutter = 0;  ///< of the time between frames
  double blur_px = 0;  ///< σ of a Gaussian
  double noise = 0;    ///< σ, grey levels
  uint32_t noise_seed = 1;
  std::function<Light(int frame)> light;

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }
  Eigen::Vector2d middle_px() const { return {(width() - 1) / 2.0, (height() - 1) / 2.0}; }

  /// Valid until the next call.
  ImageView draw(int frame);

  /// The displacement of an object relative to the background.
  Eigen::Vector2d object_displacement_px(int frame, const FilmObject& object,
                                         const Eigen::Vector2d& from_px) const;

 private:
  const FilmBackground& background_at(int frame) const {
    return cut_at >= 0 && frame >= cut_at ? after_cut : background;
  }
  int exposures_at(int frame) const;
  void add_exposure(double time, const FilmBackground& behind, float weight);
  void add_object(double time, const FilmObject& object);
  void blur();
  void develop(int frame);

  Picture picture_;
  std::vector<float> sharp_;    ///< one exposure, by rows
  std::vector<float> exposed_;  ///< their sum
};

}  // namespace spidar::test
