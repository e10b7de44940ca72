// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/samples.h"

#include <limits>
#include <stdexcept>

#include "core/grip/pose_solver.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/loop_time.h"
#include "spidar/selftest/hold.h"
#include "spidar/text.h"

namespace spidar::calibration {
namespace {

// Within this distance the length of a string is linear in the pose up to 0.3^2/(8*36) mm = 0.3 µm
// on the smallest of the devices.
constexpr double kSameLength_m = 0.3e-3;
constexpr double kMaxAveraged = 4;

}  // namespace

void check_samples(const Profile& profile, const CountSamples& counts, int min_strings) {
  const int strings = profile.geometry.count;
  if (strings < min_strings) {
    throw std::invalid_argument("calibration: profile \"" + profile.name + "\" has " +
                                as_text(strings) + " strings, must have at least " +
                                as_text(min_strings) +
                                ": a pose takes six, only those beyond tell anything");
  }
  if (counts.cols() != strings) {
    throw std::invalid_argument("calibration: samples have counts of " + as_text(counts.cols()) +
                                " strings, must have " + as_text(strings) + " as profile \"" +
                                profile.name + "\"");
  }
  if (counts.rows() < kMinSamples) {
    throw std::invalid_argument("calibration: " + as_text(counts.rows()) +
                                " samples, must be at least " + as_text(kMinSamples));
  }
  for (Eigen::Index k = 0; k < counts.rows(); ++k) {
    for (Eigen::Index i = 0; i < counts.cols(); ++i) {
      if (!std::isfinite(counts(k, i))) {
        throw std::invalid_argument("calibration: sample " + as_text(k) + ", string " + as_text(i) +
                                    ": the count is " + as_text(counts(k, i)) + ", must be finite");
      }
    }
  }
}

double rounding_sd_m(const Profile& profile, double averaged) {
  double sum = 0;
  for (int i = 0; i < profile.geometry.count; ++i) {
    sum += profile.drives[static_cast<size_t>(i)].metres_per_count;
  }
  return sum / profile.geometry.count / std::sqrt(12 * std::min(averaged, kMaxAveraged));
}

std::vector<StringVector> distinct_lengths_m(const Model& model, const CountSamples& counts) {
  std::vector<StringVector> lengths;
  StringVector first = StringVector::Zero(), sum = first;
  int same = 0;
  const auto finish = [&] {
    if (same > 0) lengths.push_back(sum / same);
    same = 0;
  };
  for (Eigen::Index k = 0; k < counts.rows(); ++k) {
    const StringVector next = model.paid_out_m(counts.row(k).transpose());
    if (same > 0 && (next - first).cwiseAbs().maxCoeff() > kSameLength_m) finish();
    if (same == 0) {
      first = next;
      sum.setZero();
    }
    sum += next;
    ++same;
  }
  finish();
  return lengths;
}

Pose pose_at_zero_count(const StringGeometry& geometry, const StringVector& home_offset_m) {
  PoseSolver solver(geometry, std::numeric_limits<double>::infinity());
  return solver.locate(string_lengths_m(geometry, {}) + home_offset_m).pose;
}

namespace {

CountSamples to_samples(const std::vector<DeviceReading>& readings, int strings) {
  CountSamples samples(static_cast<Eigen::Index>(readings.size()), strings);
  for (Eigen::Index k = 0; k < samples.rows(); ++k) {
    for (Eigen::Index i = 0; i < samples.cols(); ++i) {
      samples(k, i) = readings[static_cast<size_t>(k)].count[static_cast<size_t>(i)];
    }
  }
  return samples;
}

}  // namespace

CountSamples record_counts(StringDevice& device, const Profile& profile, double seconds,
                           double sample_period_s,
                           const std::function<bool(double time_s)>& next_tick) {
  constexpr auto kRise = static_cast<int64_t>(HapticLoop::kEnergise_s / kTick_s + 0.5);
  const auto period = static_cast<int64_t>(std::lround(sample_period_s / kTick_s));
  std::vector<DeviceReading> kept;
  int64_t tick = -kRise;  // the next one
  selftest::StringHold hold(device, profile,
                            [&] { return next_tick(static_cast<double>(tick++) * kTick_s); });
  if (hold.ramp_to(profile.min_tension_N(), HapticLoop::kEnergise_s)) {
    hold.hold_for(seconds, [&](const DeviceReading& reading) {
      if ((tick - 1) % period == 0) kept.push_back(reading);
      return true;
    });
  }
  hold.release();
  return to_samples(kept, profile.geometry.count);
}

}  // namespace spidar::calibration
