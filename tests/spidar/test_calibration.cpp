// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Results of calibrate(), and the cases that it must refuse.

#include <Eigen/Geometry>

#include "tests/spidar/calibration_samples.h"
#include "tests/support/test.h"

namespace spidar::test::calibration_test {

namespace {

constexpr double kPeriod_s = 0.01;

// Noise of one count and rounding.
double noise_m(const Profile& profile) {
  return std::sqrt(1 + 1.0 / 12) * profile.drives[0].metres_per_count;
}

double largest_error_m(const Profile& profile, const Profile& device,
                       const calibration::Result& result) {
  return zero_length_errors_m(profile, device, result).cwiseAbs().maxCoeff();
}

}  // namespace

// The counters were cleared centimetres and up to a radian away from the centre, and the strings
// are some millimetres off by themselves.
TEST(Calibration, OffsetsAndTheStartAreFound) {
  for (const char* name : {"spidar-gcc", "spidar-g6x3-v2-r"}) {
    const Profile profile = load_profile(name);
    for (unsigned seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Random random(seed);
      Profile device = profile;
      const Pose start = wrong_start(random, 0.05, 1.0);
      clear_counters_at(start, device);
      if (seed % 2) add_to_offsets(random, 3e-3, device);
      const calibration::Result result =
          calibration::calibrate(profile, moved_counts(device, 400, kPeriod_s, random, 1.0));
      ASSERT_EQ(result.status, calibration::Status::kSolved);
      EXPECT_LT(largest_error_m(profile, device, result), calibration::kMaxSd_m);
      // Two of eight lengths are redundant: what is left of the noise has a quarter of its square.
      // A standard deviation of 2 x 400 values is known to 2.5 %; Huber's weights take 2 % away.
      EXPECT_NEAR(result.residual_m / (noise_m(profile) / 2), 1.0, 3 * 0.025 + 0.02);
      // Where the hand begins and turns back, neighbours are alike.
      EXPECT_LE(result.samples, 400);
      EXPECT_GT(result.samples, 360);
      if (seed % 2 || profile.name != "spidar-gcc") continue;
      // A pose is as good as the lengths that it is made of, here some ten micrometres and, over
      // the grip's radius of 32 mm, less than a milliradian; ten times that.
      EXPECT_LT((result.cleared_at.position_m - start.position_m).norm(), 1e-4);
      EXPECT_LT(result.cleared_at.orientation.angularDistance(start.orientation), 5e-3);
      // The hand turns by 0.45 rad and back. Rotation vectors are the hand's own.
      EXPECT_GT(result.turned_rad.minCoeff(), 0.8 * 0.45);
      EXPECT_LT(result.turned_rad.maxCoeff(), 1.01 * 0.45);
    }
  }
}

// The hand does not begin at the centre, but up to 2 cm an axis and 20° beside it.
TEST(Calibration, TheHandMayBeginBesideTheCentre) {
  const Profile profile = load_profile("spidar-gcc");
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Profile device = profile;
    clear_counters_at(wrong_start(random, 0.05, 1.0), device);
    const Pose beside = wrong_start(random, 0.02, M_PI / 9);
    const calibration::CountSamples counts =
        counts_of(device, 400, kPeriod_s, random, 1.0, [&](double time_s) {
          const double left = std::max(0.0, 1 - time_s / 2);
          const Pose moved = calibration::hand_in_motion(device.geometry, time_s);
          return Pose{
              moved.position_m + left * beside.position_m,
              Eigen::Quaterniond::Identity().slerp(left, beside.orientation) * moved.orientation};
        });
    const calibration::Result result = calibration::calibrate(profile, counts);
    ASSERT_EQ(result.status, calibration::Status::kSolved);
    EXPECT_LT(largest_error_m(profile, device, result), calibration::kMaxSd_m);
  }
}

// Exits wrong by a millimetre and the scale by half a percent. D follows the exits: truth is turned
// into the frame in which its exits lie best on the profile's.
TEST(Calibration, ExitsAndScaleAreFound) {
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
    const calibration::Result result = calibration::calibrate(
        profile, moved_counts(device, 3000, kPeriod_s, random, 0), {true, true});
    ASSERT_EQ(result.status, calibration::Status::kSolved);
    // What "solved" promises.
    EXPECT_LT(std::abs(result.scale - scale) * string_lengths_m(profile.geometry, {}).mean(),
              calibration::kMaxSd_m);
    EXPECT_LT(largest_error_m(profile, device, result), calibration::kMaxSd_m);
    Eigen::Matrix3Xd truth(3, n), wanted(3, n), found(3, n);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<size_t>(i);
      truth.col(i) = device.geometry.exit_m[k];
      wanted.col(i) = profile.geometry.exit_m[k];
      found.col(i) = result.exit_m[k];
    }
    const Eigen::Matrix4d to_profile = Eigen::umeyama(truth, wanted, false);
    const Eigen::Matrix3Xd exits = (to_profile * truth.colwise().homogeneous()).topRows<3>();
    EXPECT_LT((found - exits).cwiseAbs().maxCoeff(), calibration::kMaxSd_m);
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
  const calibration::CountSamples counts = moved_counts(device, 2000, kPeriod_s, random, 0);
  const calibration::Result wrong = calibration::calibrate(profile, counts);
  EXPECT_EQ(wrong.status, calibration::Status::kContradiction);
  EXPECT_EQ(calibration::calibrate(profile, counts, {true, false}).status,
            calibration::Status::kSolved);
}

// One string is slack by 5 mm for a tenth of the time. Plain least squares would be off by about a
// tenth of that.
TEST(Calibration, SlackStringHardlyPulls) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(4);
  Profile device = profile;
  clear_counters_at(wrong_start(random, 0.03, 0.5), device);
  calibration::CountSamples counts = moved_counts(device, 1000, kPeriod_s, random, 1.0);
  const double slack_counts = 5e-3 / profile.drives[3].metres_per_count;
  counts.block(400, 3, 100, 1).array() += profile.drives[3].encoder_sign * slack_counts;
  const calibration::Result result = calibration::calibrate(profile, counts);
  ASSERT_EQ(result.status, calibration::Status::kSolved);
  EXPECT_LT(largest_error_m(profile, device, result), calibration::kMaxSd_m);
}

// Offsets of before the slip would be wrong afterwards, however few samples came after it.
TEST(Calibration, StringThatSlipsForGoodIsAContradiction) {
  const Profile profile = load_profile("spidar-gcc");
  for (const int after : {500, 100}) {
    Random random(5);
    calibration::CountSamples counts = moved_counts(profile, 1000, kPeriod_s, random, 0);
    counts.block(1000 - after, 6, after, 1).array() += 2e-3 / profile.drives[6].metres_per_count;
    EXPECT_EQ(calibration::calibrate(profile, counts).status, calibration::Status::kContradiction)
        << after;
  }
}

// Eight offsets and two redundant lengths at one pose: six combinations are open. Noise makes the
// samples differ but tells nothing.
TEST(Calibration, HeldStillDeterminesTooLittle) {
  const Profile profile = load_profile("spidar-gcc");
  for (const double noise : {0.0, 1.0}) {
    Random random(6);
    const calibration::Result result = calibration::calibrate(
        profile, counts_of(profile, 500, kPeriod_s, random, noise, [](double) { return Pose{}; }));
    EXPECT_EQ(result.status, calibration::Status::kUndetermined) << noise;
    if (noise == 0) {
      EXPECT_EQ(result.samples, 1);
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
    const calibration::Result result =
        calibration::calibrate(profile, counts_of(profile, 500, kPeriod_s, random, 0, along));
    EXPECT_EQ(result.status, calibration::Status::kUndetermined);
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
  const calibration::CountSamples counts = counts_of(profile, 1000, kPeriod_s, random, 0, shift);
  EXPECT_EQ(calibration::calibrate(profile, counts).status, calibration::Status::kSolved);
  const calibration::Result result = calibration::calibrate(profile, counts, {true, false});
  EXPECT_EQ(result.status, calibration::Status::kUndetermined);
}

TEST(Calibration, CentreMakesTheCountsThereZero) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(9);
  Profile device = profile;
  clear_counters_at(wrong_start(random, 0.03, 0.5), device);
  const calibration::Result result = calibration::calibrate_at_centre(
      profile, counts_of(device, 100, kPeriod_s, random, 1.0, [](double) { return Pose{}; }));
  EXPECT_EQ(result.status, calibration::Status::kSolved);
  // Of a hundred counts, each off by one, a mean is known to a tenth: five times that, and
  // rounding.
  EXPECT_LT(largest_error_m(profile, device, result), profile.drives[0].metres_per_count);
}

}  // namespace spidar::test::calibration_test
