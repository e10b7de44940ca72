// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The list of objects in the debug window.
#include <vector>

#include <gtest/gtest.h>

#include "plugin/window/program/model/object_click.h"
#include "plugin/window/program/model/object_list.h"

namespace spidar::test::object_list_test {
namespace {

using Eigen::Vector2d;

constexpr int64_t kFrame_ns = 40'000'000;

MovingObject object(uint32_t id, const Vector2d& middle_px, const Vector2d& size_px) {
  MovingObject made;
  made.id = id;
  made.position_px = middle_px;
  made.size_px = size_px;
  made.tracks = 10;
  return made;
}

/// Frame `n` of 200 × 100 px.
FrameFacts frame(int n, const std::vector<MovingObject>& objects) {
  FrameFacts made;
  made.visible = {0, 0, 200, 100};
  made.running_ns = n * kFrame_ns;
  made.film.stream_ns = 1'000'000'000 + n * kFrame_ns;
  made.film.scene_ns = 0;
  made.scene.objects = objects;
  return made;
}

std::vector<uint32_t> ids(const std::vector<const ListedObject*>& objects) {
  std::vector<uint32_t> ids;
  for (const ListedObject* one : objects) ids.push_back(one->id);
  return ids;
}
using Ids = std::vector<uint32_t>;

TEST(ObjectList, NamesWhatStaysForAMomentInTheOrderInWhichItCame) {
  ObjectList list;
  for (int n = 0; n < 10; ++n) {
    std::vector<MovingObject> objects = {object(7, {50, 0}, {40, 40})};
    if (n >= 1) objects.insert(objects.begin(), object(3, {-50, 10}, {20, 20}));
    if (n == 8) objects.push_back(object(9, {0, 0}, {20, 20}));
    list.see(frame(n, objects));
    if (n == 4) {
      EXPECT_EQ(ids(list.rows()), Ids()) << "0.16 s";
    }
  }
  EXPECT_EQ(ids(list.rows()), (Ids{7, 3}));
  const ListedObject& seven = *list.find(7);
  EXPECT_EQ(seven.first_ns, 1'000'000'000);
  EXPECT_NEAR((seven.first_place - Vector2d(0.75, 0.5)).norm(), 0, 1e-12);
  EXPECT_TRUE(seven.is_in_sight);
  EXPECT_FALSE(seven.is_felt);
  EXPECT_EQ(short_name(seven.id), "#7");
}

TEST(ObjectList, ListsWhatIsFeltAtOnce) {
  ObjectList list;
  FrameFacts facts = frame(0, {object(7, {50, 0}, {40, 40})});
  facts.scene.felt_object = 7;
  list.see(facts);
  ASSERT_EQ(ids(list.rows()), Ids{7});
  EXPECT_TRUE(list.rows()[0]->is_felt);
}

TEST(ObjectList, RemembersForTwoSecondsWhatIsOutOfSight) {
  ObjectList list;
  for (int n = 0; n < 10; ++n) list.see(frame(n, {object(7, {50, 0}, {40, 40})}));
  MovingObject hidden = object(7, {50, 0}, {40, 40});
  hidden.tracks = 0;
  // Seen last at 9 · 40 ms.
  for (int n = 10; n <= 58; ++n) list.see(frame(n, {hidden}));
  ASSERT_EQ(ids(list.rows()), Ids{7});
  EXPECT_FALSE(list.rows()[0]->is_in_sight);
  list.see(frame(60, {}));
  EXPECT_EQ(list.find(7), nullptr);
}

TEST(ObjectList, BeginsAnewWithASceneAFilmOrAnotherTime) {
  const std::vector<MovingObject> one = {object(7, {50, 0}, {40, 40})};
  FrameFacts cut = frame(10, {}), film = cut, back = frame(3, {});
  cut.film.scene_ns = cut.film.stream_ns;
  film.film.path = std::make_shared<const std::string>("/other.avi");
  for (const FrameFacts& next : {cut, film, back}) {
    ObjectList list;
    for (int n = 0; n < 10; ++n) list.see(frame(n, one));
    EXPECT_EQ(ids(list.rows()), Ids{7});
    list.see(next);
    EXPECT_TRUE(list.rows().empty());
  }
}

TEST(ObjectList, AsksForAPictureOfWhatIsSeenBetter) {
  ObjectList list;
  list.see(frame(0, {object(7, {95, 0}, {40, 40})}));
  ASSERT_EQ(ids(list.without_picture()), Ids{7});
  // 15 × 40 px of it are inside; the picture is 4 : 3 and 1.3 times as large.
  EXPECT_NEAR(list.find(7)->area_px2, 15 * 40 + 10 * 40, 1e-9);
  EXPECT_NEAR(list.find(7)->box.height, 52, 1e-9);
  list.pictured(7);
  EXPECT_TRUE(list.without_picture().empty());
  list.see(frame(1, {object(7, {84, 0}, {40, 40})}));  // 36 · 40 is less than 1.5 times as much
  EXPECT_TRUE(list.without_picture().empty());
  list.see(frame(2, {object(7, {60, 0}, {40, 40})}));
  EXPECT_EQ(ids(list.without_picture()), Ids{7});
}

TEST(ObjectList, KeepsItsPlacesForThoseInSight) {
  ObjectList list;
  std::vector<MovingObject> crowd;
  for (uint32_t id = 1; id <= ObjectList::kMost + 1; ++id)
    crowd.push_back(object(id, {-90.0 + 10 * id, 0}, {5, 5}));
  list.see(frame(0, crowd));
  EXPECT_NE(list.find(ObjectList::kMost), nullptr);
  EXPECT_EQ(list.find(ObjectList::kMost + 1), nullptr);
  const size_t slot = list.find(5)->slot;
  crowd.erase(crowd.begin() + 4);
  list.see(frame(1, crowd));  // the fifth is still seen to go
  list.see(frame(2, crowd));
  EXPECT_EQ(list.find(5), nullptr);
  ASSERT_NE(list.find(ObjectList::kMost + 1), nullptr);
  EXPECT_EQ(list.find(ObjectList::kMost + 1)->slot, slot);
}

/// In the middle of the large box is the small one.
TEST(ObjectList, FindsAPlaceThatMeansTheObject) {
  const FrameFacts facts = frame(0, {object(1, {-50, 0}, {60, 60}), object(2, {-50, 0}, {10, 10})});
  for (const MovingObject& one : facts.scene.objects) {
    const MovingObject* const there = object_at(facts, place_of(facts, one));
    ASSERT_NE(there, nullptr);
    EXPECT_EQ(there->id, one.id);
  }
}

}  // namespace
}  // namespace spidar::test::object_list_test
