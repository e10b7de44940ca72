// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The loop when something fails: a lost pose, a broken string, failed exchanges; and a device that
/// is not used.
#include "core/force/motion_rendering.h"
#include "spidar/chain/tension_command.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/string_grip.h"
#include "tests/spidar/loop_driver.h"
#include "tests/support/random_motion.h"
#include "tests/support/tampered_device.h"
#include "tests/support/test.h"

namespace spidar::test::loop_faults_test {
namespace {

/// A simulated device whose encoders can be stopped, a loop that plays 1 N to the right on it, or
/// nothing, and time.
struct Bench {
  explicit Bench(const std::string& name = kDefaultProfile, bool play = true)
      : profile(load_profile(name)) {
    loop->open();
    if (play) loop->schedule({0, INT64_MAX / 2, push_right(1)});
    if (play) loop->set_playback_clock({0, 0, 1, true});
    run(600);
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      now_ns += kTick_ns;
      loop->tick(now_ns, now_ns);
    }
  }
  LoopSnapshot snapshot() const { return loop->snapshot(); }
  StringVector tension_N() const { return tensions_N(device.volts(), profile); }

  const Profile profile;
  SimulatedDevice simulated{profile, SimulatedDevice::Time::kFixedStep};
  TamperedDevice device{simulated};
  std::unique_ptr<HapticLoop> loop =
      std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device));
  int64_t now_ns = 0;
};

/// The most that a string may change in a tick.
double step_N(const Profile& profile, int string) {
  return 1e-3 * TensionSlew::pace_N_s(profile.drives[static_cast<size_t>(string)]);
}

/// Neither for the brake, nor for the strings, of which none is left out for it.
TEST(LoopFaults, ABitThatFlipsInEveryFifthAnswerIsNoMotion) {
  Bench bench;
  std::mt19937 random(1);
  const auto below = [&](unsigned end) {
    return std::uniform_int_distribution<int>(0, end - 1)(random);
  };
  const uint64_t faults = bench.snapshot().counters.string_faults;
  for (int n = 0; n < 1000; ++n) {
    // The bits below say less than a hand trembles.
    bench.device.flip(static_cast<size_t>(below(8)), 5 + below(11));
    bench.run(5);
    const TickRecord last = bench.snapshot().last;
    ASSERT_EQ(last.pose_fault, PoseFault::kNone) << n;
    ASSERT_FALSE(last.brakes) << n;
    ASSERT_EQ(last.commanded.force_N, push_right(1).force_N) << n;
  }
  EXPECT_EQ(bench.snapshot().counters.string_faults, faults);
}

Pose far_hand() {
  Pose pose;
  pose.position_m = {0.02, -0.02, 0.01};  // 3 cm
  pose.orientation = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 2) / 3);
  return pose;
}

/// Three encoders stop and the hand moves by 3 cm and 29°.
void lose_pose(Bench& bench) {
  bench.device.stop_encoders(0b101001);
  bench.simulated.set_hand(far_hand());
}

TEST(LostPose, RestsWithoutIt) {
  for (const std::string name : {"spidar-gcc", "spidar-g6c", "spidar-g6x", "spidar-g6x3-v2-r"}) {
    for (const bool play : {false, true}) {
      Bench bench(name, play);
      lose_pose(bench);
      // The hand is under way for some 100 ms, in which the pose is lost.
      bench.run(200);
      for (int i = 0; i < 300; ++i) {
        bench.run(1);
        ASSERT_EQ(bench.tension_N(), bench.profile.min_tension_N()) << name;
      }
      EXPECT_EQ(bench.snapshot().last.pose_fault, PoseFault::kNoFit) << name;
      EXPECT_GE(bench.snapshot().untrusted_ns, 300 * kMs) << name;
    }
  }
}

TEST(LostPose, RampsToRestWithin50ms) {
  LoopDriver driver;
  driver.open();
  driver.loop->schedule({0, INT64_MAX / 2, push_right(1)});
  driver.play(0);
  StringVector last_N = driver.run(100 * kMs).tension_N;
  const StringVector least_N = driver.profile.min_tension_N();
  ASSERT_GT((last_N - least_N).maxCoeff(), 0.1);
  driver.log().count = {100'000, -100'000, 100'000, 100'000, -100'000, 100'000, 0, 0};
  // No string changes faster than TensionSlew allows.
  for (int tick = 0; tick < 50; ++tick) {
    const StringVector now_N = driver.tick().tension_N;
    for (int i = 0; i < driver.profile.geometry.count; ++i)
      ASSERT_LE(std::abs(now_N[i] - last_N[i]), step_N(driver.profile, i) + 1e-12);
    last_N = now_N;
  }
  EXPECT_EQ(last_N, least_N);
}

// A pose that becomes too old while the force is on its way to rest does not begin a way of its
// own.
TEST(LostPose, WhileStoppingTakesNoLonger) {
  LoopDriver driver;
  driver.open();
  driver.loop->schedule({0, INT64_MAX / 2, push_right(3)});
  driver.play(0);
  driver.run(100 * kMs);
  driver.pause();
  driver.run(18 * kMs);
  driver.tick(PoseTrust::kPoseTimeout_ns + kMs);  // a stall, of which two milliseconds count
  EXPECT_EQ(driver.loop->snapshot().last.pose_fault, PoseFault::kNoReading);
  EXPECT_EQ(driver.run(30 * kMs).tension_N, driver.profile.min_tension_N());
}

TEST(LostPose, NeedsSeveralGoodOnesInARow) {
  LoopDriver driver;
  driver.open();
  driver.loop->schedule({0, INT64_MAX / 2, push_right(1)});
  driver.play(0);
  driver.run(100 * kMs);
  const std::array<int32_t, kMaxStrings> good{};
  const std::array<int32_t, kMaxStrings> bad{100'000, -100'000, 100'000};
  driver.log().count = bad;
  driver.run(100 * kMs);
  // Now and then a good one is not enough.
  for (int i = 0; i < 20; ++i) {
    driver.log().count = good;
    ASSERT_EQ(driver.run((PoseTrust::kGoodPoses - 1) * kMs).commanded.stacked().norm(), 0);
    driver.log().count = bad;
    ASSERT_EQ(driver.tick().commanded.stacked().norm(), 0);
  }
  driver.log().count = good;
  EXPECT_EQ(driver.run((PoseTrust::kGoodPoses + 42) * kMs).commanded.force_N.x(), 1);
  EXPECT_EQ(driver.loop->snapshot().last.pose_fault, PoseFault::kNone);
}

TEST(LostPose, AJumpIsNotFollowed) {
  LoopDriver driver;
  driver.open();
  driver.loop->schedule({0, INT64_MAX / 2, push_right(1)});
  driver.play(0);
  driver.run(100 * kMs);
  Pose there;  // 5 cm in a millisecond, against the force: further along it, the brake would reduce
               // it
  there.position_m = {-0.03, 0, -0.04};
  put_grip(driver, there);
  driver.tick();
  driver.tick();
  EXPECT_EQ(driver.loop->snapshot().last.pose_fault, PoseFault::kJump);
  int rested = 0;
  for (int i = 0; i < 48; ++i) rested += driver.tick().tension_N == driver.profile.min_tension_N();
  EXPECT_GT(rested, 0);
  // It stays there, and is believed.
  EXPECT_EQ(driver.run(100 * kMs).commanded.force_N.x(), 1);
}

TEST(LostPose, CountersThatAllStandStillAreNoticed) {
  Bench bench;
  bench.device.stop_encoders(0xff);
  bench.loop->cancel_scheduled();
  bench.loop->schedule({0, INT64_MAX / 2, push_right(-1)});
  bench.run(600);
  EXPECT_EQ(bench.snapshot().last.pose_fault, PoseFault::kFrozen);
  for (int i = 0; i < 2000; ++i) {
    bench.run(1);
    ASSERT_EQ(bench.tension_N(), bench.profile.min_tension_N()) << "tick " << i;
  }
  bench.device.stop_encoders(0);
  // The hand trembles.
  Pose hand;
  hand.position_m.x() = 1e-4;
  bench.simulated.set_hand(hand);
  bench.run(200);
  EXPECT_EQ(bench.snapshot().last.pose_fault, PoseFault::kNone);
  EXPECT_EQ(bench.snapshot().last.commanded.force_N.x(), -1);
}

// Counters that never move, from the first force on: one that stays, and one that is reversed
// before the counters would be missed.
TEST(LostPose, CountersThatNeverMoveStopEveryForceThatIsFelt) {
  for (const double force_N : {kFeltForce_N, 0.1, 0.3, 1.0, 3.0}) {
    for (const bool reversed : {false, true}) {
      SafetyLimits limits;
      limits.max_force_N = force_N;
      LoopDriver driver(limits);
      driver.open();
      driver.play(0);
      // The smaller the force, the longer; ramps add to it.
      const double longest_s =
          GripWatch::kFrozenAfter_s * std::max(1.0, GripWatch::kFrozenForce_N / force_N);
      constexpr int64_t kFrame_ns = 40 * kMs;
      int64_t frame_ns = 0;
      const auto play = [&](double seconds) {
        for (const int64_t end_ns = frame_ns + std::llround(1e9 * seconds); frame_ns < end_ns;) {
          const bool back = reversed && frame_ns / (10 * kFrame_ns) % 2 == 1;
          driver.loop->schedule({frame_ns, kFrame_ns, push_right(back ? -3.0 : 3.0)});
          frame_ns += kFrame_ns;
          driver.run(kFrame_ns);
        }
      };
      play(0.9 * longest_s);
      EXPECT_EQ(driver.loop->snapshot().last.pose_fault, PoseFault::kNone) << force_N << " N";
      play(0.5 * longest_s + 0.2);
      EXPECT_EQ(driver.loop->snapshot().last.pose_fault, PoseFault::kFrozen) << force_N << " N";
      play(10);
      EXPECT_EQ(driver.loop->snapshot().last.pose_fault, PoseFault::kFrozen) << force_N << " N";
      EXPECT_EQ(driver.loop->snapshot().last.tension_N, driver.profile.min_tension_N());
    }
  }
}

TEST(LostPose, AHandThatYieldsToAWeakForceIsNotFrozen) {
  RandomMotion random(15);
  const std::vector<std::string> names = list_profiles();
  // Each profile with one of the forces.
  const std::array<double, 3> forces_N = {kFeltForce_N, 0.1, 0.5};
  for (size_t n = 0; n < names.size(); ++n) {
    Bench bench(names[n], false);
    const double force_N = forces_N[n % forces_N.size()];
    const Wrench wanted{force_N * random.direction(), Eigen::Vector3d::Zero()};
    bench.loop->schedule({0, INT64_MAX / 2, wanted});
    bench.loop->set_playback_clock({bench.now_ns, 0, 1, true});
    bench.run(8000);
    EXPECT_EQ(bench.snapshot().last.pose_fault, PoseFault::kNone) << names[n] << ", " << force_N;
  }
}

TEST(BrokenString, IsLeftOut) {
  for (int string = 0; string < 8; ++string) {
    Bench bench;
    Pose hand;
    hand.position_m = {3e-3, -2e-3, 2e-3};
    bench.simulated.set_hand(hand);
    bench.run(300);
    bench.simulated.set_count_error(string, 300);  // slack by 4.6 mm
    StringVector last_N = bench.tension_N();
    // Within the time in which a string goes through its whole range, and never faster.
    for (int i = 0; i < 25; ++i) {
      bench.run(1);
      const StringVector now_N = bench.tension_N();
      for (int k = 0; k < 8; ++k)
        ASSERT_LE(std::abs(now_N[k] - last_N[k]), step_N(bench.profile, k) + 1e-12);
      last_N = now_N;
    }
    EXPECT_EQ(bench.snapshot().last.faulty_string, string);
    EXPECT_EQ(last_N[string], 0) << "a free motor is not to be driven";
    bench.loop->set_playback_clock({});
    bench.run(100);
    EXPECT_EQ(bench.tension_N(), bench.profile.min_tension_N());
  }
}

// The other strings cannot give every wrench: the delivered wrench is no further from the requested
// one than the requested one is from the wanted one, plus the pull of the minimum tensions.
TEST(BrokenString, TheOthersDeliverOnlyWhatIsCertain) {
  RandomMotion random(14);
  int nothing = 0;
  for (const std::string name : {"spidar-gcc", "spidar-g6c", "spidar-g6x3-v2-r"}) {
    const Profile profile = load_profile(name);
    TensionCommand command(profile);
    for (int n = 0; n < 500; ++n) {
      const int string = n % profile.geometry.count;
      command.exclude(string);
      const StructureMatrix W = structure_matrix(profile.geometry, random.pose(0.02, 0.3));
      const Wrench wanted{3 * random.direction(), Eigen::Vector3d::Zero()};
      const StringVector tension_N = command.solve(W, wanted, profile.max_tension_N());
      const double asked_N = 3 * command.fraction();
      // It falls with what is asked of the others, and is back at its minimum where that is
      // nothing.
      ASSERT_NEAR(tension_N[string],
                  std::max(0.0, profile.min_tension_N()[string] -
                                    TensionCommand::kTensionPerForce * asked_N),
                  1e-12);
      nothing += asked_N == 0;
      // At the optimum the residual is no larger than that of any other tensions: of the least ones
      // it is the wrench asked for and their own pull.
      StringVector least_N = profile.min_tension_N();
      least_N[string] = tension_N[string];
      const Eigen::Matrix<double, 6, 1> pull = W * least_N;
      const double pull_N = std::hypot(pull.head<3>().norm(),
                                       pull.tail<3>().norm() / profile.geometry.grip_radius_m());
      const Eigen::Vector3d force = (W * tension_N).head<3>();
      ASSERT_LE((force - command.fraction() * wanted.force_N).norm(), asked_N + pull_N + 1e-9);
    }
  }
  EXPECT_GT(nothing, 50);  // often on spidar-g6c, whose strings pull hard at rest
}

// Its motion was forgotten with its pose, and what was left of the force threw 34 g at 1.36 m/s.
TEST(LostPose, AGripThatFliesOutOfTheFrameIsBraked) {
  LoopDriver driver;
  driver.open();
  double x_m = 0, speed_m_s = 0.3;
  const auto move = [&] {
    x_m += 1e-3 * speed_m_s;
    Pose pose;
    pose.position_m.x() = x_m;
    put_grip(driver, pose);
    return driver.tick();
  };
  double reach_m = 0;
  for (int i = 0; i < driver.profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    reach_m = std::max({reach_m, driver.profile.geometry.exit_m[k].cwiseAbs().maxCoeff(),
                        driver.profile.geometry.grip_m[k].cwiseAbs().maxCoeff()});
  }
  while (x_m < reach_m - 0.02) ASSERT_TRUE(move().pose_fault == PoseFault::kNone) << x_m;
  // A hand stays there until the force outwards is not taken for one that pushes it away.
  const double fast_m_s = std::exchange(speed_m_s, 0);
  for (int i = 0; i < 10'000; ++i) move();
  speed_m_s = fast_m_s;
  // The force has come when the pose is lost.
  driver.loop->schedule({0, INT64_MAX / 2, push_right(3)});
  driver.play(0);
  TickRecord last = move();
  while (last.pose_fault == PoseFault::kNone) last = move();
  ASSERT_EQ(last.pose_fault, PoseFault::kOutside);
  EXPECT_GT(last.commanded.force_N.x(), 0.5);
  // 3 N accelerate 34 g by 0.09 m/s in a tick.
  for (; speed_m_s < 1.2; speed_m_s += 0.09) last = move();
  EXPECT_EQ(last.pose_fault, PoseFault::kOutside);
  EXPECT_EQ(last.commanded.force_N.x(), 0);
}

TEST(Slew, GoesOnFromWhatTheBoardAcknowledged) {
  for (const LinkFault error : {LinkFault::kTimeout, LinkFault::kWrongReply}) {
    LoopDriver driver;
    driver.open();
    driver.loop->schedule({0, INT64_MAX / 2, push_right(3)});
    driver.play(0);
    driver.run(2 * kMs);
    StringVector last_N = tensions_N(driver.log().last_volts, driver.profile);
    double last_force_N = driver.loop->snapshot().last.commanded.force_N.x();
    for (int round = 0; round < 20; ++round) {
      // The pose is known for as long.
      driver.log().answer = error;
      driver.run(PoseTrust::kMaxMisses * kMs);
      driver.log().answer = LinkFault::kNone;
      for (int tick = 0; tick < PoseTrust::kMaxMisses; ++tick) {
        const TickRecord record = driver.tick();
        const StringVector now_N = tensions_N(driver.log().last_volts, driver.profile);
        // What rises takes two ticks' step at most.
        for (int i = 0; i < driver.profile.geometry.count; ++i)
          ASSERT_LE(now_N[i] - last_N[i], 2 * step_N(driver.profile, i) + 1e-12)
              << "round " << round;
        ASSERT_LE(record.commanded.force_N.x() - last_force_N,
                  2 * SafetyLimits{}.max_slew_N_s * 1e-3 + 1e-12);
        last_N = now_N;
        last_force_N = record.commanded.force_N.x();
      }
    }
  }
}

TEST(Idle, SwitchesTheMotorsOffAndOnAgain) {
  Bench bench(kDefaultProfile, false);
  const int idle_ms = static_cast<int>(1e3 * IdleWatch::kAfter_s);
  bench.run(idle_ms - 700);
  EXPECT_EQ(bench.tension_N(), bench.profile.min_tension_N());
  bench.run(200);
  EXPECT_EQ(bench.snapshot().last.device, DeviceState::kIdle);
  EXPECT_EQ(bench.tension_N().norm(), 0);
  // A force to be felt switches them on.
  bench.loop->schedule({0, INT64_MAX / 2, push_right(1)});
  bench.loop->set_playback_clock({bench.now_ns, 0, 1, true});
  bench.run(300);
  EXPECT_EQ(bench.snapshot().last.device, DeviceState::kRunning);
  EXPECT_EQ(bench.snapshot().last.commanded.force_N.x(), 1);
  // So does a hand.
  bench.loop->set_playback_clock({});
  bench.run(idle_ms + 100);
  EXPECT_EQ(bench.snapshot().last.device, DeviceState::kIdle);
  Pose hand;
  hand.position_m.x() = 0.02;
  bench.simulated.set_hand(hand);
  bench.run(400);
  EXPECT_EQ(bench.snapshot().last.device, DeviceState::kRunning);
}

}  // namespace
}  // namespace spidar::test::loop_faults_test
