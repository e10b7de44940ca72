// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The force and the torque that a hand gets, compared with the limits: the simulated device's
/// truth, not what the loop believes.
#include "core/grip/string_geometry.h"
#include "spidar/chain/tension_command.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/loop/loop_time.h"
#include "spidar/loop/string_grip.h"
#include "tests/support/fake_device.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"
#include "tests/support/rest_force.h"
#include "tests/support/test.h"
#include "tests/support/tick_watch.h"

namespace spidar::test::delivered_limit_test {
namespace {

constexpr double kMax_m = 0.02;
constexpr double kFastest_Hz = 3.7;

/// kMax_m, or what there is room for: beyond, the grip passes the exits of its strings.
double room_m(const Profile& profile) {
  return std::min(kMax_m, half_workspace_m(profile.geometry).minCoeff());
}

/// Goes about within `reach_m` and 20° in sines of these frequencies, at up to 0.5 m/s.
Pose wandering(double time_s, double phase, double reach_m) {
  const auto wave = [&](double rate_Hz, double shift) {
    return std::sin(2 * M_PI * rate_Hz * time_s + phase + shift);
  };
  Pose pose;
  pose.position_m =
      reach_m / std::sqrt(3.0) * Eigen::Vector3d(wave(3.1, 0), wave(2.3, 1), wave(kFastest_Hz, 2));
  const Eigen::Vector3d turn_rad =
      0.35 / std::sqrt(3.0) * Eigen::Vector3d(wave(1.3, 3), wave(0.9, 4), wave(1.1, 5));
  pose.orientation = Eigen::AngleAxisd(turn_rad.norm(), turn_rad.stableNormalized());
  return pose;
}

/// The steps of the D/A converter round each string by half a step.
double rounding_N(const Profile& profile) {
  double sum_N = 0;
  for (int i = 0; i < profile.geometry.count; ++i)
    sum_N += 0.5 * profile.dac_max_V / ((1 << profile.dac_bits) - 1) *
             profile.drives[static_cast<size_t>(i)].newtons_per_volt;
  return sum_N;
}

/// The loop looks at both ends of the way that the grip goes in 6 ms. Between them the direction of
/// a string is off by the square of half of that way over the string's length, at most. The end
/// itself is off by the acceleration, during that time and the lag of the velocity.
double turn_between_ends(const Profile& profile, double fastest_m_s) {
  const double length_m =
      string_lengths_m(profile.geometry, {}).head(profile.geometry.count).minCoeff();
  const double turn = 0.5 * 6e-3 * fastest_m_s / length_m;
  const double late_s = 6e-3 + GripMotion::kLag_s;
  const double off_m = 0.5 * std::pow(2 * M_PI * kFastest_Hz * late_s, 2) * room_m(profile);
  return turn * turn + off_m / length_m;
}

TEST(DeliveredLimit, HoldsInTheHand) {
  RandomMotion random(25);
  const double seconds = std::getenv("SPIDAR_SWEEP") == nullptr ? 1.5 : 60;
  double worst_N = 0;
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    const double phase = random.uniform(0, 7);
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
    double until_s = 0;
    // Another direction every 0.1 s.
    PlayedGrip grip(profile, grip_model_of(profile), [&](double time_s) {
      for (; until_s <= time_s; until_s += 0.1) force_N = 3 * random.direction();
      return Wrench{force_N, Eigen::Vector3d::Zero()};
    });
    double excess_N = 0;
    for (double time_s = 0; time_s < seconds; time_s += 1e-3) {
      grip.device.set_hand(wandering(time_s, phase, room_m(profile)));
      grip.tick();
      const FeltState felt = grip.device.felt();
      const double allowed_N = std::max(3.0, rest_force_N(profile, felt.pose).norm());
      excess_N = std::max(excess_N, felt.wrench.force_N.norm() - allowed_N);
    }
    const double allowed_N = rounding_N(profile) + 3 * turn_between_ends(profile, grip.fastest_m_s);
    worst_N = std::max(worst_N, excess_N);
    EXPECT_LE(excess_N, allowed_N) << name;
  }
  std::printf("at most %.3f N above the limit\n", worst_N);
}

// Far from the centre, strings cannot brake, and what they gave instead pushed: a grip of 300 g got
// 75 mJ of 38.
TEST(DeliveredLimit, ABrakeGivesNoMorePowerThanItWants) {
  RandomMotion random(27);
  int judged = 0;
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    const double room_m = half_frame_m(profile.geometry).minCoeff();
    for (int n = 0; n < 40; ++n) {
      FakeDevice device;
      StringGrip grip(profile, device);
      grip.open();
      const Eigen::Vector3d towards = random.direction();
      const Eigen::Vector3d velocity_m_s = (random.chance(0.5) ? -0.6 : 0.6) * towards;
      GripCommand command;
      command.power = 1;
      command.dt_s = kTick_s;
      // From the centre to where it is judged.
      const double way_m = random.uniform(0.3, 0.9) * room_m;
      constexpr int kTicks = 400, kMoves = 40;
      for (int tick = 1; tick <= kTicks; ++tick) {
        const Eigen::Vector3d end_m = way_m * towards - 1e-3 * kMoves * velocity_m_s;
        Pose pose;
        pose.position_m =
            tick < kTicks - kMoves
                ? Eigen::Vector3d(tick / (kTicks - kMoves - 1.0) * end_m)
                : Eigen::Vector3d(end_m + 1e-3 * (tick - kTicks + kMoves) * velocity_m_s);
        device.log().count = counts_at(profile, pose);
        command.now_ns += kTick_ns;
        grip.exchange(command);
      }
      if (!grip.reading().knows_pose()) continue;
      ++judged;
      const GripVelocity then = grip.reading().motion.velocity_in(profile.drive_lag_s);
      command.wrench = {-8 * towards.dot(then.linear_m_s) / 0.6 * towards,
                        0.05 * random.direction()};
      command.fresh = command.brakes = true;
      command.now_ns += kTick_ns;
      grip.exchange(command);
      const GripReading& given = grip.reading();
      const auto power_W = [&](const Wrench& wrench) {
        return wrench.force_N.dot(then.linear_m_s) + wrench.torque_Nm.dot(then.angular_rad_s);
      };
      EXPECT_LE(power_W(given.delivered - given.at_rest),
                std::max(0.0, power_W(command.wrench)) + 1e-9)
          << name << ", grip " << n;
    }
  }
  EXPECT_GT(judged, 300);
}

// With force and torque wanted at their limits, the pull at rest and what least squares leaves come
// on top: without a bound of its own, the torque was 0.123 N m.
TEST(DeliveredLimit, HoldsForTheTorque) {
  RandomMotion random(26);
  double worst_Nm = 0;
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    const SafetyLimits limits;
    const double phase = random.uniform(0, 7);
    Wrench wanted;
    double until_s = 0;
    PlayedGrip grip(profile, grip_model_of(profile), [&](double time_s) {
      for (; until_s <= time_s; until_s += 0.1)
        wanted = {limits.max_force_N * random.direction(),
                  limits.max_torque_Nm * random.direction()};
      return wanted;
    });
    double excess_Nm = 0, sum_N = 0, reach_m = 0;
    for (int i = 0; i < profile.geometry.count; ++i)
      reach_m = std::max(reach_m, profile.geometry.grip_m[static_cast<size_t>(i)].norm());
    for (double time_s = 0; time_s < 1.5; time_s += 1e-3) {
      grip.device.set_hand(wandering(time_s, phase, room_m(profile)));
      grip.tick();
      const FeltState felt = grip.device.felt();
      excess_Nm = std::max(excess_Nm, felt.wrench.torque_Nm.norm() - limits.max_torque_Nm);
      sum_N = std::max(sum_N, felt.tension_N.sum());
    }
    // Each newton of a string has the farthest arm. The arm itself turns by 0.35 rad at 1.3 Hz, and
    // is off by its acceleration.
    const double late_s = 6e-3 + GripMotion::kLag_s;
    const double arm_off = 0.5 * std::pow(2 * M_PI * 1.3 * late_s, 2) * 0.35;
    const double allowed_Nm =
        reach_m *
        (rounding_N(profile) + sum_N * (turn_between_ends(profile, grip.fastest_m_s) + arm_off));
    worst_Nm = std::max(worst_Nm, excess_Nm);
    EXPECT_LE(excess_Nm, allowed_Nm) << name;
  }
  std::printf("at most %.4f N m above the limit\n", worst_Nm);
}

/// What strings give counts as what is commanded if it is no more than this away.
constexpr double kGiven_N = 0.03;

struct Rates {
  double given_N_s = 0;    ///< by the strings, in ticks in which they give what is commanded
  int given_ticks = 0;     ///< of which there are so many
  double unable_N_s = 0;   ///< in the others
  double at_rest_N_s = 0;  ///< their pull at rest, by the motion of the hand
  double tension_N_s = 0;  ///< of all strings together, each by its pace at most
};

/// Of random forces, one every 0.1 s, to a hand that goes in circles within 1 cm.
Rates rates_of(const Profile& profile, double force_N, double torque_Nm, double hand_m_s) {
  RandomMotion random(28);
  SafetyLimits limits;
  limits.max_force_N = force_N;
  Wrench wanted;
  double until_s = 0;
  PlayedGrip grip(
      profile, grip_model_of(profile),
      [&](double time_s) {
        for (; until_s <= time_s; until_s += 0.1)
          wanted = {force_N * random.direction(), torque_Nm * random.direction()};
        return wanted;
      },
      limits);
  const double reach_m = room_m(profile) / 2;
  TickWatch watch;
  TickRecord before = grip.snapshot().last;
  Wrench rest_before = grip.loop->grip().reading().at_rest;
  Rates most;
  double error_before_N = 0;
  for (double time_s = 0; time_s < 1; time_s += 1e-3) {
    const double angle = time_s * hand_m_s / reach_m;
    grip.device.set_hand({reach_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0),
                          Eigen::Quaterniond::Identity()});
    grip.tick();
    const TickRecord now = grip.snapshot().last;
    const Wrench rest = grip.loop->grip().reading().at_rest;
    const double error_N = (now.delivered.force_N - now.commanded.force_N - rest.force_N).norm();
    watch.check(now, grip.snapshot().limits);
    // The brake is faster; the watch has judged it.
    if (!now.brakes && !before.brakes && before.faulty_string < 0) {
      const auto raise = [](double& rate, double change) { rate = std::max(rate, 1e3 * change); };
      const bool is_given = std::max(error_N, error_before_N) <= kGiven_N;
      most.given_ticks += is_given;
      raise(is_given ? most.given_N_s : most.unable_N_s,
            (now.delivered.force_N - before.delivered.force_N).norm());
      raise(most.at_rest_N_s, (rest.force_N - rest_before.force_N).norm());
      raise(most.tension_N_s, (now.tension_N - before.tension_N).cwiseAbs().sum());
    }
    before = now;
    error_before_N = error_N;
    rest_before = rest;
  }
  return most;
}

// Where strings can give a force, what they give changes as fast as what is commanded, and by their
// pull at rest as the hand moves. Where they cannot, only the pace of each tension bounds it.
TEST(DeliveredRate, IsThatOfTheCommandAndOfTheHand) {
  int given_ticks = 0;
  double unable_N_s = 0, at_rest_N_s = 0;
  const auto measure = [&](const std::string& name, double force_N) {
    const Profile profile = load_profile(name);
    double pace_N_s = 0;
    for (int i = 0; i < profile.geometry.count; ++i)
      pace_N_s += TensionSlew::pace_N_s(profile.drives[static_cast<size_t>(i)]);
    for (const double torque_Nm : {0.0, SafetyLimits{}.max_torque_Nm}) {
      for (const double hand_m_s : {0.0, 0.2}) {
        const Rates most = rates_of(profile, force_N, torque_Nm, hand_m_s);
        EXPECT_LE(most.tension_N_s, pace_N_s * (1 + 1e-12)) << name;
        unable_N_s = std::max(unable_N_s, most.unable_N_s);
        at_rest_N_s = std::max(at_rest_N_s, most.at_rest_N_s);
        given_ticks += most.given_ticks;
        EXPECT_LE(most.given_N_s,
                  SafetyLimits{}.max_slew_N_s + most.at_rest_N_s + 1e3 * 2 * kGiven_N)
            << name << ", " << force_N << " N";
      }
    }
  };
  for (const double force_N : {3.0, 10.0, 20.0}) {
    given_ticks = 0;
    unable_N_s = at_rest_N_s = 0;
    for (const std::string& name : list_profiles()) measure(name, force_N);
    EXPECT_GT(given_ticks, 1000);
    std::printf(
        "%.0f N: up to %.0f N/s where strings cannot give it, %.0f of the pull at rest, %d ticks\n",
        force_N, unable_N_s, at_rest_N_s, given_ticks);
  }
}

// The limits hold at the pose and at the pose ahead, whether the loop has looked there or has
// inferred it from how far the grip can move.
TEST(DeliveredLimit, HoldsWhereTheGripGoes) {
  RandomMotion random(27);
  const SafetyLimits limits;
  int reduced = 0, kept = 0;
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    TensionCommand command(profile);
    for (int n = 0; n < 300; ++n) {
      // At up to 1 m/s and 10 rad/s; 30 ticks are ten time constants of the estimate.
      const Pose pose = random.pose(0.02, 0.35);
      const Eigen::Vector3d step_m = random.uniform(0, 1e-3) * random.direction();
      const Eigen::Vector3d axis = random.direction();
      const double turn_rad = random.uniform(0, 0.01);
      GripMotion motion;
      for (int i = -30; i <= 0; ++i) {
        motion.update({pose.position_m + i * step_m,
                       Eigen::AngleAxisd(i * turn_rad, axis) * pose.orientation},
                      i * kTick_ns);
      }
      const Wrench wanted{random.uniform(0, 3) * random.direction(),
                          random.uniform(0, 0.1) * random.direction()};
      const StructureMatrix W = structure_matrix(profile.geometry, pose);
      const StringVector whole_N = command.solve(W, wanted, profile.max_tension_N());
      const StringVector tension_N = command.limit(W, limits, pose, motion);
      ++(tension_N == whole_N ? kept : reduced);
      const double ahead_s = TensionCommand::kAhead_s + 2 * profile.drive_lag_s;
      const StructureMatrix ahead =
          structure_matrix(profile.geometry, motion.pose_in(pose, ahead_s));
      for (const StructureMatrix& at : {W, ahead}) {
        const Eigen::Matrix<double, 6, 1> given = at * tension_N;
        const Eigen::Matrix<double, 6, 1> rest = at * profile.min_tension_N();
        const double stray_Nm =
            TensionCommand::kStrayLever * profile.geometry.grip_radius_m() * limits.max_force_N;
        // Rounding of sums of some 10 N.
        ASSERT_LE(given.head<3>().norm(),
                  std::max(limits.max_force_N, rest.head<3>().norm()) + 1e-12)
            << name;
        ASSERT_LE(given.tail<3>().norm(),
                  std::max(limits.max_torque_Nm, rest.tail<3>().norm() + stray_Nm) + 1e-12)
            << name;
      }
    }
  }
  EXPECT_GT(reduced, 100);
  EXPECT_GT(kept, 100);
}

}  // namespace
}  // namespace spidar::test::delivered_limit_test
