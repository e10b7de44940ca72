// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/block_votes.h"

#include <cmath>

namespace spidar {
namespace {

/// Blocks this close to the border of the picture count as being at the border.
constexpr int kBorderBlocks = 2;
/// Smaller eigenvalue of the structure tensor, (grey / px)²: the vote of a block approaches a full
/// one well above it.
constexpr double kFullTexture = 24;
/// A block whose own motion leaves this residual has half a vote, grey².
constexpr double kBadResidual = 60;

enum class Voters { kTextured, kEdgesToo };

/// Textured blocks vote on the camera's motion. A vote counts the more, the more structure the
/// block has in both directions and the better its motion fits; it counts twice at the border of
/// the picture, and half for a block that moved by itself until now. Rest at the border counts
/// once: graphics are mostly there, whereas a camera at rest shows it all over the picture. How an
/// edge moves along itself is not known; edges therefore vote only where little else does, as in a
/// picture out of focus. Returns whether the voters together have edges in more than one direction.
bool collect(const BlockField& field, const Past& past, Voters voters, BackgroundVotes& votes) {
  votes.cast.clear();
  votes.all = 0;
  votes.with_edges = voters == Voters::kEdgesToo;
  votes.are_lost = false;
  Eigen::Matrix2f together = Eigen::Matrix2f::Zero();
  const BlockGrid& grid = field.grid();
  const int left = past.margin_columns;
  const int top = past.margin_rows;
  votes.size_px = {(grid.columns - 2 * left) * kBlock_px, (grid.rows - 2 * top) * kBlock_px};
  for (size_t i = 0; i < grid.size(); ++i) {
    const int across = grid.columns_beside(i) - left, down = grid.rows_beside(i) - top;
    if (across < 0 || down < 0) continue;
    const bool at_border = across < kBorderBlocks || down < kBorderBlocks;
    votes.all += at_border ? kBorderVotes : 1;
    const MotionBlock& block = field.blocks()[i];
    const double texture = static_cast<double>(block.weakest_texture());
    const bool may_vote =
        votes.with_edges ? block.has_texture() && texture > 0 : block.has_corners();
    if (!may_vote || votes.cast.size() >= kMostDisplacements) continue;
    if (!past.burned_in.empty() && past.burned_in[i] != 0) continue;
    double weight = texture / (texture + kFullTexture) /
                    (1 + static_cast<double>(block.residual) / kBadResidual);
    // Right to half a pixel, as all motion is before it is refined.
    const bool rests = std::hypot(block.moved_px.x(), block.moved_px.y()) < kMostOff_px / 2;
    if (at_border && !rests) weight *= kBorderVotes;
    if (!past.persistence.empty()) {
      weight *= 1 - static_cast<double>(past.persistence[field.origin_of(i)]) / 2;
    }
    const Eigen::Vector2d moved_px = block.moved_px.cast<double>();
    const Displacement point{block.centre_px.cast<double>() - moved_px, moved_px};
    votes.cast.push_back({point, weight, at_border, i});
    together += block.structure / block.structure.trace();
  }
  return static_cast<double>(roundness(together)) > MotionBlock::kLeastRoundness;
}

}  // namespace

void collect_votes(const BlockField& field, const Past& past, BackgroundVotes& votes) {
  collect(field, past, Voters::kTextured, votes);
  if (!votes.are_few()) return;
  if (!collect(field, past, Voters::kEdgesToo, votes)) {
    collect(field, past, Voters::kTextured, votes);
  }
  votes.are_lost = field.are_lost([](size_t) { return true; });
}

}  // namespace spidar
