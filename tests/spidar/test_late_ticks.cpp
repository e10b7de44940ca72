// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Ticks as machines really have them: what a hand that holds the grip gets is what it gets of
/// ticks in time.
#include "spidar/chain/brake_table.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"
#include "tests/support/late_ticks.h"
#include "tests/support/let_go_device.h"
#include "tests/support/test.h"

namespace spidar::test::late_ticks_test {
namespace {

constexpr double kHand_Hz = 3;

/// A hand of 1500 N/m and 8 N s/m goes to and fro, at `hand_m_s` at most, and the device is read
/// somewhere within a tick.
class HeldGrip {
 public:
  HeldGrip(const Profile& profile, double hand_m_s, double film_N, uint64_t seed)
      : film_N_(film_N),
        random_(seed),
        ticks_(seed, kTick_ns),
        device_(profile, firm_hand(profile), firm_hand(profile)),
        loop_(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device_))) {
    device_.move_hand([hand_m_s](double time_s) {
      const double turn_rad_s = 2 * M_PI * kHand_Hz;
      return Pose{{hand_m_s / turn_rad_s * std::sin(turn_rad_s * time_s), 0, 0},
                  Eigen::Quaterniond::Identity()};
    });
    loop_->open();
  }

  TickRecord tick() {
    ticks_.advance();
    const int64_t now_ns = ticks_.now_ns();
    device_.exchange_at(now_ns + std::llround(random_.uniform(0, LateTicks::kCycle_ns)));
    constexpr int64_t kFrame_ns = 40 * kTick_ns;
    for (; next_ns_ <= now_ns + 2 * kFrame_ns; next_ns_ += kFrame_ns)
      loop_->schedule({next_ns_, 2 * kFrame_ns, {{0, film_N_, 0}, {0, 0, 0}}});
    loop_->set_playback_clock({now_ns, now_ns, 1, true});
    loop_->tick(ticks_.deadline_ns(), now_ns);
    return loop_->snapshot().last;
  }

  const GripMotion& motion() const { return loop_->grip().reading().motion; }
  const GripDynamics::State& state() const { return device_.state(); }

 private:
  static GripModel firm_hand(const Profile& profile) {
    GripModel model = grip_model_of(profile);
    model.hand_stiffness_N_m = 1500;
    return model;
  }

  const double film_N_;
  RandomMotion random_;
  LateTicks ticks_;
  int64_t next_ns_ = 0;
  LetGoDevice device_;
  std::unique_ptr<HapticLoop> loop_;
};

// Divided by the last interval alone, of 0.05 ms, the acceleration was twenty times what it is: a
// hand at 0.5 m/s got the whole limit of 3 N for a tick, with no force wanted.
TEST(LateTicks, NoBrakeActsOnAHandThatHolds) {
  // As far below the lowest speed at which the brake acts as the speed that it sees may be wrong,
  // with a tenth for what the grip is faster than the hand's rest.
  const double hand_m_s = 0.9 * (brake::kHeavyFrom_m_s - brake::kSpeedError_m_s);
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    for (const double film_N : {0.0, 1.0}) {
      HeldGrip grip(profile, hand_m_s, film_N, 5);
      int late = 0;
      for (int i = 0; i < 4000; ++i) {
        const TickRecord last = grip.tick();
        late += last.lateness_ns > kTick_ns / 2;
        ASSERT_FALSE(last.brakes) << name << ", " << film_N << " N, tick " << i;
        ASSERT_LE(last.commanded.force_N.norm(), film_N + 1e-9) << name << ", tick " << i;
      }
      EXPECT_GT(late, 50);
    }
  }
}

// A sinus of 3 Hz has a third derivative of v ω²: over the 6.5 ms of the fit and the 6.5 ms ahead,
// the parabola is wrong by v (ω · 13 ms)² / 2, 3 % of v, and the steps of the encoders by less than
// that; what the brake allows for is more. What nobody has read for milliseconds, as long as the
// fit takes, nobody knows.
TEST(LateTicks, TheSpeedThatIsForeseenIsWhatComes) {
  const Profile profile = load_profile(kDefaultProfile);
  HeldGrip grip(profile, 1, 0, 6);
  const double ahead_s = brake::kLoop_s + profile.drive_lag_s;
  double worst_m_s = 0;
  int64_t last_ns = 0, stood_still_ns = 0;
  int judged = 0;
  for (int i = 0; i < 8000; ++i) {
    const int64_t now_ns = grip.tick().monotonic_ns;
    if (now_ns - std::exchange(last_ns, now_ns) > 2 * kTick_ns) stood_still_ns = now_ns;
    if (i < 500 || now_ns - stood_still_ns < 7 * kTick_ns) continue;
    ++judged;
    const GripDynamics::State& state = grip.state();
    // Of a firm hand that moves by a sinus: the acceleration is −ω² times the way.
    const Eigen::Vector3d then_m_s =
        state.velocity_m_s - ahead_s * std::pow(2 * M_PI * kHand_Hz, 2) * state.pose.position_m;
    worst_m_s =
        std::max(worst_m_s, (grip.motion().velocity_in(ahead_s).linear_m_s - then_m_s).norm());
  }
  std::printf("%.3f m/s at most in %d ticks\n", worst_m_s, judged);
  EXPECT_GT(judged, 3000);
  EXPECT_LE(worst_m_s, brake::kSpeedError_m_s);
}

TEST(GripMotion, TakesPosesAsTheyCome) {
  // A burst, the same time twice, an earlier one, and a pause of an hour.
  GripMotion motion;
  RandomMotion random(7);
  int64_t at_ns = 0;
  for (int i = 0; i < 20'000; ++i) {
    const int64_t step_ns[] = {
        0, -1, 1, 10, 1'000, 50'000, 1'000'000, 30'000'000, 3'600'000'000'000};
    at_ns += step_ns[random.some(i % 1000 == 0 ? 9 : 8)];
    motion.update({Eigen::Vector3d(0.3e-9 * static_cast<double>(at_ns), 0, 0), {}}, at_ns);
    const double then_m_s = motion.velocity_in(5e-3).linear_m_s.x();
    ASSERT_TRUE(std::isfinite(then_m_s));
    if (i > 1000) {
      ASSERT_NEAR(then_m_s, 0.3, 1e-4) << "pose " << i;
    }
  }
}

}  // namespace
}  // namespace spidar::test::late_ticks_test
