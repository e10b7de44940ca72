// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Of several objects, the one that a person chose is felt, for as long as anybody knows where it
// is.
#include "core/analysis/motion_analyzer.h"
#include "core/choice/object_choice.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::object_choice_test {
namespace {

using Eigen::Vector2d;

constexpr int kWidth = 480, kHeight = 270;
constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kFrame_s = 0.04;
/// Frames until an object is known, for it is one in the second pair of frames in which it moves.
constexpr int kKnown = 4;

struct Disc {
  double radius_px;
  std::function<Vector2d(double n)> centre_px;  ///< from the middle of frame n
};

double wave(double n, double period) {
  return std::sin(2 * 3.14159265 * n / period);
}

Disc large() {
  return {45, [](double n) { return Vector2d(-120 + 60 * wave(n, 60), -60); }};
}
Disc middle() {
  return {32, [](double n) { return Vector2d(140, -40 + 50 * wave(n, 50)); }};
}
Disc small() {
  return {24, [](double n) { return Vector2d(90 * wave(n, 70), 90 + 10 * wave(n, 35)); }};
}

std::string rule_at(double from_s, double to_s, const Disc& disc, const std::string& more = "") {
  const Vector2d at_px = disc.centre_px(from_s / kFrame_s);
  return std::to_string(from_s) + "-" + std::to_string(to_s) + " object at " +
         std::to_string(0.5 + at_px.x() / kWidth) + "," +
         std::to_string(0.5 + at_px.y() / kHeight) + more + "\n";
}

/// Plays discs, and says which of them is felt.
class Player {
 public:
  /// A plain wall behind them is drawn in a fraction of the time.
  explicit Player(std::vector<Disc> discs, bool plain = true)
      : discs_(std::move(discs)), scene_(kWidth, kHeight) {
    if (plain) scene_.plain_background();
    for (const Disc& disc : discs_) scene_.add_disc(disc.radius_px);
  }

  void set_rules(const std::string& text) {
    settings_.feel = std::make_shared<FeelRules>(text);
    analyzer_.configure(settings_);
  }
  void click(uint32_t count, const Vector2d& position) {
    settings_.kept = {count, position};
    analyzer_.configure(settings_);
  }

  const Frame& next() {
    std::vector<Placement> positions;
    for (const Disc& disc : discs_) positions.push_back({disc.centre_px(frames_)});
    const int64_t now_ns = frames_ * kFrame_ns;
    frame_ = analyzer_.analyze(scene_.draw({pan_px * frames_}, positions), now_ns, now_ns);
    ++frames_;
    return frame_;
  }
  void skip(int frames) { frames_ += frames; }
  void play_to(int frame) {
    while (frames_ < frame) next();
  }

  /// The number of the disc whose motion is felt alone; -1: none.
  int felt() const {
    if (frame_.felt_object == 0) return -1;
    for (const MovingObject& object : frame_.objects) {
      if (object.id != frame_.felt_object) continue;
      int nearest = 0;
      for (int i = 1; i < static_cast<int>(discs_.size()); ++i)
        if (distance_px(i, object) < distance_px(nearest, object)) nearest = i;
      return nearest;
    }
    return -1;
  }
  /// Fraction of the frames up to `end` in which that disc is felt.
  double fraction_felt(int disc, int end) {
    int all = 0, right = 0;
    while (frames_ < end) {
      next();
      ++all;
      right += felt() == disc;
    }
    return static_cast<double>(right) / all;
  }

  Vector2d pan_px{0, 0};  ///< by which the background moves in a frame

 private:
  double distance_px(int disc, const MovingObject& object) const {
    return (discs_[static_cast<size_t>(disc)].centre_px(frames_ - 1) - object.position_px).norm();
  }

  std::vector<Disc> discs_;
  MovingScene scene_;
  AnalyzerSettings settings_;
  MotionAnalyzer analyzer_;
  Frame frame_;
  int frames_ = 0;
};

/// What a person asks for; the frames in which an object is not known yet are left out.
constexpr double kMaxFrames = 0.95;

TEST(ObjectChoice, FollowsTheObjectOfEachRule) {
  Player player({large(), middle(), small()}, false);
  player.set_rules(rule_at(0, 1, small()) + rule_at(1, 2, large()) + rule_at(2, 3, middle()));
  player.play_to(kKnown);
  EXPECT_GE(player.fraction_felt(2, 25), kMaxFrames);
  EXPECT_GE(player.fraction_felt(0, 50), kMaxFrames);
  EXPECT_GE(player.fraction_felt(1, 75), kMaxFrames);
}

/// An object that rests is none for the tracker after a second.
TEST(ObjectChoice, AnObjectThatRestsIsTheSameWhenItGoesOn) {
  const Disc walker = {30, [](double n) {
                         const double walks = n < 30 ? n : n < 90 ? 30 : n - 60;
                         return Vector2d(-150 + 3 * walks, 60);
                       }};
  Player player({walker, middle()});
  player.set_rules(rule_at(0, 9, walker));
  player.play_to(kKnown);
  EXPECT_GE(player.fraction_felt(0, 30), kMaxFrames);
  double felt_N = 0;
  for (int n = 40; n < 90; ++n) {
    const Frame& frame = player.next();
    EXPECT_NE(player.felt(), 1) << n;
    if (n >= 60) felt_N = std::max(felt_N, frame.wrench.force_N.norm());
  }
  EXPECT_EQ(felt_N, 0);
  player.play_to(94 + kKnown);
  EXPECT_GE(player.fraction_felt(0, 130), kMaxFrames);
}

TEST(ObjectChoice, TheOneThatBeginsToMoveLaterIsFound) {
  const Disc sleeper = {30,
                        [](double n) { return Vector2d(-150 + 3 * std::max(0.0, n - 50), 60); }};
  Player player({sleeper, middle()});
  player.set_rules(rule_at(0, 9, sleeper));
  player.play_to(30);
  EXPECT_EQ(player.next().choice.state, Chosen::State::kNotThere) << "this is told";
  EXPECT_EQ(player.felt(), -1);
  player.play_to(50 + kKnown);
  EXPECT_GE(player.fraction_felt(0, 110), kMaxFrames);
}

TEST(ObjectChoice, AnObjectThatHasLeftIsLostAndItsForceFades) {
  const Disc leaver = {30, [](double n) { return Vector2d(100 + 5 * n, 60); }};
  Player player({leaver, large()});
  player.set_rules(rule_at(0, 9, leaver));
  player.play_to(20);
  EXPECT_EQ(player.felt(), 0);
  // Out of the picture after 34 frames; nothing is left of the force 0.1 s later.
  player.play_to(40);
  for (int n = 40; n < 75; ++n) EXPECT_EQ(player.next().wrench.force_N.norm(), 0) << n;
  EXPECT_EQ(player.next().choice.state, Chosen::State::kLost);
}

TEST(ObjectChoice, WhatWasNotSeenAtItsTimeIsNotKnown) {
  Player player({large(), middle()});
  player.set_rules(rule_at(0, 9, large()));
  player.skip(50);
  player.play_to(60);
  EXPECT_EQ(player.next().choice.state, Chosen::State::kNotSeen);
  EXPECT_EQ(player.felt(), -1);
}

/// What a perfect tracker would find; the first disc has id 1.
std::vector<MovingObject> objects_at(const std::vector<Disc>& discs, int n) {
  std::vector<MovingObject> objects;
  for (const Disc& disc : discs) {
    MovingObject object;
    object.id = static_cast<uint32_t>(objects.size()) + 1;
    object.position_px = disc.centre_px(n);
    object.size_px.setConstant(2 * disc.radius_px);
    object.area_px2 = object.size_px.prod();
    object.relative_px_s = (disc.centre_px(n) - disc.centre_px(n - 1)) / kFrame_s;
    object.points = 10;
    objects.push_back(object);
  }
  return objects;
}

TEST(ObjectChoice, OfTwoAtAPositionTheSmallerOneIsMeant) {
  const auto here_px = [](double) { return Vector2d(0, 0); };
  const Disc front{24, here_px}, behind{45, here_px};
  for (const uint32_t id : {1u, 2u}) {
    FollowedObject followed;
    followed.begin({0, 0}, 0);
    const auto objects = objects_at({id == 1 ? front : behind, id == 1 ? behind : front}, 0);
    EXPECT_EQ(followed.update(objects, kHeight, kFrame_s, nullptr), &objects[id - 1]);
  }
}

TEST(ObjectChoice, OneThatComesBackWithAnotherIdWhereItWouldBeIsTheSame) {
  const Disc runner = {10, [](double n) { return Vector2d(-100 + 10 * n, 0); }};
  FollowedObject followed;
  followed.begin(runner.centre_px(0), 0);
  for (int n = 0; n <= 8; ++n) {
    std::vector<MovingObject> objects;
    if (n <= 4 || n == 8) objects = objects_at({runner}, n);
    if (n == 8) objects[0].id = 7;
    EXPECT_EQ(followed.update(objects, kHeight, kFrame_s, nullptr) != nullptr, !objects.empty())
        << n;
  }
}

/// When somebody changes other rules of the file while the film plays.
TEST(ObjectChoice, ARuleThatIsThereAsBeforeGoesOnWithItsObject) {
  Player player({small(), large()});
  player.set_rules(rule_at(0, 2, small()));
  player.play_to(40);
  ASSERT_EQ(player.felt(), 0);
  player.set_rules(rule_at(0, 1.8, small()) + "1.8- camera");
  player.next();
  EXPECT_EQ(player.felt(), 0);
  player.set_rules(rule_at(0, 2, large()));
  player.next();
  EXPECT_EQ(player.felt(), -1) << "its object was at that position long ago";
}

TEST(ObjectChoice, OfTheLargestAndOfThoseAtTheSides) {
  const std::pair<const char*, uint32_t> rules[] = {
      {"largest", 1}, {"leftmost", 1}, {"rightmost", 2}, {"bottommost", 3}};
  const std::pair<const char*, uint32_t> turned[] = {
      {"leftmost", 2}, {"rightmost", 1}, {"topmost", 3}};
  const auto play = [](const char* rule, const Orientation& turn) {
    ObjectChoice choice;
    choice.set_rules(std::make_shared<FeelRules>(rule));
    std::vector<int> frames(4, 0);
    for (int n = 0; n < 100; ++n) {
      const std::vector<MovingObject> objects = objects_at({large(), middle(), small()}, n);
      const Chosen chosen = choice.choose({objects, nullptr, FilmPlace::whole(kWidth, kHeight),
                                           kFrame_s, n == 0, n * kFrame_ns, turn});
      ++frames[chosen.object ? chosen.object->id : 0];
    }
    return frames;
  };
  for (const auto& [rule, disc] : rules) {
    SCOPED_TRACE(rule);
    EXPECT_EQ(play(rule, {})[disc], 100);
  }
  const Orientation upside_down(2);
  for (const auto& [rule, disc] : turned) {
    SCOPED_TRACE(rule);
    EXPECT_EQ(play(rule, upside_down)[disc], 100);
  }
}

/// Two of nearly the same size do not take turns.
TEST(ObjectChoice, TheLargestStaysUntilAnotherIsClearlyLarger) {
  ObjectChoice choice;
  choice.set_rules(std::make_shared<FeelRules>("largest"));
  int changes = 0;
  uint32_t last = 0;
  for (int n = 0; n < 100; ++n) {
    std::vector<MovingObject> objects = objects_at({large(), middle()}, n);
    objects[0].area_px2 = n < 50 ? 1000 + 100 * (n % 2) : 1500;
    objects[1].area_px2 = 1050;
    const Chosen chosen = choice.choose(
        {objects, nullptr, FilmPlace::whole(kWidth, kHeight), kFrame_s, n == 0, n * kFrame_ns, {}});
    ASSERT_NE(chosen.object, nullptr);
    changes += chosen.object->id != last;
    last = chosen.object->id;
  }
  EXPECT_EQ(changes, 2) << "the first one, and then the larger one";
}

TEST(ObjectChoice, OfARegionOnlyWhatIsInIt) {
  Player player({large(), middle(), small()}, false);
  player.set_rules("region 0.6,0 to 1,0.65");
  player.play_to(kKnown);
  for (int n = kKnown; n < 50; ++n) {
    const Frame& frame = player.next();
    const double true_px_s = (middle().centre_px(n) - middle().centre_px(n - 1)).y() / kFrame_s;
    // The other discs go sideways, with up to 157 px/s.
    EXPECT_LT(std::fabs(frame.motion.velocity_px_s.x()), 15) << n;
    EXPECT_NEAR(frame.motion.velocity_px_s.y(), true_px_s, 0.2 * 157) << n;
  }
}

TEST(ObjectChoice, OfTheCameraOrOfNothing) {
  Player player({large(), middle()}, false);
  player.pan_px << 3, 0;
  player.set_rules("0-1 camera; 1-2 nothing");
  player.play_to(20);
  EXPECT_LT(player.next().motion.velocity_px_s.x() * kFrame_s, -0.9 * 3);
  EXPECT_LT(player.next().wrench.force_N.x(), -0.1);
  player.play_to(29);
  const Frame& nothing = player.next();
  EXPECT_EQ(nothing.wrench.force_N.norm(), 0);
  player.play_to(56);
  EXPECT_GT(player.next().wrench.force_N.norm(), 0.1) << "what motion says, where no rule is";
}

TEST(ObjectChoice, GainChangesTheForceUpToTheLargest) {
  const auto force_N = [](const std::string& more) {
    Player player({large(), middle()});
    player.set_rules(rule_at(0, 9, large(), more));
    player.play_to(20);
    return player.next().wrench.force_N.norm();
  };
  const double plain_N = force_N("");
  EXPECT_GT(plain_N, 0.2);
  // Rounding of two products.
  EXPECT_NEAR(force_N(" gain 0.5"), plain_N / 2, 1e-12);
  EXPECT_EQ(force_N(" gain 0"), 0);
  EXPECT_NEAR(force_N(" gain 10"), std::min(10 * plain_N, ControllerSettings().max_force_N), 1e-12);
}

TEST(ObjectChoice, AClickKeepsWhatIsThereAndComesBeforeRules) {
  Player player({large(), middle(), small()});
  player.set_rules("largest");
  player.play_to(20);
  EXPECT_EQ(player.felt(), 0);
  const Vector2d at_px = small().centre_px(19);
  player.click(1, {0.5 + at_px.x() / kWidth, 0.5 + at_px.y() / kHeight});
  EXPECT_GE(player.fraction_felt(2, 60), kMaxFrames);
  player.click(0, {0, 0});
  EXPECT_GE(player.fraction_felt(0, 80), kMaxFrames);
  player.click(2, {0.05, 0.95});
  player.next();
  EXPECT_EQ(player.felt(), 0) << "there is nothing";
  player.play_to(100);
  EXPECT_EQ(player.next().choice.state, Chosen::State::kNotThere);
}

}  // namespace
}  // namespace spidar::test::object_choice_test
