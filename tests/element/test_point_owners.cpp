// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// To which object each point belongs.
#include "plugin/frame/point_owners.h"
#include "tests/support/test.h"

namespace spidar::test::point_owners_test {
namespace {

DrawnFrame report_of(const std::vector<FollowedPoint>& points, const PicturePart& visible) {
  DrawnFrame report;
  report.frame.picture = FrameComparison::kOther;
  report.frame.points = points;
  report.frame.interval_ns = 40'000'000;
  report.visible = visible;
  report.frame.place = FilmPlace::whole(visible.width, visible.height);
  return report;
}

TEST(PointOwners, TellsNewAndLostPoints) {
  PointOwners owners;
  const PicturePart visible{10, 20, 320, 240};
  const std::vector<FollowedPoint> first{{1, {0, 0}, {1, 0}}, {2, {5, 5}, {6, 5}}};
  const std::vector<FollowedPoint> second{{3, {9, 9}, {9, 9}}, {1, {1, 0}, {2, 0}}};
  DrawnFrame report = report_of(first, visible);
  owners.find(report);
  for (const OwnedPoint& point : report.points) {
    EXPECT_FALSE(point.is_new) << "nothing to compare with";
  }
  report = report_of(second, visible);
  owners.find(report);
  ASSERT_EQ(report.points.size(), 2u);
  EXPECT_TRUE(report.points[0].is_new);
  EXPECT_FALSE(report.points[1].is_new);
  EXPECT_EQ(report.points[1].to.x_px, 12) << "in the frame, not in its visible part";
  EXPECT_EQ(report.points[1].to.y_px, 20);
  ASSERT_EQ(report.lost.size(), 1u);
  EXPECT_EQ(report.lost[0].x_px, 16);
  report = DrawnFrame();  // a restart
  owners.find(report);
  report = report_of(first, visible);
  owners.find(report);
  EXPECT_TRUE(report.lost.empty());
}

TEST(PointOwners, TheArrowOfTheForceBeginsOnTheObjectThatIsFelt) {
  DrawnFrame report;
  report.visible = {10, 20, 321, 241};
  report.frame.place = FilmPlace::whole(321, 241);
  report.frame.objects.resize(1);
  report.frame.objects[0].id = 7;
  report.frame.objects[0].position_px = {-30, 40};
  const auto origin_px = [&](const std::vector<uint32_t>& felt) {
    report.felt = felt;
    return force_origin_px(report);
  };
  const Eigen::Vector2d middle_px(170, 140);
  EXPECT_EQ(origin_px({}), middle_px);
  EXPECT_EQ(origin_px({7, 8}), middle_px) << "not one alone";
  EXPECT_EQ(origin_px({7}), middle_px + report.frame.objects[0].position_px)
      << "nothing else is known";
  // Three corners of a square, as of a banana: its mean (97, 97) is beside it.
  for (const ImagePoint at : {ImagePoint{80, 80}, {80, 130}, {130, 80}}) {
    report.points.push_back({1, at, at, PointOwner::kObject, 7, false});
  }
  report.points.push_back({2, {97, 97}, {97, 97}, PointOwner::kBackground, 0, false});
  report.points.push_back({3, {97, 97}, {97, 97}, PointOwner::kObject, 8, false});
  EXPECT_EQ(origin_px({7}), Eigen::Vector2d(80, 80));
}

TEST(PointOwners, TellsTheBackgroundFromObjects) {
  Background background;
  background.model.kind = ModelKind::kTranslation;
  background.model.shift_px = {4, 0};
  background.sigma_px = 0.1;
  MovingObject left, right;  // boxes overlap at the centre of the frame
  left.id = 7;
  right.id = 8;
  left.points = right.points = 3;
  left.position_px = {-10, 0};
  right.position_px = {10, 0};
  left.size_px = right.size_px = {40, 40};
  left.relative_px_s = {-100, 0};  // 4 px a frame
  right.relative_px_s = {0, 100};
  const std::vector<FollowedPoint> points{{1, {20, 20}, {24.2F, 20}},   // background within 3 σ
                                          {2, {160, 120}, {160, 120}},  // with the left object
                                          {3, {160, 120}, {164, 124}},  // with the right one
                                          {4, {20, 220}, {20, 220}}};   // alone
  DrawnFrame report = report_of(points, {0, 0, 321, 241});
  report.frame.background = background;
  report.frame.objects = {left, right};
  PointOwners().find(report);
  EXPECT_EQ(report.points[0].owner, PointOwner::kBackground);
  EXPECT_EQ(report.points[1].owner, PointOwner::kObject);
  EXPECT_EQ(report.points[1].object, 7u);
  EXPECT_EQ(report.points[2].object, 8u);
  EXPECT_EQ(report.points[3].owner, PointOwner::kUnknown);
}

}  // namespace
}  // namespace spidar::test::point_owners_test
