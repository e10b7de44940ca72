// What a board shows of the simulated grip: quantised, saturated, lagging, and failing on request.

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "spidar/device_factory.h"
#include "spidar/profile.h"
#include "spidar/simulated_device.h"
#include "tests/support/allocation_count.h"

using namespace spidar;

namespace {

GripModel without_lag() {
  GripModel model;
  model.motor_time_constant_s = 0;
  return model;
}

/// Volts for a tension of every string, before the D/A rounds them.
MotorVolts volts_for(const Profile& profile, const StringVector& tension_N) {
  MotorVolts volts;
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    volts.volt[k] = drive.motor_sign * tension_N[i] / drive.newtons_per_volt;
  }
  return volts;
}

/// The D/A's step as a tension of string `i`.
double step_N(const Profile& profile, int i) {
  return profile.dac_max_V / ((1 << profile.dac_bits) - 1) *
         profile.drives[static_cast<size_t>(i)].newtons_per_volt;
}

Pose hand_at(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Pose hand;
  hand.position_m = 0.02 * Eigen::Vector3d(unit(random), unit(random), unit(random));
  hand.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(
      unit(random), Eigen::Vector3d(unit(random), unit(random), unit(random)).normalized()));
  return hand;
}

}  // namespace

class SimulatedDeviceTest : public testing::Test {
 protected:
  static constexpr auto kFixedStep = SimulatedDevice::Time::kFixedStep;

  const Profile profile = load_profile(kDefaultProfile);
};

TEST_F(SimulatedDeviceTest, CountsAreZeroAtTheCentreAndSignedAsTheProfileSays) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  DeviceReading reading;
  reading.count.fill(77);
  ASSERT_EQ(device.exchange({}, reading), ExchangeStatus::kOk);
  for (const int32_t count : reading.count) EXPECT_EQ(count, 0);

  // To the right: strings of the left side (0, 1, 4, 5) are paid out.
  Pose hand;
  hand.position_m.x() = 0.01;
  device.set_hand(hand);
  for (int tick = 0; tick < 500; ++tick) device.exchange({}, reading);
  for (const size_t i : {0u, 1u, 4u, 5u})
    EXPECT_GT(reading.count[i] * profile.drives[i].encoder_sign, 0) << i;
  for (const size_t i : {2u, 3u, 6u, 7u})
    EXPECT_LT(reading.count[i] * profile.drives[i].encoder_sign, 0) << i;
}

TEST_F(SimulatedDeviceTest, CountsAreWithinHalfACountOfTheLengths) {
  constexpr unsigned kSeed = 1;
  std::mt19937 random(kSeed);
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  const StringVector home_m = string_lengths_m(profile.geometry, {});
  double largest = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    if (tick % 50 == 0) device.set_hand(hand_at(random));
    DeviceReading reading;
    ASSERT_EQ(device.exchange({}, reading), ExchangeStatus::kOk);
    const StringVector change_m = string_lengths_m(profile.geometry, device.felt().pose) - home_m;
    for (int i = 0; i < profile.geometry.count; ++i) {
      const StringDrive& drive = profile.drives[static_cast<size_t>(i)];
      const double counted_m =
          drive.encoder_sign * drive.metres_per_count * reading.count[static_cast<size_t>(i)];
      const double error = std::abs(counted_m - change_m[i]) / drive.metres_per_count;
      // Half a count, and rounding of lengths of 0.1 m.
      ASSERT_LE(error, 0.5 + 1e-9) << "seed " << kSeed << ", tick " << tick << ", string " << i;
      largest = std::max(largest, error);
    }
  }
  // 40 000 lengths leave no part of a count unvisited: otherwise nothing was quantised.
  EXPECT_GT(largest, 0.49);
}

TEST_F(SimulatedDeviceTest, TensionsHaveTheStepsOfTheDA) {
  SimulatedDevice device(profile, kFixedStep, without_lag());
  device.open();
  const double step = step_N(profile, 2);
  for (int quarter = 0; quarter <= 400; ++quarter) {
    const double wanted_N = quarter * step / 4;
    StringVector tension_N = StringVector::Zero();
    tension_N[2] = wanted_N;
    DeviceReading reading;
    device.exchange(volts_for(profile, tension_N), reading);
    device.exchange(volts_for(profile, tension_N), reading);  // the first one's volts have acted
    const double got_N = device.felt().tension_N[2];
    EXPECT_LE(std::abs(got_N - wanted_N), step / 2 * (1 + 1e-9)) << quarter;
    const double steps = got_N / step;
    EXPECT_NEAR(steps, std::round(steps), 1e-9) << quarter;
  }
}

TEST_F(SimulatedDeviceTest, MotorsSaturateAndStringsNeverPush) {
  SimulatedDevice device(profile, kFixedStep, without_lag());
  device.open();
  const double infinity = std::numeric_limits<double>::infinity();
  const StringVector max_N = profile.max_tension_N();
  MotorVolts volts = volts_for(profile, StringVector::Constant(1.0));
  volts.volt[0] *= 1e6;             // far beyond the D/A
  volts.volt[1] *= max_N[1] + 0.5;  // within the D/A, more than the motor can do
  volts.volt[2] *= -1;              // pushes
  volts.volt[3] = std::nan("");
  volts.volt[4] = infinity;
  volts.volt[5] = -infinity;
  ASSERT_LT(std::abs(volts.volt[1]), profile.dac_max_V);
  DeviceReading reading;
  for (int tick = 0; tick < 2; ++tick) device.exchange(volts, reading);
  const StringVector tension_N = device.felt().tension_N;
  EXPECT_EQ(tension_N[0], max_N[0]);
  EXPECT_EQ(tension_N[1], max_N[1]);
  for (int i = 2; i <= 5; ++i) EXPECT_EQ(tension_N[i], 0) << i;
  EXPECT_NEAR(tension_N[6], 1.0, step_N(profile, 6) / 2 * (1 + 1e-9));
}

TEST_F(SimulatedDeviceTest, DARangeEndsBeforeTheMotor) {
  Profile weak = profile;
  weak.dac_max_V = 0.5;
  SimulatedDevice device(weak, kFixedStep, without_lag());
  device.open();
  DeviceReading reading;
  for (int tick = 0; tick < 2; ++tick)
    device.exchange(volts_for(weak, StringVector::Constant(4.0)), reading);
  ASSERT_LT(0.5 * weak.drives[0].newtons_per_volt, weak.drives[0].max_tension_N);
  EXPECT_NEAR(device.felt().tension_N[0], 0.5 * weak.drives[0].newtons_per_volt, 1e-12);
}

// Constant volts on some strings: the grip rests where the hand's springs hold the wrench of the
// tensions that were asked for. The D/A is off by up to half a step a string, each of which moves
// the grip by at most step/2 over the stiffness, and turns it by at most arm·step/2 over the
// stiffness.
TEST_F(SimulatedDeviceTest, RestingGripBalancesTheCommandedTensions) {
  const GripModel model;
  SimulatedDevice device(profile, kFixedStep, model);
  device.open();
  StringVector tension_N = StringVector::Constant(0.5);
  tension_N[6] = 2.0;
  tension_N[3] = 1.3;
  DeviceReading reading;
  for (int tick = 0; tick < 3000; ++tick) device.exchange(volts_for(profile, tension_N), reading);

  const FeltState felt = device.felt();
  const Eigen::Matrix<double, 6, 1> wrench =
      structure_matrix(profile.geometry, felt.pose) * tension_N;
  double off_N = 0;
  for (int i = 0; i < profile.geometry.count; ++i) off_N += step_N(profile, i) / 2;
  const double arm_m = profile.geometry.grip_radius_m();
  EXPECT_LT((felt.pose.position_m - wrench.head<3>() / model.hand_stiffness_N_m).norm(),
            off_N / model.hand_stiffness_N_m);
  EXPECT_LT(
      (rotation_vector(felt.pose.orientation) - wrench.tail<3>() / model.hand_stiffness_Nm_rad)
          .norm(),
      off_N * arm_m / model.hand_stiffness_Nm_rad);
  EXPECT_LT((felt.wrench.force_N - wrench.head<3>()).norm(), off_N);
  EXPECT_GT(wrench.head<3>().norm(), 100 * off_N) << "too small a force to say anything";
}

TEST_F(SimulatedDeviceTest, SameInputsGiveTheSameBits) {
  constexpr unsigned kSeed = 7;
  SimulatedDevice first(profile, kFixedStep);
  SimulatedDevice second(profile, kFixedStep);
  first.open();
  second.open();
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> tension(0, 4);
  for (int tick = 0; tick < 2000; ++tick) {
    StringVector tension_N;
    for (double& t : tension_N) t = tension(random);
    const Pose hand = hand_at(random);
    first.set_hand(hand);
    second.set_hand(hand);
    DeviceReading a, b;
    first.exchange(volts_for(profile, tension_N), a);
    second.exchange(volts_for(profile, tension_N), b);
    ASSERT_EQ(a.count, b.count) << "seed " << kSeed << ", tick " << tick;
    const FeltState x = first.felt();
    const FeltState y = second.felt();
    ASSERT_EQ(x.time_ns, (tick + 1) * 1'000'000);
    ASSERT_EQ(x.time_ns, y.time_ns);
    ASSERT_EQ(x.tension_N, y.tension_N);
    ASSERT_EQ(x.pose.position_m, y.pose.position_m);
    ASSERT_EQ(x.pose.orientation.coeffs(), y.pose.orientation.coeffs());
    ASSERT_EQ(x.velocity_m_s, y.velocity_m_s);
    ASSERT_EQ(x.angular_velocity_rad_s, y.angular_velocity_rad_s);
  }
}

TEST_F(SimulatedDeviceTest, SilentHostLeavesTheStringsPulling) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  DeviceReading reading;
  for (int tick = 0; tick < 100; ++tick)
    device.exchange(volts_for(profile, StringVector::Constant(2.0)), reading);
  const FeltState before = device.felt();
  EXPECT_NEAR(before.tension_N[0], 2.0, step_N(profile, 0) / 2 * (1 + 1e-9));

  // Nothing arrives for half a second: the last volts stand.
  device.set_fault(ExchangeStatus::kTimeout);
  for (int tick = 0; tick < 500; ++tick)
    ASSERT_EQ(device.exchange({}, reading), ExchangeStatus::kTimeout);
  const FeltState after = device.felt();
  EXPECT_EQ(after.time_ns - before.time_ns, 500'000'000);
  EXPECT_NEAR(after.tension_N[0], before.tension_N[0], 1e-12);
}

TEST_F(SimulatedDeviceTest, FaultsAnswerAsToldUntilTheyEnd) {
  SimulatedDevice device(profile, kFixedStep, without_lag());
  device.open();
  const MotorVolts volts = volts_for(profile, StringVector::Constant(1.0));
  DeviceReading reading;

  device.set_fault(ExchangeStatus::kBadReply);
  reading.count.fill(77);
  for (int tick = 0; tick < 2; ++tick)
    EXPECT_EQ(device.exchange(volts, reading), ExchangeStatus::kBadReply);
  EXPECT_EQ(reading.count[0], 77) << "written although the reply was bad";
  EXPECT_GT(device.felt().tension_N[0], 0.9) << "the volts arrive, only the reply is bad";

  device.set_fault(ExchangeStatus::kOk);
  EXPECT_EQ(device.exchange(volts, reading), ExchangeStatus::kOk);
  EXPECT_NE(reading.count[0], 77);

  device.set_fault(ExchangeStatus::kLost);
  EXPECT_EQ(device.exchange(volts, reading), ExchangeStatus::kLost);
  EXPECT_TRUE(device.felt().tension_N.isZero(0));
  EXPECT_THROW(device.open(), DeviceError);
  device.close();

  device.set_fault(ExchangeStatus::kOk);
  EXPECT_EQ(device.exchange(volts, reading), ExchangeStatus::kLost) << "lost until opened again";
  device.open();
  EXPECT_EQ(device.felt().time_ns, 0);
  EXPECT_EQ(device.exchange(volts, reading), ExchangeStatus::kOk);
}

TEST_F(SimulatedDeviceTest, ClosingRelaxesTheMotorsAndEverythingFeltIsKept) {
  SimulatedDevice device(profile, kFixedStep);
  FeltState felt;
  EXPECT_FALSE(device.pop_felt(felt));
  device.close();
  EXPECT_FALSE(device.pop_felt(felt)) << "closing what is not open does nothing";
  device.open();
  DeviceReading reading;
  for (int tick = 0; tick < 50; ++tick)
    device.exchange(volts_for(profile, StringVector::Constant(2.0)), reading);
  device.close();
  device.close();
  EXPECT_TRUE(device.felt().tension_N.isZero(0));
  EXPECT_EQ(device.exchange({}, reading), ExchangeStatus::kLost);

  // Tensions rise while it is open, then fall without a step down: a lag of 2 ms keeps e^(−1/2) =
  // 61 % from one millisecond to the next, until next to nothing is left.
  int64_t ticks = -1;
  double last_N = 0;
  while (device.pop_felt(felt)) {
    ++ticks;
    if (ticks > 50 && last_N > 1e-3) {
      EXPECT_NEAR(felt.tension_N[0], last_N * std::exp(-0.5), 1e-12) << ticks;
    }
    last_N = felt.tension_N[0];
  }
  EXPECT_GE(ticks, 50 + 10);
  EXPECT_EQ(last_N, 0);
}

TEST_F(SimulatedDeviceTest, HandThatIsNotFiniteIsIgnored) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  Pose bad;
  bad.position_m.x() = std::nan("");
  device.set_hand(bad);
  bad = {};
  bad.orientation.coeffs().setZero();
  device.set_hand(bad);
  DeviceReading reading;
  device.exchange({}, reading);
  EXPECT_TRUE(device.felt().pose.position_m.isZero(0));

  Pose scaled;  // means the same turn
  scaled.orientation.coeffs() *= 5;
  device.set_hand(scaled);
  device.exchange({}, reading);
  EXPECT_TRUE(device.felt().angular_velocity_rad_s.isZero(0));
}

TEST_F(SimulatedDeviceTest, ExchangeDoesNotAllocate) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  const MotorVolts volts = volts_for(profile, StringVector::Constant(1.0));
  DeviceReading reading;
  const long before = test::allocations;
  for (int tick = 0; tick < 5000; ++tick) device.exchange(volts, reading);  // more than are kept
  device.set_fault(ExchangeStatus::kLost);
  device.exchange(volts, reading);
  EXPECT_EQ(test::allocations, before);
}

// States read from another thread while the hand is moved from a third are whole: the wrench that
// was stored with a pose and tensions is the one these give.
TEST_F(SimulatedDeviceTest, OtherThreadsSeeWholeStates) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  std::atomic<bool> done{false};
  std::atomic<int> torn{0};
  std::thread reader([&] {
    while (!done) {
      const FeltState felt = device.felt();
      const Eigen::Matrix<double, 6, 1> wrench =
          structure_matrix(profile.geometry, felt.pose) * felt.tension_N;
      if (!(felt.wrench.stacked() - wrench).isZero(1e-12)) ++torn;
    }
  });
  std::thread hand([&] {
    std::mt19937 random(3);
    while (!done) device.set_hand(hand_at(random));
  });
  std::mt19937 random(4);
  std::uniform_real_distribution<double> tension(0, 4);
  DeviceReading reading;
  for (int tick = 0; tick < 3000; ++tick) {
    StringVector tension_N;
    for (double& t : tension_N) t = tension(random);
    device.exchange(volts_for(profile, tension_N), reading);
  }
  done = true;
  reader.join();
  hand.join();
  EXPECT_EQ(torn, 0);
}

TEST_F(SimulatedDeviceTest, ClockModeTakesTheTimeThatPassedUpToFiftyMilliseconds) {
  SimulatedDevice device(profile, SimulatedDevice::Time::kClock);
  const auto start = std::chrono::steady_clock::now();
  device.open();
  DeviceReading reading;
  for (int tick = 0; tick < 20; ++tick) device.exchange({}, reading);
  const auto passed = std::chrono::steady_clock::now() - start;
  const int64_t before_ns = device.felt().time_ns;
  EXPECT_GE(before_ns, 0);
  EXPECT_LE(before_ns, std::chrono::nanoseconds(passed).count());

  // sleep_for() never returns early.
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  device.exchange({}, reading);
  EXPECT_EQ(device.felt().time_ns - before_ns, 50'000'000);
}

TEST(DeviceFactory, KnowsTheSimulatedDeviceAndListsItForOtherNames) {
  const Profile profile = load_profile(kDefaultProfile);
  const auto device = make_device("sim", profile);
  EXPECT_EQ(device->name(), "sim");
  for (const std::string spec : {"foo", "", "SIM", "usb"}) {
    try {
      make_device(spec, profile);
      FAIL() << spec;
    } catch (const DeviceError& error) {
      const std::string expected = "unknown device \"" + spec + "\"; known are: sim";
      EXPECT_EQ(error.what(), expected);
    }
  }
}
