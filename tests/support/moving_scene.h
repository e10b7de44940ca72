// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A camera that pans, zooms and rolls over a texture, and discs that move in front of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tests/support/picture.h"
#include "tests/support/texture.h"

namespace spidar::test {

/// The placement of a drawn thing, in pixels from the centre of the frame (x right, y down).
struct Placement {
  Eigen::Vector2d centre_px{0, 0};
  double scale = 1;
  double angle_rad = 0;  ///< clockwise as seen on the screen

  bool operator==(const Placement& other) const {
    return centre_px == other.centre_px && scale == other.scale && angle_rad == other.angle_rad;
  }
  /// Maps a position of the frame to the thing itself.
  Eigen::Vector2d on_thing(const Eigen::Vector2d& frame_px) const {
    return Eigen::Rotation2Dd(-angle_rad) * (frame_px - centre_px) / scale;
  }
};

class MovingScene {
 public:
  /// Grey level at a position, px from the centre.
  using Skin = std::function<double(const Eigen::Vector2d& at_px)>;
  struct Disc {
    double radius_px;  ///< at scale 1
    Skin skin;
  };

  /// `cell_px` is the grid of the textures. By default, structures have a dozen pixels, the size of
  /// the tracker's windows.
  MovingScene(int width, int height, uint32_t seed = 1, double cell_px = 8)
      : picture_(width, height), seed_(seed), cell_px_(cell_px), background_(seed, cell_px) {}

  void plain_background() { plain_ = true; }
  void add_disc(double radius_px) {
    const Texture texture(seed_ + 1 + static_cast<uint32_t>(discs_.size()), cell_px_);
    add_disc(radius_px,
             [texture](const Eigen::Vector2d& at_px) { return texture.at(at_px.x(), at_px.y()); });
  }
  void add_disc(double radius_px, Skin skin) { discs_.push_back({radius_px, std::move(skin)}); }

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }

  /// Takes one placement for each disc; the last ones are in front. Valid until the next call.
  ImageView draw(const Placement& background, const std::vector<Placement>& discs) {
    const Eigen::Vector2d middle((width() - 1) / 2.0, (height() - 1) / 2.0);
    if (!plain_) draw_behind(background, middle);
    picture_.fill([&](double x, double y) {
      const Eigen::Vector2d at = Eigen::Vector2d(x, y) - middle;
      double left = 1;  // the fraction of the pixel that nothing in front covers
      double sum = 0;
      for (size_t i = discs.size(); i-- > 0 && left > 0;) {
        const Eigen::Vector2d on_disc = discs[i].on_thing(at);
        const double inside_px = (discs_[i].radius_px - on_disc.norm()) * discs[i].scale;
        const double cover = left * std::clamp(inside_px + 0.5, 0.0, 1.0);
        if (cover == 0) continue;
        sum += cover * discs_[i].skin(on_disc);
        left -= cover;
      }
      if (left == 0) return sum;
      const auto index = static_cast<size_t>(y * width() + x);
      return sum + left * (plain_ ? 128 : behind_[index]);
    });
    return picture_.view();
  }

 private:
  /// Drawn once for each placement, because it takes longest.
  void draw_behind(const Placement& placement, const Eigen::Vector2d& middle_px) {
    if (!behind_.empty() && placement == behind_at_) return;
    behind_at_ = placement;
    behind_.clear();
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) {
        const Eigen::Vector2d at_px = placement.on_thing(Eigen::Vector2d(x, y) - middle_px);
        behind_.push_back(background_.at(at_px.x(), at_px.y()));
      }
    }
  }

  Picture picture_;
  uint32_t seed_;
  double cell_px_;
  Texture background_;
  std::vector<double> behind_;  ///< grey levels by rows, at …
  Placement behind_at_;
  bool plain_ = false;
  std::vector<Disc> discs_;
};

}  // namespace spidar::test
