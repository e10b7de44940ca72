// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The lag of a drive from a response that is known exactly.
#include <complex>

#include "spidar/selftest/lag_fit.h"
#include "tests/support/test.h"

namespace spidar::test::lag_fit_test {
namespace {

using Complex = std::complex<double>;
constexpr Complex kJ(0, 1);
constexpr int kPeriods = 12;

/// Of a grip of 0.1 kg that a light hand holds.
Complex grip_of(double w) {
  return 1.0 / (100.0 - 0.1 * w * w + kJ * 2.0 * w);
}

/// With errors of `noise` of the response, rms, and a variance that says so.
template <typename Response>
std::vector<selftest::ResponseLine> lines_of(const Response& response, double noise,
                                             uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1 / std::sqrt(2.0));
  std::vector<selftest::ResponseLine> lines;
  for (const double frequency_Hz : selftest::Multisine::kFrequency_Hz) {
    const Complex exact = response(2 * M_PI * frequency_Hz);
    const double sd = noise * std::abs(exact);
    const Complex error = sd * Complex(normal(random), normal(random));
    lines.push_back({frequency_Hz, exact + error, sd * sd});
  }
  return lines;
}

// An amplifier and a winding, neither of which is alone: T and T'. The model has one stage and a
// delay; one that agrees up to the second order (T² + T'²) differs by 2 (T² + T'²)^1.5 − 2 (T³ +
// T'³) in the third, a sixth of which times ω² is a lag: 76 µs at 64 Hz, in the middle of the lines
// that tell it from a delay. It errs towards too much.
TEST(LagFit, OfTwoStagesIsHardlyTooLong) {
  const auto response = [&](double w) {
    return grip_of(w) / ((1.0 + kJ * w * 0.001) * (1.0 + kJ * w * 0.0015));
  };
  const selftest::LagFit fit = selftest::fit_lag(lines_of(response, 0.005, 1), kPeriods);
  EXPECT_EQ(fit.error, "");
  EXPECT_GE(fit.most_s, 0.0025);
  EXPECT_LE(fit.least_s, 0.0025 + 76e-6);
}

/// A grip of 0.1 kg in fingers of `spring` N/m and `damper` N s/m, and those on a hand of 0.4 kg
/// that an arm of 300 N/m and 8 N s/m carries, behind a drive of 2 ms.
selftest::LagFit in_fingers_of(double spring, double damper) {
  const auto response = [&](double w) {
    const Complex fingers = spring + kJ * w * damper;
    const Complex hand = 300.0 - 0.4 * w * w + kJ * w * 8.0;
    const Complex held = fingers * hand / (fingers + hand);
    return std::exp(-kJ * w * 0.002) / (held - 0.1 * w * w);
  };
  return selftest::fit_lag(lines_of(response, 0.01, 1), kPeriods);
}

// The mass of a hand is not in the model. Soft fingers keep it away from the grip; hard ones make
// it a part of the grip. Between them nothing may be reported that is wrong by more than what would
// be refused as too vague.
TEST(LagFit, OfAHandOnFingersIsRightOrRefused) {
  int found = 0;
  for (const double spring : {100.0, 300.0, 1000.0, 3000.0, 10000.0}) {
    for (const double damper : {0.5, 2.0, 8.0}) {
      SCOPED_TRACE(testing::Message() << spring << " N/m, " << damper << " N s/m");
      const selftest::LagFit fit = in_fingers_of(spring, damper);
      if (!fit.error.empty()) continue;
      ++found;
      EXPECT_NEAR(fit.lag_s, 0.002, selftest::kVagueLag_s);
    }
  }
  EXPECT_GT(found, 0);
}

TEST(LagFit, GivesNoNumberWhereThereIsNone) {
  const auto expect_error = [](const auto& response, double noise, const char* part) {
    const selftest::LagFit fit = selftest::fit_lag(lines_of(response, noise, 1), kPeriods);
    EXPECT_NE(fit.error.find(part), std::string::npos) << part << ": " << fit.error;
  };
  const auto delayed = [](double w) { return grip_of(w) * std::exp(-kJ * w * 0.002); };
  expect_error(delayed, 2.0, "hardly moved");
  const auto sluggish = [](double w) { return grip_of(w) / (1.0 + kJ * w * 0.008); };
  expect_error(sluggish, 0.1, "could be told to within");
  const auto slow = [](double w) { return grip_of(w) * std::exp(-kJ * w * 0.04); };
  expect_error(slow, 0.005, "more than 30 ms");
  // Two grips that swing against each other.
  const auto resonant = [](double w) {
    return grip_of(w) + 1.0 / (0.02 * (8e4 - w * w) + kJ * 0.3 * w);
  };
  expect_error(resonant, 0.005, "not move as a mass");
}

}  // namespace
}  // namespace spidar::test::lag_fit_test
