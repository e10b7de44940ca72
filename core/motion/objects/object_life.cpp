// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/objects/object_life.h"

#include <algorithm>

#include "core/field/block_field.h"
#include "core/motion/layers/moving_blocks.h"

namespace spidar {
namespace {

/// With less of its usual blocks than this, only a rim of an object is visible.
constexpr double kRimShare = 0.5;

}  // namespace

void ObjectLife::turn(State next) {
  if (state != next) since_s = 0;
  state = next;
}

bool ObjectLife::moves_like(const Region& other, double interval_s) const {
  const Eigen::Vector2d expected_px = velocity_px_s * interval_s;
  const double fastest_px = std::max(expected_px.norm(), other.relative_px.norm());
  return (other.relative_px - expected_px).norm() <
         kAlikeShare * fastest_px + static_cast<double>(kMostOff_px);
}

bool ObjectLife::is_rim(const Region& visible) const {
  return visible.blocks < kRimShare * expected.blocks;
}

bool ObjectLife::has_left(double interval_s) const {
  const Eigen::Vector2d on_screen_px = expected.velocity_px_s * interval_s + region.background_px;
  return region.border_blocks > 0 && region.position_px.dot(on_screen_px) > 0;
}

void ObjectLife::go_on_unseen(double interval_s) {
  expected.position_px += expected.velocity_px_s * interval_s + region.background_px;
}

// Not inlined, so that the list of executed sources knows this one.
[[gnu::noinline]] void ObjectLife::expect(double interval_s) {
  const double blocks = region.blocks;
  const double forgotten = std::min(1.0, interval_s / kForgotten_s);
  expected.blocks = std::max(blocks, expected.blocks + forgotten * (blocks - expected.blocks));
  if (is_rim(region)) {  // the rest of it is hidden
    go_on_unseen(interval_s);
    return;
  }
  expected.position_px = region.position_px;
  expected.velocity_px_s = velocity_px_s;
  expected.sides_px = region.high_px - region.low_px;
}

}  // namespace spidar
