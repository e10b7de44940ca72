// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Two settings side by side in the debug window.
#include "plugin/window/program/model/settings_comparison.h"
#include "tests/support/test.h"

namespace spidar::test::settings_comparison_test {
namespace {

using Changes = std::vector<std::pair<std::string, double>>;

std::vector<window::Setting> settings_of(double alpha, double max_force_N, double mute = 0) {
  std::vector<window::Setting> settings(3);
  settings[0].name = "alpha";
  settings[0].value = alpha;
  settings[1].name = "max-force";
  settings[1].value = max_force_N;
  settings[2].name = "mute";
  settings[2].value = mute;
  return settings;
}

TEST(SettingsComparison, EachKeepsWhatIsChangedWhileItIsInUse) {
  window::SettingsComparison two;
  two.update(settings_of(0.01, 3));
  EXPECT_TRUE(two.are_same());
  EXPECT_TRUE(two.use(1).empty()) << "the second one begins as the first";
  two.update(settings_of(0.02, 3));
  EXPECT_FALSE(two.are_same());
  EXPECT_EQ(two.other().at("alpha"), 0.01);
  EXPECT_EQ(two.use(0), (Changes{{"alpha", 0.01}}));
  two.update(settings_of(0.01, 3));
  EXPECT_EQ(two.other().at("alpha"), 0.02);
  EXPECT_EQ(two.use(1), (Changes{{"alpha", 0.02}}));
}

// The element answers some time after it was asked.
TEST(SettingsComparison, AnAnswerFromBeforeChangesNothing) {
  window::SettingsComparison two;
  two.update(settings_of(0.01, 3));
  two.use(1);
  two.update(settings_of(0.02, 3));
  two.use(0);
  two.update(settings_of(0.02, 3));
  EXPECT_EQ(two.use(1), (Changes{{"alpha", 0.02}})) << "also before the answer has come";
  two.update(settings_of(0.01, 3));  // the answer to the question before
  two.update(settings_of(0.02, 3));
  EXPECT_EQ(two.other().at("alpha"), 0.01);
  EXPECT_EQ(two.use(0), (Changes{{"alpha", 0.01}}));
}

TEST(SettingsComparison, WhatTheElementRefusesHoldsNothingUp) {
  window::SettingsComparison two;
  two.update(settings_of(0.01, 3));
  two.use(1);
  two.update(settings_of(0.02, 3));
  two.use(0);
  for (int i = 0; i <= window::SettingsComparison::kMaxAnswers; ++i)
    two.update(settings_of(0.02, 3));
  two.update(settings_of(0.03, 3));
  EXPECT_EQ(two.use(1), (Changes{{"alpha", 0.02}}));
  EXPECT_EQ(two.other().at("alpha"), 0.03);
}

TEST(SettingsComparison, StoppingTheForceIsPartOfNeither) {
  window::SettingsComparison two;
  two.update(settings_of(0.01, 3));
  two.update(settings_of(0.01, 3, 1));
  EXPECT_TRUE(two.are_same());
  EXPECT_TRUE(two.use(1).empty());
}

TEST(SettingsComparison, AResetGivesBackWhatWasSeenFirst) {
  window::SettingsComparison two;
  two.update(settings_of(0.01, 3));
  two.update(settings_of(0.05, 1));
  EXPECT_EQ(two.reset(), (Changes{{"alpha", 0.01}, {"max-force", 3}}));
}

TEST(SettingsComparison, ControllerIsThatOfTheValues) {
  const ControllerSettings controller = window::with_values(
      {ControlLaw::kLinear, 3, 0.01},
      {{"controller", static_cast<double>(ControlLaw::kAdaptive)}, {"max-force", 2}});
  EXPECT_EQ(controller.law, ControlLaw::kAdaptive);
  EXPECT_EQ(controller.max_force_N, 2);
  EXPECT_EQ(controller.alpha_s_px, 0.01);
}

}  // namespace
}  // namespace spidar::test::settings_comparison_test
