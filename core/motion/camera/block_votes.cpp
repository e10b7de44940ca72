// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/block_votes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/field/coarse_blocks.h"

namespace spidar {
namespace {

/// Blocks this close to the border of the picture count as being at the border.
constexpr int kBorderBlocks = 2;
/// The smaller eigenvalue of the structure tensor at which a block has half of a full vote, (grey /
/// px)².
constexpr double kFullTexture = 24;
/// The residual of a block's own motion at which the block has half a vote, grey².
constexpr double kBadResidual = 60;

/// The weight of a vote rises with the structure that the block has in both directions, and falls
/// with the residual of its motion; a block that moved by itself until now has half the weight.
/// `texture_scale` is 1, or kCoarseTextureScale.
double weight_of(const MotionBlock& block, double texture_scale, float foreground) {
  const double texture = static_cast<double>(block.weakest_texture());
  return texture / (texture + texture_scale * kFullTexture) /
         (1 + static_cast<double>(block.residual) / kBadResidual) *
         (1 - static_cast<double>(foreground) / 2);
}

BackgroundVote vote_of(const MotionBlock& block, double weight, bool at_border, size_t source) {
  const Eigen::Vector2d moved_px = block.moved_px.cast<double>();
  return {{block.centre_px.cast<double>() - moved_px, moved_px}, weight, at_border, source};
}

void clear_votes(BackgroundVotes& votes) {
  votes.cast.clear();
  votes = {.cast = std::move(votes.cast)};
}

/// The motion of an edge along itself is unknown.
bool may_vote(const MotionBlock& block, bool with_edges) {
  return with_edges ? block.has_texture() && block.weakest_texture() > 0 : block.has_corners();
}

/// Whether the block is at rest to half a pixel, the accuracy of all motion before refinement.
bool is_at_rest(const MotionBlock& block) {
  return std::hypot(block.moved_px.x(), block.moved_px.y()) < kMaxOff_px / 2;
}

/// Collects the votes of single blocks. Votes at the border of the picture count twice, except
/// votes for rest, because graphics are mostly at the border, whereas a camera at rest shows rest
/// all over the picture.
void collect_blocks(const BlockField& field, const PreviousFrame& past, bool with_edges,
                    BackgroundVotes& votes) {
  clear_votes(votes);
  votes.with_edges = with_edges;
  const BlockGrid& grid = field.grid();
  const int left = past.margin_columns, top = past.margin_rows;
  votes.size_px = {(grid.columns - 2 * left) * kBlock_px, (grid.rows - 2 * top) * kBlock_px};
  for (size_t i = 0; i < grid.size(); ++i) {
    const int across = grid.columns_beside(i) - left, down = grid.rows_beside(i) - top;
    if (across < 0 || down < 0) continue;
    const bool at_border = across < kBorderBlocks || down < kBorderBlocks;
    votes.all += at_border ? kBorderVotes : 1;
    const MotionBlock& block = field.blocks()[i];
    if (!may_vote(block, with_edges) || past.is_burned_in(i)) continue;
    if (votes.cast.size() >= kMaxDisplacements) continue;
    const double times = at_border && !is_at_rest(block) ? kBorderVotes : 1;
    const float foreground = past.foreground_of(field.origin_of(i));
    votes.cast.push_back(vote_of(block, times * weight_of(block, 1, foreground), at_border, i));
  }
}

/// Whether the voters together have edges in more than one direction.
bool have_corners_together(const BackgroundVotes& votes, const BlockField& field) {
  Eigen::Matrix2f together = Eigen::Matrix2f::Zero();
  for (const BackgroundVote& vote : votes.cast) {
    const Eigen::Matrix2f& structure = field.blocks()[vote.source].structure;
    together += structure / structure.trace();
  }
  return static_cast<double>(roundness(together)) > MotionBlock::kMinRoundness;
}

/// Whether most blocks of a coarse block vote themselves. `middle_px` is from the picture's corner.
bool blocks_have_corners(const BlockField& field, const Eigen::Vector2d& middle_px) {
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

/// Whether more of the picture is lost than found, and at least kMinVotes: a ball that bounces
/// before a plain wall may be all that is lost.
bool is_new(const BlockField& field) {
  size_t lost = 0, found = 0;
  for (size_t i = 0; i < field.blocks().size(); ++i) {
    const BlockField::Match match = field.match_of(i);
    lost += match == BlockField::Match::kLost;
    found += match == BlockField::Match::kFound;
  }
  return lost > found && lost >= kMinVotes;
}

}  // namespace

void collect_votes(const BlockField& field, const PreviousFrame& past, BackgroundVotes& votes) {
  collect_blocks(field, past, false, votes);
}

void collect_edges(const BlockField& field, const PreviousFrame& past, BackgroundVotes& votes) {
  collect_blocks(field, past, true, votes);
  if (!have_corners_together(votes, field)) collect_blocks(field, past, false, votes);
  votes.are_lost = is_new(field);
}

void collect_coarse_blocks(const BlockField& field, const std::vector<MotionBlock>& coarse,
                           const PreviousFrame& past, BackgroundVotes& votes) {
  clear_votes(votes);
  votes.of_coarse_blocks = true;
  const Eigen::Vector2d picture_px(field.picture().width(), field.picture().height());
  const Eigen::Vector2d margin_px(past.margin_columns * kBlock_px, past.margin_rows * kBlock_px);
  votes.size_px = picture_px - 2 * margin_px;
  constexpr double kHalf_px = kCoarser * kBlock_px / 2;
  for (const MotionBlock& block : coarse) {
    const Eigen::Vector2d from_middle_px = block.centre_px.cast<double>();
    const double inside_px = (votes.size_px / 2 - from_middle_px.cwiseAbs()).minCoeff() - kHalf_px;
    // A coarse block may reach over the film's border by a pixel of the coarse picture.
    if (inside_px < -kCoarser) continue;
    const bool at_border = inside_px < kBorderBlocks * kBlock_px;
    votes.all += at_border ? kBorderVotes : 1;
    if (block.weakest_texture() < kCoarseTextureScale * MotionBlock::kMinTexture) continue;
    const Eigen::Vector2d centre_px = from_middle_px + picture_px / 2;
    const size_t middle = field.grid().block_at(centre_px);
    if (past.is_burned_in(middle) || blocks_have_corners(field, centre_px)) continue;
    const double weight = weight_of(block, static_cast<double>(kCoarseTextureScale),
                                    past.foreground_of(field.origin_of(middle)));
    votes.cast.push_back(vote_of(block, weight, at_border, middle));
  }
}

}  // namespace spidar
