// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/wiring_answers.h"

#include <algorithm>
#include <cmath>

#include "spidar/loop/haptic_loop.h"
#include "spidar/text.h"

namespace spidar::selftest {
namespace {

constexpr double kRunaway_m = 0.03;
constexpr int kRounds = 4;
/// The fraction by which two answers may differ, because hands drift and tremble. A motor that does
/// nothing has no answer, so this allows at most smallest_answer_m() for it.
constexpr double kSteady = 0.25;

class WiringMeasurement {
 public:
  WiringMeasurement(StringDevice& device, const Profile& profile, const Pace& pace,
                    const WiringSettings& settings)
      : device_(device),
        profile_(profile),
        settings_(settings),
        rest_N_(profile.min_tension_N()),
        hold_(device, profile, pace) {}

  void run(const std::array<bool, kMaxStrings>& motors, WiringAnswers& answers) {
    for (int i = 0; i < profile_.geometry.count; ++i) {
      if (answers.reversed[static_cast<size_t>(i)]) hold_.reverse_motor(i);
    }
    answers.complete = repeated(
                           hold_, [] { return true; }, [this] { return begin(); }) &&
                       measure_all(motors, answers);
    hold_.release();
  }

 private:
  bool begin() {
    pulling_ = -1;
    rested_ = false;
    return hold_.ramp_to(rest_N_, HapticLoop::kEnergise_s) && settle();
  }

  bool measure_all(const std::array<bool, kMaxStrings>& motors, WiringAnswers& answers) {
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      if (!motors[k]) continue;
      const bool reversed = answers.reversed[k];
      if (!measure(i, answers)) return false;
      if (settings_.try_reversed && !reversed && !answered(answers, i) &&
          !measure_reversed(i, answers)) {
        return false;
      }
      report(i, answers);
    }
    return true;
  }

  void report(int motor, const WiringAnswers& answers) const {
    if (!settings_.pulled) return;
    const int sign = profile_.drives[static_cast<size_t>(motor)].encoder_sign;
    const double length_m = sign * metres_per_count(motor) * answers.counts(motor, motor);
    settings_.pulled->push({motor, length_m, !answers.unsteady[static_cast<size_t>(motor)]});
  }

  bool answered(const WiringAnswers& answers, int motor) const {
    return largest_m(answers.counts.col(motor)) >= smallest_answer_m(profile_);
  }

  bool measure(int motor, WiringAnswers& answers) {
    const auto k = static_cast<size_t>(motor);
    StringVector pulled_N = rest_N_;
    pulled_N[motor] = std::min(rest_N_[motor] + settings_.pull_N, profile_.drives[k].max_tension_N);
    answers.pulled_N[motor] = pulled_N[motor] - rest_N_[motor];
    bool steady = false;
    for (int round = 0; round < kRounds && !steady; ++round) {
      Pull first, second;
      if (!pull(motor, pulled_N, first) || !pull(motor, pulled_N, second)) return false;
      answers.counts.col(motor) = 0.5 * (first.answer + second.answer);
      const double allowed_m =
          std::max(kSteady * std::max(largest_m(first.answer), largest_m(second.answer)),
                   smallest_answer_m(profile_));
      steady = largest_m(first.answer - second.answer) < allowed_m &&
               largest_m(first.drift) < allowed_m && largest_m(second.drift) < allowed_m;
    }
    answers.unsteady[k] = !steady;
    return true;
  }

  struct Pull {
    StringVector answer = StringVector::Zero();
    /// The change from the rest before the pull to the rest after it.
    StringVector drift = StringVector::Zero();
  };

  bool pull(int motor, const StringVector& pulled_N, Pull& result) {
    return repeated(
        hold_, [this] { return begin(); }, [&] { return pull_once(motor, pulled_N, result); });
  }

  bool pull_once(int motor, const StringVector& pulled_N, Pull& result) {
    StringVector pulled, after;
    if (!rested_ && !average(at_rest_)) return false;
    pulling_ = motor;
    if (!hold_.ramp_to(pulled_N, settings_.ramp_s) || !settle() || !average(pulled)) return false;
    pulling_ = -1;
    if (!hold_.ramp_to(rest_N_, settings_.ramp_s) || !settle() || !average(after)) return false;
    // The reference is the mean of both rests, so that a slow drift of the hand cancels.
    result.answer = pulled - 0.5 * (at_rest_ + after);
    result.drift = after - at_rest_;
    at_rest_ = after;
    rested_ = true;
    return true;
  }

  double largest_m(const StringVector& counts) const {
    double largest = 0;
    for (int j = 0; j < profile_.geometry.count; ++j) {
      largest = std::max(largest, std::fabs(counts[j]) * metres_per_count(j));
    }
    return largest;
  }

  /// Tries the other sign and keeps it if the motor then pulls.
  bool measure_reversed(int motor, WiringAnswers& answers) {
    if (!reverse(motor) || !measure(motor, answers)) return false;
    answers.reversed[static_cast<size_t>(motor)] = answered(answers, motor);
    return answered(answers, motor) || reverse(motor);
  }

  bool reverse(int motor) {
    StringVector without_N = rest_N_;
    without_N[motor] = 0;
    const auto slacken = [&] { return hold_.ramp_to(without_N, settings_.ramp_s); };
    if (!repeated(
            hold_, [this] { return begin(); }, slacken)) {
      return false;
    }
    hold_.reverse_motor(motor);
    rested_ = false;
    const auto tighten = [this] { return hold_.ramp_to(rest_N_, settings_.ramp_s) && settle(); };
    return repeated(
        hold_, [this] { return begin(); }, tighten);
  }

  bool settle() {
    return hold_.hold_for(settings_.settle_s, [this](const DeviceReading& reading) {
      watch(reading);
      return true;
    });
  }

  bool average(StringVector& counts) {
    counts.setZero();
    int readings = 0;
    const bool whole = hold_.hold_for(settings_.average_s, [&](const DeviceReading& reading) {
      watch(reading);
      for (int j = 0; j < profile_.geometry.count; ++j) {
        counts[j] += reading.count[static_cast<size_t>(j)];
      }
      ++readings;
      return true;
    });
    if (readings == 0 && whole) {
      throw DeviceError(loss_text(device_.name(), device_.health().last_fault, 0));
    }
    if (readings > 0) counts /= readings;
    return whole;
  }

  void watch(const DeviceReading& reading) const {
    if (pulling_ < 0) return;
    for (int j = 0; j < profile_.geometry.count; ++j) {
      const double moved_m =
          metres_per_count(j) * (reading.count[static_cast<size_t>(j)] - at_rest_[j]);
      if (std::fabs(moved_m) < kRunaway_m) continue;
      throw DeviceError(
          device_.name() +
          formatted(": encoder %d ran by %.0f mm when motor %d pulled; hold the grip, and if it "
                    "was held, string %d is broken, or the motor's wires are reversed",
                    j, 1e3 * std::fabs(moved_m), pulling_, j));
    }
  }

  double metres_per_count(int j) const {
    return profile_.drives[static_cast<size_t>(j)].metres_per_count;
  }

  StringDevice& device_;
  const Profile& profile_;
  const WiringSettings settings_;
  const StringVector rest_N_;
  StringHold hold_;
  int pulling_ = -1;
  StringVector at_rest_ = StringVector::Zero();  ///< the latest average of the counts
  bool rested_ = false;  ///< whether `at_rest_` belongs to the present tensions
};

}  // namespace

double smallest_answer_m(const Profile& profile) {
  constexpr double kCounts = 8;
  double coarsest_m = 0;
  for (int i = 0; i < profile.geometry.count; ++i) {
    coarsest_m = std::max(coarsest_m, profile.drives[static_cast<size_t>(i)].metres_per_count);
  }
  return kCounts * coarsest_m;
}

WiringAnswers measure_wiring(StringDevice& device, const Profile& profile, const Pace& pace,
                             const WiringSettings& settings) {
  WiringAnswers answers;
  std::array<bool, kMaxStrings> all{};
  all.fill(true);
  measure_again(device, profile, pace, settings, all, answers);
  return answers;
}

void measure_again(StringDevice& device, const Profile& profile, const Pace& pace,
                   const WiringSettings& settings, const std::array<bool, kMaxStrings>& motors,
                   WiringAnswers& answers) {
  WiringMeasurement(device, profile, pace, settings).run(motors, answers);
}

}  // namespace spidar::selftest
