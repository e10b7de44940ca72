// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a film does to a grip that nobody holds, and that a hand which holds it notices nothing.
/// All speeds, blows and forces are the simulated device's truth.
#include <cstdlib>
#include <future>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "spidar/grip/grip_motion.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"

namespace spidar::test::released_grip_test {
namespace {

constexpr double kFastest_m_s = 1.0;
constexpr double kHardest_J = 0.05;

struct Played {
  double force_N;
  double rate_Hz;
  bool both_ways;
};

/// SPIDAR_SWEEP=1 plays four forces at rates from 0.5 to 30 Hz, each half as fast again as the one
/// before. The brake remembers 50 ms, so that it has no narrow resonance between them.
std::vector<Played> films() {
  if (std::getenv("SPIDAR_SWEEP") == nullptr) {
    return {{3, 0, false},  {3, 2, true}, {3, 6, true},
            {3, 20, false}, {1, 3, true}, {0.1, 2, false}};
  }
  std::vector<Played> all;
  for (const double force_N : {0.1, 0.5, 1.0, 3.0}) {
    all.push_back({force_N, 0, false});
    for (double rate_Hz = 0.5; rate_Hz < 31; rate_Hz *= 1.5)
      for (const bool both_ways : {false, true}) all.push_back({force_N, rate_Hz, both_ways});
  }
  return all;
}

/// The worst of a profile's films.
struct Slowness {
  double fastest_m_s = 0, hardest_J = 0;
  std::string fastest, hardest;  ///< of which film
};

Slowness play_all(const std::string& name, uint64_t seed) {
  // In the sweep, the force rests for a second, returns within another, and acts again.
  const double seconds = std::getenv("SPIDAR_SWEEP") == nullptr ? 1.2 : 2.6;
  const Profile profile = load_profile(name);
  RandomMotion random(seed);
  Slowness worst;
  for (const double mass_kg : {0.05, 0.1}) {
    for (const Played& film : films()) {
      const Eigen::Vector3d force_N = film.force_N * random.direction();
      PlayedGrip grip(profile, released(profile, mass_kg),
                      pulses(force_N, film.rate_Hz, film.both_ways));
      grip.run(seconds);
      std::ostringstream what;
      what << name << ", " << mass_kg << " kg, " << film.rate_Hz << " Hz, "
           << (film.both_ways ? "to and fro" : "on and off") << ", force " << force_N.transpose();
      if (grip.fastest_m_s > worst.fastest_m_s) {
        worst.fastest_m_s = grip.fastest_m_s;
        worst.fastest = what.str();
      }
      if (grip.hardest_J > worst.hardest_J) {
        worst.hardest_J = grip.hardest_J;
        worst.hardest = what.str();
      }
    }
  }
  return worst;
}

TEST(ReleasedGrip, StaysSlow) {
  const std::vector<std::string> names = list_profiles();
  std::vector<std::future<Slowness>> played;
  const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
  Slowness worst;
  for (size_t n = 0; n < names.size() + processors; ++n) {
    if (n < names.size())
      played.push_back(std::async(std::launch::async, play_all, names[n], 25 + n));
    if (n < processors) continue;
    const Slowness one = played[n - processors].get();
    EXPECT_LE(one.fastest_m_s, kFastest_m_s) << one.fastest;
    EXPECT_LT(one.hardest_J, kHardest_J) << one.hardest;
    if (one.fastest_m_s > worst.fastest_m_s) {
      worst.fastest_m_s = one.fastest_m_s;
      worst.fastest = one.fastest;
    }
    if (one.hardest_J > worst.hardest_J) {
      worst.hardest_J = one.hardest_J;
      worst.hardest = one.hardest;
    }
  }
  std::printf("fastest %.2f m/s (%s)\nhardest blow %.1f mJ (%s)\n", worst.fastest_m_s,
              worst.fastest.c_str(), 1e3 * worst.hardest_J, worst.hardest.c_str());
}

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
  // It swings for some seconds. GripBrake::kRest_s and kReturn_s after it was last faster than
  // 0.15 m/s, both 1 s, the whole force is back.
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
    still.see(pose, i * kTick_ns);
    if (i >= 100) sum += std::pow(still.velocity().linear_m_s.x() - kSpeed_m_s, 2);
    pose.position_m.x() = 0.5 * kSlope_m_s2 * time_s * time_s;
    pose.orientation = Eigen::AngleAxisd(0.5 * time_s, Eigen::Vector3d::UnitY());
    faster.see(pose, i * kTick_ns);
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
