// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/block_votes.h"

#include <algorithm>
#include <cmath>

#include "core/field/areas.h"

namespace spidar {
namespace {

/// Blocks this close to the border of the picture count as being at the border.
constexpr int kBorderBlocks = 2;
/// Smaller eigenvalue of the structure tensor, (grey / px)²: the vote of a block approaches a full
/// one well above it.
constexpr double kFullTexture = 24;
/// A block whose own motion leaves this residual has half a vote, grey².
constexpr double kBadResidual = 60;

/// The weight of a vote rises with the structure that the block has in both directions, and falls
/// with the residual of its motion; for a block that moved by itself until now it is half. What
/// comes from the coarse picture needs less texture, see kAreaTextureScale.
double weight_of(const MotionBlock& block, double of_texture, float persistence) {
  const double texture = static_cast<double>(block.weakest_texture());
  return texture / (texture + of_texture * kFullTexture) /
         (1 + static_cast<double>(block.residual) / kBadResidual) *
         (1 - static_cast<double>(persistence) / 2);
}

BackgroundVote vote_of(const MotionBlock& block, double weight, bool at_border, size_t source) {
  const Eigen::Vector2d moved_px = block.moved_px.cast<double>();
  return {{block.centre_px.cast<double>() - moved_px, moved_px}, weight, at_border, source};
}

void begin(BackgroundVotes& votes) {
  votes.cast.clear();
  votes.all = 0;
  votes.with_edges = false;
  votes.are_lost = false;
  votes.of_areas = false;
}

/// Textured blocks vote on the camera's motion, and count twice at the border of the picture. Rest
/// at the border counts once: graphics are mostly there, whereas a camera at rest shows it all over
/// the picture. How an edge moves along itself is not known; edges therefore vote only where little
/// else does, as in a picture out of focus. Returns whether the voters together have edges in more
/// than one direction.
bool collect(const BlockField& field, const PreviousFrame& past, bool with_edges,
             BackgroundVotes& votes) {
  begin(votes);
  votes.with_edges = with_edges;
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
    if (!may_vote || votes.cast.size() >= kMaxDisplacements) continue;
    if (past.is_burned_in(i)) continue;
    double weight = weight_of(block, 1, past.persistence_of(field.origin_of(i)));
    // Right to half a pixel, as all motion is before it is refined.
    const bool rests = std::hypot(block.moved_px.x(), block.moved_px.y()) < kMaxOff_px / 2;
    if (at_border && !rests) weight *= kBorderVotes;
    votes.cast.push_back(vote_of(block, weight, at_border, i));
    together += block.structure / block.structure.trace();
  }
  return static_cast<double>(roundness(together)) > MotionBlock::kMinRoundness;
}

/// Whether most of the blocks of an area vote themselves. `middle_px` is from the picture's corner.
bool has_corners(const BlockField& field, const Eigen::Vector2d& middle_px) {
  const BlockGrid& grid = field.grid();
  constexpr double kToFirst_px = kBlock_px * (kCoarser - 1) / 2.0;
  const size_t first = grid.block_at(middle_px - Eigen::Vector2d::Constant(kToFirst_px));
  const int left = grid.column(first), top = grid.row(first);
  int corners = 0;
  for (int y = top; y < std::min(top + kCoarser, grid.rows); ++y) {
    for (int x = left; x < std::min(left + kCoarser, grid.columns); ++x) {
      corners += field.blocks()[grid.index(x, y)].has_corners();
    }
  }
  return corners > kCoarser * kCoarser / 2;
}

/// Whether more of the picture is lost than found, and at least kMinVotes of it: a ball that
/// bounces before a plain wall may be all that is lost.
bool is_new(const BlockField& field) {
  size_t lost = 0;
  size_t found = 0;
  for (size_t i = 0; i < field.blocks().size(); ++i) {
    const BlockField::Match match = field.match_of(i);
    lost += match == BlockField::Match::kLost;
    found += match == BlockField::Match::kFound;
  }
  return lost > found && lost >= kMinVotes;
}

}  // namespace

void collect_votes(const BlockField& field, const PreviousFrame& past, BackgroundVotes& votes) {
  collect(field, past, false, votes);
}

void collect_edges(const BlockField& field, const PreviousFrame& past, BackgroundVotes& votes) {
  if (!collect(field, past, true, votes)) {
    collect(field, past, false, votes);
  }
  votes.are_lost = is_new(field);
}

void collect_areas(const BlockField& field, const std::vector<MotionBlock>& areas,
                   const PreviousFrame& past, BackgroundVotes& votes) {
  begin(votes);
  votes.of_areas = true;
  const Eigen::Vector2d picture_px(field.picture().width(), field.picture().height());
  const Eigen::Vector2d margin_px(past.margin_columns * kBlock_px, past.margin_rows * kBlock_px);
  votes.size_px = picture_px - 2 * margin_px;
  constexpr double kHalf_px = kCoarser * kBlock_px / 2;
  for (const MotionBlock& area : areas) {
    const Eigen::Vector2d centre_px = area.centre_px.cast<double>();
    const double inside_px = (votes.size_px / 2 - centre_px.cwiseAbs()).minCoeff() - kHalf_px;
    if (inside_px < -kCoarser) continue;
    const bool at_border = inside_px < kBorderBlocks * kBlock_px;
    votes.all += at_border ? kBorderVotes : 1;
    if (area.weakest_texture() < kAreaTextureScale * MotionBlock::kMinTexture) continue;
    const size_t middle = field.grid().block_at(centre_px + picture_px / 2);
    if (past.is_burned_in(middle) || has_corners(field, centre_px + picture_px / 2)) continue;
    const double weight = weight_of(area, static_cast<double>(kAreaTextureScale),
                                    past.persistence_of(field.origin_of(middle)));
    votes.cast.push_back(vote_of(area, weight, at_border, middle));
  }
}

}  // namespace spidar
