// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/delay_test.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "spidar/grip/pose_trust.h"
#include "spidar/link/link_thread.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"

namespace spidar::selftest {
namespace {

constexpr double kFade_s = DelaySettings::kFade_s;
constexpr double kBegin_s = kFade_s + DelaySettings::kSettle_s;
constexpr double kRound_s = DelaySettings::kRound_s;
/// Wrenches are scheduled this long before they are due: the loop would fade a late one in.
constexpr int64_t kAhead_ns = 20 * kTick_ns;
/// How long a wrench lasts if the next one is late; then the loop ramps to zero.
constexpr int64_t kHold_ns = 10 * kTick_ns;
constexpr double kOpening_s = 2;        ///< in which the pose must become known
constexpr double kLongestGap_s = 0.01;  ///< a period with a longer pause is unusable

/// Rises from 0 to 1 at the beginning of a period and falls to 0 at its end, without a step in the
/// slope.
double envelope(double time_s) {
  const double way = std::clamp(std::min(time_s, kRound_s - time_s) / kFade_s, 0.0, 1.0);
  return way * way * (3 - 2 * way);
}

class DelayRun {
 public:
  DelayRun(StringDevice& device, const Profile& profile, const Pace& pace,
           const std::function<int64_t()>& now_ns, const DelaySettings& settings)
      : device_(device),
        loop_(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device),
                                           limits(settings))),
        pace_(pace),
        now_ns_(now_ns),
        settings_(settings) {}

  DelayTest run() {
    loop_->open();
    if (settle()) excite();
    release();
    if (result_.complete && result_.error.empty()) judge();
    return result_;
  }

 private:
  static SafetyLimits limits(const DelaySettings& settings) {
    SafetyLimits limits;
    limits.max_force_N = std::min(limits.max_force_N, settings.peak_N);
    return limits;
  }

  /// Returns false when the user interrupts the test, or when the device is lost.
  bool tick() {
    if (!pace_()) {
      result_.complete = false;
      return false;
    }
    const int64_t now_ns = now_ns_();
    const int64_t late_ns = record_.monotonic_ns == 0 ? 0 : now_ns - record_.monotonic_ns;
    loop_->tick(now_ns, now_ns);
    while (loop_->pop_record(record_)) {
    }
    if (!loop_->lost()) return true;
    // The guardian sets the motors to zero when this process is suspended. The test then opens the
    // device again and goes on.
    const bool was_suspended = device_.health().last_fault == LinkFault::kSuspended;
    if (was_suspended && ++reopened_ <= settings_.most_periods() && loop_->reopen()) return true;
    return fail_by_device(loss_text(device_.name(), device_.health().last_fault, late_ns));
  }

  bool fail(const std::string& error) {
    result_.error = error;
    return false;
  }

  bool fail_by_device(const std::string& error) {
    result_.is_of_device = true;
    return fail(error);
  }

  /// Runs until each string has its minimum tension and the pose is known.
  bool settle() {
    const int64_t begin_ns = now_ns_();
    for (;;) {
      if (!tick()) return false;
      const LoopSnapshot now = loop_->snapshot();
      if (record_.device == DeviceState::kRunning && now.last.pose_fault == PoseFault::kNone) break;
      if (1e-9 * static_cast<double>(record_.monotonic_ns - begin_ns) > kOpening_s) {
        return fail_by_device(std::string("the pose of the grip is not known: ") +
                              to_string(now.last.pose_fault));
      }
    }
    start_m_ = record_.pose.position_m;
    begin_ns_ = record_.monotonic_ns;
    loop_->set_playback_clock({begin_ns_, 0, 1.0, true});
    return true;
  }

  void excite() {
    std::mt19937 random(settings_.seed);
    rounds_.clear();
    for (int i = 0; i < settings_.most_periods(); ++i) {
      rounds_.emplace_back(random, settings_.peak_N);
    }
    for (int i = 0; i < settings_.most_periods(); ++i) {
      if (static_cast<int>(periods_.size()) == settings_.periods || !round(i)) return;
    }
  }

  double wanted_N(double time_s) const {
    const double number = std::floor(time_s / kRound_s);
    if (number < 0 || number >= static_cast<double>(rounds_.size())) return 0;
    const double in_round_s = time_s - number * kRound_s;
    return envelope(in_round_s) * rounds_[static_cast<size_t>(number)].at(in_round_s);
  }

  void schedule_ahead(int64_t running_ns) {
    for (; next_ns_ <= running_ns + kAhead_ns; next_ns_ += kTick_ns) {
      TimedWrench entry;
      entry.time_ns = next_ns_;
      entry.hold_ns = kHold_ns;
      entry.wrench.force_N.z() = wanted_N(1e-9 * static_cast<double>(next_ns_));
      if (!loop_->schedule(entry)) return;
    }
  }

  bool round(int number) {
    const double end_s = kRound_s * (number + 1);
    const uint64_t errors = loop_->snapshot().counters.exchange_errors;
    bool whole = true;
    PeriodSums sums(kRound_s * number + kBegin_s);
    for (;;) {
      schedule_ahead(now_ns_() - begin_ns_);
      if (!tick()) return false;
      if (recovers()) {
        whole = false;
      } else if (!is_well()) {
        return false;
      }
      const double time_s = 1e-9 * static_cast<double>(record_.monotonic_ns - begin_ns_);
      sums.add(time_s, record_.delivered.force_N.z(), record_.pose.position_m.z());
      if (time_s >= end_s) break;
    }
    whole = whole && loop_->snapshot().counters.exchange_errors == errors;
    if (whole && sums.longest_gap_s() < kLongestGap_s) periods_.push_back(sums);
    return true;
  }

  /// Whether the loop looks for the pose again after a pause of the computer, and ramps the force
  /// to zero until then. This is not a fault of the device.
  bool recovers() const {
    const PoseFault fault = loop_->snapshot().last.pose_fault;
    return record_.acknowledged && (fault == PoseFault::kNoReading || fault == PoseFault::kNotYet);
  }

  /// Returns false, which ends the test, when the pose is lost, a string is faulty, or the grip has
  /// moved too far.
  bool is_well() {
    const LoopSnapshot now = loop_->snapshot();
    if (now.last.pose_fault == PoseFault::kFrozen) {
      return fail(
          "no encoder counted although the force changed: the grip is held too firmly, or clamped; "
          "hold it loosely, so that it can move");
    }
    if (now.last.pose_fault != PoseFault::kNone) {
      return fail_by_device(std::string("the pose of the grip was lost: ") +
                            to_string(now.last.pose_fault));
    }
    if (record_.faulty_string >= 0) {
      return fail_by_device(
          "the length of string " + std::to_string(record_.faulty_string) +
          " does not fit the others: it is slack or broken, or its encoder is dead");
    }
    const double moved_m = (record_.pose.position_m - start_m_).norm();
    if (moved_m <= kFurthest_m) return true;
    return fail("the grip went further than 20 mm; hold it still and loosely, at the centre");
  }

  /// Ends with a ramp to zero, which an interruption by the user does not cut short.
  void release() {
    loop_->begin_close();
    while (!loop_->released()) {
      pace_();
      const int64_t now_ns = now_ns_();
      loop_->tick(now_ns, now_ns);
    }
    loop_->close();
  }

  void judge() {
    result_.periods = static_cast<int>(periods_.size());
    if (result_.periods < DelaySettings::kFewestPeriods) {
      fail("only " + std::to_string(result_.periods) + " of " +
           std::to_string(settings_.most_periods()) +
           " seconds were without a pause of 10 ms or an exchange without answer; at least " +
           std::to_string(DelaySettings::kFewestPeriods) + " are needed");
      return;
    }
    result_.fit = fit_lag(average(periods_), result_.periods);
    result_.error = result_.fit->error;
  }

  const StringDevice& device_;
  const std::unique_ptr<HapticLoop> loop_;
  const Pace& pace_;
  const std::function<int64_t()>& now_ns_;
  const DelaySettings settings_;
  DelayTest result_;
  TickRecord record_;
  int reopened_ = 0;
  Eigen::Vector3d start_m_ = Eigen::Vector3d::Zero();
  int64_t begin_ns_ = 0;
  int64_t next_ns_ = 0;
  std::vector<Multisine> rounds_;
  std::vector<PeriodSums> periods_;
};

}  // namespace

DelayTest measure_delay(StringDevice& device, const Profile& profile, const Pace& pace,
                        const std::function<int64_t()>& now_ns, const DelaySettings& settings) {
  if (settings.periods < DelaySettings::kFewestPeriods) {
    throw std::invalid_argument("measure_delay: " + std::to_string(settings.periods) +
                                " periods, must be at least " +
                                std::to_string(DelaySettings::kFewestPeriods));
  }
  return DelayRun(device, profile, pace, now_ns, settings).run();
}

LagVerdict judge_lag(const Profile& profile, const LagFit& fit, int64_t answer_ns) {
  const int64_t beyond_ns = std::max<int64_t>(answer_ns - boards::StringLink::kReplyWait_ns, 0);
  const double late_s = kTick_s * static_cast<double>((beyond_ns + kTick_ns - 1) / kTick_ns);
  // Without the 1e-6, a rounding error could round up to the next step.
  constexpr double kStep_s = 1e-4;
  LagVerdict verdict;
  verdict.stated_enough = profile.drive_lag_s >= fit.least_s + late_s;
  verdict.safe_lag_s = kStep_s * std::ceil((std::max(0.0, fit.most_s) + late_s) / kStep_s - 1e-6);
  return verdict;
}

}  // namespace spidar::selftest
