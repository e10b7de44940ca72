// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Compares the predicted standard deviations with ceres::Covariance of the same problem, formulated
// independently with automatic derivatives.

#include <vector>

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "tests/spidar/calibration_samples.h"

namespace spidar::test::calibration_covariance_test {

namespace {

struct LengthError {
  Eigen::Vector3d exit_m, grip_m;
  double home_m, paid_out_m;

  template <typename T>
  bool operator()(const T* position, const T* rotation, const T* offset, T* residual) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> p(position);
    const Eigen::Map<const Eigen::Quaternion<T>> q(rotation);
    const Eigen::Matrix<T, 3, 1> string = exit_m.cast<T>() - p - q * grip_m.cast<T>();
    residual[0] = string.norm() - T(home_m) - T(paid_out_m) - offset[0];
    return true;
  }
};

}  // namespace

TEST(CalibrationCovariance, AgreesWithCeres) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(11);
  const CountSamples counts = moved_counts(profile, 60, 0.1, random, 0);
  const CalibrationResult result = calibrate(profile, counts);
  ASSERT_EQ(result.status, CalibrationStatus::kSolved);

  const StringVector home_m = string_lengths_m(profile.geometry, {});
  std::vector<Eigen::Vector3d> positions(60, Eigen::Vector3d::Zero());
  std::vector<Eigen::Quaterniond> rotations(60, Eigen::Quaterniond::Identity());
  double offsets[8] = {};
  ceres::Problem problem;
  for (size_t k = 0; k < 60; ++k)
    for (size_t i = 0; i < 8; ++i) {
      const auto row = static_cast<Eigen::Index>(k);
      const auto column = static_cast<Eigen::Index>(i);
      const StringDrive& drive = profile.drives[i];
      auto* error =
          new LengthError{profile.geometry.exit_m[i], profile.geometry.grip_m[i], home_m[column],
                          drive.encoder_sign * drive.metres_per_count * counts(row, column)};
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LengthError, 1, 3, 4, 1>(error),
                               nullptr, positions[k].data(), rotations[k].coeffs().data(),
                               offsets + i);
    }
  for (Eigen::Quaterniond& rotation : rotations)
    problem.SetManifold(rotation.coeffs().data(), new ceres::EigenQuaternionManifold);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  ASSERT_TRUE(summary.IsSolutionUsable());

  ceres::Covariance::Options covariance_options;
  covariance_options.algorithm_type = ceres::SPARSE_QR;
  covariance_options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  ceres::Covariance covariance(covariance_options);
  std::vector<std::pair<const double*, const double*>> blocks;
  for (double& offset : offsets) blocks.emplace_back(&offset, &offset);
  ASSERT_TRUE(covariance.Compute(blocks, &problem));
  for (int i = 0; i < 8; ++i) {
    double variance = 0;
    ASSERT_TRUE(covariance.GetCovarianceBlock(offsets + i, offsets + i, &variance));
    // Both are linearised at their own optimum. Ours gives less weight to samples in Huber's tail,
    // 5 % of them, by less than half: that changes a standard deviation by less than 2.5 %.
    const double sd_m = result.length_noise_m * std::sqrt(variance);
    EXPECT_NEAR(result.home_offset_sd_m[i] / sd_m, 1.0, 0.025) << "string " << i;
    EXPECT_NEAR(result.home_offset_m[i], offsets[i], sd_m) << "string " << i;
  }
}

}  // namespace spidar::test::calibration_covariance_test
