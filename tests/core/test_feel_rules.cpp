// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a person writes of what is to be felt, and what is said of mistakes in it.
#include "core/choice/feel_rules.h"
#include "tests/support/test.h"

namespace spidar::test::feel_rules_test {
namespace {

constexpr int64_t kSecond = 1'000'000'000;

std::string error(const std::string& text) {
  try {
    const FeelRules rules(text);
  } catch (const FeelRulesError& error) {
    return error.what();
  }
  return "";
}

TEST(FeelRules, AreALineEachWithRemarksAndEmptyLines) {
  const FeelRules rules(
      "\xEF\xBB\xBF# what I want to feel; not all of it\r\n"
      "\n"
      "0:00-0:12   object at 0.31, 0.62  gain 1.5   # the dancer\r\n"
      "0:12 - 1:02:03.5 region 0.5,1 to 1,0\n"
      "  3723.5-\tleftmost");
  ASSERT_EQ(rules.rules().size(), 3u);
  const FeelRule& dancer = rules.rules()[0];
  EXPECT_EQ(dancer.line, 3);
  EXPECT_EQ(dancer.kind, FeelRule::Kind::kObjectAt);
  EXPECT_EQ(dancer.position, Eigen::Vector2d(0.31, 0.62));
  EXPECT_EQ(dancer.gain, 1.5);
  EXPECT_EQ(dancer.to_ns, 12 * kSecond);
  const FeelRule& region = rules.rules()[1];
  EXPECT_EQ(region.kind, FeelRule::Kind::kRegion);
  EXPECT_EQ(region.position, Eigen::Vector2d(0.5, 0));
  EXPECT_EQ(region.far_corner, Eigen::Vector2d(1, 1));
  EXPECT_EQ(region.to_ns, 3723 * kSecond + kSecond / 2);
  const FeelRule& last = rules.rules()[2];
  EXPECT_EQ(last.line, 5);
  EXPECT_EQ(last.kind, FeelRule::Kind::kFurthest);
  EXPECT_EQ(last.direction, Eigen::Vector2d(-1, 0));
  EXPECT_EQ(last.to_ns, FeelRule::kNoEnd);
}

TEST(FeelRules, HoldFromTheirBeginUpToTheirEnd) {
  const FeelRules rules("1-2 largest; 2-3 camera; 5- nothing");
  EXPECT_EQ(rules.at(kSecond - 1), nullptr);
  EXPECT_EQ(rules.at(kSecond)->kind, FeelRule::Kind::kLargest);
  EXPECT_EQ(rules.at(2 * kSecond - 1)->kind, FeelRule::Kind::kLargest);
  EXPECT_EQ(rules.at(2 * kSecond)->kind, FeelRule::Kind::kCamera);
  EXPECT_EQ(rules.at(3 * kSecond), nullptr);
  EXPECT_EQ(rules.at(100'000 * kSecond)->kind, FeelRule::Kind::kNothing);
  const FeelRules always("largest");
  EXPECT_EQ(always.at(0)->kind, FeelRule::Kind::kLargest);
  EXPECT_EQ(always.at(100'000 * kSecond)->kind, FeelRule::Kind::kLargest);
}

TEST(FeelRules, HaveOneFormInWhichTheyCanBeReadAgain) {
  const std::string text = FeelRules(
                               "0-12 object at .25,0.5 gain 2.0\n 12 - 72 region 1,1 to 0.5,0\n"
                               "0:1:12.25-80 largest\n3600-3601 topmost gain 0\n3601-3602 camera\n"
                               "3602-3603 rightmost\n3603-3604 bottommost\n3604- nothing")
                               .text();
  EXPECT_EQ(text,
            "0:00-0:12 object at 0.25,0.5 gain 2; 0:12-1:12 region 0.5,0 to 1,1; 1:12.25-1:20 "
            "largest; 1:00:00-1:00:01 topmost gain 0; 1:00:01-1:00:02 camera; 1:00:02-1:00:03 "
            "rightmost; 1:00:03-1:00:04 bottommost; 1:00:04- nothing");
  EXPECT_EQ(FeelRules(text).text(), text);
  EXPECT_EQ(FeelRules(" leftmost ").text(), "leftmost");
  const char* const boxes =
      "0:00-0:01 box; 0:01-0:02 box gain 2; 0:02-0:03 box face gain 0.5; 0:03- box \"traffic "
      "light\"";
  EXPECT_EQ(FeelRules(boxes).text(), boxes);
  EXPECT_STREQ(FeelRules("box \"gain\" gain 2").rules()[0].name.data(), "gain");
  EXPECT_STREQ(FeelRules("box gain 2").rules()[0].name.data(), "");
  const std::string longest(FeelRule::kLongestName, 'x');
  EXPECT_EQ(FeelRules("box " + longest).rules()[0].name.data(), longest);
}

/// A rounding residue, and the smallest number of all.
TEST(FeelRules, WriteEveryNumberSoThatItIsReadAgain) {
  for (const char* text :
       {"object at 0.31,5.551115123125783e-17", "largest gain 1.2345678901234567e-17",
        "region 0,5e-324 to 2.2250738585072014e-308,0.30000000000000004"}) {
    EXPECT_EQ(FeelRules(text).text(), text);
  }
}

TEST(FeelRules, SayWhatIsWrongAndInWhichLine) {
  const std::string all =
      "object at X,Y; largest; leftmost; rightmost; topmost; bottommost; box [NAME]; region X,Y "
      "to X,Y; camera; nothing";
  const std::string no_position =
      " is not a position such as 0.31,0.62: fractions, from 0 to 1, of the picture's width and "
      "height, "
      "from its top left corner";
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"", "line 1: there is no rule, which is one of: " + all},
      {"# nothing yet\n", "line 1: there is no rule, which is one of: " + all},
      {"camera\nbiggest", "line 2: \"biggest\" is none of: " + all},
      {"0-1 camera\n\n1-2", "line 3: what is felt is missing, one of: " + all},
      {"0-1 camera; 1-2 biggest", "line 2: \"biggest\" is none of: " + all},
      {"# a; b\n0-1 camera; 1-2 biggest", "line 2: \"biggest\" is none of: " + all},
      {"0:12 largest", "line 1: \"0:12\" has no end: FROM-TO, or FROM- up to the end of the film"},
      {"0:12-0:05 largest", "line 1: \"0:12-0:05\" ends before it begins"},
      {"0:12-0:12 largest", "line 1: \"0:12-0:12\" ends before it begins"},
      {"0:1x-0:20 largest", "line 1: \"0:1x\" is not a time such as 12.5, 0:12 or 1:02:03"},
      {"0-1:75 largest", "line 1: \"1:75\" is not a time such as 12.5, 0:12 or 1:02:03"},
      {"0-1:0:0:0 largest", "line 1: \"1:0:0:0\" is not a time such as 12.5, 0:12 or 1:02:03"},
      {"-5 largest", "line 1: \"\" is not a time such as 12.5, 0:12 or 1:02:03"},
      {"0-100000 largest", "line 1: \"100000\" is not a time such as 12.5, 0:12 or 1:02:03"},
      {"1-3 largest\n2-4 camera",
       "line 2: it begins at 0:02, before line 1 ends, which does so at 0:03"},
      {"largest\n2-4 camera", "line 2: it begins at 0:02, before line 1 ends, which never does"},
      {"object 0.5,0.5", "line 1: an object is object at X,Y, as in object at 0.31,0.62"},
      {"object at 0.5", "line 1: \"0.5\"" + no_position},
      {"object at here", "line 1: \"here\"" + no_position},
      {"object at 31,62", "line 1: \"31,62\"" + no_position},
      {"object at nan,0.5", "line 1: \"nan,0.5\"" + no_position},
      {"region 0,0", "line 1: a region is region X,Y to X,Y, from corner to corner"},
      {"region 0,0 to 0,1", "line 1: the region is empty: its corners are opposite ones"},
      {"box \"traffic light",
       "line 1: the name of a box is one word, or in quotes, as in box \"traffic light\""},
      {"box \"\"",
       "line 1: the name of a box is one word, or in quotes, as in box \"traffic light\""},
      {"box traffic light", "line 1: \"light\" follows the rule; only gain G can, as in gain 1.5"},
      {std::string("box a\0b", 7), "line 1: the name of a box has a control character: \"a?b\""},
      {"box " + std::string(64, 'x'), "line 1: the name of a box has at most 63 bytes, and \"" +
                                          std::string(40, 'x') + "…\" more"},
      {"largest gain 11", "line 1: \"11\" is not a gain from 0 to 10"},
      {"largest gain", "line 1: \"\" is not a gain from 0 to 10"},
      {"largest 1.5", "line 1: \"1.5\" follows the rule; only gain G can, as in gain 1.5"},
      {"leftmost gän", "line 1: \"g??n\" follows the rule; only gain G can, as in gain 1.5"},
      {std::string(100, 'x'), "line 1: \"" + std::string(40, 'x') + "…\" is none of: " + all},
  };
  for (const auto& [text, wanted] : mistakes) {
    EXPECT_EQ(error(text), wanted) << text;
  }
  EXPECT_EQ(error("0-nan largest"), "line 1: \"nan\" is not a time such as 12.5, 0:12 or 1:02:03");
  EXPECT_NE(error(std::string("largest\0camera", 14)), "");
}

std::string after(const std::string& text, const FeelEdit& edit) {
  std::string result;
  for (const FeelRule& rule : edited(FeelRules(text).rules(), edit)) {
    result += (result.empty() ? "" : "; ") + rule_text(rule);
  }
  return result;
}

TEST(FeelEdit, TakesTheTimeOfOtherRules) {
  const FeelEdit edit{10 * kSecond, 20 * kSecond, Eigen::Vector2d(0.25, 0.5)};
  const std::string chosen = "0:10-0:20 object at 0.25,0.5";
  EXPECT_EQ(after("0-10 camera; 20- largest", edit),
            "0:00-0:10 camera; " + chosen + "; 0:20- largest");
  EXPECT_EQ(after("largest gain 2", edit),
            "0:00-0:10 largest gain 2; " + chosen + "; 0:20- largest gain 2");
  EXPECT_EQ(after("5-12 camera; 12-13 box; 13-14 nothing; 18-25 region 0,0 to 1,1", edit),
            "0:05-0:10 camera; " + chosen + "; 0:20-0:25 region 0,0 to 1,1");
  EXPECT_EQ(after("10-20 object at 0.5,0.5 gain 3", edit), chosen);
  EXPECT_EQ(after("30- camera", edit), chosen + "; 0:30- camera");
}

TEST(FeelEdit, LeavesNoRuleAboutAnObjectWhosePlaceIsNotKnown) {
  const FeelEdit edit{10 * kSecond, 20 * kSecond, std::nullopt};
  EXPECT_EQ(after("5-25 object at 0.5,0.5", edit), "0:05-0:10 object at 0.5,0.5");
  EXPECT_EQ(after("12-25 object at 0.5,0.5; 25- object at 0,0", edit), "0:25- object at 0,0");
}

TEST(FeelEdit, WithoutDurationChangesNothing) {
  EXPECT_EQ(after("largest", {kSecond, kSecond, Eigen::Vector2d(0, 0)}), "largest");
  EXPECT_EQ(after("largest", {2 * kSecond, kSecond, std::nullopt}), "largest");
}

}  // namespace
}  // namespace spidar::test::feel_rules_test
