// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/track_owners.h"

#include <algorithm>
#include <utility>

namespace spidar {
namespace {

/// A track that deviates more than this from the background moves independently.
constexpr double kMovingSigmas = 3;

bool by_id(const OwnedTrack& a, const OwnedTrack& b) {
  return a.id < b.id;
}

bool has(const std::vector<OwnedTrack>& sorted, uint32_t id) {
  OwnedTrack wanted;
  wanted.id = id;
  return std::binary_search(sorted.begin(), sorted.end(), wanted, by_id);
}

Eigen::Vector2d centre_px(const VisiblePart& visible) {
  return {visible.x + 0.5 * (visible.width - 1), visible.y + 0.5 * (visible.height - 1)};
}

bool is_in_box(const MovingObject& object, const Eigen::Vector2d& at_px) {
  const Eigen::Vector2d distance_px = (at_px - object.position_px).cwiseAbs();
  return (distance_px.array() <= object.size_px.array() / 2).all();
}

/// Assigns the track to the background if it follows it, otherwise to the object with the most
/// similar velocity among those whose box contains the track.
void find_owner(const Frame& frame, const VisiblePart& visible, OwnedTrack& track) {
  // Relative to the centre of the picture.
  const Eigen::Vector2d middle_px(0.5 * (visible.width - 1), 0.5 * (visible.height - 1));
  const Eigen::Vector2d from_px = Eigen::Vector2d(track.from.x_px, track.from.y_px) - middle_px;
  const Eigen::Vector2d to_px = Eigen::Vector2d(track.to.x_px, track.to.y_px) - middle_px;
  const Background& background = *frame.background;
  const Eigen::Vector2d relative_px = to_px - from_px - background.model.displacement_px(from_px);
  if (relative_px.norm() <= kMovingSigmas * background.sigma_px) {
    track.owner = TrackOwner::kBackground;
    return;
  }
  const double interval_s = 1e-9 * static_cast<double>(frame.interval_ns);
  double nearest_px = 0;
  for (const MovingObject& object : frame.objects) {
    if (object.tracks == 0 || !is_in_box(object, to_px)) continue;
    const double difference_px = (relative_px - object.relative_px_s * interval_s).norm();
    if (track.owner == TrackOwner::kObject && difference_px >= nearest_px) continue;
    nearest_px = difference_px;
    track.owner = TrackOwner::kObject;
    track.object = object.id;
  }
}

}  // namespace

std::vector<uint32_t> felt_objects(const FrameReport& report) {
  std::vector<uint32_t> felt;
  if (report.touch.on && !(report.touch.motion_fraction > 0)) return felt;
  const bool all = report.frame.choice.is_free() && report.motion == MotionKind::kObjects;
  for (const MovingObject& object : report.frame.objects) {
    if (object.tracks == 0) continue;
    if (all || object.id == report.frame.felt_object) felt.push_back(object.id);
  }
  return felt;
}

ObjectCorners corners_of(const MovingObject& object, const VisiblePart& visible) {
  return {centre_px(visible) + object.drawn_low_px(), centre_px(visible) + object.drawn_high_px()};
}

Eigen::Vector2d force_origin_px(const FrameReport& report) {
  const Eigen::Vector2d middle_px = centre_px(report.visible);
  if (report.felt.size() != 1) return middle_px;
  const uint32_t felt = report.felt.front();
  std::vector<Eigen::Vector2d> on_px;
  Eigen::Vector2d mean_px(0, 0);
  for (const OwnedTrack& track : report.tracks) {
    if (track.owner != TrackOwner::kObject || track.object != felt) continue;
    on_px.emplace_back(track.to.x_px, track.to.y_px);
    mean_px += on_px.back();
  }
  if (on_px.empty()) {
    for (const MovingObject& object : report.frame.objects) {
      if (object.id == felt) return middle_px + object.position_px;
    }
    return middle_px;
  }
  mean_px /= static_cast<double>(on_px.size());
  // The mean of a curved object lies beside it.
  return *std::min_element(on_px.begin(), on_px.end(), [&](const auto& a, const auto& b) {
    return (a - mean_px).squaredNorm() < (b - mean_px).squaredNorm();
  });
}

void TrackOwners::find(FrameReport& report) {
  report.felt = felt_objects(report);
  report.tracks.clear();
  report.lost.clear();
  if (report.frame.picture == PictureKind::kFirst) return reset();
  const auto left_px = static_cast<float>(report.visible.x);
  const auto top_px = static_cast<float>(report.visible.y);
  for (const Track& given : report.frame.tracks) {
    OwnedTrack track;
    track.id = given.id;
    track.from = given.from;
    track.to = given.to;
    if (report.frame.background) find_owner(report.frame, report.visible, track);
    for (ImagePoint* point : {&track.from, &track.to}) {
      point->x_px += left_px;
      point->y_px += top_px;
    }
    report.tracks.push_back(track);
  }
  if (compares_) compare(report);
  compares_ = true;
  before_ = report.tracks;
}

void TrackOwners::compare(FrameReport& report) {
  std::sort(before_.begin(), before_.end(), by_id);
  std::vector<OwnedTrack> now = report.tracks;
  std::sort(now.begin(), now.end(), by_id);
  for (OwnedTrack& track : report.tracks) track.is_new = !has(before_, track.id);
  for (const OwnedTrack& track : before_) {
    if (!has(now, track.id)) report.lost.push_back(track.to);
  }
}

}  // namespace spidar
