// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The wiring test with a hand that does not keep still.
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/selftest/wiring_report.h"
#include "tests/support/miswired_device.h"
#include "tests/support/test.h"

namespace spidar::test::wiring_hand_test {
namespace {

/// Of the hand.
constexpr double kMean_s = 1.2;
constexpr const char* kThree[] = {"spidar-gcc", "spidar-g6x3-v2-r", "spidar-i7"};

/// Time is that of the exchanges.
bool without_pauses() {
  return true;
}

/// A hand that trembles by 0.1 mm at 8 to 12 Hz and, at random times, every `mean_s` on average,
/// goes 1 to 3 mm from the centre in any direction, within some 40 ms.
class UnrulyHand final : public StringDevice {
 public:
  UnrulyHand(const Profile& profile, const std::string& faults, unsigned seed, double mean_s)
      : StringDevice("sim"), random_(seed), pause_s_(1 / mean_s) {
    auto sim = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
    sim_ = sim.get();
    device_ = std::make_unique<MiswiredDevice>(std::move(sim), faults);
    next_ms_ = pause_ms();
  }

  void open() override { device_->open(); }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    if (++ms_ >= next_ms_) {
      next_ms_ = ms_ + pause_ms();
      std::normal_distribution<double> normal;
      const Eigen::Vector3d to(normal(random_), normal(random_), normal(random_));
      to_m_ = std::uniform_real_distribution<double>(0.001, 0.003)(random_) * to.normalized();
    }
    at_m_ += (to_m_ - at_m_) / 40;
    Pose pose;
    for (int k = 0; k < 3; ++k)
      pose.position_m[k] = at_m_[k] + 1e-4 * std::sin(2 * M_PI * (8.3 + 1.7 * k) * 1e-3 * ms_ + k);
    sim_->set_hand(pose);
    return device_->exchange(volts, reading);
  }
  void close() noexcept override { device_->close(); }

 private:
  int pause_ms() { return 1 + static_cast<int>(1e3 * pause_s_(random_)); }

  std::mt19937 random_;
  std::exponential_distribution<double> pause_s_;
  SimulatedDevice* sim_ = nullptr;
  std::unique_ptr<StringDevice> device_;
  int ms_ = 0, next_ms_ = 0;
  Eigen::Vector3d to_m_ = Eigen::Vector3d::Zero(), at_m_ = Eigen::Vector3d::Zero();
};

}  // namespace

/// After one try, this hand made 113 of 200 good devices fail, and after three 6.
TEST(Wiring, AnUnrulyHandDoesNotMakeAGoodDeviceFail) {
  int first = 0, rejected = 0;
  constexpr unsigned kDevices = 40;
  for (unsigned seed = 0; seed < kDevices; ++seed) {
    const Profile profile = load_profile(kThree[seed % 3]);
    UnrulyHand device(profile, "", seed, kMean_s);
    bool again = false;
    const auto [answers, report] = selftest::test_wiring(
        device, profile, without_pauses, {}, [&](const selftest::WiringReport& unclear) {
          again = true;
          EXPECT_FALSE(unclear.is_conclusive());
        });
    first += again;
    rejected += !report.as_profile();
  }
  EXPECT_GT(first, kDevices / 5) << "this hand is too quiet for the test";
  EXPECT_LE(rejected, kDevices / 20);
}

TEST(Wiring, AnUnrulyHandNeverMakesABadDevicePass) {
  constexpr const char* kFaults[] = {"cut-motor:",   "reverse-motor:",   "cut-encoder:",
                                     "swap-motors:", "reverse-encoder:", "swap-encoders:"};
  for (unsigned seed = 0; seed < 72; ++seed) {
    const Profile profile = load_profile(kThree[seed % 3]);
    const unsigned channel = seed / 6 % static_cast<unsigned>(profile.geometry.count);
    std::string fault = kFaults[seed % 6] + std::to_string(channel);
    if (fault[0] == 's') fault += channel == 0 ? ",1" : ",0";
    UnrulyHand device(profile, fault, seed, kMean_s);
    const auto [answers, report] = selftest::test_wiring(device, profile, without_pauses, {});
    EXPECT_FALSE(report.as_profile()) << profile.name << ", " << fault << ", seed " << seed;
  }
}

/// Motors whose answers are clear are not pulled again.
TEST(Wiring, OnlyDoubtfulMotorsArePulledAgain) {
  const Profile profile = load_profile("spidar-gcc");
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  selftest::WiringAnswers answers = selftest::measure_wiring(device, profile, without_pauses);
  const auto right = answers.counts;
  answers.counts.setConstant(1);
  std::array<bool, kMaxStrings> doubtful{};
  doubtful[2] = true;
  selftest::measure_again(device, profile, without_pauses, {}, doubtful, answers);
  EXPECT_TRUE(answers.complete);
  // To a count: both are averages of readings that are rounded.
  EXPECT_LE((answers.counts.col(2) - right.col(2)).cwiseAbs().maxCoeff(), 1);
  EXPECT_EQ(answers.counts.col(3).maxCoeff(), 1);
}

}  // namespace spidar::test::wiring_hand_test
