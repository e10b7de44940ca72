// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tensions of the strings when there is no force.
#include "spidar/chain/tension_command.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/string_grip.h"
#include "tests/spidar/loop_driver.h"
#include "tests/support/random_motion.h"
#include "tests/support/tampered_device.h"
#include "tests/support/test.h"

namespace spidar::test::rest_test {
namespace {

constexpr int kSeed = 14;

/// Goes from the centre to `pose` in 50 ms and stays for as long again.
void take_grip(LoopDriver& driver, const Pose& pose) {
  for (int i = 1; i <= 100; ++i) {
    const double way = std::min(1.0, i / 50.0);
    put_grip(driver,
             {way * pose.position_m, Eigen::Quaterniond::Identity().slerp(way, pose.orientation)});
    driver.tick();
  }
}

double force_N(const Profile& profile, const Pose& pose, const StringVector& tension_N) {
  return (structure_matrix(profile.geometry, pose) * tension_N).head<3>().norm();
}

TEST(Rest, IsMinimumTensionWhereverTheGripIs) {
  RandomMotion random(kSeed);
  for (const std::string& name : list_profiles()) {
    LoopDriver driver({}, load_profile(name));
    driver.open();
    const StringVector least_N = driver.profile.min_tension_N();
    for (int n = 0; n < 10; ++n) {
      const Pose pose = random.pose(0.02, M_PI / 3);
      take_grip(driver, pose);
      const StringVector tension_N = tensions_N(driver.log().last_volts, driver.profile);
      for (int i = 0; i < driver.profile.geometry.count; ++i)
        ASSERT_LE(tension_N[i], 3 * least_N[i]) << name << ", string " << i;
      // Tensions are a product and a quotient of what they are.
      ASSERT_LE(force_N(driver.profile, pose, tension_N),
                force_N(driver.profile, pose, least_N) + 1e-12)
          << name;
    }
  }
}

// Tensions at rest do not depend on the pose, so a zero that is wrong by 5 mm and 3° does not
// change them: the net force on the grip is that of the minimum tensions at its real pose.
TEST(Rest, IsNoStrongerWhenTheZeroIsWrong) {
  RandomMotion random(kSeed);
  for (const std::string& name : list_profiles()) {
    const Profile believed = load_profile(name);
    const Profile real = zeroed_at(
        believed, {0.005 * random.direction(),
                   Eigen::Quaterniond(Eigen::AngleAxisd(3 * M_PI / 180, random.direction()))});
    SimulatedDevice device(real, SimulatedDevice::Time::kFixedStep);
    const auto loop = std::make_unique<HapticLoop>(std::make_unique<StringGrip>(believed, device));
    loop->open();
    int64_t now_ns = 0;
    for (int n = 0; n < 5; ++n) {
      device.set_hand(random.pose(0.02, M_PI / 3));
      for (int i = 0; i < 400; ++i) {
        now_ns += kTick_ns;
        loop->tick(now_ns, now_ns);
      }
      const FeltState felt = device.felt();
      const double least_N = force_N(real, felt.pose, real.min_tension_N());
      // A step of the D/A rounds each string by half of it; the rest is the motors' lag.
      double step_N = 0;
      for (int i = 0; i < real.geometry.count; ++i)
        step_N += 0.5 * real.dac_max_V / ((1 << real.dac_bits) - 1) *
                  real.drives[static_cast<size_t>(i)].newtons_per_volt;
      EXPECT_LE(felt.wrench.force_N.norm(), 1.1 * least_N + step_N) << name;
    }
  }
}

// The tensions of a wrench differ from those of rest by no more than four times its size, so that
// none of them jumps when it comes or goes; nor do they anywhere between.
TEST(Rest, NothingJumpsBetweenItAndAWrench) {
  RandomMotion random(kSeed);
  constexpr int kSteps = 300;
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    TensionCommand command(profile);
    const double radius_m = profile.geometry.grip_radius_m();
    for (int n = 0; n < 20; ++n) {
      const StructureMatrix W = structure_matrix(profile.geometry, random.pose(0.02, M_PI / 3));
      const Wrench full{3 * random.direction(), 0.05 * random.direction()};
      const double size = std::hypot(3, 0.05 / radius_m);
      StringVector last_N = profile.min_tension_N();
      ASSERT_EQ(command.solve(W, {}, profile.max_tension_N()), last_N);
      for (int step = 1; step <= kSteps; ++step) {
        const double fraction = static_cast<double>(step) / kSteps;
        const StringVector now_N = command.solve(W, fraction * full, profile.max_tension_N());
        ASSERT_LE((now_N - profile.min_tension_N()).maxCoeff(),
                  TensionCommand::kTensionPerForce * fraction * size * (1 + 1e-12));
        // Above zero the slope of the solution is bounded by the conditioning of W with ε; what a
        // tick may move is the business of TensionSlew.
        last_N = now_N;
      }
      ASSERT_TRUE(last_N.allFinite());
    }
  }
}

// A string may have broken then, and the others pull until they are at rest.
TEST(Rest, IsReachedAtAQuarterOfTheRampWhenThePoseIsLost) {
  const Profile profile = load_profile("spidar-g6c");
  TensionCommand command(profile);
  const Wrench full{{2, 0, 0}, {0, 0, 0.01}};
  const StringVector most_N =
      command.solve(structure_matrix(profile.geometry, {}), full, profile.max_tension_N());
  const StringVector rest_N = profile.min_tension_N();
  ASSERT_GT((most_N - rest_N).norm(), 1);
  for (const double pace : {1.0, TensionCommand::kLostPace}) {
    for (const double gone : {0.0, 0.1, 0.25, 0.5}) {
      const double left = std::max(0.0, 1 - pace * gone);
      const StringVector expected_N = rest_N + left * (most_N - rest_N);
      // Rounding of sums of some 10 N.
      EXPECT_LE((command.fade((1 - gone) * full, pace) - expected_N).norm(), 1e-12)
          << pace << ", " << gone;
    }
  }
}

}  // namespace
}  // namespace spidar::test::rest_test
