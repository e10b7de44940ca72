// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Results of calibrate(), their standard deviations, and the cases that it must refuse.

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/spidar/calibration_samples.h"

namespace spidar::test::calibration_test {

namespace {

constexpr double kPeriod_s = 0.01;

void print_undetermined(const CalibrationResult& result) {
  for (const UndeterminedCombination& one : result.undetermined)
    std::printf("  undetermined: sd %g um: %s\n", 1e6 * one.sd_m, one.text.c_str());
}

/// |error| / standard deviation of normal variables: beyond 5 for one in 1.7 million.
constexpr double kFiveSigma = 5.0;

}  // namespace

// The counters were cleared centimetres and up to a radian away from the centre, and the strings
// are some millimetres off by themselves. The errors must be what the covariance says. Of 2 x 8
// runs with 8 offsets each, which may depend on each other, at least 16 are independent: their
// root mean square in units of sd is 1 with a standard deviation of at most 1/sqrt(2*16) = 0.177.
TEST(Calibration, OffsetsAreFoundAsWellAsPredicted) {
  constexpr int kRuns = 8;
  double sum = 0;
  int terms = 0;
  for (const char* name : {"spidar-gcc", "spidar-g6x3-v2-r"}) {
    const Profile profile = load_profile(name);
    for (unsigned seed = 1; seed <= kRuns; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Random random(seed);
      Profile device = profile;
      clear_counters_at(wrong_start(random, 0.05, 1.0), device);
      add_to_offsets(random, 3e-3, device);
      const CalibrationResult result =
          calibrate(profile, moved_counts(device, 400, kPeriod_s, random, 1.0));
      ASSERT_EQ(result.status, CalibrationStatus::kSolved);
      const StringVector error_m = zero_length_errors_m(profile, device, result);
      for (int i = 0; i < profile.geometry.count; ++i) {
        const double in_sd = error_m[i] / result.home_offset_sd_m[i];
        EXPECT_LT(std::abs(in_sd), kFiveSigma) << "string " << i;
        sum += in_sd * in_sd;
        ++terms;
      }
    }
  }
  EXPECT_NEAR(std::sqrt(sum / terms), 1.0, 3 * 0.177);
}

// Noise of one count and rounding: sqrt(1 + 1/12) counts. Of 400 samples with two redundant
// lengths, less eight offsets, a standard deviation is known to 1/sqrt(2*792) = 2.5 %; Huber's
// weights take up to 2 % away.
TEST(Calibration, NoiseAndStartAreReported) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(1);
  Profile device = profile;
  const Pose start = wrong_start(random, 0.03, 0.8);
  clear_counters_at(start, device);
  const CalibrationResult result =
      calibrate(profile, moved_counts(device, 400, kPeriod_s, random, 1.0));
  ASSERT_EQ(result.status, CalibrationStatus::kSolved);
  const double expected_m = std::sqrt(1 + 1.0 / 12) * profile.drives[0].metres_per_count;
  EXPECT_NEAR(result.length_noise_m / expected_m, 1.0, 3 * 0.025 + 0.02);
  // Where the hand begins and turns back, neighbours are alike.
  EXPECT_LE(result.samples, 400);
  EXPECT_GT(result.samples, 360);
  EXPECT_EQ(result.outlier_share, 0);
  // A pose is as good as the lengths that it is made of, here some ten micrometres and, over the
  // grip's radius of 32 mm, less than a milliradian; ten times that.
  EXPECT_LT((result.cleared_at.position_m - start.position_m).norm(), 1e-4);
  EXPECT_LT(result.cleared_at.orientation.angularDistance(start.orientation), 5e-3);
  // The hand goes to 0.4 of the half-width of 59 mm and 0.45 rad and back. Rotation vectors are
  // the hand's own.
  EXPECT_GT(result.moved_m.minCoeff(), 0.8 * 0.4 * 0.059);
  EXPECT_LT(result.moved_m.maxCoeff(), 1.01 * 0.4 * 0.059);
  EXPECT_GT(result.turned_rad.minCoeff(), 0.8 * 0.45);
  EXPECT_LT(result.turned_rad.maxCoeff(), 1.01 * 0.45);
}

// Exits wrong by a millimetre and the scale by half a percent. D follows the exits: truth is turned
// into the frame in which its exits lie best on the profile's.
TEST(Calibration, ExitsAndScaleAreFoundAsWellAsPredicted) {
  const Profile profile = load_profile("spidar-gcc");
  for (unsigned seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Profile device = profile;
    const int n = profile.geometry.count;
    const double scale = 1 + uniform(random, 0.005);
    for (size_t i = 0; i < static_cast<size_t>(n); ++i) {
      device.geometry.exit_m[i] += uniform_vector(random, 1e-3);
      device.drives[i].metres_per_count *= scale;
    }
    clear_counters_at(wrong_start(random, 0.02, 0.5), device);
    const CalibrationResult result =
        calibrate(profile, moved_counts(device, 3000, kPeriod_s, random, 0), {true, true});
    print_undetermined(result);
    ASSERT_EQ(result.status, CalibrationStatus::kSolved);
    EXPECT_LT(std::abs(result.scale - scale), kFiveSigma * result.scale_sd);
    const StringVector error_m = zero_length_errors_m(profile, device, result);
    Eigen::Matrix3Xd truth(3, n), wanted(3, n);
    for (int i = 0; i < n; ++i) {
      EXPECT_LT(std::abs(error_m[i]), kFiveSigma * result.home_offset_sd_m[i]) << "string " << i;
      truth.col(i) = device.geometry.exit_m[static_cast<size_t>(i)];
      wanted.col(i) = profile.geometry.exit_m[static_cast<size_t>(i)];
    }
    const Eigen::Matrix4d to_profile = Eigen::umeyama(truth, wanted, false);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<size_t>(i);
      const Eigen::Vector3d exit = (to_profile * truth.col(i).homogeneous()).head<3>();
      const Eigen::Vector3d in_sd =
          (result.exit_m[k] - exit).cwiseQuotient(result.exit_sd_m.col(i)).cwiseAbs();
      EXPECT_LT(in_sd.maxCoeff(), kFiveSigma) << "exit " << i;
    }
  }
}

// What the profile says of the device is wrong, and offsets are all that is asked for. Of errors
// that are normal, 95 % are within two standard deviations; the prior is not the distribution of
// the errors made here, therefore 90 %. What is refused makes no false statement.
TEST(Calibration, UncertaintyCoversAProfileThatIsWrong) {
  const Profile profile = load_profile("spidar-gcc");
  constexpr int kDevices = 8;
  const auto scale_all = [](Profile& device, Random&) {
    for (StringDrive& drive : device.drives) drive.metres_per_count *= 1.003;
  };
  const auto stretch = [](Profile& device, Random& random) {
    // Strings at their smallest tension, each longer than the drum has paid out.
    for (StringDrive& drive : device.drives)
      drive.metres_per_count *= 1 + std::abs(uniform(random, 0.004));
  };
  const auto move_exit = [](Profile& device, Random& random) {
    device.geometry.exit_m[random() % 8] += 1e-3 * uniform_vector(random, 1).normalized();
  };
  const auto nothing = [](Profile&, Random&) {};
  const std::pair<const char*, std::function<void(Profile&, Random&)>> models[] = {
      {"right", nothing}, {"scale", scale_all}, {"stretch", stretch}, {"exit", move_exit}};
  for (const auto& [name, spoil] : models) {
    int covered = 0, by_sd = 0, stated = 0, refused = 0;
    for (unsigned seed = 0; seed < kDevices; ++seed) {
      Random random(seed);
      Profile device = profile;
      clear_counters_at(wrong_start(random, 0.03, 0.5), device);
      spoil(device, random);
      const CalibrationResult result =
          calibrate(profile, moved_counts(device, 1000, 0.02, random, 1.0));
      if (result.status != CalibrationStatus::kSolved) {
        ++refused;
        continue;
      }
      const StringVector error_m = zero_length_errors_m(profile, device, result);
      for (int i = 0; i < profile.geometry.count; ++i) {
        ++stated;
        covered += std::abs(error_m[i]) <= 2 * result.home_offset_uncertainty_m[i];
        by_sd += std::abs(error_m[i]) <= 2 * result.home_offset_sd_m[i];
      }
    }
    RecordProperty(std::string(name) + "_covered_of_" + std::to_string(stated),
                   std::to_string(covered) + ", by sd " + std::to_string(by_sd));
    EXPECT_LT(refused, kDevices / 2) << name;
    EXPECT_GE(covered, 0.9 * stated) << name;
  }
}

// Offsets make up for most of an exit that is two millimetres off: the lengths agree to less than
// 50 µm. But what is left goes with the pose and is not noise. With exits free there is no
// contradiction.
TEST(Calibration, WrongGeometryIsAContradictionUnlessItIsFree) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(3);
  Profile device = profile;
  device.geometry.exit_m[2].x() += 2e-3;
  const CountSamples counts = moved_counts(device, 2000, kPeriod_s, random, 0);
  const CalibrationResult wrong = calibrate(profile, counts);
  EXPECT_EQ(wrong.status, CalibrationStatus::kContradiction);
  EXPECT_EQ(calibrate(profile, counts, {true, false}).status, CalibrationStatus::kSolved);
}

// One string is slack by 5 mm for a tenth of the time. A sample pulls by at most kHuber = 2.45 sd
// of a length, a good one by sqrt(2) sd in no direction on the whole: of K = 1000 samples a tenth
// pulls the result by at most 0.1/0.9 * 2.45 * sqrt(K) = 8.6 of its standard deviations, times how
// much more than the average these samples tell, which is less than 3. Plain least squares would be
// off by about a tenth of the 5 mm.
TEST(Calibration, SlackStringHardlyPulls) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(4);
  Profile device = profile;
  clear_counters_at(wrong_start(random, 0.03, 0.5), device);
  CountSamples counts = moved_counts(device, 1000, kPeriod_s, random, 1.0);
  const double slack_counts = 5e-3 / profile.drives[3].metres_per_count;
  counts.block(400, 3, 100, 1).array() += profile.drives[3].encoder_sign * slack_counts;
  const CalibrationResult result = calibrate(profile, counts);
  ASSERT_EQ(result.status, CalibrationStatus::kSolved);
  EXPECT_NEAR(result.outlier_share, 0.1, 0.002);
  const StringVector error_m = zero_length_errors_m(profile, device, result);
  for (int i = 0; i < 8; ++i)
    EXPECT_LT(std::abs(error_m[i]), 3 * 8.6 * result.home_offset_sd_m[i]) << "string " << i;
}

// Offsets of before the slip would be wrong afterwards, however few samples came after it.
TEST(Calibration, StringThatSlipsForGoodIsAContradiction) {
  const Profile profile = load_profile("spidar-gcc");
  for (const int after : {500, 100}) {
    Random random(5);
    CountSamples counts = moved_counts(profile, 1000, kPeriod_s, random, 0);
    counts.block(1000 - after, 6, after, 1).array() += 2e-3 / profile.drives[6].metres_per_count;
    EXPECT_EQ(calibrate(profile, counts).status, CalibrationStatus::kContradiction) << after;
  }
}

// Eight offsets and two redundant lengths at one pose: six combinations are open. Noise makes the
// samples differ but tells nothing.
TEST(Calibration, HeldStillDeterminesTwoCombinations) {
  const Profile profile = load_profile("spidar-gcc");
  for (const double noise : {0.0, 1.0}) {
    Random random(6);
    const CalibrationResult result = calibrate(
        profile, counts_of(profile, 500, kPeriod_s, random, noise, [](double) { return Pose{}; }));
    EXPECT_EQ(result.status, CalibrationStatus::kUndetermined) << noise;
    EXPECT_EQ(result.undetermined.size(), 6u) << noise;
    EXPECT_GT(result.home_offset_sd_m.minCoeff(), kMaxCalibrationSd_m) << noise;
    if (noise == 0) {
      EXPECT_EQ(result.samples, 1);
      EXPECT_TRUE(std::isinf(result.home_offset_sd_m[0]));
      EXPECT_FALSE(result.undetermined[0].text.empty());
    }
  }
}

// Moving along one axis only: of the singular values of the reduced Jacobian along z four are zero,
// because the frame is symmetric; along x and y none is, but at least one gives more than 50 µm.
TEST(Calibration, MotionAlongOneAxisIsReported) {
  const Profile profile = load_profile("spidar-gcc");
  for (int axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE("axis " + std::to_string(axis));
    Random random(7);
    const auto along = [&](double time_s) {
      Pose pose;
      pose.position_m[axis] = 0.03 * std::sin(2 * time_s);
      return pose;
    };
    const CalibrationResult result =
        calibrate(profile, counts_of(profile, 500, kPeriod_s, random, 0, along));
    EXPECT_EQ(result.status, CalibrationStatus::kUndetermined);
    EXPECT_GE(result.undetermined.size(), axis == 2 ? 4u : 1u);
  }
}

// Without turning the grip, an exit cannot be told from the point where its string is tied: what
// offsets need suffices, what exits need does not.
TEST(Calibration, ExitsNeedRotation) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(8);
  const auto shift = [](double time_s) {
    Pose pose;
    pose.position_m = 0.03 * Eigen::Vector3d(std::sin(1.9 * time_s), std::sin(2.3 * time_s + 1),
                                             std::sin(2.9 * time_s + 2));
    return pose;
  };
  const CountSamples counts = counts_of(profile, 1000, kPeriod_s, random, 0, shift);
  EXPECT_EQ(calibrate(profile, counts).status, CalibrationStatus::kSolved);
  const CalibrationResult result = calibrate(profile, counts, {true, false});
  EXPECT_EQ(result.status, CalibrationStatus::kUndetermined);
  EXPECT_GE(result.undetermined.size(), 4u);
}

TEST(Calibration, CentreMakesTheCountsThereZero) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(9);
  Profile device = profile;
  clear_counters_at(wrong_start(random, 0.03, 0.5), device);
  const CalibrationResult result = calibrate_at_centre(
      profile, counts_of(device, 100, kPeriod_s, random, 1.0, [](double) { return Pose{}; }));
  EXPECT_EQ(result.status, CalibrationStatus::kSolved);
  const StringVector error_m = zero_length_errors_m(profile, device, result);
  for (int i = 0; i < 8; ++i) {
    EXPECT_LT(std::abs(error_m[i]), kFiveSigma * result.home_offset_sd_m[i]);
    EXPECT_LT(result.home_offset_sd_m[i], 2 * profile.drives[0].metres_per_count);
  }
}

}  // namespace spidar::test::calibration_test
