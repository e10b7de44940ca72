// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/point_owners.h"

#include <algorithm>

namespace spidar {
namespace {

/// A point that deviates more than this from the background moves independently.
constexpr double kMovingSigmas = 3;

bool by_id(const OwnedPoint& a, const OwnedPoint& b) {
  return a.id < b.id;
}

bool has(const std::vector<OwnedPoint>& sorted, uint32_t id) {
  OwnedPoint wanted;
  wanted.id = id;
  return std::binary_search(sorted.begin(), sorted.end(), wanted, by_id);
}

Eigen::Vector2d centre_px(const PicturePart& film) {
  return {film.x + 0.5 * (film.width - 1), film.y + 0.5 * (film.height - 1)};
}

bool is_in_box(const MovingObject& object, const Eigen::Vector2d& at_px) {
  const Eigen::Vector2d distance_px = (at_px - object.position_px).cwiseAbs();
  return (distance_px.array() <= object.size_px.array() / 2).all();
}

/// Assigns the point to the background if the point follows it, otherwise to the object with the
/// most similar velocity among those whose box contains the point.
void find_owner(const Frame& frame, OwnedPoint& point) {
  // The position is relative to the centre of the film.
  const Eigen::Vector2d middle_px(0.5 * (frame.width() - 1), 0.5 * (frame.height() - 1));
  const Eigen::Vector2d from_px = Eigen::Vector2d(point.from.x_px, point.from.y_px) - middle_px;
  const Eigen::Vector2d to_px = Eigen::Vector2d(point.to.x_px, point.to.y_px) - middle_px;
  const Background& background = *frame.background;
  const Eigen::Vector2d relative_px = to_px - from_px - background.model.displacement_px(from_px);
  if (relative_px.norm() <= kMovingSigmas * background.sigma_px) {
    point.owner = PointOwner::kBackground;
    return;
  }
  const double interval_s = 1e-9 * static_cast<double>(frame.interval_ns);
  double nearest_px = 0;
  for (const MovingObject& object : frame.objects) {
    if (object.points == 0 || !is_in_box(object, to_px)) continue;
    const double difference_px = (relative_px - object.relative_px_s * interval_s).norm();
    if (point.owner == PointOwner::kObject && difference_px >= nearest_px) continue;
    nearest_px = difference_px;
    point.owner = PointOwner::kObject;
    point.object = object.id;
  }
}

}  // namespace

std::vector<uint32_t> felt_objects(const DrawnFrame& report) {
  std::vector<uint32_t> felt;
  if (report.touch.on && !(report.touch.motion_fraction > 0)) return felt;
  const bool all = report.frame.choice.is_free() && report.motion == MotionKind::kObjects;
  for (const MovingObject& object : report.frame.objects) {
    if (object.points == 0) continue;
    if (all || object.id == report.frame.felt_object) felt.push_back(object.id);
  }
  return felt;
}

Eigen::AlignedBox2d box_px(const MovingObject& object, const PicturePart& film) {
  return {centre_px(film) + object.drawn_low_px(), centre_px(film) + object.drawn_high_px()};
}

Eigen::Vector2d force_origin_px(const DrawnFrame& report) {
  const Eigen::Vector2d middle_px = centre_px(report.film_part());
  if (report.felt.size() != 1) return middle_px;
  const uint32_t felt = report.felt.front();
  std::vector<Eigen::Vector2d> on_px;
  Eigen::Vector2d mean_px(0, 0);
  for (const OwnedPoint& point : report.points) {
    if (point.owner != PointOwner::kObject || point.object != felt) continue;
    on_px.emplace_back(point.to.x_px, point.to.y_px);
    mean_px += on_px.back();
  }
  if (on_px.empty()) {
    for (const MovingObject& object : report.frame.objects) {
      if (object.id == felt) return middle_px + object.position_px;
    }
    return middle_px;
  }
  mean_px /= static_cast<double>(on_px.size());
  // The mean may lie outside a curved object, so take the point nearest to it.
  return *std::min_element(on_px.begin(), on_px.end(), [&](const auto& a, const auto& b) {
    return (a - mean_px).squaredNorm() < (b - mean_px).squaredNorm();
  });
}

void PointOwners::find(DrawnFrame& report) {
  report.felt = felt_objects(report);
  report.points.clear();
  report.lost.clear();
  if (report.frame.picture == FrameComparison::kFirst) return reset();
  const PicturePart film = report.film_part();
  const auto left_px = static_cast<float>(film.x);
  const auto top_px = static_cast<float>(film.y);
  for (const FollowedPoint& given : report.frame.points) {
    OwnedPoint point;
    point.id = given.id;
    point.from = given.from;
    point.to = given.to;
    if (report.frame.background) find_owner(report.frame, point);
    for (ImagePoint* end : {&point.from, &point.to}) {
      end->x_px += left_px;
      end->y_px += top_px;
    }
    report.points.push_back(point);
  }
  if (compares_) compare(report);
  compares_ = true;
  before_ = report.points;
}

void PointOwners::compare(DrawnFrame& report) {
  std::sort(before_.begin(), before_.end(), by_id);
  std::vector<OwnedPoint> now = report.points;
  std::sort(now.begin(), now.end(), by_id);
  for (OwnedPoint& point : report.points) point.is_new = !has(before_, point.id);
  for (const OwnedPoint& point : before_) {
    if (!has(now, point.id)) report.lost.push_back(point.to);
  }
}

}  // namespace spidar
