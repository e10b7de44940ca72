// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Finds the wiring from answers computed from the geometry, and from the simulated device, whose
// hand and motors differ from the assumed ones.
#include <numeric>

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/selftest/hold.h"
#include "spidar/selftest/selftest_report.h"
#include "spidar/selftest/wiring_report.h"
#include "tests/support/messages.h"
#include "tests/support/miswired_device.h"
#include "tests/support/test.h"

namespace spidar::test::wiring_test {
namespace {

/// "2 reads 5" for every channel that is not as in the profile.
std::string faults_of(const selftest::WiringReport& report) {
  std::string text;
  for (int i = 0; i < report.count; ++i) {
    const selftest::WiringChannel& c = report.channel[static_cast<size_t>(i)];
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

selftest::WiringReport test_of(const Profile& profile, const std::string& faults,
                               bool try_reversed = true) {
  auto sim = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
  MiswiredDevice device(std::move(sim), faults);
  selftest::WiringSettings settings;
  settings.try_reversed = try_reversed;
  const selftest::WiringAnswers answers =
      selftest::measure_wiring(device, profile, at_once, settings);
  EXPECT_TRUE(answers.complete);
  return selftest::judge_wiring(profile, answers);
}

TEST(LossText, SaysForHowLongTheProgramStoodStillOnlyIfThatIsKnown) {
  const std::string known = selftest::loss_text("usb", LinkFault::kSuspended, 250'000'000);
  expect_contains(known, "stood still for 250 ms, because");
  const std::string unknown = selftest::loss_text("usb", LinkFault::kSuspended, 0);
  expect_contains(unknown, "stood still, because");
}

/// Its guardian sets the motors to zero after each of these numbers of exchanges.
class PausedDevice final : public StringDevice {
 public:
  PausedDevice(const Profile& profile, std::vector<int> pauses)
      : StringDevice("sim"),
        real_(profile, SimulatedDevice::Time::kFixedStep),
        pauses_(std::move(pauses)) {}
  void open() override {
    real_.open();
    lost_ = false;
    ++opened;
  }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    ++exchanges_;
    lost_ = lost_ || std::find(pauses_.begin(), pauses_.end(), exchanges_) != pauses_.end();
    return lost_ ? LinkFault::kSuspended : real_.exchange(volts, reading);
  }
  void close() noexcept override { real_.close(); }
  LinkHealth health() const noexcept override {
    LinkHealth health;
    if (lost_) health.last_fault = LinkFault::kSuspended;
    return health;
  }
  int opened = 0;

 private:
  SimulatedDevice real_;
  const std::vector<int> pauses_;
  int exchanges_ = 0;
  bool lost_ = false;
};

}  // namespace

TEST(Wiring, IsFoundAlthoughTheProgramStoodStill) {
  const Profile profile = load_profile("spidar-gcc");
  SimulatedDevice undisturbed(profile, SimulatedDevice::Time::kFixedStep);
  const selftest::WiringAnswers right = selftest::measure_wiring(undisturbed, profile, at_once);
  // While the strings are tightened, in pulls, and in the release.
  for (const std::vector<int>& pauses :
       {std::vector<int>{50}, {700, 1900, 2500}, {400, 401, 402}, {8000, 8100, 8200, 8300}}) {
    PausedDevice device(profile, pauses);
    const selftest::WiringAnswers answers = selftest::measure_wiring(device, profile, at_once);
    EXPECT_TRUE(answers.complete);
    EXPECT_EQ(faults_of(selftest::judge_wiring(profile, answers)),
              faults_of(selftest::judge_wiring(profile, right)));
    EXPECT_TRUE(selftest::judge_wiring(profile, answers).as_profile());
  }
}

TEST(Wiring, IsNotLookedForOnAMachineThatStandsStillForEver) {
  const Profile profile = load_profile("spidar-gcc");
  std::vector<int> always(100'000);
  std::iota(always.begin(), always.end(), 100);
  PausedDevice device(profile, always);
  EXPECT_THROW(selftest::measure_wiring(device, profile, at_once), selftest::ProcessSuspended);
  EXPECT_EQ(device.opened, 11);
}

TEST(Wiring, OfEveryShippedProfileIsFoundToBeRight) {
  for (const std::string& name : list_profiles()) {
    SCOPED_TRACE(name);
    const selftest::WiringReport report = test_of(load_profile(name), "");
    EXPECT_TRUE(report.as_profile()) << faults_of(report) << report.correlation;
    // But for the rotation's fraction and the encoders' steps the answers are those expected.
    EXPECT_GT(report.correlation, 0.98);
  }
}

// Exchanged plugs are exchanged columns and rows of what the device answered before.
TEST(Wiring, EveryExchangeOfTwoIsFound) {
  for (const std::string name : {"spidar-gcc", "spidar-g6x3-v2-r", "spidar-g6x4", "spidar-i7"}) {
    const Profile profile = load_profile(name);
    SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
    const selftest::WiringAnswers right = selftest::measure_wiring(device, profile, at_once);
    for (int a = 0; a < profile.geometry.count; ++a) {
      for (int b = a + 1; b < profile.geometry.count; ++b) {
        for (const bool motors : {false, true}) {
          for (const bool encoders : {false, true}) {
            SCOPED_TRACE(name + " " + std::to_string(a) + "," + std::to_string(b));
            selftest::WiringAnswers answers = right;
            if (motors) answers.counts.col(a).swap(answers.counts.col(b));
            if (encoders) answers.counts.row(a).swap(answers.counts.row(b));
            const selftest::WiringReport report = selftest::judge_wiring(profile, answers);
            EXPECT_TRUE(report.is_conclusive());
            for (int i = 0; i < report.count; ++i) {
              const int other = i == a ? b : i == b ? a : i;
              const selftest::WiringChannel& c = report.channel[static_cast<size_t>(i)];
              EXPECT_EQ(c.motor_string, motors ? other : i) << faults_of(report);
              EXPECT_EQ(c.encoder_string, encoders ? other : i) << faults_of(report);
            }
          }
        }
      }
    }
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
    const selftest::WiringReport report = test_of(profile, wiring);
    EXPECT_TRUE(report.is_conclusive());
    EXPECT_FALSE(report.as_profile());
    EXPECT_EQ(faults_of(report), faults);
  }
  // A board that has no negative volts.
  EXPECT_EQ(faults_of(test_of(profile, "reverse-motor:0", false)), "motor 0 pulls -1; ");
}

TEST(Wiring, RewiredProfileIsTheDeviceAsItIs) {
  Profile profile = load_profile("spidar-gcc");
  profile.drives[3].home_offset_m = 0.001;
  profile.calibration = CalibrationRecord{};
  const std::string wiring = "swap-strings:1,2;reverse-motor:5;reverse-encoder:6";
  const selftest::WiringReport report = test_of(profile, wiring);
  ASSERT_TRUE(report.fixable()) << faults_of(report);
  std::ostringstream text;
  selftest::print_wiring(text, profile, {}, report);
  for (const char* line :
       {"\n        1  pulls string 2       reads string 2 ",
        "\n        5  reversed             ok ", "\n        6  ok                   reversed ",
        "\nwiring: not as in the profile\n"})
    EXPECT_NE(text.str().find(line), std::string::npos) << line << text.str();
  const Profile rewired = selftest::rewired_profile(profile, report, "test");
  EXPECT_EQ(rewired.geometry.exit_m[1], profile.geometry.exit_m[2]);
  EXPECT_EQ(rewired.geometry.grip_m[2], profile.geometry.grip_m[1]);
  EXPECT_EQ(rewired.drives[5].motor_sign, -profile.drives[5].motor_sign);
  EXPECT_EQ(rewired.drives[6].encoder_sign, -profile.drives[6].encoder_sign);
  EXPECT_FALSE(rewired.calibration);
  EXPECT_EQ(rewired.drives[3].home_offset_m, 0);
  EXPECT_EQ(rewired.provenance.back().evidence, Evidence::kMeasured);
  // The new profile's answers, as the device with that wiring gives them.
  auto sim = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
  MiswiredDevice device(std::move(sim), wiring);
  const selftest::WiringReport again =
      selftest::judge_wiring(rewired, selftest::measure_wiring(device, rewired, at_once));
  EXPECT_TRUE(again.as_profile()) << faults_of(again);
}

TEST(Wiring, WhatAProfileCannotExpressIsNotWritten) {
  const Profile profile = load_profile("spidar-gcc");
  for (const std::string wiring : {"swap-motors:0,2", "cut-motor:1", "cut-encoder:1"}) {
    const selftest::WiringReport report = test_of(profile, wiring);
    EXPECT_FALSE(report.fixable()) << wiring;
    EXPECT_THROW(selftest::rewired_profile(profile, report, "test"), std::invalid_argument);
  }
}

TEST(Wiring, AnotherDevicesAnswersAreNotUnderstood) {
  const Profile profile = load_profile("spidar-gcc");
  selftest::WiringAnswers answers;
  answers.pulled_N.setConstant(0.5);
  std::mt19937 random(1);
  std::normal_distribution<double> counts(0, 100);
  for (double& count : answers.counts.reshaped()) count = counts(random);
  EXPECT_FALSE(selftest::judge_wiring(profile, answers).is_conclusive());
  EXPECT_FALSE(selftest::judge_wiring(profile, {}).is_conclusive());
}

TEST(Wiring, PullingEndsWithTheMotorsAtZero) {
  const Profile profile = load_profile("spidar-gcc");
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  int ticks = 0;
  const selftest::WiringAnswers answers =
      selftest::measure_wiring(device, profile, [&ticks] { return ++ticks < 1000; });
  EXPECT_FALSE(answers.complete);
  EXPECT_EQ(device.felt().tension_N.norm(), 0);
}

TEST(Wiring, AStringThatRunsAwayEndsTheTest) {
  const Profile profile = load_profile("spidar-gcc");
  GripModel nobody;  // holds it
  nobody.hand_stiffness_N_m = 1;
  nobody.hand_damping_N_s_m = 0.5;
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep, nobody);
  const auto measure = [&] { selftest::measure_wiring(device, profile, at_once); };
  expect_contains(message_of<DeviceError>(measure), "hold the grip");
}

TEST(Wiring, LostDeviceEndsTheTest) {
  const Profile profile = load_profile("spidar-gcc");
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  int ticks = 0;
  const auto fail_at = [&](LinkFault fault) {
    ticks = 0;
    return [&, fault] {
      if (++ticks == 300) device.set_fault(fault);
      return true;
    };
  };
  EXPECT_THROW(selftest::measure_wiring(device, profile, fail_at(LinkFault::kGone)), DeviceError);
  device.set_fault(LinkFault::kNone);
  EXPECT_THROW(selftest::measure_wiring(device, profile, fail_at(LinkFault::kTimeout)),
               DeviceError);
}

}  // namespace spidar::test::wiring_test
