// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a film does to a grip that nobody holds, and that a hand which holds it notices nothing.
/// All speeds, blows and forces are the simulated device's truth.
#include "spidar/chain/brake_table.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/limits/released_turn.h"
#include "tests/support/let_go_device.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"
#include "tests/support/test.h"

namespace spidar::test::released_grip_test {
namespace {

TEST(ReleasedGrip, ItsForceRestsAndReturns) {
  const Profile profile = load_profile(kDefaultProfile);
  // A force of 3 N throws the grip about; from 1.5 s on there is a light one, which a grip without
  // a hand follows to where its strings hold it.
  PlayedGrip grip(profile, released(profile, 0.1), [](double time_s) {
    const Film thrown = pulses({3, 0, 0}, 3, true);
    return time_s < 1.5 ? thrown(time_s) : Wrench{{0.02, 0, 0}, {0, 0, 0}};
  });
  grip.run(0.3);
  EXPECT_FALSE(grip.snapshot().last.held);
  grip.run(0.2);
  EXPECT_LT(grip.snapshot().last.commanded.force_N.norm(), 1e-3);
  // It swings for some seconds, too slowly to be released again. brake::kRest_s and kReturn_s
  // later, both 1 s, the whole force is back.
  grip.run(9.5);
  EXPECT_TRUE(grip.snapshot().last.held);
  EXPECT_EQ(grip.snapshot().last.commanded.force_N.x(), 0.02);
}

// The loop of a held grip gives the same force as the safety chain alone. The bound is a fiftieth
// of the force: half of the smallest change of a force that is noticed, 7 %, or less.
TEST(ReleasedGrip, AHandNoticesNothing) {
  for (const std::string name : {"spidar-gcc", "spidar-g6c"}) {
    const Profile profile = load_profile(name);
    for (const double mass_kg : {0.05, 0.1}) {
      for (const double rate_Hz : {0.5, 2.0, 3.0, 5.0, 8.0, 20.0}) {
        GripModel hand = grip_model_of(profile);  // 300 N/m, 8 N s/m
        hand.inertia_kg_m2 *= mass_kg / hand.mass_kg;
        hand.mass_kg = mass_kg;
        PlayedGrip grip(profile, hand, pulses({3, 0, 0}, rate_Hz, true));
        WrenchLimits safety;
        for (int i = 0; i < 800; ++i) {
          grip.tick();
          const TickRecord last = grip.snapshot().last;
          const bool fresh = last.found != Found::kNothing;
          const Wrench alone = safety.apply(last.wanted, fresh, 1e-3, {});
          ASSERT_LE((last.commanded.force_N - alone.force_N).norm(), 0.02 * 3)
              << name << ", " << mass_kg << " kg, " << rate_Hz << " Hz, tick " << i;
          ASSERT_TRUE(last.held);
        }
      }
    }
  }
}

// A hand that turns its wrist by 45° to and fro, more than twice a second, is still a hand, even
// while the film turns it, too.
TEST(ReleasedGrip, AHandThatTurnsKeepsTheForce) {
  constexpr double kTurn_rad = M_PI / 4, kFastest_rad_s = 12;
  for (const std::string name : {"spidar-gcc", "spidar-g6c", "spidar-i7"}) {
    const Profile profile = load_profile(name);
    PlayedGrip grip(profile, grip_model_of(profile), [](double time_s) {
      return Wrench{{1, 0, 0}, {0, 0, std::fmod(3 * time_s, 1.0) < 0.5 ? 0.1 : -0.1}};
    });
    double fastest_rad_s = 0;
    for (int i = 0; i < 2000; ++i) {
      Pose hand;
      hand.orientation = Eigen::AngleAxisd(
          kTurn_rad * std::sin(kFastest_rad_s / kTurn_rad * 1e-3 * i), Eigen::Vector3d::UnitZ());
      grip.device.set_hand(hand);
      grip.tick();
      const TickRecord last = grip.snapshot().last;
      ASSERT_TRUE(last.held) << name << ", tick " << i;
      fastest_rad_s = std::max(fastest_rad_s, last.velocity.angular_rad_s.norm());
    }
    // The hand yields to the strings.
    EXPECT_GT(fastest_rad_s, 0.9 * kFastest_rad_s) << name;
  }
}

// Nobody turns a grip until its strings tangle. It may come back any time later, slowly, and then
// gets no force that it could be thrown by.
TEST(ReleasedGrip, AGripThatComesBackFromATurnGetsNoForceYet) {
  const Profile profile = load_profile(kDefaultProfile);
  PlayedGrip grip(profile, grip_model_of(profile), pulses({1, 0, 0}, 0, false));
  double turn_rad = 0;
  const auto turn_to = [&](double to_rad) {
    while (std::abs(to_rad - turn_rad) > 1e-3) {
      turn_rad += std::clamp(to_rad - turn_rad, -5e-3, 5e-3);
      Pose hand;
      hand.orientation = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ());
      grip.device.set_hand(hand);
      grip.tick();
    }
  };
  grip.run(0.5);
  ASSERT_TRUE(grip.snapshot().last.held);
  turn_to(GripWatch::kMaxTurn_rad + 0.2);
  EXPECT_EQ(grip.snapshot().last.pose_fault, PoseFault::kTurned);
  EXPECT_FALSE(grip.snapshot().last.held);
  grip.run(brake::kRest_s + brake::kReturn_s + 1);
  turn_to(GripWatch::kMaxTurn_rad - 0.5);
  ASSERT_EQ(grip.snapshot().last.pose_fault, PoseFault::kNone);
  grip.run(0.5);
  EXPECT_FALSE(grip.snapshot().last.held);
  EXPECT_EQ(grip.snapshot().last.commanded.force_N.norm(), 0);
  grip.run(brake::kRest_s + brake::kReturn_s);
  EXPECT_TRUE(grip.snapshot().last.held);
}

/// A grip in no hand, whose device answers only in one tick of `every`.
class SeldomDevice final : public StringDevice {
 public:
  SeldomDevice(const Profile& profile, const GripModel& model, int every)
      : StringDevice("seldom"), grip_(profile, model, model), every_(every) {}

  void open() override { grip_.open(); }
  void close() noexcept override { grip_.close(); }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    grip_.exchange_at(++ticks_ * kTick_ns);
    return ticks_ % every_ == 0 ? grip_.exchange(volts, reading) : LinkFault::kTimeout;
  }
  double speed_m_s() const { return grip_.speed_m_s(); }
  double turn_rad_s() const { return grip_.state().angular_velocity_rad_s.norm(); }

 private:
  LetGoDevice grip_;
  const int every_;
  int64_t ticks_ = 0;
};

/// A force and a torque move a grip in no hand for a moment, and the film pauses. The dampers must
/// not shake the grip for ever: too strong for its mass or its inertia, they kept 20 g at 2.4 m/s
/// and turned a light grip at 250 rad/s. A second later, it is slower than the brake acts on it, as
/// far as that knows its speed: the friction of the strings does the rest.
TEST(ReleasedGrip, ComesToRest) {
  constexpr double kAtRest_m_s = brake::kHeavyFrom_m_s + brake::kSpeedError_m_s;
  constexpr int kLags = 4, kChoices = 4;
  constexpr double kLag_s[kLags] = {0, 0.002, 0.01, 0.045};
  for (const std::string& name : list_profiles()) {
    for (int choice = 0; choice < kLags << kChoices; ++choice) {
      const auto either = [&](int bit, double one, double other) {
        return (choice >> bit & 1) != 0 ? one : other;
      };
      Profile profile = load_profile(name);
      profile.drive_lag_s = kLag_s[choice >> kChoices];
      GripModel model = released(profile, either(0, 0.02, 0.6));
      const double inertia = either(1, 0.25, 4);
      model.inertia_kg_m2 *= inertia;
      const int every = static_cast<int>(either(2, 1, 3));
      SafetyLimits limits;
      limits.max_force_N = either(3, kDefaultForce_N, 20);  // more than any device gives
      limits.max_torque_Nm = either(3, kDefaultTorque_Nm, 9);
      SeldomDevice device(profile, model, every);
      const auto loop =
          std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device), limits);
      loop->open();
      int64_t now_ns = 0;
      const auto run = [&](int ticks) {
        double most_m_s = 0;
        for (int i = 0; i < ticks; ++i) {
          now_ns += kTick_ns;
          loop->tick(now_ns, now_ns);
          most_m_s = std::max(
              {most_m_s, device.speed_m_s(), profile.body().surface_m * device.turn_rad_s()});
        }
        return most_m_s;
      };
      run(250);
      loop->set_playback_clock({now_ns, 0, 1, true});
      loop->schedule(
          {0, 60 * kTick_ns, {{0, 0, limits.max_force_N}, {0, 0, limits.max_torque_Nm}}});
      const double first_m_s = run(100);
      loop->set_playback_clock({now_ns, 0, 1, false});
      run(1000);
      EXPECT_LE(run(100), kAtRest_m_s)
          << name << ", " << model.mass_kg << " kg, " << inertia
          << " times the inertia, an answer in " << every << " ticks, a lag of "
          << profile.drive_lag_s << " s, up to " << limits.max_force_N << " N: " << first_m_s
          << " m/s at first";
    }
  }
}

TEST(ReleasedTurn, TheLargestTorqueGivesALightGripTheSpeedOfTheLargestForce) {
  // Whatever the radius is, the surface of a sphere of 34 g gets no faster than kReleased_m_s.
  for (const double radius_m : {0.01, 0.02, 0.03}) {
    const double torque_Nm = released_torque_Nm(GripBody::inferred(radius_m), radius_m, 0.002);
    const double turn_rad_s =
        torque_Nm * (kNoticed_s + 0.002) / (0.4 * kLightestGrip_kg * radius_m * radius_m);
    EXPECT_GE(turn_rad_s * radius_m, kReleased_m_s * (1 - 1e-12)) << radius_m;
    const double reversed_rad_s =
        turn_rad_s * (kNoticed_s + kReversed * 0.002) / (kNoticed_s + 0.002);
    EXPECT_LE(reversed_rad_s * radius_m, kReleased_m_s * (1 + 1e-12)) << radius_m;
  }
  const GripBody body = GripBody::inferred(0.03);
  EXPECT_LT(released_torque_Nm(body, 0.03, 0.002, 1e-3), released_torque_Nm(body, 0.03, 0.002));
  EXPECT_EQ(released_torque_Nm({}, 0, 0.002), std::numeric_limits<double>::infinity());
}

TEST(ReleasedTurn, NoTorqueAboveThatIsCommanded) {
  const Profile profile = load_profile(kDefaultProfile);
  SafetyLimits limits;
  limits.max_torque_Nm = 1;
  const double most_Nm =
      released_torque_Nm(profile.body(), profile.geometry.grip_radius_m(), profile.drive_lag_s);
  const Film film = [](double) { return Wrench{{0, 0, 0}, {0, 0, 1}}; };
  PlayedGrip grip(profile, grip_model_of(profile), film, limits);
  double largest_Nm = 0;
  for (int i = 0; i < 200; ++i) {
    grip.tick();
    largest_Nm = std::max(largest_Nm, grip.snapshot().last.commanded.torque_Nm.norm());
    EXPECT_LE(grip.snapshot().last.max_torque_Nm, most_Nm) << "what the strings are held to";
  }
  EXPECT_LE(largest_Nm, most_Nm * (1 + 1e-12));
  EXPECT_GT(largest_Nm, 0.9 * most_Nm);
}

/// A callback returns what is not a number while its force moves a hand on. That counts as no
/// force, of which the brake leaves a part on the way; compared with what is not a number, it took
/// nothing.
TEST(ReleasedGrip, WhatIsNotANumberDoesNotKeepTheBrakeFromActing) {
  constexpr double kWay_m = 0.03, kTurn_rad_s = 2 * M_PI * 5;
  const Profile profile = load_profile(kDefaultProfile);
  const Film nothing = [](double) { return Wrench{}; };
  PlayedGrip grip(profile, grip_model_of(profile), nothing);
  bool is_bad = false;
  grip.loop->callback().set(
      [&](const CallbackInput& in) {
        const double pull_N = is_bad ? std::numeric_limits<double>::quiet_NaN() : 3;
        return Wrench{pull_N * in.velocity.linear_m_s.normalized(), {0, 0, 0}};
      },
      false);
  int bad = 0;
  for (int i = 0; i < 2000; ++i) {
    Pose hand;
    hand.position_m.x() = kWay_m * std::sin(kTurn_rad_s * 1e-3 * i);
    grip.device.set_hand(hand);
    grip.tick();
    const TickRecord last = grip.snapshot().last;
    if (is_bad) {
      // Rest is on its way from at most 3 N at the slew limit, of which the brake leaves a part.
      EXPECT_LE(last.commanded.force_N.norm(), 3 - 0.3 * (1 - 1e-9)) << i;
    }
    const double along_N = last.commanded.force_N.dot(last.velocity.linear_m_s.normalized());
    is_bad = !is_bad && last.brakes && along_N > 1;
    bad += is_bad;
  }
  EXPECT_GT(bad, 0);
}

/// The motion of a grip that has turned at `turn_rad_s` for 0.1 s.
GripMotion spin(double turn_rad_s) {
  GripMotion spins;
  for (int i = 0; i < 100; ++i) {
    Pose pose;
    pose.orientation = Eigen::AngleAxisd(1e-3 * turn_rad_s * i, Eigen::Vector3d::UnitZ());
    spins.update(pose, i * kTick_ns);
  }
  return spins;
}

/// The motion of a grip that has had this velocity for 0.1 s.
GripMotion flight_along(const Eigen::Vector3d& velocity_m_s) {
  GripMotion flies;
  for (int i = 0; i < 100; ++i) {
    Pose pose;
    pose.position_m = 1e-3 * i * velocity_m_s;
    flies.update(pose, i * kTick_ns);
  }
  return flies;
}

GripMotion flight(double speed_m_s) {
  return flight_along({speed_m_s, 0, 0});
}

/// In each tick, the grip seems to be at the centre, and to have this motion.
void repeat(GripBrake& brake, const GripMotion& motion, double seconds) {
  for (int i = 0; i < std::lround(1e3 * seconds); ++i) {
    brake.update(Eigen::Vector3d::Zero(), motion, 0, 1e-3);
    brake.apply({}, motion, 1e-3);
  }
}

TEST(GripBrake, AGripThatStaysFastRests) {
  const GripBody body = GripBody::inferred(0.03);
  const double spin_rad_s = brake::kFadeFrom_m_s / body.surface_m;
  for (const GripMotion& fast : {spin(1.1 * spin_rad_s), flight(1.1 * brake::kFadeFrom_m_s)}) {
    GripBrake brake(body, 0);
    repeat(brake, fast, brake::kFast_s - kTick_s);
    EXPECT_TRUE(brake.held());
    // What counts is forgotten in twice its time.
    repeat(brake, {}, 2 * brake::kFast_s);
    repeat(brake, fast, brake::kFast_s - kTick_s);
    EXPECT_TRUE(brake.held());
    brake.reset();
    repeat(brake, fast, brake::kFast_s - kTick_s);
    EXPECT_TRUE(brake.held());
    repeat(brake, fast, 2 * kTick_s);
    EXPECT_FALSE(brake.held());
    // However long it goes on, its wrench returns as soon afterwards.
    repeat(brake, fast, 1);
    constexpr double kRounding_s = 0.01;
    repeat(brake, {}, 2 * brake::kFast_s + brake::kRest_s + brake::kReturn_s + kRounding_s);
    EXPECT_TRUE(brake.held());
  }
  for (const GripMotion& slow : {spin(0.9 * spin_rad_s), flight(0.9 * brake::kFadeFrom_m_s)}) {
    GripBrake brake(body, 0);
    repeat(brake, slow, 1);
    EXPECT_TRUE(brake.held());
  }
}

/// A force outwards ends at kFar_m, one inwards or across stays; and the place follows.
TEST(GripBrake, AForceAwayFromItsPlaceFades) {
  const Wrench out{{1, 1, 0}, {0, 0, 0.1}}, in{{-1, 1, 0}, {0, 0, 0.1}};
  GripBrake brake(GripBody::inferred(0.03), 0);
  const auto left = [&](double way_m, const Wrench& wanted) {
    brake.update({way_m, 0, 0}, {}, 0, 1e-6);
    return brake.apply(wanted, {}, 1e-6).force_N;
  };
  EXPECT_EQ(left(0, out), out.force_N);
  EXPECT_EQ(left(0.9 * brake::kNear_m, out), out.force_N);
  EXPECT_NEAR(left(0.5 * (brake::kNear_m + brake::kFar_m), out).x(), 0.5, 1e-3);
  EXPECT_NEAR(left(1.1 * brake::kFar_m, out).x(), 0, 1e-12);
  EXPECT_EQ(left(1.1 * brake::kFar_m, in), in.force_N);
  for (int i = 0; i < 3; ++i) brake.update({brake::kFar_m, 0, 0}, {}, 0, brake::kFollows_s);
  EXPECT_EQ(left(brake::kFar_m, out), out.force_N);
}

/// Without its part outwards, this force would push along the motion.
TEST(GripBrake, AForceThatFadesByPlacePushesNoFastGrip) {
  GripBrake brake(GripBody::inferred(0.03), 0);
  brake.update(Eigen::Vector3d::Zero(), {}, 0, 1e-6);
  const GripMotion inwards = flight_along({-0.8, 0.8, 0});
  brake.update({1.1 * brake::kFar_m, 0, 0}, inwards, 0, 1e-6);
  const Wrench left = brake.limit(brake.apply({{1, 1, 0}, {}}, inwards, 1e-6));
  EXPECT_LE(left.force_N.dot(inwards.velocity().linear_m_s), 1e-12);
}

/// A loose hand that was pushed out must not be pushed as far again after each gap.
TEST(GripBrake, RemembersItsPlaceWhileThePoseIsUnknown) {
  GripBrake brake(GripBody::inferred(0.03), 0);
  brake.update(Eigen::Vector3d::Zero(), {}, 0, 1e-6);
  brake.reset();
  brake.update({1.1 * brake::kFar_m, 0, 0}, {}, 0, 1e-6);
  EXPECT_NEAR(brake.apply({{1, 0, 0}, {}}, {}, 1e-6).force_N.x(), 0, 1e-12);
  brake.forget_place();
  brake.update({1.1 * brake::kFar_m, 0, 0}, {}, 0, 1e-6);
  EXPECT_EQ(brake.apply({{1, 0, 0}, {}}, {}, 1e-6).force_N.x(), 1);
}

/// Tensions at rest that pull a grip from where it lay towards the centre are no film.
TEST(GripBrake, ItsPlaceFollowsAgainstTheTensionsAtRest) {
  GripBrake brake(GripBody::inferred(0.03), 0);
  brake.update(Eigen::Vector3d::Zero(), {}, 0, 1e-6);
  const auto left_N = [&](const Eigen::Vector3d& film_N) {
    const Eigen::Vector3d at_rest_N(0.5, 0, 0);
    for (int i = 0; i < 3; ++i) {
      brake.pull(at_rest_N + film_N, at_rest_N, 1e-3);
      brake.update({1.1 * brake::kFar_m, 0, 0}, {}, 0, brake::kFollows_s);
    }
    return brake.apply({{1, 0, 0}, {}}, {}, 1e-6).force_N.x();
  };
  EXPECT_NEAR(left_N({0.1, 0, 0}), 0, 1e-12);
  EXPECT_EQ(left_N(Eigen::Vector3d::Zero()), 1);
}

/// Until drives that lag 45 ms have followed, the grip turns by 0.37, 0.74 and 1.1 rad.
TEST(GripBrake, AWrenchThatWouldComeForAnotherPoseIsWithheld) {
  const Wrench wanted{{1, 0, 0}, {0, 0, 0}};
  const auto left_N = [&](double turn_rad_s) {
    GripBrake brake(GripBody::inferred(0.03), 0.045);
    const Wrench left = brake.limit(brake.apply(wanted, spin(turn_rad_s), 1e-3));
    EXPECT_TRUE(turn_rad_s < 20 || brake.damper().torque_Nm.isZero(0));
    return left.force_N.x();
  };
  EXPECT_EQ(left_N(8), 1);
  EXPECT_GT(left_N(16), 0.1);
  EXPECT_LT(left_N(16), 0.9);
  EXPECT_EQ(left_N(24), 0);
}

TEST(GripBrake, TimeWithoutAPoseDoesNotBringTheForceBack) {
  GripBrake brake(GripBody::inferred(0.03), 0);
  const Wrench wanted{{1, 0, 0}, {0, 0, 0}};
  const auto run = [&](double seconds, bool knows_pose) {
    Wrench left;
    for (int i = 0; i < std::lround(1e3 * seconds); ++i) {
      if (!knows_pose) brake.reset();
      left = brake.apply(wanted, {}, 1e-3);
    }
    return left.force_N.x();
  };
  EXPECT_EQ(run(1, true), 1);
  EXPECT_EQ(run(1, false), 1);  // a hand holds it, as far as is known
  brake.release();
  EXPECT_EQ(run(2 * (brake::kRest_s + brake::kReturn_s), false), 0);
  EXPECT_EQ(run(0.9 * brake::kRest_s, true), 0);
  EXPECT_EQ(run(0.2 * brake::kRest_s + brake::kReturn_s, true), 1);
}

// The strings at rest pull the grip back to the centre, with a force that has a potential. A hand
// that goes to and fro gets energy from a force across its way that switches this pull off on the
// way out: the work of that force itself is zero.
TEST(ReleasedGrip, AWeakForceGivesNoEnergyToAHandThatGoesToAndFro) {
  constexpr double kWay_m = 0.02;
  for (const std::string name : {"spidar-gcc", "spidar-g6c", "spidar-g6x3-v2-r"}) {
    const Profile profile = load_profile(name);
    for (const double force_N : {0.05, 0.1, 0.2}) {
      PlayedGrip grip(profile, grip_model_of(profile), pulses({0, force_N, 0}, 2, false));
      double work_J = 0;
      for (int i = 0; i < 4000; ++i) {
        Pose hand;
        hand.position_m.x() = kWay_m * std::sin(2 * M_PI * 1e-3 * i);
        grip.device.set_hand(hand);
        const FeltState before = grip.device.felt();
        grip.tick();
        const FeltState felt = grip.device.felt();
        if (i < 1000) continue;  // three whole turns
        work_J += 0.5 * (before.wrench.force_N + felt.wrench.force_N).x() *
                  (felt.pose.position_m.x() - before.pose.position_m.x());
      }
      // The steps of the D/A converter are half a step of a string's force off, in both directions
      // of the way alike: what they add on half of it at most.
      const double step_N =
          profile.dac_max_V / ((1 << profile.dac_bits) - 1) * profile.drives[0].newtons_per_volt;
      EXPECT_LE(work_J / 3, 0.5 * step_N * 4 * kWay_m) << name << ", " << force_N << " N";
      std::printf("%s, %.2f N: %.4f mJ a turn\n", name.c_str(), force_N, 1e3 * work_J / 3);
    }
  }
}

// A hand is faster than the brake allows, and the film wants far more than the limit against it.
// The brake took all of that at once, and the slew limit went on from there: 1,005 N for 4 N.
TEST(ReleasedGrip, NoForceAgainstTheMotionExceedsTheLimit) {
  constexpr double kWay_m = 0.03, kTurn_rad_s = 2 * M_PI * 5;
  SafetyLimits limits;
  limits.max_force_N = 4;
  for (const std::string name : {"spidar-gcc", "spidar-g6c"}) {
    const Profile profile = load_profile(name);
    const Film film = [](double time_s) {
      return Wrench{{-1000 * std::cos(kTurn_rad_s * time_s), 300, 0}, {0, 0, 0}};
    };
    PlayedGrip grip(profile, grip_model_of(profile), film, limits);
    int braked = 0;
    for (int i = 0; i < 2000; ++i) {
      Pose hand;
      hand.position_m.x() = kWay_m * std::sin(kTurn_rad_s * 1e-3 * i);
      grip.device.set_hand(hand);
      grip.tick();
      const TickRecord last = grip.snapshot().last;
      braked += last.brakes;
      ASSERT_LE(last.commanded.force_N.norm(), limits.max_force_N * (1 + 1e-12))
          << name << ", tick " << i;
    }
    EXPECT_GT(braked, 100) << name;
  }
}

TEST(GripMotion, IsAsLateAndAsNoisyAsItSays) {
  constexpr double kSpeed_m_s = 0.2, kSlope_m_s2 = 2, kSigma_m = 6e-6;
  GripMotion still, faster;
  RandomMotion random(25);
  double sum = 0;
  constexpr int kTicks = 4000;
  for (int i = 0; i < kTicks; ++i) {
    const double time_s = 1e-3 * i;
    Pose pose;
    // A uniform error of this standard deviation, as of a count.
    pose.position_m.x() = kSpeed_m_s * time_s + std::sqrt(3.0) * kSigma_m * random.uniform(-1, 1);
    still.update(pose, i * kTick_ns);
    if (i >= 100) sum += std::pow(still.velocity().linear_m_s.x() - kSpeed_m_s, 2);
    pose.position_m.x() = 0.5 * kSlope_m_s2 * time_s * time_s;
    pose.orientation = Eigen::AngleAxisd(0.5 * time_s, Eigen::Vector3d::UnitY());
    faster.update(pose, i * kTick_ns);
  }
  // The low-pass settles within 5 % of its continuous model at 16 ticks a time constant of 2.65.
  const double now_m_s = kSlope_m_s2 * 1e-3 * (kTicks - 1);
  EXPECT_NEAR(faster.velocity().linear_m_s.x(), now_m_s - kSlope_m_s2 * GripMotion::kLag_s,
              0.2 * kSlope_m_s2 * GripMotion::kLag_s);
  EXPECT_NEAR(faster.velocity_in(0).linear_m_s.x(), now_m_s,
              0.2 * kSlope_m_s2 * GripMotion::kLag_s);
  EXPECT_NEAR(faster.velocity().angular_rad_s.y(), 0.5, 1e-6);
  std::printf("noise %.3f of the error per tick\n",
              std::sqrt(sum / (kTicks - 100)) / (kSigma_m / 1e-3));
  EXPECT_LE(std::sqrt(sum / (kTicks - 100)), 0.45 * kSigma_m / 1e-3);
}

}  // namespace
}  // namespace spidar::test::released_grip_test
