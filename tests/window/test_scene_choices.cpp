// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What the debug window makes of choices: rules, and marks on the film.
#include "plugin/window/program/model/scene_choices.h"
#include "tests/support/test.h"

namespace spidar::test::scene_choices_test {
namespace {

using Eigen::Vector2d;

constexpr int64_t kSecond = 1'000'000'000, kFrame_ns = 40'000'000;

/// A film with cuts at whole multiples of two seconds.
class Film {
 public:
  explicit Film(window::SceneChoices& choices) : choices_(choices) {}

  void play(double from_s, double to_s, const std::vector<uint32_t>& objects) {
    const auto end_ns = static_cast<int64_t>(to_s * 1e9);
    auto ns = static_cast<int64_t>(from_s * 1e9);
    if (std::llabs(ns - next_ns_) > kFrame_ns / 2) {  // a seek
      ++epoch_;
      begin_ns_ = ns;
    }
    for (; ns < end_ns; ns += kFrame_ns) {
      next_ns_ = ns + kFrame_ns;
      begin_ns_ = std::max(begin_ns_, ns / (2 * kSecond) * 2 * kSecond);
      DrawnFrame report;
      report.stamp.epoch = epoch_;
      report.stamp.stream_ns = ns;
      report.film.begin_ns = begin_ns_;
      report.frame.interval_ns = 40 * 1'000'000;
      for (const uint32_t id : objects) {
        MovingObject object;
        object.id = id;
        object.points = 10;
        report.frame.objects.push_back(object);
      }
      report.click = click;
      choices_.update(report);
    }
  }
  uint32_t click = 0;  ///< that the element knows of

 private:
  window::SceneChoices& choices_;
  uint32_t epoch_ = 0;
  int64_t next_ns_ = 0, begin_ns_ = 0;
};

window::SeenObject object(uint32_t id, double first_s, const Vector2d& position) {
  window::SeenObject made;
  made.id = id;
  made.first_ns = static_cast<int64_t>(first_s * 1e9);
  made.first_position = position;
  return made;
}

/// The rules of the choices, beside those that there were.
std::string rules(const window::SceneChoices& choices, const std::string& before = "") {
  std::vector<FeelRule> now;
  if (!before.empty()) now = FeelRules(before).rules();
  for (const FeelEdit& edit : choices.edits()) now = edited(now, edit);
  std::string text;
  for (const FeelRule& rule : now) text += (text.empty() ? "" : "; ") + rule_text(rule);
  return text;
}

class Choices : public testing::Test {
 protected:
  window::SceneChoices choices;
  Film film{choices};
};

TEST_F(Choices, HoldFromTheFirstSightOfTheObjectToTheCut) {
  film.play(0, 1, {1, 2});
  choices.choose(object(1, 0.2409, {0.25049, 0.5}));
  EXPECT_EQ(rules(choices), "0:00.24-0:01 object at 0.25,0.5");
  film.play(1, 1.5, {1, 2});
  EXPECT_EQ(rules(choices), "0:00.24-0:01.52 object at 0.25,0.5") << "as far as it is known";
  film.play(1.52, 3, {3});
  EXPECT_EQ(rules(choices), "0:00.24-0:02 object at 0.25,0.5");
  choices.choose(object(3, 2.2, {0.75, 0.5}));
  film.play(3, 5, {});
  EXPECT_EQ(rules(choices), "0:00.24-0:02 object at 0.25,0.5; 0:02.2-0:04 object at 0.75,0.5");
}

TEST_F(Choices, TheLastOneOfASceneCounts) {
  film.play(0, 1, {1, 2});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  choices.choose(object(2, 0.4, {0.75, 0.5}));
  film.play(1, 2.1, {1, 2});
  EXPECT_EQ(rules(choices), "0:00.4-0:02 object at 0.75,0.5");
  EXPECT_EQ(choices.edits().size(), 1u);
}

TEST_F(Choices, OneThatCameAfterAnotherHadGoneFollowsIt) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  film.play(1, 1.8, {2});
  choices.choose(object(2, 1.2, {0.75, 0.5}));
  film.play(1.8, 2.1, {2});
  EXPECT_EQ(rules(choices), "0:00.2-0:01.2 object at 0.25,0.5; 0:01.2-0:02 object at 0.75,0.5");
}

TEST_F(Choices, EndWithASeekWhereNoCutWasSeen) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  film.play(40, 41, {5});
  EXPECT_EQ(rules(choices), "0:00.2-0:01 object at 0.25,0.5");
  choices.choose(object(5, 40.2, {0.75, 0.5}));
  film.play(0, 0.5, {});
  EXPECT_EQ(rules(choices), "0:00.2-0:01 object at 0.25,0.5; 0:40.2-0:41 object at 0.75,0.5");
}

TEST_F(Choices, EndWithASeekWithinTheScene) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  film.play(1.04, 1.2, {1});  // a frame further
  EXPECT_EQ(rules(choices), "0:00.2-0:01 object at 0.25,0.5");
  choices.choose(object(1, 1.04, {0.75, 0.5}));
  film.play(1.16, 1.5, {1});  // a frame back
  EXPECT_EQ(rules(choices), "0:00.2-0:01 object at 0.25,0.5; 0:01.04-0:01.2 object at 0.75,0.5");
}

/// When the film is played again, what `motion` says is felt from there on, as it was here.
TEST_F(Choices, EndWhereTheObjectWasSeenLastWhenItIsLost) {
  film.click = 1;
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  film.click = 0;
  film.play(1, 1.04, {1});  // the element knows of the one before and that it was let go of
  film.click = 2;
  film.play(1.04, 1.4, {1});
  film.play(1.4, 1.8, {2});
  EXPECT_EQ(rules(choices), "0:00.2-0:01.8 object at 0.25,0.5") << "it may come back";
  film.click = 0;
  film.play(1.8, 2.2, {2});
  EXPECT_EQ(rules(choices), "0:00.2-0:01.4 object at 0.25,0.5");
}

TEST_F(Choices, LetGoOfLeaveWhatTheRulesSay) {
  const std::string before = "0:00-0:01 camera";
  film.play(0, 1, {1});
  choices.choose(object(1, 0, {0.25, 0.5}));
  EXPECT_EQ(rules(choices, before), "0:00-0:01 object at 0.25,0.5");
  choices.undo_last();
  EXPECT_EQ(rules(choices, before), before);
  EXPECT_FALSE(choices.has_unsaved());
}

TEST_F(Choices, SavedOnesAreSavedAgainWhenTheirEndIsKnown) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  EXPECT_TRUE(choices.has_unsaved());
  EXPECT_FALSE(choices.has_late_end());
  choices.saved();
  film.play(1, 2, {1});
  EXPECT_FALSE(choices.has_unsaved());
  EXPECT_FALSE(choices.has_late_end());
  film.play(2, 2.1, {});
  EXPECT_TRUE(choices.has_late_end());
  EXPECT_EQ(rules(choices, "0:00.2-0:01 object at 0.25,0.5"), "0:00.2-0:02 object at 0.25,0.5");
  choices.saved();
  EXPECT_TRUE(choices.edits().empty());
}

TEST_F(Choices, SavedAndLetGoOfAreTakenOutOfTheRules) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  choices.saved();
  choices.undo_last();
  EXPECT_TRUE(choices.has_unsaved());
  EXPECT_EQ(rules(choices, "0:00.2-0:01 object at 0.25,0.5"), "");
  film.play(1, 2.1, {});
  EXPECT_FALSE(choices.has_late_end()) << "nothing is saved that nobody asked for";
}

TEST_F(Choices, ThatCannotBeSavedAreNotTriedAgain) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  choices.saved();
  choices.end_scene();
  EXPECT_TRUE(choices.has_late_end());
  choices.not_saved();
  EXPECT_FALSE(choices.has_late_end());
  EXPECT_TRUE(choices.has_unsaved());
}

TEST_F(Choices, OfAnObjectThatIsLostSayWhenOnce) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  film.click = 1;
  film.play(1, 1.5, {1});
  EXPECT_FALSE(choices.take_lost());
  film.click = 0;
  film.play(1.5, 1.9, {});
  EXPECT_NEAR(1e-9 * static_cast<double>(choices.take_lost().value_or(0)), 1.5, 0.04)
      << "the frame that was the last one";
  EXPECT_FALSE(choices.take_lost());
}

TEST_F(Choices, AndRulesCanBeRemoved) {
  film.play(0, 1, {1});
  choices.choose(object(1, 0.2, {0.25, 0.5}));
  choices.remove(200'000'000, 1 * kSecond);
  choices.remove(4 * kSecond, FeelRule::kNoEnd);
  EXPECT_EQ(rules(choices, "0:04- largest"), "");
  EXPECT_TRUE(choices.has_unsaved());
}

TEST_F(Choices, NeedATimeInTheFilm) {
  choices.update({});
  choices.choose(object(1, 0, {0.25, 0.5}));
  film.play(0, 1, {1});
  choices.choose(window::SeenObject());
  EXPECT_TRUE(choices.edits().empty());
}

DrawnFrame seen(double at_s, double scene_s, const std::vector<uint32_t>& objects) {
  DrawnFrame report;
  report.visible = {0, 0, 200, 100};
  report.frame.place = FilmPlace::whole(200, 100);
  report.stamp.stream_ns = static_cast<int64_t>(at_s * 1e9);
  report.film.begin_ns = static_cast<int64_t>(scene_s * 1e9);
  for (const uint32_t id : objects) {
    MovingObject object;
    object.id = id;
    object.points = 10;
    object.position_px = {50 * at_s, -25};  // to the right, in the upper half
    object.size_px = {10, 10};
    report.frame.objects.push_back(object);
  }
  return report;
}

TEST(SeenObjects, AreTheFirstOfTheScene) {
  window::SeenObjects seen_objects;
  seen_objects.update(seen(0, 0, {1}));
  seen_objects.update(seen(1, 0, {1, 2}));
  ASSERT_TRUE(seen_objects.find(1) && seen_objects.find(2));
  EXPECT_EQ(seen_objects.find(1)->first_ns, 0);
  EXPECT_EQ(seen_objects.find(1)->first_position, Vector2d(0.5, 0.25));
  EXPECT_EQ(seen_objects.find(2)->first_ns, kSecond);
  EXPECT_EQ(seen_objects.find(3), nullptr);
  seen_objects.update(seen(2.9, 0, {}));
  EXPECT_TRUE(seen_objects.find(1)) << "it may be hidden";
  seen_objects.update(seen(3.1, 0, {}));
  EXPECT_EQ(seen_objects.find(1), nullptr);
  seen_objects.update(seen(3.2, 0, {4}));
  seen_objects.update(seen(3.3, 3.3, {4}));
  EXPECT_EQ(seen_objects.find(4)->first_ns, static_cast<int64_t>(3.3e9)) << "after a cut";
}

TEST(SeenObjects, AreForgottenWithASeekAndGoOnAfterAGap) {
  window::SeenObjects seen_objects;
  seen_objects.update(seen(1, 0, {1}));
  DrawnFrame later = seen(2.5, 0, {1});
  seen_objects.update(later);
  EXPECT_EQ(seen_objects.find(1)->first_ns, kSecond) << "a gap in the film";
  ++later.stamp.epoch;
  seen_objects.update(later);
  EXPECT_EQ(seen_objects.find(1)->first_ns, later.stamp.stream_ns) << "to the same frame";
}

TEST(SeenObjects, PlacesAreThoseOfThePictureAsItIsShown) {
  DrawnFrame report = seen(1, 0, {1});
  report.turn = Orientation(1);
  window::SeenObjects seen_objects;
  seen_objects.update(report);
  EXPECT_LT((seen_objects.find(1)->first_position - Vector2d(0.75, 0.75)).norm(), 1e-12);
}

DrawnFrame moment(double now_s, double length_s, const std::string& path = "/film.avi") {
  DrawnFrame made;
  made.film.path = std::make_shared<const std::string>(path);
  made.film.length_ns = static_cast<int64_t>(length_s * 1e9);
  made.stamp.stream_ns = static_cast<int64_t>(now_s * 1e9);
  return made;
}

TEST(FilmStrip, MarksRulesAndChoices) {
  const FeelRules rules("0-10 camera; 20- largest");
  const std::vector<FeelEdit> edits = {{5 * kSecond, 15 * kSecond, Vector2d(0.5, 0.5)}};
  const window::FilmStrip strip = window::film_strip(moment(50, 100), &rules, edits);
  EXPECT_DOUBLE_EQ(strip.fraction(strip.now_ns), 0.5);
  ASSERT_EQ(strip.marks.size(), 3u);
  EXPECT_EQ(rule_text(strip.marks[0].rule), "0:00-0:05 camera");
  EXPECT_EQ(rule_text(strip.marks[1].rule), "0:05-0:15 object at 0.5,0.5");
  EXPECT_TRUE(strip.marks[1].is_new);
  EXPECT_FALSE(strip.marks[0].is_new) << "only shorter";
  EXPECT_FALSE(strip.marks[2].is_new);
  EXPECT_EQ(strip.fraction(strip.marks[2].rule.to_ns), 1);
  EXPECT_EQ(strip.at(0.1, 0), &strip.marks[1]);
  EXPECT_EQ(strip.at(0.17, 0), nullptr);
  EXPECT_EQ(strip.at(0.17, 0.025), &strip.marks[1]);
  EXPECT_EQ(strip.at(0.9, 0), &strip.marks[2]);
}

TEST(FilmStrip, IsOnlyThereForAFilmAndNeverEndsBeforeIt) {
  EXPECT_EQ(window::film_strip(moment(1, 100, ""), nullptr, {}).length_ns, 0);
  DrawnFrame unknown = moment(1, 100);
  unknown.stamp.stream_ns = -1;
  EXPECT_EQ(window::film_strip(unknown, nullptr, {}).length_ns, 0);
  EXPECT_EQ(window::film_strip({}, nullptr, {}).length_ns, 0);
  EXPECT_EQ(window::film_strip(moment(7, 0), nullptr, {}).length_ns, 7 * kSecond);
  EXPECT_EQ(window::FilmStrip().fraction(kSecond), 0);
}

}  // namespace
}  // namespace spidar::test::scene_choices_test
