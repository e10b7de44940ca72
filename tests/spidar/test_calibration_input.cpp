// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Messages of the calibration for unusable input.

#include "tests/spidar/calibration_samples.h"
#include "tests/support/messages.h"
#include "tests/support/test.h"

namespace spidar::test::calibration_input_test {

namespace {

std::string error_of(const std::function<void()>& call) {
  return message_of<std::invalid_argument>(call);
}

calibration::CountSamples good_counts(const Profile& profile) {
  Random random(1);
  return moved_counts(profile, 100, 0.05, random, 0);
}

}  // namespace

TEST(CalibrationInput, TooFewSamples) {
  const Profile profile = load_profile("spidar-gcc");
  const calibration::CountSamples counts = good_counts(profile).topRows(19);
  expect_contains(error_of([&] { calibration::calibrate(profile, counts); }),
                  "19 samples, must be at least 20");
  expect_contains(error_of([&] { calibration::calibrate_at_centre(profile, counts); }),
                  "19 samples");
}

TEST(CalibrationInput, NotANumber) {
  const Profile profile = load_profile("spidar-gcc");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    calibration::CountSamples counts = good_counts(profile);
    counts(17, 3) = bad;
    expect_contains(error_of([&] { calibration::calibrate(profile, counts); }),
                    "sample 17, string 3: ");
    expect_contains(error_of([&] { calibration::calibrate_at_centre(profile, counts); }),
                    "must be finite");
  }
}

TEST(CalibrationInput, WrongStringCount) {
  Profile profile = load_profile("spidar-gcc");
  const calibration::CountSamples counts = good_counts(profile);
  const calibration::CountSamples seven = counts.leftCols(7);
  expect_contains(error_of([&] { calibration::calibrate(profile, seven); }),
                  "counts of 7 strings, must have 8 as profile \"spidar-gcc\"");
  profile.geometry.count = 6;
  expect_contains(error_of([&] { calibration::calibrate(profile, counts.leftCols(6)); }),
                  "has 6 strings, must have at least 7");
}

// One redundant length instead of two: twice the samples.
TEST(CalibrationInput, SevenStringsDo) {
  Profile profile = load_profile("spidar-gcc");
  Random random(2);
  profile.geometry.count = 7;
  Profile device = profile;
  clear_counters_at(wrong_start(random, 0.02, 0.3), device);
  const calibration::Result result =
      calibration::calibrate(profile, moved_counts(device, 2000, 0.01, random, 0));
  ASSERT_EQ(result.status, calibration::Status::kSolved);
  EXPECT_LT(zero_length_errors_m(profile, device, result).cwiseAbs().maxCoeff(),
            calibration::kMaxSd_m);
}

TEST(CalibrationInput, GripThatMovesIsNotHeldAtTheCentre) {
  const Profile profile = load_profile("spidar-gcc");
  expect_contains(
      error_of([&] { calibration::calibrate_at_centre(profile, good_counts(profile)); }),
      "not held still");
}

TEST(CalibrationInput, OnlyASolvedResultMakesAProfile) {
  const Profile profile = load_profile("spidar-gcc");
  calibration::Result result;
  result.status = calibration::Status::kUndetermined;
  expect_contains(error_of([&] { calibration::calibrated_profile(profile, result, "a test"); }),
                  "not solved");
}

}  // namespace spidar::test::calibration_input_test
