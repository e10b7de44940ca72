// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Finds the wiring from answers computed from the geometry, and from the simulated device, whose
// hand and motors differ from the assumed ones.
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "spidar/conformance/wiring_report.h"
#include "spidar/grip/tension_command.h"
#include "spidar/simulation/simulated_device.h"
#include "spidar/tools/miswired_device.h"

namespace spidar::test::wiring_test {
namespace {

/// "2 reads 5" for every channel that is not as in the profile.
std::string faults_of(const WiringReport& report) {
  std::string text;
  for (int i = 0; i < report.count; ++i) {
    const WiringChannel& c = report.channel[static_cast<size_t>(i)];
    const std::string name = std::to_string(i);
    if (c.motor_string != i)
      text += "motor " + name + " pulls " + std::to_string(c.motor_string) + "; ";
    if (c.motor_reversed) text += "motor " + name + " reversed; ";
    if (c.encoder_string != i)
      text += "encoder " + name + " reads " + std::to_string(c.encoder_string) + "; ";
    if (c.encoder_reversed) text += "encoder " + name + " reversed; ";
  }
  return text;
}

/// Time is that of the exchanges.
bool at_once() {
  return true;
}

/// A simulated device whose hand shifts once while a certain motor pulls, or should pull.
class ShiftingHand final : public Device {
 public:
  struct Shift {
    int motor = 0;
    double pull_V = 0;  ///< the motor's volts at half of its pull
    int after = 0;      ///< milliseconds of its pull
    int lasts = 0;      ///< milliseconds; 0: for ever
    Pose to;
  };

  ShiftingHand(const Profile& profile, const std::string& faults, const Shift& shift)
      : shift_(shift) {
    auto sim = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
    sim_ = sim.get();
    device_ = make_miswired(std::move(sim), parse_miswiring(faults, profile.geometry.count));
  }

  void open() override { device_->open(); }
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    const double volt = std::fabs(volts.volt[static_cast<size_t>(shift_.motor)]);
    if (volt > shift_.pull_V) ++pulled_ms_;
    if (pulled_ms_ > shift_.after) {
      const bool back = shift_.lasts > 0 && shifted_ms_++ >= shift_.lasts;
      sim_->set_hand(back ? Pose{} : shift_.to);
    }
    return device_->exchange(volts, reading);
  }
  void close() noexcept override { device_->close(); }
  const std::string& name() const noexcept override { return device_->name(); }

 private:
  const Shift shift_;
  SimulatedDevice* sim_ = nullptr;
  std::unique_ptr<Device> device_;
  int pulled_ms_ = 0;
  int shifted_ms_ = 0;
};

/// By 1 to 3 mm anywhere, at any time of a pull, for a while or for ever.
ShiftingHand::Shift any_shift(const Profile& profile, std::mt19937& random) {
  std::uniform_real_distribution<double> size_m(0.001, 0.003);
  std::normal_distribution<double> normal;
  ShiftingHand::Shift shift;
  shift.motor = std::uniform_int_distribution<int>(0, profile.geometry.count - 1)(random);
  StringVector half_N = StringVector::Zero();
  half_N[shift.motor] = profile.min_tension_N()[shift.motor] + 0.5 * WiringTestSettings{}.pull_N;
  shift.pull_V = std::fabs(to_volts(half_N, profile).volt[static_cast<size_t>(shift.motor)]);
  shift.after = std::uniform_int_distribution<int>(0, 200)(random);
  shift.lasts = std::uniform_int_distribution<int>(0, 1)(random) *
                std::uniform_int_distribution<int>(50, 500)(random);
  const Eigen::Vector3d to(normal(random), normal(random), normal(random));
  shift.to.position_m = size_m(random) * to.normalized();
  return shift;
}

WiringReport test_with(const Profile& profile, const std::string& faults,
                       const ShiftingHand::Shift& shift) {
  ShiftingHand device(profile, faults, shift);
  return judge_wiring(profile, ask_wiring(device, profile, at_once));
}

WiringReport test_of(const Profile& profile, const std::string& faults, bool try_reversed = true) {
  auto sim = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
  const auto device =
      make_miswired(std::move(sim), parse_miswiring(faults, profile.geometry.count));
  WiringTestSettings settings;
  settings.try_reversed = try_reversed;
  const WiringAnswers answers = ask_wiring(*device, profile, at_once, settings);
  EXPECT_TRUE(answers.complete);
  return judge_wiring(profile, answers);
}

}  // namespace

TEST(Wiring, OfEveryShippedProfileIsFoundToBeRight) {
  for (const std::string& name : list_profiles()) {
    SCOPED_TRACE(name);
    const WiringReport report = test_of(load_profile(name), "");
    EXPECT_TRUE(report.as_profile()) << faults_of(report) << report.correlation;
    // But for the rotation's share and the encoders' steps the answers are those expected.
    EXPECT_GT(report.correlation, 0.98);
  }
}

// Exchanged plugs are exchanged columns and rows of what the device answered before.
TEST(Wiring, EveryExchangeOfTwoIsFound) {
  for (const std::string name : {"spidar-gcc", "spidar-g6x3-v2-r", "spidar-g6x4", "spidar-i7"}) {
    const Profile profile = load_profile(name);
    SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
    const WiringAnswers right = ask_wiring(device, profile, at_once);
    for (int a = 0; a < profile.geometry.count; ++a) {
      for (int b = a + 1; b < profile.geometry.count; ++b) {
        for (const bool motors : {false, true}) {
          for (const bool encoders : {false, true}) {
            SCOPED_TRACE(name + " " + std::to_string(a) + "," + std::to_string(b));
            WiringAnswers answers = right;
            if (motors) answers.counts.col(a).swap(answers.counts.col(b));
            if (encoders) answers.counts.row(a).swap(answers.counts.row(b));
            const WiringReport report = judge_wiring(profile, answers);
            EXPECT_TRUE(report.understood());
            for (int i = 0; i < report.count; ++i) {
              const int other = i == a ? b : i == b ? a : i;
              const WiringChannel& c = report.channel[static_cast<size_t>(i)];
              EXPECT_EQ(c.motor_string, motors ? other : i) << faults_of(report);
              EXPECT_EQ(c.encoder_string, encoders ? other : i) << faults_of(report);
            }
          }
        }
      }
    }
  }
}

// A hand's tremor, as rows and columns of random counts: a tenth of a pull's own answer.
TEST(Wiring, FaultsAreFoundThroughTremor) {
  const Profile profile = load_profile("spidar-g6x3-v2-r");
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  WiringAnswers answers = ask_wiring(device, profile, at_once);
  const double own = answers.counts.diagonal().cwiseAbs().minCoeff();
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> tremor(0, 0.1 * own);
    WiringAnswers shaken = answers;
    for (double& count : shaken.counts.reshaped()) count += tremor(random);
    EXPECT_TRUE(judge_wiring(profile, shaken).as_profile())
        << faults_of(judge_wiring(profile, shaken));
    shaken.counts.row(3) *= -1;
    shaken.counts.row(1).swap(shaken.counts.row(6));
    // Encoders 1 and 6 have the same sign in this profile.
    EXPECT_EQ(faults_of(judge_wiring(profile, shaken)),
              "encoder 1 reads 6; encoder 3 reversed; encoder 6 reads 1; ");
  }
}

TEST(Wiring, ReversedAndCutWiresAreFound) {
  const Profile profile = load_profile("spidar-gcc");
  const std::pair<const char*, const char*> cases[] = {
      {"reverse-motor:0", "motor 0 reversed; "},
      {"reverse-encoder:7", "encoder 7 reversed; "},
      {"reverse-motor:2;reverse-encoder:2", "motor 2 reversed; encoder 2 reversed; "},
      {"cut-motor:3", "motor 3 pulls -1; "},
      {"cut-encoder:4;reverse-encoder:5", "encoder 4 reads -1; encoder 5 reversed; "},
      // 0 and 2 have the same signs.
      {"swap-motors:0,2;reverse-encoder:2",
       "motor 0 pulls 2; motor 2 pulls 0; encoder 2 reversed; "},
  };
  for (const auto& [wiring, faults] : cases) {
    SCOPED_TRACE(wiring);
    const WiringReport report = test_of(profile, wiring);
    EXPECT_TRUE(report.understood());
    EXPECT_FALSE(report.as_profile());
    EXPECT_EQ(faults_of(report), faults);
  }
  // A board that has no negative volts.
  EXPECT_EQ(faults_of(test_of(profile, "reverse-motor:0", false)), "motor 0 pulls -1; ");
}

TEST(Wiring, AShiftingHandNeverMakesAFaultyMotorPass) {
  for (const std::string name : {"spidar-gcc", "spidar-g6x3-v2-r", "spidar-i7"}) {
    const Profile profile = load_profile(name);
    for (unsigned seed = 0; seed < 160; ++seed) {
      std::mt19937 random(seed);
      const ShiftingHand::Shift shift = any_shift(profile, random);
      const std::string fault =
          (seed % 2 ? "cut-motor:" : "reverse-motor:") + std::to_string(shift.motor);
      const WiringReport report = test_with(profile, fault, shift);
      EXPECT_FALSE(report.as_profile()) << name << ", " << fault << ", seed " << seed;
    }
  }
}

TEST(Wiring, AHandThatShiftsOnceNeverMakesAMotorFail) {
  const Profile profile = load_profile("spidar-gcc");
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    const WiringReport report = test_with(profile, "", any_shift(profile, random));
    EXPECT_TRUE(report.as_profile()) << "seed " << seed << ": " << faults_of(report);
  }
}

TEST(Wiring, RewiredProfileIsTheDeviceAsItIs) {
  Profile profile = load_profile("spidar-gcc");
  profile.drives[3].home_offset_m = 0.001;
  profile.calibration = CalibrationRecord{};
  const std::string wiring = "swap-strings:1,2;reverse-motor:5;reverse-encoder:6";
  const WiringReport report = test_of(profile, wiring);
  ASSERT_TRUE(report.fixable()) << faults_of(report);
  const Profile rewired = rewired_profile(profile, report, "test");
  EXPECT_EQ(rewired.geometry.exit_m[1], profile.geometry.exit_m[2]);
  EXPECT_EQ(rewired.geometry.grip_m[2], profile.geometry.grip_m[1]);
  EXPECT_EQ(rewired.drives[5].motor_sign, -profile.drives[5].motor_sign);
  EXPECT_EQ(rewired.drives[6].encoder_sign, -profile.drives[6].encoder_sign);
  EXPECT_FALSE(rewired.calibration);
  EXPECT_EQ(rewired.drives[3].home_offset_m, 0);
  EXPECT_EQ(rewired.provenance.back().evidence, Evidence::kMeasured);
  // The new profile's answers, as the device with that wiring gives them.
  auto sim = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
  const auto device = make_miswired(std::move(sim), parse_miswiring(wiring, 8));
  const WiringReport again = judge_wiring(rewired, ask_wiring(*device, rewired, at_once));
  EXPECT_TRUE(again.as_profile()) << faults_of(again);
}

TEST(Wiring, WhatAProfileCannotExpressIsNotWritten) {
  const Profile profile = load_profile("spidar-gcc");
  for (const std::string wiring : {"swap-motors:0,2", "cut-motor:1", "cut-encoder:1"}) {
    const WiringReport report = test_of(profile, wiring);
    EXPECT_FALSE(report.fixable()) << wiring;
    EXPECT_THROW(rewired_profile(profile, report, "test"), std::invalid_argument);
  }
}

TEST(Wiring, AnotherDevicesAnswersAreNotUnderstood) {
  const Profile profile = load_profile("spidar-gcc");
  WiringAnswers answers;
  answers.pulled_N.setConstant(0.5);
  std::mt19937 random(1);
  std::normal_distribution<double> counts(0, 100);
  for (double& count : answers.counts.reshaped()) count = counts(random);
  EXPECT_FALSE(judge_wiring(profile, answers).understood());
  EXPECT_FALSE(judge_wiring(profile, {}).understood());
}

TEST(Wiring, PullingEndsWithTheMotorsAtZero) {
  const Profile profile = load_profile("spidar-gcc");
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  int ticks = 0;
  const WiringAnswers answers = ask_wiring(device, profile, [&ticks] { return ++ticks < 1000; });
  EXPECT_FALSE(answers.complete);
  EXPECT_EQ(device.felt().tension_N.norm(), 0);
}

TEST(Wiring, AStringThatRunsAwayEndsTheTest) {
  const Profile profile = load_profile("spidar-gcc");
  GripModel nobody;  // holds it
  nobody.hand_stiffness_N_m = 1;
  nobody.hand_damping_N_s_m = 0.5;
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep, nobody);
  try {
    ask_wiring(device, profile, at_once);
    FAIL() << "nothing ran away";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("hold the grip"), std::string::npos) << error.what();
  }
}

TEST(Wiring, LostDeviceEndsTheTest) {
  const Profile profile = load_profile("spidar-gcc");
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  int ticks = 0;
  const auto fail_at = [&](ExchangeStatus fault) {
    ticks = 0;
    return [&, fault] {
      if (++ticks == 300) device.set_fault(fault);
      return true;
    };
  };
  EXPECT_THROW(ask_wiring(device, profile, fail_at(ExchangeStatus::kLost)), DeviceError);
  device.set_fault(ExchangeStatus::kOk);
  EXPECT_THROW(ask_wiring(device, profile, fail_at(ExchangeStatus::kTimeout)), DeviceError);
}

TEST(Miswiring, BadFaultsAreNamed) {
  for (const std::string text :
       {"x", "swap-motors:1", "swap-motors:1,1", "swap-motors:1,8", "reverse-motor:-1",
        "reverse-motor:1,2", "swap-motors:1;2", "cut-motor:", "turn-motor:1"}) {
    try {
      parse_miswiring(text, 8);
      ADD_FAILURE() << text << " is taken";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("channels are 0 to 7"), std::string::npos);
    }
  }
}

}  // namespace spidar::test::wiring_test
