// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/camera_choice.h"

#include <utility>

#include "core/field/areas.h"
#include "core/motion/camera/border_ring.h"

namespace spidar {
namespace {

bool moves(const Background& background) {
  return background.is_known && background.model.kind != ModelKind::kStill;
}

}  // namespace

CameraChoice::CameraChoice() {
  votes_.cast.reserve(kMostDisplacements);
  area_votes_.cast.reserve(kMostDisplacements);
}

void CameraChoice::reset() {
  plain_.reset();
  estimator_.reset();
}

/// `likely` is what explains the picture best, whether it was believed or not: over several
/// pictures the plain parts may show what they do not show in one.
const Background& CameraChoice::keep(const BlockField& field, const Background& chosen,
                                     const MotionModel& likely) {
  plain_.remember(field, likely);
  return estimator_.keep(chosen);
}

const Background& CameraChoice::find(const BlockField& field, const Past& past) {
  areas_.reserve(field.blocks().size());
  collect_votes(field, past, votes_);
  const bool are_few = votes_.are_few();
  const Background of_blocks = are_few ? Background() : estimator_.propose(votes_);
  if (moves(of_blocks) || votes_.are_many()) return keep(field, of_blocks, of_blocks.model);

  find_areas(field, areas_);
  collect_areas(field, areas_, past, area_votes_);
  const Background of_areas =
      area_votes_.are_few() ? Background() : estimator_.propose(area_votes_);
  if (moves(of_areas) && (plain_.have_moved(field, past, of_areas.model) ||
                          border_has_moved(field, past, of_areas.model))) {
    std::swap(votes_, area_votes_);
    return keep(field, of_areas, of_areas.model);
  }
  if (!are_few) return keep(field, of_blocks, of_areas.model);

  collect_edges(field, past, votes_);
  return keep(field, estimator_.propose(votes_), of_areas.model);
}

}  // namespace spidar
