// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Two faults at about the same time, of every pair of kinds, on every profile: the largest force
/// and speed, and how long they last, by the simulated device's truth. Short by default;
/// SPIDAR_TICKS=10000000 is the long run (--suite hazards), which prints the table of
/// docs/strings.md. SPIDAR_SEED selects another seed, SPIDAR_SHOW=1 prints every round.
#include "spidar/limits/released_grip.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/loop_thread.h"
#include "spidar/loop/string_grip.h"
#include "tests/support/faulty_device.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"
#include "tests/support/rest_force.h"
#include "tests/support/test.h"

namespace spidar::test::hazards_test {
namespace {

constexpr int64_t kFrame_ns = 10 * kTick_ns;
/// A string breaks, or is slack by up to 10 mm; an encoder stops, or jumps; the link fails for up
/// to 0.3 s; the player stalls for up to 60 ms; it is killed, or stopped for ever.
enum Kind { kString, kEncoder, kLink, kStall, kProcess, kKinds };
constexpr std::array<const char*, kKinds> kNames{"string", "encoder", "link", "stall", "process"};
/// A fault comes between these times after the film has begun; the second one soon after.
constexpr int kEarliest_ms = 150;
constexpr int kLatest_ms = 500;
constexpr int kApart_ms = 150;
constexpr int kAfter_ms = 800;
constexpr int kLongestStall_ms = 60;
constexpr int kLongestLink_ms = 300;
/// The guardian has set the motors to zero this long after the player died or stopped, or when the
/// board takes it: it tries every 10 ms (spidar/guardian/).
constexpr int kGuardian_ms = 50;
constexpr int kGuardianTry_ms = 10;
/// A pose that fits no longer is used for PoseTrust::kMaxMisses more ticks; then a quarter of the
/// ramp of 40 ms, which is level at first, takes the tensions to rest (TensionCommand::kLostPace).
constexpr int kFade_ms = 14;
/// Three time constants of the drives, after which a force of three times the limit is within it.
constexpr int kLag_ms = 6;
constexpr int kMaxAbove_ms = PoseTrust::kMaxMisses + 1 + kFade_ms + kLag_ms;
/// Where the pose was lost before the player died. A string needs up to TensionSlew::kRange_s more
/// when it passes through its whole range.
constexpr int kSlew_ms = 20;
constexpr int kMaxAfter_ms = kFade_ms + kSlew_ms + kGuardian_ms + kGuardianTry_ms;
/// Forces that differ by less are the same: rounding of the D/A converter, and the pull at rest
/// while the motors follow.
constexpr double kMargin_N = 0.1;

struct Worst {
  double force_N = 0;
  double speed_m_s = 0;
  // Longest times in a row; `…acting_ms` without the time in which nothing reaches the board, and
  // without that from when the player died.
  int above_ms = 0;  ///< above the limit
  int above_acting_ms = 0;
  int after_ms = 0;  ///< with a force that should rest
  int after_acting_ms = 0;
  int rounds = 0;

  void take(const Worst& other) {
    force_N = std::max(force_N, other.force_N);
    speed_m_s = std::max(speed_m_s, other.speed_m_s);
    above_ms = std::max(above_ms, other.above_ms);
    after_ms = std::max(after_ms, other.after_ms);
    above_acting_ms = std::max(above_acting_ms, other.above_acting_ms);
    after_acting_ms = std::max(after_acting_ms, other.after_acting_ms);
    ++rounds;
  }
};

/// One session, from opening until some time after both faults.
class Round {
 public:
  Round(const Profile& profile, uint64_t seed, bool held)
      : random_(seed),
        profile_(profile),
        phase_(random_.uniform(0, 7)),
        simulated_(profile, SimulatedDevice::Time::kFixedStep,
                   held ? grip_model_of(profile) : released(profile, 0.1)),
        device_(simulated_, profile),
        loop_(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device_))) {
    loop_->open();
    for (int ms = 0; ms < 250; ++ms) step();
    played_at_ns_ = now_ns_;
    loop_->set_playback_clock({now_ns_, 0, 1, true});
  }

  Worst run(Kind first, Kind second) {
    const int first_ms = kEarliest_ms + random_.some(kLatest_ms - kEarliest_ms);
    const int second_ms = first_ms + random_.some(kApart_ms);
    for (int ms = 0; ms < second_ms + kAfter_ms; ++ms) {
      if (ms == first_ms) happen(first);
      if (ms == second_ms) happen(second);
      step();
    }
    return worst_;
  }

  int ticks() const { return static_cast<int>(now_ns_ / kTick_ns); }

 private:
  void happen(Kind kind) {
    const int string = random_.some(profile_.geometry.count);
    const bool first_way = random_.chance(0.5);
    const auto counts = [&](double metres) {
      return static_cast<int32_t>(metres /
                                  profile_.drives[static_cast<size_t>(string)].metres_per_count);
    };
    switch (kind) {
      case kString:
        if (first_way) return device_.cut(string);
        return device_.shift(string, counts(random_.uniform(0.002, 0.01)));
      case kEncoder:
        if (first_way) return device_.stop_encoder(string);
        return device_.shift(string, counts(random_.uniform(-0.02, 0.02)));
      case kLink:
        link_ms_ = std::max(link_ms_, 1 + random_.some(kLongestLink_ms));
        return device_.set_link(first_way ? LinkFault::kTimeout : LinkFault::kWrongReply);
      case kStall:
        stall_ms_ = std::max(stall_ms_, 1 + random_.some(kLongestStall_ms));
        return;
      default:
        if (dead_ms_ < 0) dead_ms_ = 0;
    }
  }

  /// A millisecond, in which the loop ticks if it can.
  void step() {
    now_ns_ += kTick_ns;
    move_hand();
    if (dead_ms_ >= 0) {
      guard();
    } else if (stall_ms_ > 0) {
      --stall_ms_;
      device_.hold();
    } else {
      feed();
      loop_->tick(now_ns_, now_ns_);
      if (loop_->lost() && now_ns_ >= next_try_ns_) {
        loop_->reopen();
        next_try_ns_ = now_ns_ + LoopThread::kRetry_ns;
      }
      if (loop_->lost()) device_.hold();
    }
    if (link_ms_ > 0 && --link_ms_ == 0) device_.set_link(LinkFault::kNone);
    measure();
  }

  void guard() {
    if (dead_ms_ >= kGuardian_ms && (dead_ms_ - kGuardian_ms) % kGuardianTry_ms == 0)
      device_.zero();
    ++dead_ms_;
    device_.hold();
  }

  void feed() {
    const int64_t running_ns = now_ns_ - played_at_ns_;
    for (; next_frame_ns_ <= running_ns + 2 * kFrame_ns; next_frame_ns_ += kFrame_ns) {
      if (next_frame_ns_ % (20 * kFrame_ns) == 0) force_N_ = 3 * random_.direction();
      loop_->schedule({next_frame_ns_, 2 * kFrame_ns, {force_N_, Eigen::Vector3d::Zero()}});
    }
  }

  /// To and fro within 2 cm, at up to 0.5 m/s.
  void move_hand() {
    const double time_s = 1e-9 * static_cast<double>(now_ns_);
    const auto wave = [&](double rate_Hz, double shift) {
      return 0.02 / std::sqrt(3.0) * std::sin(2 * M_PI * rate_Hz * time_s + phase_ + shift);
    };
    Pose hand;
    hand.position_m = {wave(3.1, 0), wave(2.3, 1), wave(3.7, 2)};
    simulated_.set_hand(hand);
  }

  /// Whether there should be no force: nobody commands one, or the pose is not known.
  bool should_rest() const {
    if (dead_ms_ >= 0 || loop_->lost()) return true;
    return loop_->snapshot().last.pose_fault != PoseFault::kNone && played_at_ns_ > 0;
  }

  void measure() {
    const FeltState felt = simulated_.felt();
    const double force_N = felt.wrench.force_N.norm();
    const double rest_N = rest_force_N(profile_, felt.pose).norm();
    worst_.force_N = std::max(worst_.force_N, force_N);
    worst_.speed_m_s = std::max(worst_.speed_m_s, felt.velocity_m_s.norm());
    const bool above = force_N > std::max(3.0, rest_N) + kMargin_N;
    const bool rests = (device_.told_N() - profile_.min_tension_N()).maxCoeff() <= 1e-9;
    const bool acting = link_ms_ <= 0 && stall_ms_ <= 0;
    above_.see(above, acting && dead_ms_ < 0, worst_.above_ms, worst_.above_acting_ms);
    after_.see(should_rest() && !rests, acting, worst_.after_ms, worst_.after_acting_ms);
  }

  /// Milliseconds in a row.
  struct Row {
    int all_ms = 0, acting_ms = 0;

    void see(bool goes_on, bool acting, int& longest_ms, int& longest_acting_ms) {
      all_ms = goes_on ? all_ms + 1 : 0;
      acting_ms = goes_on ? acting_ms + acting : 0;
      longest_ms = std::max(longest_ms, all_ms);
      longest_acting_ms = std::max(longest_acting_ms, acting_ms);
    }
  };

  RandomMotion random_;
  const Profile& profile_;
  const double phase_;
  SimulatedDevice simulated_;
  FaultyDevice device_;
  std::unique_ptr<HapticLoop> loop_;
  int64_t now_ns_ = 0;
  int64_t played_at_ns_ = 0;
  int64_t next_frame_ns_ = 0;
  int64_t next_try_ns_ = 0;
  Eigen::Vector3d force_N_ = Eigen::Vector3d::Zero();
  int link_ms_ = 0;
  int stall_ms_ = 0;
  int dead_ms_ = -1;  ///< since the player died; −1: it lives
  Row above_, after_;
  Worst worst_;
};

uint64_t number(const char* variable, uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

TEST(Hazards, InPairs) {
  const uint64_t seed = number("SPIDAR_SEED", 1);
  const uint64_t ticks = number("SPIDAR_TICKS", 200'000);
  std::vector<Profile> profiles;
  for (const std::string& name : list_profiles()) profiles.push_back(load_profile(name));
  std::map<std::pair<int, int>, Worst> table;
  uint64_t done = 0;
  for (uint64_t n = 0; done < ticks; ++n) {
    const uint64_t pair = n % (kKinds * kKinds);
    const auto first = static_cast<Kind>(pair / kKinds);
    const auto second = static_cast<Kind>(pair % kKinds);
    const Profile& profile = profiles[n % profiles.size()];
    Round round(profile, seed * 1'000'003 + n, n % 4 != 3);
    const Worst worst = round.run(first, second);
    done += static_cast<uint64_t>(round.ticks());
    table[std::minmax<int>(first, second)].take(worst);
    const std::string where = profile.name + ", " + kNames[first] + " and " + kNames[second] +
                              ", round " + std::to_string(n) +
                              ", SPIDAR_SEED=" + std::to_string(seed);
    EXPECT_LE(worst.above_acting_ms, kMaxAbove_ms) << where;
    EXPECT_LE(worst.after_acting_ms, kMaxAfter_ms) << where;
    EXPECT_LE(worst.speed_m_s, kReleased_m_s) << where;
    if (std::getenv("SPIDAR_SHOW") != nullptr)
      std::printf("%llu %s %s+%s %s: %.2f N %.2f m/s %d %d %d %d\n",
                  static_cast<unsigned long long>(n), profile.name.c_str(), kNames[first],
                  kNames[second], n % 4 != 3 ? "held" : "released", worst.force_N, worst.speed_m_s,
                  worst.above_ms, worst.above_acting_ms, worst.after_ms, worst.after_acting_ms);
  }
  std::printf(
      "| faults | rounds | largest force, N | fastest, m/s | longest above the limit, ms | longest "
      "with a force that should rest, ms |\n|---|---|---|---|---|---|\n");
  for (const auto& [kinds, worst] : table) {
    std::printf("| %s, %s | %d | %.1f | %.2f | %d (%d) | %d (%d) |\n",
                kNames[static_cast<size_t>(kinds.first)], kNames[static_cast<size_t>(kinds.second)],
                worst.rounds, worst.force_N, worst.speed_m_s, worst.above_ms, worst.above_acting_ms,
                worst.after_ms, worst.after_acting_ms);
  }
  std::printf("%llu ticks, seed %llu\n", static_cast<unsigned long long>(done),
              static_cast<unsigned long long>(seed));
}

}  // namespace
}  // namespace spidar::test::hazards_test
