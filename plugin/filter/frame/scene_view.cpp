// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/frame/scene_view.h"

#include <algorithm>
#include <utility>

namespace spidar {
namespace {

/// A track that deviates more than this from the background moves independently.
constexpr double kMovingSigmas = 3;

bool by_id(const SceneTrack& a, const SceneTrack& b) {
  return a.id < b.id;
}

bool has(const std::vector<SceneTrack>& sorted, uint32_t id) {
  SceneTrack wanted;
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

}  // namespace

std::vector<uint32_t> felt_objects(const SceneView& scene, MotionKind motion,
                                   const TouchScene& touch) {
  std::vector<uint32_t> felt;
  if (touch.on && !(touch.motion_share > 0)) return felt;
  const bool all = scene.is_free && motion == MotionKind::kObjects;
  for (const MovingObject& object : scene.objects) {
    if (object.tracks == 0) continue;
    if (all || object.id == scene.felt_object) felt.push_back(object.id);
  }
  return felt;
}

ObjectCorners corners_of(const MovingObject& object, const VisiblePart& visible) {
  const Eigen::Vector2d at_px = centre_px(visible) + object.position_px;
  return {at_px - object.size_px / 2, at_px + object.size_px / 2};
}

Eigen::Vector2d force_origin_px(const SceneView& scene, const std::vector<uint32_t>& felt,
                                const VisiblePart& visible) {
  if (felt.size() != 1) return centre_px(visible);
  std::vector<Eigen::Vector2d> on_px;
  Eigen::Vector2d mean_px(0, 0);
  for (const SceneTrack& track : scene.tracks) {
    if (track.owner != TrackOwner::kObject || track.object != felt.front()) continue;
    on_px.emplace_back(track.to.x_px, track.to.y_px);
    mean_px += on_px.back();
  }
  if (on_px.empty()) {
    const auto is_felt = [&](const MovingObject& object) { return object.id == felt.front(); };
    const auto object = std::find_if(scene.objects.begin(), scene.objects.end(), is_felt);
    return centre_px(visible) +
           (object == scene.objects.end() ? Eigen::Vector2d(0, 0) : object->position_px);
  }
  mean_px /= static_cast<double>(on_px.size());
  // The mean of a curved object lies beside it.
  return *std::min_element(on_px.begin(), on_px.end(), [&](const auto& a, const auto& b) {
    return (a - mean_px).squaredNorm() < (b - mean_px).squaredNorm();
  });
}

void SceneViewer::reset() {
  scene_ = {};
  compares_ = false;
}

const SceneView& SceneViewer::see(const Frame& frame, const VisiblePart& visible,
                                  const PictureTurn& turn) {
  std::vector<SceneTrack> before = std::move(scene_.tracks);
  scene_.tracks.clear();
  scene_.lost.clear();
  scene_.objects.clear();
  scene_.motion = frame.motion;
  scene_.wrench = frame.wrench;
  scene_.felt_object = frame.felt_object;
  scene_.is_free = frame.choice.is_free();
  scene_.turn = turn;
  scene_.objects = frame.objects;
  if (frame.picture == PictureKind::kFirst) {
    compares_ = false;
    return scene_;
  }
  const auto left_px = static_cast<float>(visible.x);
  const auto top_px = static_cast<float>(visible.y);
  for (const Track& given : frame.tracks) {
    SceneTrack track;
    track.id = given.id;
    track.from = given.from;
    track.to = given.to;
    if (frame.background) find_owner(frame, visible, track);
    for (ImagePoint* point : {&track.from, &track.to}) {
      point->x_px += left_px;
      point->y_px += top_px;
    }
    scene_.tracks.push_back(track);
  }
  if (compares_) compare(before);
  compares_ = true;
  return scene_;
}

/// Assigns the track to the background if it follows it, otherwise to the object with the most
/// similar velocity among those whose box contains the track.
void SceneViewer::find_owner(const Frame& frame, const VisiblePart& visible, SceneTrack& track) {
  // Relative to the centre of the picture, as in displacements().
  const Eigen::Vector2d centre_px(0.5 * (visible.width - 1), 0.5 * (visible.height - 1));
  const Eigen::Vector2d from_px = Eigen::Vector2d(track.from.x_px, track.from.y_px) - centre_px;
  const Eigen::Vector2d to_px = Eigen::Vector2d(track.to.x_px, track.to.y_px) - centre_px;
  const Background& background = *frame.background;
  const Eigen::Vector2d relative_px = to_px - from_px - background.model.displacement_px(from_px);
  if (relative_px.norm() <= kMovingSigmas * background.sigma_px) {
    track.owner = TrackOwner::kBackground;
    return;
  }
  const double interval_s = 1e-9 * static_cast<double>(frame.interval_ns);
  double nearest_px = 0;
  for (const MovingObject& object : scene_.objects) {
    if (object.tracks == 0 || !is_in_box(object, to_px)) continue;
    const double difference_px = (relative_px - object.relative_px_s * interval_s).norm();
    if (track.owner == TrackOwner::kObject && difference_px >= nearest_px) continue;
    nearest_px = difference_px;
    track.owner = TrackOwner::kObject;
    track.object = object.id;
  }
}

void SceneViewer::compare(const std::vector<SceneTrack>& before) {
  std::vector<SceneTrack> known = before;
  std::sort(known.begin(), known.end(), by_id);
  std::vector<SceneTrack> now = scene_.tracks;
  std::sort(now.begin(), now.end(), by_id);
  for (SceneTrack& track : scene_.tracks) track.is_new = !has(known, track.id);
  for (const SceneTrack& track : before) {
    if (!has(now, track.id)) scene_.lost.push_back(track.to);
  }
}

}  // namespace spidar
