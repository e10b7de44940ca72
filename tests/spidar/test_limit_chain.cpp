// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The lists of the limits of a tick are those of the page.
#include "spidar/chain/tension_chain.h"
#include "spidar/chain/wrench_chain.h"
#include "spidar/loop/haptic_loop.h"
#include "tests/support/test.h"

namespace spidar::test::limit_chain_test {
namespace {

/// The text of docs/architecture.md, which SPIDAR_PAGE names, each run of white space as one space.
std::string page() {
  const char* const path = std::getenv("SPIDAR_PAGE");
  std::ifstream file(path ? path : "docs/architecture.md");
  std::string text, word;
  while (file >> word) text += word + ' ';
  return text;
}

/// The list of a chain as the page has it, in Markdown.
template <typename Chain>
std::string listed() {
  std::string list;
  int number = 0;
  for (const auto& step : Chain::kSteps) {
    list += std::to_string(++number) + ". **" + step.name + "**: " + step.limit + ", " +
            step.reason + ' ';
  }
  return list;
}

TEST(LimitChains, ThePageListsWhatTheCodeDoes) {
  const std::string text = page();
  for (const std::string& list : {listed<WrenchChain>(), listed<TensionChain>()}) {
    const size_t at = text.find(list);
    ASSERT_NE(at, std::string::npos) << "docs/architecture.md lacks, in this order:\n" << list;
    EXPECT_FALSE(std::isdigit(text[at + list.size()])) << "the page goes on with the list " << list;
  }
}

// The numbers in these texts.
TEST(LimitChains, TheirTextsNameTheConstants) {
  EXPECT_EQ(SafetyLimits{}.max_slew_N_s, 300);
  EXPECT_EQ(SafetyLimits{}.max_slew_Nm_s, 10);
  EXPECT_EQ(SafetyLimits{}.ramp_s, 0.04);
  EXPECT_EQ(HapticLoop::kEnergise_s, 0.2);
  EXPECT_EQ(HapticLoop::kRelease_s, 0.05);
  EXPECT_EQ(TensionSlew::kRange_s, 0.02);
  EXPECT_EQ(TensionSlew::kMin_N_s, 300);
}

// Compared with what is not a number, the last two steps took nothing from the force of before.
TEST(LimitChains, RatesTakeWhatIsNotFiniteForNothing) {
  const Profile profile = load_profile(kDefaultProfile);
  SafetyLimits limits;
  VibrationBudget vibration(profile.geometry.grip_radius_m());
  GripBrake brake(profile.body(), profile.drive_lag_s);
  WrenchLimits rates;
  const Wrench before = rates.apply({{1, 0, 0}, {0, 0, 0}}, true, 1, limits);
  WrenchChain chain{limits, limits, limits, vibration, brake, rates,
                    {},     {},     before, true,      1e-3,  1e-3};
  for (const WrenchChain::Step& step : WrenchChain::kSteps) {
    if (std::string(step.name) != "Rates") continue;
    const Wrench bad{{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 0}};
    EXPECT_NEAR((chain.*step.function)(bad).force_N.x(), 1 - 1e-3 * limits.max_slew_N_s, 1e-12);
  }
}

// When the pose is lost, nothing says how fast the grip is: what the brake had left goes on from
// there.
TEST(LimitChains, NoForceReturnsWhereTheBrakeCannotAct) {
  const Profile profile = load_profile(kDefaultProfile);
  const SafetyLimits limits;
  const Wrench film{{3, 0, 0}, {0, 0, 0}}, left{{0.5, 0, 0}, {0, 0, 0}};
  GripTraits traits;
  traits.can_fly = true;
  for (const bool fresh : {false, true}) {
    VibrationBudget vibration(profile.geometry.grip_radius_m());
    GripBrake brake(profile.body(), profile.drive_lag_s);
    WrenchLimits rates;
    rates.apply(film, true, 1, limits);
    WrenchChain chain{limits, limits, limits, vibration, brake, rates,
                      traits, {},     left,   fresh,     1e-3,  1e-3};
    EXPECT_LE(chain.apply(film).force_N.norm(), 0.5 + 1e-3 * limits.max_slew_N_s + 1e-12);
  }
}

}  // namespace
}  // namespace spidar::test::limit_chain_test
