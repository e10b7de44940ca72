// The simulated grip against closed solutions, and its stability on every profile.

#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "spidar/grip_model.h"
#include "spidar/profile.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 1e-3;

Eigen::Quaterniond turned(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}

/// Kinetic energy, the hand's springs, and strings of constant tension.
double energy_J(const StringGeometry& geometry, const GripModel& model,
                const StringVector& target_N, const Pose& hand, const GripState& state) {
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

TEST(GripModel, TensionsFollowWithTheTimeConstant) {
  const Profile profile = load_profile(kDefaultProfile);
  GripModel model;
  model.motor_time_constant_s = 0.004;
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), model);
  GripState state;
  StringVector target_N = StringVector::Zero();
  target_N[3] = 2.0;
  for (int tick = 1; tick <= 20; ++tick) {
    dynamics.advance(target_N, {}, kTick_s, state);
    // The lag is solved exactly: only rounding, a few 1e-16 a substep.
    EXPECT_NEAR(state.tension_N[3], 2.0 * (1 - std::exp(-tick * kTick_s / 0.004)), 1e-13) << tick;
    EXPECT_EQ(state.tension_N[2], 0) << tick;
  }
}

TEST(GripModel, MotorsWithoutLagAreThereAtOnce) {
  const Profile profile = load_profile(kDefaultProfile);
  GripModel model;
  model.motor_time_constant_s = 0;
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), model);
  GripState state;
  const StringVector target_N = StringVector::Constant(1.5);
  dynamics.advance(target_N, {}, kTick_s, state);
  EXPECT_EQ(state.tension_N, target_N);
}

// Slack strings leave a damped oscillator: x(t) = x0 e^(−δt)(cos ωt + δ/ω sin ωt), δ = b/2m,
// ω² = k/m − δ². The method is of first order: within h·v_max of it, and ten times nearer with
// steps ten times shorter.
TEST(GripModel, SlackGripSwingsAsADampedOscillator) {
  const Profile profile = load_profile(kDefaultProfile);
  const GripModel model;
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), model);
  const double x0_m = 0.01;
  const double decay = model.hand_damping_N_s_m / (2 * model.mass_kg);
  const double omega = std::sqrt(model.hand_stiffness_N_m / model.mass_kg - decay * decay);

  const auto largest_error_m = [&](double step_s) {
    GripState state;
    state.pose.position_m.x() = x0_m;
    double largest = 0;
    const int steps = static_cast<int>(std::lround(0.3 / step_s));
    for (int i = 1; i <= steps; ++i) {
      dynamics.advance(StringVector::Zero(), {}, step_s, state);
      const double t = i * step_s;
      const double exact =
          x0_m * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
      largest = std::max(largest, std::abs(state.pose.position_m.x() - exact));
    }
    return largest;
  };
  const double coarse = largest_error_m(1e-4);
  const double fine = largest_error_m(1e-5);
  EXPECT_LT(coarse, 1e-4 * x0_m * std::sqrt(model.hand_stiffness_N_m / model.mass_kg));
  EXPECT_NEAR(coarse / fine, 10, 1) << "not of first order";
}

TEST(GripModel, GripStopsAtTheFrame) {
  const Profile profile = load_profile(kDefaultProfile);
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), {});
  EXPECT_TRUE(dynamics.limit_m().isApprox(Eigen::Vector3d(0.059, 0.064, 0.059), 1e-12));
  GripState state;
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
  const auto error_of = [&](const GripModel& model) -> std::string {
    try {
      GripDynamics(profile.geometry, profile.max_tension_N(), model);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  GripModel model;
  model.mass_kg = 0;
  EXPECT_NE(error_of(model).find("mass_kg"), std::string::npos);
  model = {};
  model.inertia_kg_m2 = std::nan("");
  EXPECT_NE(error_of(model).find("inertia_kg_m2"), std::string::npos);
  model = {};
  model.hand_damping_N_s_m = -1;
  EXPECT_NE(error_of(model).find("hand_damping_N_s_m"), std::string::npos);
  model = {};
  model.hand_stiffness_N_m = 1e12;
  EXPECT_NE(error_of(model).find("too stiff"), std::string::npos);
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
  GripState rest;
  rest.tension_N = pull_N;
  const GripDynamics settling(profile.geometry, pull_N, {});
  for (int tick = 0; tick < 2000; ++tick) settling.advance(pull_N, {}, kTick_s, rest);
  const double rest_J = energy_J(profile.geometry, {}, pull_N, {}, rest);

  for (const double damping : {0.0, 1.0, 1e4}) {
    GripModel model;
    model.hand_damping_N_s_m *= damping;
    model.hand_damping_Nm_s_rad *= damping;
    const GripDynamics dynamics(profile.geometry, pull_N, model);
    GripState state = rest;
    state.velocity_m_s = {0.5, -0.3, 0.2};
    state.angular_velocity_rad_s = {10, 20, -30};
    const double start_J = energy_J(profile.geometry, model, pull_N, {}, state) - rest_J;
    for (int tick = 0; tick < 10'000; ++tick) {
      dynamics.advance(pull_N, {}, kTick_s, state);
      const double now_J = energy_J(profile.geometry, model, pull_N, {}, state) - rest_J;
      ASSERT_LT(now_J, 1.5 * start_J) << "tick " << tick << ", damping times " << damping;
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
  GripState state;
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
