// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an ObjectTracker finds in pictures of the size in which motion is measured.
#pragma once

#include <vector>

#include "core/field/block_field.h"
#include "core/motion/objects/object_tracker.h"
#include "core/picture/padded_image.h"
#include "tests/support/picture.h"
#include "tests/support/scene_film.h"

namespace spidar::test {

constexpr int kFieldWidth = 427;
constexpr int kFieldHeight = 240;

/// As a BlockField reads it.
inline PaddedImage padded(const Picture& picture) {
  PaddedImage image;
  reduce_blocks(picture.view(), 1, image);
  image.repeat_border();
  return image;
}

/// After a cut.
inline PreviousFrame nothing_before() {
  static const std::vector<float> foreground;
  static const std::vector<uint8_t> burned_in;
  static const std::vector<uint32_t> objects;
  return {foreground, burned_in, objects};
}

/// A background that moves by so much in each frame, with noise of a standard deviation `noise_px`.
inline Background background_moved_by(const Eigen::Vector2d& shift_px,
                                      double noise_px = kUsualNoise_px) {
  Background background{{}, noise_px, 0.4};
  if (!shift_px.isZero()) background.model.kind = ModelKind::kTranslation;
  background.model.shift_px = shift_px;
  return background;
}

/// The objects of frames 1 … `frames` − 1 of a scene, in px of the frame, kSceneFrame_s apart.
inline std::vector<std::vector<MovingObject>> objects_in(const Scene& scene, int frames,
                                                         const Background& background) {
  BlockField field;
  ObjectTracker tracker;
  const std::vector<FineMotion> no_windows;
  std::vector<std::vector<MovingObject>> found;
  for (int n = 0; n < frames; ++n) {
    Picture picture(kFieldWidth, kFieldHeight);
    picture.fill([&](double x, double y) { return scene(n, {x, y}); });
    if (field.update(padded(picture)) != BlockField::Result::kMoved) continue;
    found.push_back(tracker.update({field, 1, {0, 0}, kSceneFrame_s, no_windows}, background));
  }
  return found;
}

}  // namespace spidar::test
