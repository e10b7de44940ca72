// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Of the objects that move, those that somebody else's boxes are around are felt.
#include "core/choice/object_choice.h"
#include "tests/support/test.h"

namespace spidar::test::boxed_object_test {
namespace {

using Eigen::Vector2d;

constexpr int kWidth = 400, kHeight = 200;
constexpr double kFrame_s = 0.04;

MovingObject object(uint32_t id, const Vector2d& middle_px, const Vector2d& size_px) {
  MovingObject made;
  made.id = id;
  made.position_px = middle_px;
  made.size_px = size_px;
  made.area_px2 = size_px.prod();
  made.points = 10;
  return made;
}

/// Around the middle, in px from the middle of the frame.
PictureBox box(const char* name, const Vector2d& middle_px, const Vector2d& size_px) {
  const auto position = [](const Vector2d& px) {
    return Vector2d(0.5 + px.x() / kWidth, 0.5 + px.y() / kHeight);
  };
  return {name, position(middle_px - size_px / 2), position(middle_px + size_px / 2)};
}

const Vector2d kLeft(-100, 0), kRight(100, 0), kSize(40, 80);

class Watcher {
 public:
  explicit Watcher(const std::string& rule) {
    choice_.set_rules(std::make_shared<FeelRules>(rule));
  }

  /// The id of the object that is felt; 0: none.
  uint32_t update(const std::vector<MovingObject>& objects, const std::vector<PictureBox>& boxes) {
    const int64_t now_ns = int64_t{frames_++} * 40'000'000;
    const Chosen chosen = choice_.choose({objects, nullptr, FilmPlace::whole(kWidth, kHeight),
                                          kFrame_s, frames_ == 1, now_ns, turn_, &boxes});
    state_ = chosen.state;
    return chosen.object ? chosen.object->id : 0;
  }
  /// The same for so long; the last answer.
  uint32_t see_for(double s, const std::vector<MovingObject>& objects,
                   const std::vector<PictureBox>& boxes) {
    uint32_t last = 0;
    for (const int end = frames_ + static_cast<int>(s / kFrame_s + 0.5); frames_ < end;) {
      last = update(objects, boxes);
    }
    return last;
  }

  Orientation turn_;
  Chosen::State state_ = Chosen::State::kGood;

 private:
  ObjectChoice choice_;
  int frames_ = 0;
};

const std::vector<MovingObject>& two() {
  static const std::vector<MovingObject> objects = {object(1, kLeft, kSize),
                                                    object(2, kRight, kSize)};
  return objects;
}

/// Which part of a thing a detector marks and which part of it moves are two questions.
TEST(BoxedObject, ItsBoxMayBeAPartOfItOrItAPartOfTheBox) {
  Watcher watcher("box");
  EXPECT_EQ(watcher.update(two(), {box("", kRight + Vector2d(0, -25), {20, 20})}), 2u);
  EXPECT_EQ(watcher.update(two(), {box("", kRight + Vector2d(0, 20), {60, 140})}), 2u);
  // 0.4 of either is in the other.
  EXPECT_EQ(Watcher("box").update(two(), {box("", kRight + Vector2d(24, 0), kSize)}), 0u);
  // Both are in it: the one that fills more of it is meant.
  const std::vector<MovingObject> ball_and_player = {object(1, {0, 60}, {10, 10}),
                                                     object(2, {0, 0}, kSize)};
  EXPECT_EQ(Watcher("box").update(ball_and_player, {box("", {0, 0}, {50, 140})}), 2u);
}

TEST(BoxedObject, OfATurnedPictureBoxesAreWhereTheyAreShown) {
  Watcher watcher("box");
  watcher.turn_ = Orientation(2);
  EXPECT_EQ(watcher.update(two(), {box("", kLeft, kSize)}), 2u);
}

TEST(BoxedObject, TheLargestOfSeveralAndThenThatOneAsLongAsItHasABox) {
  Watcher watcher("box");
  const std::vector<MovingObject> objects = {object(1, kLeft, kSize), object(2, kRight, 2 * kSize)};
  const PictureBox left = box("", kLeft, kSize), right = box("", kRight, 2 * kSize);
  EXPECT_EQ(watcher.update(objects, {left, right}), 2u);
  EXPECT_EQ(watcher.update({object(1, kLeft, 3 * kSize), objects[1]}, {left, right}), 2u);
  EXPECT_EQ(watcher.see_for(BoxedObject::kHold_s - kFrame_s, objects, {left}), 2u);
  EXPECT_EQ(watcher.see_for(2 * kFrame_s, objects, {left}), 1u);
  EXPECT_EQ(watcher.update(objects, {left, right}), 1u);
}

TEST(BoxedObject, ADetectorMayMissFramesButNotTheThing) {
  Watcher watcher("box");
  watcher.update(two(), {box("", kRight, kSize)});
  EXPECT_EQ(watcher.see_for(BoxedObject::kHold_s - kFrame_s, two(), {}), 2u);
  EXPECT_EQ(watcher.see_for(2 * kFrame_s, two(), {}), 0u);
}

TEST(BoxedObject, SaysWhetherBoxesOrObjectsAreMissingAndNotAtOnce) {
  const std::pair<std::vector<PictureBox>, Chosen::State> cases[] = {
      {{}, Chosen::State::kNoBox},
      {{box("cat", kLeft, kSize)}, Chosen::State::kNoBox},
      {{box("dog", {0, 60}, {20, 20})}, Chosen::State::kBoxAtRest}};
  for (const auto& [boxes, state] : cases) {
    Watcher watcher("box dog");
    watcher.see_for(BoxedObject::kBoxTimeout_s - kFrame_s, two(), boxes);
    EXPECT_EQ(watcher.state_, Chosen::State::kGood);
    watcher.see_for(2 * kFrame_s, two(), boxes);
    EXPECT_EQ(watcher.state_, state);
    EXPECT_EQ(watcher.update(two(), {box("dog", kLeft, kSize)}), 1u);
    EXPECT_EQ(watcher.state_, Chosen::State::kGood);
    watcher.see_for(10, two(), boxes);
    EXPECT_EQ(watcher.state_, Chosen::State::kGood) << "it rests, or has left";
  }
}

}  // namespace
}  // namespace spidar::test::boxed_object_test
