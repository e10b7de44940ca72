// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// An object keeps its id while it is in view, meets others or is hidden, and loses it when it has
// gone.
#include "core/analysis/motion_analyzer.h"
#include "core/motion/objects/object_tracker.h"
#include "tests/core/field_film.h"
#include "tests/support/picture.h"
#include "tests/support/scene_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::object_identity_test {
namespace {

using Eigen::Vector2d;
using test::in_disc;
using test::kSceneFrame_ns;
using test::kSceneFrame_s;
using test::Scene;
using test::Texture;

/// An object is one from the second pair of frames on in which it moves.
constexpr int kFound = 2;

/// A disc of texture that goes its way, positions in px from the upper left corner.
struct Disc {
  uint32_t texture;  ///< seed
  double radius_px;
  std::function<Vector2d(int n)> centre_px;
};

Disc straight(uint32_t texture, const Vector2d& from_px, const Vector2d& step_px,
              double radius_px = 50) {
  return {texture, radius_px, [=](int n) { return Vector2d(from_px + n * step_px); }};
}

/// An obstacle in front of all discs, which moves with the background.
struct Post {
  double left_px;
  double right_px;
};

/// What was found: the ids of each frame, and where each was.
struct Film {
  std::vector<Disc> discs;  ///< the last ones are in front
  std::vector<Post> posts;
  Vector2d pan_px{0, 0};  ///< by which the background goes, a frame

  double grey(int n, const Vector2d& at) const {
    static const Texture wall(1, 10);
    static const Texture stone(2, 10);
    const Vector2d behind = at - n * pan_px;
    for (const Post& post : posts) {
      if (behind.x() > post.left_px && behind.x() < post.right_px) {
        return stone.at(behind.x(), behind.y());
      }
    }
    for (size_t k = discs.size(); k-- > 0;) {
      const Vector2d centre = discs[k].centre_px(n);
      if (!in_disc(at, centre, discs[k].radius_px)) continue;
      const Vector2d on = at - centre;
      return Texture(discs[k].texture, 10).at(on.x(), on.y());
    }
    return wall.at(behind.x(), behind.y());
  }
};

/// An object found in a frame.
struct Seen {
  uint32_t id;
  Vector2d at_px;  ///< from the upper left corner
  Vector2d moved_px;
};

std::vector<std::vector<Seen>> watch(const Film& film, int frames) {
  MotionAnalyzer analyzer;
  std::vector<std::vector<Seen>> seen(static_cast<size_t>(frames));
  for (int n = 0; n < frames; ++n) {
    const auto picture = test::draw([&](int k, const Vector2d& at) { return film.grey(k, at); }, n);
    const Frame found = analyzer.analyze(picture.view(), n * kSceneFrame_ns);
    for (const MovingObject& object : found.objects) {
      if (object.points == 0) continue;
      const Vector2d middle_px((test::kSceneWidth - 1) / 2.0, (test::kSceneHeight - 1) / 2.0);
      seen[static_cast<size_t>(n)].push_back(
          {object.id, object.position_px + middle_px, object.on_screen_px_s * kSceneFrame_s});
    }
  }
  return seen;
}

/// Blocks are 24 px of these frames wide: the middle of those on a disc is within one of its own.
constexpr double kPosition_px = 24;

/// The id of what moves as the disc does and is where it is; 0 when nothing is.
uint32_t id_of(const std::vector<Seen>& seen, const Disc& disc, int n) {
  const Vector2d centre_px = disc.centre_px(n);
  const Vector2d moved_px = centre_px - disc.centre_px(n - 1);
  for (const Seen& object : seen) {
    if ((object.at_px - centre_px).norm() < kPosition_px &&
        (object.moved_px - moved_px).norm() < 0.25 * moved_px.norm()) {
      return object.id;
    }
  }
  return 0;
}

/// The one id that a disc has in the frames first … last, in all of which it is to be found.
uint32_t only_id(const std::vector<std::vector<Seen>>& seen, const Disc& disc, int first,
                 int last) {
  std::set<uint32_t> ids;
  for (int n = first; n <= last; ++n) {
    const uint32_t id = id_of(seen[static_cast<size_t>(n)], disc, n);
    EXPECT_NE(id, 0u) << "not found in frame " << n;
    if (id != 0) ids.insert(id);
  }
  EXPECT_EQ(ids.size(), 1u) << "ids in frames " << first << " to " << last;
  return ids.empty() ? 0 : *ids.begin();
}

TEST(ObjectIdentity, TwoThatPassEachOtherKeepTheirs) {
  // On rows of their own, so that they are never both on one block.
  Film film;
  film.discs = {straight(3, {150, 100}, {6, 0}), straight(4, {490, 260}, {-6, 0})};
  const auto seen = watch(film, 40);
  EXPECT_NE(only_id(seen, film.discs[0], kFound, 39), only_id(seen, film.discs[1], kFound, 39));
}

/// Frames in which the discs are further apart than this, from the first pair on.
struct Meeting {
  int last_before = 0;
  int first_after = 0;
};

Meeting meeting(const Disc& a, const Disc& b, int frames, double apart_px) {
  Meeting found;
  for (int n = kFound; n < frames; ++n) {
    if ((a.centre_px(n) - b.centre_px(n)).norm() > apart_px) continue;
    if (found.last_before == 0) found.last_before = n - 1;
    found.first_after = n + 1;
  }
  return found;
}

/// Their ids before they meet are those after they have met.
void expect_kept_across(const Film& film, int frames) {
  const Disc& a = film.discs[0];
  const Disc& b = film.discs[1];
  const auto seen = watch(film, frames);
  // A block and a half between them: no block and no neighbour of one is on both.
  const Meeting met = meeting(a, b, frames, a.radius_px + b.radius_px + 36);
  ASSERT_GT(met.last_before, kFound + 2);
  ASSERT_LT(met.first_after, frames - 3);
  const uint32_t id_a = only_id(seen, a, kFound, met.last_before);
  const uint32_t id_b = only_id(seen, b, kFound, met.last_before);
  EXPECT_NE(id_a, id_b);
  EXPECT_EQ(only_id(seen, a, met.first_after + 1, frames - 1), id_a);
  EXPECT_EQ(only_id(seen, b, met.first_after + 1, frames - 1), id_b);
}

TEST(ObjectIdentity, IsKeptWhereTwoCross) {
  const Disc right = straight(3, {120, 190}, {8, 0}), left = straight(4, {520, 180}, {-8, 0});
  const struct {
    const char* how;
    Film film;
  } crossings[] = {
      {"head on", {{right, left}, {}}},
      {"at a right angle",
       {{straight(3, {120, 180}, {8, 0}, 40), straight(4, {320, 20}, {0, 7}, 40)}, {}}},
      {"one overtakes the other",
       {{straight(3, {260, 180}, {3, 0}, 40), straight(4, {60, 175}, {12, 0}, 40)}, {}}},
      {"while the camera pans", {{right, left}, {}, {-4, 1}}},
      {"a large one hides a small one",
       {{straight(3, {110, 180}, {9, 0}, 35), straight(4, {500, 180}, {-7, 0}, 75)}, {}}}};
  for (const auto& crossing : crossings) {
    SCOPED_TRACE(crossing.how);
    expect_kept_across(crossing.film, 44);
  }
}

/// A post that hides discs of 80 px in whole for four frames of 10 px.
constexpr Post kPost{260, 380};

/// Of a film with kPost: the first and last frame in which the disc is in view in whole on one side
/// of it, with half a block to spare.
int last_before_post(const Film& film, const Disc& disc) {
  int n = 0;
  while (disc.centre_px(n).x() - n * film.pan_px.x() < kPost.left_px - disc.radius_px - 12) ++n;
  return n - 1;
}
int first_after_post(const Film& film, const Disc& disc) {
  int n = 0;
  while (disc.centre_px(n).x() - n * film.pan_px.x() < kPost.right_px + disc.radius_px + 12) ++n;
  return n;
}

TEST(ObjectIdentity, IsTheSameBehindAPost) {
  for (const Vector2d& pan_px : {Vector2d(0, 0), Vector2d(-3, 1)}) {
    Film film;
    film.pan_px = pan_px;
    film.discs = {straight(3, {100, 180}, {10, 0}, 40)};
    film.posts = {kPost};
    const Disc& disc = film.discs[0];
    const int after = first_after_post(film, disc);
    const auto seen = watch(film, after + 6);
    EXPECT_EQ(only_id(seen, disc, kFound, last_before_post(film, disc)),
              only_id(seen, disc, after, after + 5))
        << "pan " << pan_px.transpose();
  }
}

TEST(ObjectIdentity, TwoThatGoBehindAPostOneAfterTheOtherKeepTheirs) {
  Film film;
  film.discs = {straight(3, {210, 180}, {10, 0}, 40), straight(4, {70, 180}, {10, 0}, 40)};
  film.posts = {kPost};
  const int frames = first_after_post(film, film.discs[1]) + 4;
  const auto seen = watch(film, frames);
  std::vector<uint32_t> ids;
  for (const Disc& disc : film.discs) {
    const int after = first_after_post(film, disc);
    ids.push_back(only_id(seen, disc, kFound, std::max(kFound, last_before_post(film, disc))));
    EXPECT_EQ(only_id(seen, disc, after, after + 3), ids.back());
  }
  EXPECT_NE(ids[0], ids[1]);
}

TEST(ObjectIdentity, OneThatHasLeftIsNotInheritedByOneThatEntersThere) {
  // The first leaves to the right; 0.2 s later another comes in there the other way.
  Film film;
  film.discs = {straight(3, {400, 180}, {12, 0}), straight(4, {1060, 190}, {-9, 0})};
  const auto seen = watch(film, 60);
  EXPECT_NE(only_id(seen, film.discs[0], kFound, 15), only_id(seen, film.discs[1], 54, 59));
}

TEST(ObjectIdentity, OneBehindAPostIsNotInheritedByAnotherThatComesBackFromThere) {
  // The first stays behind the post, and the other one, which was there, leaves.
  Film film;
  film.posts = {kPost};
  film.discs = {{3, 40, [](int n) { return Vector2d(std::min(120 + 10 * n, 320), 180); }},
                {4, 40, [](int n) { return Vector2d(std::min(320, 320 - 10 * (n - 20)), 180); }}};
  const auto seen = watch(film, 41);
  EXPECT_NE(only_id(seen, film.discs[0], kFound, last_before_post(film, film.discs[0])),
            only_id(seen, film.discs[1], 36, 40));
}

TEST(ObjectIdentity, IsForgottenWhenItHasBeenOutOfSightForLong) {
  // Gone behind a post and out again much later than kForgotten_s.
  const int away = 3 * static_cast<int>(ObjectTracker::kForgotten_s / kSceneFrame_s);
  Film film;
  film.posts = {kPost};
  film.discs = {{3, 40, [=](int n) {
                   const int moving = n < 25 ? n : n < 25 + away ? 25 : n - away;
                   return Vector2d(120.0 + 8 * moving, 180);
                 }}};
  const auto seen = watch(film, 60 + away);
  EXPECT_NE(only_id(seen, film.discs[0], kFound, 10),
            only_id(seen, film.discs[0], 25 + away + 15, 59 + away));
}

TEST(ObjectIdentity, OneThatStandsStillForAMomentIsTheSame) {
  const int rest = static_cast<int>(0.5 * ObjectTracker::kForgotten_s / kSceneFrame_s);
  Film film;
  film.discs = {{3, 50, [=](int n) {
                   const int moving = n < 10 ? n : n < 10 + rest ? 10 : n - rest;
                   return Vector2d(120.0 + 7 * moving, 180);
                 }}};
  const auto seen = watch(film, 25 + rest);
  EXPECT_EQ(only_id(seen, film.discs[0], kFound, 10),
            only_id(seen, film.discs[0], 10 + rest + kFound, 24 + rest));
}

/// How often a disc that goes to the right counts as an object, in a field of which the outer parts
/// move with the background and the rest by `depth_px` more: back left of the disc's middle, on
/// right of it. 60 % of the picture is such a layer.
int times_found(const Vector2d& depth_px) {
  const Vector2d camera_px(0.5, 0);
  const Vector2d disc_px(3, 0);
  const Texture wall(1, 8);
  const Texture cover(2, 8);
  const auto scene = [&](int n, const Vector2d& at) {
    const Vector2d centre = Vector2d(200, 120) + n * (camera_px + disc_px);
    if (in_disc(at, centre, 36)) return cover.at(at.x() - centre.x(), at.y() - centre.y());
    const bool is_layer = at.x() > 0.2 * test::kFieldWidth && at.x() < 0.8 * test::kFieldWidth;
    const double depth = !is_layer ? 0 : at.x() < 0.5 * test::kFieldWidth ? -1 : 1;
    const Vector2d from = at - n * (camera_px + depth * depth_px);
    return wall.at(from.x(), from.y());
  };
  int found = 0;
  for (const auto& objects : test::objects_in(scene, 6, test::background_moved_by(camera_px))) {
    for (const MovingObject& object : objects) {
      found +=
          (object.relative_px_s * kSceneFrame_s - disc_px).norm() < 0.5 && object.prominence > 0;
    }
  }
  return found;
}

TEST(ObjectTracker, WhatMovesNoMoreThanTheLayersAroundItIsNoObject) {
  EXPECT_GE(times_found({0, 0}), 4) << "of 5 pairs, it is found in the second";
  // 3 px is less than five standard deviations of 2.5 / 0.67 px.
  EXPECT_EQ(times_found({2.5, 0}), 0);
}

}  // namespace
}  // namespace spidar::test::object_identity_test
