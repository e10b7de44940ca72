// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/wiring_report.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/quantile.h"
#include "spidar/devices/sim/grip_model.h"

namespace spidar::selftest {
namespace {

/// How much each assumed fault lowers the score of an explanation; a perfect correlation is 1.
constexpr double kFaultCost = 2e-3;
/// An answer below this fraction of the median of the strongest answers counts as none.
constexpr double kSilent = 0.1;
/// The accepted strength of a motor's answer relative to the others, as a multiple of the expected
/// one: hands are not equally stiff in all directions, and motors not equally strong.
constexpr double kWeakest = 1.0 / 3, kStrongest = 3;
constexpr double kRotationShares[] = {0.1, 0.3, 1, 3, 10};

struct Explanation {
  std::array<int, kMaxStrings> motor{}, encoder{};
  std::array<bool, kMaxStrings> encoder_reversed{};
  double correlation = 0;
  double worth = -1;  // the correlation minus the cost of the faults
};

class WiringDiagnosis {
 public:
  WiringDiagnosis(const Profile& profile, const WiringAnswers& answers)
      : count_(profile.geometry.count), structure_(structure_matrix(profile.geometry, {})) {
    for (int i = 0; i < count_; ++i) {
      if (!(answers.pulled_N[i] > 0)) continue;
      for (int j = 0; j < count_; ++j) {
        const StringDrive& drive = profile.drives[static_cast<size_t>(j)];
        answer_(j, i) = -drive.encoder_sign * drive.metres_per_count * answers.counts(j, i) /
                        answers.pulled_N[i];
      }
    }
    find_silent(profile, answers);
  }

  WiringReport report(const WiringAnswers& answers) {
    Explanation best;
    double best_fraction = 1;
    for (const double fraction : kRotationShares) {
      expect(fraction);
      Explanation found = search();
      if (found.worth <= best.worth) continue;
      best = found;
      best_fraction = fraction;
    }
    expect(best_fraction);
    const std::array<bool, kMaxStrings> unclear = find_unclear(best);
    WiringReport report;
    report.count = count_;
    report.correlation = best.correlation;
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
      WiringChannel& channel = report.channel[i];
      if (!silent_motor_[i]) channel.motor_string = best.motor[i];
      if (!silent_encoder_[i]) channel.encoder_string = best.encoder[i];
      channel.motor_reversed = answers.reversed[i];
      channel.unclear = answers.unsteady[i] || unclear[i];
      channel.encoder_reversed = !silent_encoder_[i] && best.encoder_reversed[i];
    }
    return report;
  }

 private:
  void find_silent(const Profile& profile, const WiringAnswers& answers) {
    std::vector<double> of_motors, of_encoders;
    for (int i = 0; i < count_; ++i) {
      of_motors.push_back(answer_.col(i).cwiseAbs().maxCoeff());
      of_encoders.push_back(answer_.row(i).cwiseAbs().maxCoeff());
    }
    const double motor = kSilent * median(of_motors), encoder = kSilent * median(of_encoders);
    const double pulled_N = std::max(answers.pulled_N.maxCoeff(), 1e-9);
    const double least = smallest_answer_m(profile) / pulled_N;
    for (size_t i = 0; i < of_motors.size(); ++i) {
      silent_motor_[i] = of_motors[i] < std::max(motor, least);
      silent_encoder_[i] = of_encoders[i] < std::max(encoder, least);
      if (silent_motor_[i]) answer_.col(static_cast<Eigen::Index>(i)).setZero();
    }
    for (size_t i = 0; i < of_motors.size(); ++i) {
      if (silent_encoder_[i]) answer_.row(static_cast<Eigen::Index>(i)).setZero();
    }
  }

  /// Computes the shortening of string j when string i is pulled, up to a common factor.
  void expect(double rotation_fraction) {
    const GripModel hand;
    Eigen::Matrix<double, 6, 1> compliance;
    compliance.head<3>().setConstant(1 / hand.hand_stiffness_N_m);
    compliance.tail<3>().setConstant(rotation_fraction / hand.hand_stiffness_Nm_rad);
    expected_ = structure_.transpose() * compliance.asDiagonal() * structure_;
  }

  /// Rates how well an assignment of motors and encoders to strings explains the answers by the
  /// correlation
  ///   Σⱼ |Σᵢ answer(j, i) expected(encoder j, motor i)| / (‖answer‖ ‖expected‖)
  /// over all encoders j and motors i that are not silent. Each encoder has the sign that fits
  /// better. Every fault has a small cost, so that the simpler explanation wins.
  Explanation explain(const std::array<int, kMaxStrings>& motor,
                      const std::array<int, kMaxStrings>& encoder) const {
    Explanation e;
    e.motor = motor;
    e.encoder = encoder;
    double product = 0, expected_norm2 = 0;
    for (size_t j = 0; j < static_cast<size_t>(count_); ++j) {
      if (silent_encoder_[j]) continue;
      const StringVector expected = expected_answers(e, j);
      const double row = answer_.row(static_cast<Eigen::Index>(j)).dot(expected);
      e.encoder_reversed[j] = row < 0;
      product += std::fabs(row);
      expected_norm2 += expected.squaredNorm();
    }
    const double norm = answer_.norm() * std::sqrt(expected_norm2);
    e.correlation = norm > 0 ? product / norm : 0;
    e.worth = e.correlation - kFaultCost * count_faults(e);
    return e;
  }

  /// The expected answers of encoder j, not reversed, to each motor; zero for silent motors.
  StringVector expected_answers(const Explanation& e, size_t j) const {
    StringVector expected = StringVector::Zero();
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
      if (!silent_motor_[i]) expected[static_cast<int>(i)] = expected_(e.encoder[j], e.motor[i]);
    }
    return expected;
  }

  /// A motor and an encoder that were exchanged together count as one fault.
  int count_faults(const Explanation& e) const {
    int faults = 0;
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
      const bool motor = e.motor[i] != static_cast<int>(i);
      const bool encoder = e.encoder[i] != static_cast<int>(i) && !silent_encoder_[i];
      const bool together = motor && e.motor[i] == e.encoder[i];
      faults += e.encoder_reversed[i] + motor + encoder - together;
    }
    return faults;
  }

  /// Finds motors whose answers do not match their strings in direction or size.
  std::array<bool, kMaxStrings> find_unclear(const Explanation& e) const {
    std::array<bool, kMaxStrings> unclear{};
    std::array<double, kMaxStrings> size{};
    std::vector<double> sizes;
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
      if (silent_motor_[i]) continue;
      StringVector expected = StringVector::Zero();
      for (size_t j = 0; j < static_cast<size_t>(count_); ++j) {
        if (!silent_encoder_[j]) {
          expected[static_cast<int>(j)] =
              (e.encoder_reversed[j] ? -1 : 1) * expected_(e.encoder[j], e.motor[i]);
        }
      }
      const auto answer = answer_.col(static_cast<Eigen::Index>(i));
      const double product = answer.dot(expected);
      unclear[i] = !(product >= WiringReport::kMinCorrelation * answer.norm() * expected.norm());
      size[i] = product / std::max(expected.squaredNorm(), 1e-30);
      sizes.push_back(size[i]);
    }
    if (sizes.empty()) return unclear;
    const double typical = median(sizes);
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
      if (!silent_motor_[i]) {
        unclear[i] |= size[i] < kWeakest * typical || size[i] > kStrongest * typical;
      }
    }
    return unclear;
  }

  Explanation search() const {
    std::array<int, kMaxStrings> same{};
    for (int i = 0; i < kMaxStrings; ++i) same[static_cast<size_t>(i)] = i;
    Explanation best = explain(same, same);
    for (;;) {
      const Explanation from = best;
      for (size_t a = 0; a < static_cast<size_t>(count_); ++a) {
        for (size_t b = a + 1; b < static_cast<size_t>(count_); ++b) {
          try_exchanges(from, a, b, best);
        }
      }
      if (!(best.worth > from.worth)) return best;
    }
  }

  void try_exchanges(const Explanation& from, size_t a, size_t b, Explanation& best) const {
    const bool motors = !silent_motor_[a] && !silent_motor_[b];
    const bool encoders = !silent_encoder_[a] && !silent_encoder_[b];
    std::array<int, kMaxStrings> motor = from.motor, encoder = from.encoder;
    std::swap(motor[a], motor[b]);
    std::swap(encoder[a], encoder[b]);
    const auto consider = [&](const Explanation& e) {
      if (e.worth > best.worth) best = e;
    };
    if (motors) consider(explain(motor, from.encoder));
    if (encoders) consider(explain(from.motor, encoder));
    if (motors && encoders) consider(explain(motor, encoder));
  }

  const int count_;
  const StructureMatrix structure_;
  decltype(WiringAnswers::counts) answer_ = decltype(answer_)::Zero();  ///< metres per newton
  Eigen::Matrix<double, kMaxStrings, kMaxStrings> expected_;
  std::array<bool, kMaxStrings> silent_motor_{}, silent_encoder_{};
};

}  // namespace

bool WiringReport::is_conclusive() const noexcept {
  return correlation >= kMinCorrelation &&
         std::none_of(channel.begin(), channel.begin() + count,
                      [](const WiringChannel& c) { return c.unclear; });
}

bool WiringReport::as_profile() const noexcept {
  for (int i = 0; i < count; ++i) {
    const WiringChannel& c = channel[static_cast<size_t>(i)];
    if (c.motor_string != i || c.encoder_string != i || c.motor_reversed || c.encoder_reversed) {
      return false;
    }
  }
  return is_conclusive();
}

bool WiringReport::fixable() const noexcept {
  for (int i = 0; i < count; ++i) {
    const WiringChannel& c = channel[static_cast<size_t>(i)];
    if (c.motor_string < 0 || c.motor_string != c.encoder_string) return false;
  }
  return is_conclusive();
}

WiringReport judge_wiring(const Profile& profile, const WiringAnswers& answers) {
  return WiringDiagnosis(profile, answers).report(answers);
}

Profile rewired_profile(const Profile& profile, const WiringReport& report,
                        const std::string& how) {
  if (!report.fixable()) {
    throw std::invalid_argument("wiring: it is unclear, or no profile can describe it");
  }
  Profile rewired = profile;
  bool moved = false, motors = false, encoders = false;
  for (size_t i = 0; i < static_cast<size_t>(report.count); ++i) {
    const WiringChannel& channel = report.channel[i];
    const auto from = static_cast<size_t>(channel.motor_string);
    rewired.geometry.exit_m[i] = profile.geometry.exit_m[from];
    rewired.geometry.grip_m[i] = profile.geometry.grip_m[from];
    if (channel.motor_reversed) rewired.drives[i].motor_sign *= -1;
    if (channel.encoder_reversed) rewired.drives[i].encoder_sign *= -1;
    moved |= from != i;
    motors |= channel.motor_reversed;
    encoders |= channel.encoder_reversed;
  }
  if (moved || encoders) {
    for (StringDrive& drive : rewired.drives) drive.home_offset_m = 0;
    rewired.calibration.reset();
  }
  const auto measured = [&](const char* field) {
    rewired.provenance.push_back({field, how, Evidence::kMeasured, ""});
  };
  if (moved) measured("geometry");
  if (motors) measured("motor_sign");
  if (encoders) measured("encoder_sign");
  return rewired;
}

std::pair<WiringAnswers, WiringReport> test_wiring(
    StringDevice& device, const Profile& profile, const Pace& pace, const WiringSettings& settings,
    const std::function<void(const WiringReport&)>& repeat) {
  WiringReport report;
  WiringAnswers answers = measure_wiring(device, profile, pace, settings);
  for (int tries = 1; answers.complete; ++tries) {
    report = judge_wiring(profile, answers);
    const auto& channels = report.channel;
    const bool silent = std::all_of(channels.begin(), channels.end(), [](const WiringChannel& c) {
      return c.motor_string < 0 && !c.unclear;
    });
    if (report.is_conclusive() || silent || tries == kWiringTries) break;
    std::array<bool, kMaxStrings> doubtful{};
    for (size_t i = 0; i < doubtful.size(); ++i) doubtful[i] = report.channel[i].unclear;
    if (std::none_of(doubtful.begin(), doubtful.end(), [](bool d) { return d; })) {
      doubtful.fill(true);
    }
    if (repeat) repeat(report);
    measure_again(device, profile, pace, settings, doubtful, answers);
  }
  return {answers, report};
}

std::string unclear_motors(const WiringReport& report) {
  std::string names;
  for (int i = 0; i < report.count; ++i) {
    if (report.channel[static_cast<size_t>(i)].unclear) {
      names += (names.empty() ? " " : ", ") + std::to_string(i);
    }
  }
  return names;
}

}  // namespace spidar::selftest
