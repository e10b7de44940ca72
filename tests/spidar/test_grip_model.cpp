// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The simulated grip compared with closed-form solutions, and its stability for every profile.
#include <complex>

#include <Eigen/Geometry>

#include "spidar/devices/sim/grip_model.h"
#include "spidar/profiles/profile.h"
#include "tests/support/messages.h"
#include "tests/support/test.h"

namespace spidar::test::grip_model_test {

namespace {

constexpr double kTick_s = 1e-3;

Eigen::Quaterniond turned(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}

/// Kinetic energy, the hand's springs, and strings of constant tension.
double energy_J(const StringGeometry& geometry, const GripModel& model,
                const StringVector& target_N, const Pose& hand, const GripDynamics::State& state) {
  const Eigen::Vector3d stretch_m = hand.position_m - state.pose.position_m;
  const Eigen::Vector3d twist_rad =
      rotation_vector(hand.orientation * state.pose.orientation.conjugate());
  return 0.5 * model.mass_kg * state.velocity_m_s.squaredNorm() +
         0.5 * model.inertia_kg_m2 * state.angular_velocity_rad_s.squaredNorm() +
         0.5 * model.hand_stiffness_N_m * stretch_m.squaredNorm() +
         0.5 * model.hand_stiffness_Nm_rad * twist_rad.squaredNorm() +
         target_N.dot(string_lengths_m(geometry, state.pose));
}

class EveryProfile : public testing::TestWithParam<std::string> {};

}  // namespace

TEST(RotationVector, IsTheShorterWayRound) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -3).normalized();
  for (const double angle : {0.0, 1e-12, 1e-5, 0.5, 3.0}) {
    const Eigen::Quaterniond q = turned(angle, axis);
    // cos and sin of half the angle are rounded to 1e-16: the angle to a few of that.
    EXPECT_LT((rotation_vector(q) - angle * axis).norm(), 1e-15) << angle;
    const Eigen::Quaterniond same(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((rotation_vector(same) - angle * axis).norm(), 1e-15) << angle;
  }
}

// Slack strings leave a damped oscillator, ẍ + 2δẋ + ω²x = 0, swinging in translation and creeping
// in rotation: x(t) = x0 e^(−δt)(cosh st + δ/s sinh st), s² = δ² − ω². The method is of first
// order: within one step of motion, h·ω·x0, and ten times nearer with steps ten times shorter.
TEST(GripModel, SlackGripSwingsAsADampedOscillator) {
  const Profile profile = load_profile(kDefaultProfile);
  const GripModel model;
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), model);
  const auto exact = [](double stiffness, double damping, double inertia, double t) {
    const std::complex<double> delta = damping / (2 * inertia);
    const std::complex<double> s = std::sqrt(delta * delta - stiffness / inertia);
    return (std::exp(-delta * t) * (std::cosh(s * t) + delta / s * std::sinh(s * t))).real();
  };
  // Largest differences of x/x0 and angle/angle0.
  const auto largest_errors = [&](double step_s) {
    GripDynamics::State state;
    state.pose.position_m.x() = 0.01;
    state.pose.orientation = turned(0.5, {0, 1, 0});
    double translation = 0;
    double rotation = 0;
    const int steps = static_cast<int>(std::lround(0.1 / step_s));
    for (int i = 1; i <= steps; ++i) {
      dynamics.advance(StringVector::Zero(), {}, step_s, state);
      const double x =
          exact(model.hand_stiffness_N_m, model.hand_damping_N_s_m, model.mass_kg, i * step_s);
      const double angle = exact(model.hand_stiffness_Nm_rad, model.hand_damping_Nm_s_rad,
                                 model.inertia_kg_m2, i * step_s);
      translation = std::max(translation, std::abs(state.pose.position_m.x() / 0.01 - x));
      rotation =
          std::max(rotation, std::abs(rotation_vector(state.pose.orientation).y() / 0.5 - angle));
    }
    return std::pair(translation, rotation);
  };
  const auto [coarse_x, coarse_angle] = largest_errors(1e-4);
  const auto [fine_x, fine_angle] = largest_errors(1e-5);
  EXPECT_LT(coarse_x, 1e-4 * std::sqrt(model.hand_stiffness_N_m / model.mass_kg));
  EXPECT_LT(coarse_angle, 1e-4 * std::sqrt(model.hand_stiffness_Nm_rad / model.inertia_kg_m2));
  EXPECT_NEAR(coarse_x / fine_x, 10, 1) << "not of first order";
  EXPECT_NEAR(coarse_angle / fine_angle, 10, 1) << "not of first order";
}

// Nothing acts: velocities stay, and a grip that is already turned goes on turning about the axis
// of its angular velocity in D, not in its own frame.
TEST(GripModel, FreeGripKeepsItsVelocitiesInTheDeviceFrame) {
  const Profile profile = load_profile(kDefaultProfile);
  GripModel model;
  model.hand_stiffness_N_m = model.hand_damping_N_s_m = 0;
  model.hand_stiffness_Nm_rad = model.hand_damping_Nm_s_rad = 0;
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), model);
  GripDynamics::State state;
  const Eigen::Quaterniond start = turned(1.0, {1, 0, 0});
  state.pose.orientation = start;
  state.velocity_m_s = {0.01, -0.02, 0.03};
  state.angular_velocity_rad_s = {0, 2.0, 0};
  for (int tick = 0; tick < 1000; ++tick)
    dynamics.advance(StringVector::Zero(), {}, kTick_s, state);
  // A second of motion; a few thousand roundings of 1e-16.
  EXPECT_LT((state.pose.position_m - Eigen::Vector3d(0.01, -0.02, 0.03)).norm(), 1e-12);
  EXPECT_LT(state.pose.orientation.angularDistance(turned(2.0, {0, 1, 0}) * start), 1e-12);
}

TEST(GripModel, GripStopsAtTheFrame) {
  const Profile profile = load_profile(kDefaultProfile);
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), {});
  EXPECT_TRUE(dynamics.limit_m().isApprox(Eigen::Vector3d(0.059, 0.064, 0.059), 1e-12));
  GripDynamics::State state;
  Pose hand;
  hand.position_m = {1e6, -0.5, 0.03};
  for (int tick = 0; tick < 1000; ++tick) {
    dynamics.advance(StringVector::Zero(), hand, kTick_s, state);
    ASSERT_TRUE((state.pose.position_m.cwiseAbs().array() <= dynamics.limit_m().array()).all());
  }
  EXPECT_EQ(state.pose.position_m.x(), dynamics.limit_m().x());
  EXPECT_EQ(state.pose.position_m.y(), -dynamics.limit_m().y());
  EXPECT_EQ(state.velocity_m_s.x(), 0);
  hand.position_m.setZero();
  for (int tick = 0; tick < 1000; ++tick)
    dynamics.advance(StringVector::Zero(), hand, kTick_s, state);
  // It comes off again: e^(−40 t) of the way is left after a second (δ = 40 1/s).
  EXPECT_LT(state.pose.position_m.norm(), 1e-12);
}

TEST(GripModel, ModelThatIsNotPhysicalIsRefused) {
  const Profile profile = load_profile(kDefaultProfile);
  const auto error_of = [&](const GripModel& model) {
    return message_of<std::invalid_argument>(
        [&] { GripDynamics(profile.geometry, profile.max_tension_N(), model); });
  };
  GripModel model;
  model.mass_kg = 0;
  expect_contains(error_of(model), "mass_kg");
  model = {};
  model.inertia_kg_m2 = std::nan("");
  expect_contains(error_of(model), "inertia_kg_m2");
  model = {};
  model.hand_damping_N_s_m = -1;
  expect_contains(error_of(model), "hand_damping_N_s_m");
  model = {};
  model.motor_delay_s = 0.06;
  expect_contains(error_of(model), "motor_delay_s");
  model = {};
  model.hand_stiffness_N_m = 1e12;
  expect_contains(error_of(model), "too stiff");
  EXPECT_EQ(error_of({}), "");
}

// Strings that pull constantly are a potential, Σ tᵢ Lᵢ. Without dampers the energy is conserved;
// the method conserves a neighbour H̃ of it, and for a linear system |H − H̃| ≤ (hω/2) H, H above the
// rest energy. By construction hω ≤ 0.25, so H stays below (1 + 0.125)/(1 − 0.125) = 1.29 times its
// start. The strings' stiffness changes with the pose: 1.5. (Explicit Euler grows by e^(hω² t),
// that is by hundreds of powers of e in these ten seconds.) Dampers, however strong, only take
// energy out.
TEST_P(EveryProfile, EnergyDoesNotGrow) {
  const Profile profile = load_profile(GetParam());
  const StringVector pull_N = profile.max_tension_N();
  // Ten seconds without dampers; with usual and hard ones, which bring it to rest in less than one;
  // and in a grasp so stiff that steps of a millisecond would be unstable (ω = 5500 1/s).
  struct Grasp {
    double stiffness, damping;
    int ticks;
  };
  for (const Grasp& grasp : {Grasp{1, 0, 10'000}, {1, 1, 1000}, {1, 1e4, 1000}, {1e4, 0, 500}}) {
    SCOPED_TRACE("stiffness × " + std::to_string(grasp.stiffness) + ", damping × " +
                 std::to_string(grasp.damping));
    GripModel model;
    model.hand_stiffness_N_m *= grasp.stiffness;
    model.hand_stiffness_Nm_rad *= grasp.stiffness;
    GripDynamics::State state;
    state.tension_N = pull_N;
    const GripDynamics settling(profile.geometry, pull_N, model);
    for (int tick = 0; tick < 1000; ++tick) settling.advance(pull_N, {}, kTick_s, state);
    const double rest_J = energy_J(profile.geometry, model, pull_N, {}, state);

    model.hand_damping_N_s_m *= grasp.damping;
    model.hand_damping_Nm_s_rad *= grasp.damping;
    const GripDynamics dynamics(profile.geometry, pull_N, model);
    state.velocity_m_s = {0.5, -0.3, 0.2};
    state.angular_velocity_rad_s = {10, 20, -30};
    const double start_J = energy_J(profile.geometry, model, pull_N, {}, state) - rest_J;
    for (int tick = 0; tick < grasp.ticks; ++tick) {
      dynamics.advance(pull_N, {}, kTick_s, state);
      const double now_J = energy_J(profile.geometry, model, pull_N, {}, state) - rest_J;
      ASSERT_LT(now_J, 1.5 * start_J) << "tick " << tick;
    }
  }
}

// Where the grip comes to rest, the hand's springs hold what the strings pull: stretched by force
// over stiffness, twisted by torque over stiffness.
TEST_P(EveryProfile, RestingGripIsDisplacedByWrenchOverStiffness) {
  const Profile profile = load_profile(GetParam());
  const GripModel model;
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), model);
  // One string in two pulls a little more: out of balance, yet inside the frame.
  StringVector pull_N = profile.min_tension_N();
  for (int i = 0; i < kMaxStrings; i += 2) pull_N[i] += 0.02 * profile.max_tension_N()[i];
  Pose hand;
  hand.position_m = {0.001, -0.001, 0.0005};
  hand.orientation = turned(0.1, {1, 1, 0});
  GripDynamics::State state;
  for (int tick = 0; tick < 5000; ++tick) dynamics.advance(pull_N, hand, kTick_s, state);

  ASSERT_TRUE((state.pose.position_m.cwiseAbs().array() < dynamics.limit_m().array()).all())
      << "pulled against the frame";
  const Eigen::Matrix<double, 6, 1> wrench =
      structure_matrix(profile.geometry, state.pose) * pull_N;
  ASSERT_GT(wrench.norm(), 1e-3);
  const Eigen::Vector3d stretch_m = state.pose.position_m - hand.position_m;
  const Eigen::Vector3d twist_rad =
      rotation_vector(state.pose.orientation * hand.orientation.conjugate());
  // The slowest mode of the default hand decays with 40 1/s, so nothing is left of it; what remains
  // is the rounding of a pose of order 1 at each of a few thousand steps: 1e-13.
  EXPECT_LT((stretch_m - wrench.head<3>() / model.hand_stiffness_N_m).norm(), 1e-12);
  EXPECT_LT((twist_rad - wrench.tail<3>() / model.hand_stiffness_Nm_rad).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(All, EveryProfile, testing::ValuesIn(list_profiles()),
                         [](const testing::TestParamInfo<std::string>& row) {
                           std::string name = row.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace spidar::test::grip_model_test
