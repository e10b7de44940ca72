// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// To which object each track belongs.
#include <vector>

#include <gtest/gtest.h>

#include "plugin/filter/frame/scene_view.h"

namespace spidar::test::scene_view_test {
namespace {

Frame analysis_of(const std::vector<Track>& tracks) {
  Frame analysis;
  analysis.picture = PictureKind::kOther;
  analysis.tracks = tracks;
  analysis.interval_ns = 40'000'000;
  return analysis;
}

TEST(Scene, TellsNewAndLostPoints) {
  SceneViewer viewer;
  const VisiblePart visible{10, 20, 320, 240};
  const std::vector<Track> first{{1, {0, 0}, {1, 0}}, {2, {5, 5}, {6, 5}}};
  const std::vector<Track> second{{3, {9, 9}, {9, 9}}, {1, {1, 0}, {2, 0}}};
  for (const SceneTrack& track : viewer.see(analysis_of(first), visible).tracks) {
    EXPECT_FALSE(track.is_new) << "nothing to compare with";
  }
  const SceneView& scene = viewer.see(analysis_of(second), visible);
  ASSERT_EQ(scene.tracks.size(), 2u);
  EXPECT_TRUE(scene.tracks[0].is_new);
  EXPECT_FALSE(scene.tracks[1].is_new);
  EXPECT_EQ(scene.tracks[1].to.x_px, 12) << "in the frame, not in its visible part";
  EXPECT_EQ(scene.tracks[1].to.y_px, 20);
  ASSERT_EQ(scene.lost.size(), 1u);
  EXPECT_EQ(scene.lost[0].x_px, 16);
  viewer.see(Frame(), visible);  // a restart
  EXPECT_TRUE(viewer.see(analysis_of(first), visible).lost.empty());
}

TEST(Scene, TheArrowOfTheForceBeginsOnTheObjectThatIsFelt) {
  const VisiblePart visible{10, 20, 321, 241};
  SceneView scene;
  scene.objects.resize(1);
  scene.objects[0].id = 7;
  scene.objects[0].position_px = {-30, 40};
  const auto origin_px = [&](const std::vector<uint32_t>& felt) {
    return force_origin_px(scene, felt, visible);
  };
  const Eigen::Vector2d middle_px(170, 140);
  EXPECT_EQ(origin_px({}), middle_px);
  EXPECT_EQ(origin_px({7, 8}), middle_px) << "not one alone";
  EXPECT_EQ(origin_px({7}), middle_px + scene.objects[0].position_px) << "nothing else is known";
  // Three corners of a square, as of a banana: its mean (97, 97) is beside it.
  for (const ImagePoint at : {ImagePoint{80, 80}, {80, 130}, {130, 80}}) {
    scene.tracks.push_back({1, at, at, TrackOwner::kObject, 7, false});
  }
  scene.tracks.push_back({2, {97, 97}, {97, 97}, TrackOwner::kBackground, 0, false});
  scene.tracks.push_back({3, {97, 97}, {97, 97}, TrackOwner::kObject, 8, false});
  EXPECT_EQ(origin_px({7}), Eigen::Vector2d(80, 80));
}

TEST(Scene, TellsTheBackgroundFromObjects) {
  Background background;
  background.model.kind = ModelKind::kTranslation;
  background.model.shift_px = {4, 0};
  background.sigma_px = 0.1;
  MovingObject left, right;  // boxes overlap at the centre of the frame
  left.id = 7;
  right.id = 8;
  left.tracks = right.tracks = 3;
  left.position_px = {-10, 0};
  right.position_px = {10, 0};
  left.size_px = right.size_px = {40, 40};
  left.relative_px_s = {-100, 0};  // 4 px a frame
  right.relative_px_s = {0, 100};
  const std::vector<Track> tracks{{1, {20, 20}, {24.2F, 20}},   // background within 3 σ
                                  {2, {160, 120}, {160, 120}},  // with the left object
                                  {3, {160, 120}, {164, 124}},  // with the right one
                                  {4, {20, 220}, {20, 220}}};   // alone
  Frame analysis = analysis_of(tracks);
  analysis.background = background;
  analysis.objects = {left, right};
  SceneViewer viewer;
  const SceneView& scene = viewer.see(analysis, {0, 0, 321, 241});
  EXPECT_EQ(scene.tracks[0].owner, TrackOwner::kBackground);
  EXPECT_EQ(scene.tracks[1].owner, TrackOwner::kObject);
  EXPECT_EQ(scene.tracks[1].object, 7u);
  EXPECT_EQ(scene.tracks[2].object, 8u);
  EXPECT_EQ(scene.tracks[3].owner, TrackOwner::kUnknown);
  EXPECT_EQ(scene.objects.size(), 2u);
}

}  // namespace
}  // namespace spidar::test::scene_view_test
