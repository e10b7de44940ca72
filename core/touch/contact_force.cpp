// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/contact_force.h"

#include <algorithm>
#include <cmath>

#include "core/require.h"

namespace spidar::touch {
namespace {

/// The texture's slope at the position of the grip, not of the proxy, which friction can hold back.
Eigen::Vector2d texture_slope(const HeightField& texture, double gain,
                              const Eigen::Vector3d& grip_m) noexcept {
  const Eigen::Vector2d slope = gain * texture.at(grip_m.x(), grip_m.y()).slope;
  const double steepness = slope.norm();
  if (steepness <= ContactForce::kMaxTextureSlope) return slope;
  return slope * (ContactForce::kMaxTextureSlope / steepness);
}

/// The drives have the lag that remains of the delay without its one and a half ticks. The force of
/// a velocity comes after the whole delay and the lag of the low-pass filter.
ForcePath path_of(const ContactSettings& settings) noexcept {
  ForcePath path;
  path.max_force_N = settings.max_force_N;
  path.max_slew_N_s = settings.max_slew_N_s;
  path.lag_s = std::max(0.0, settings.delay_s - 1.5 * path.tick_s);
  path.velocity_lag_s = settings.delay_s + 1 / (2 * M_PI * ContactForce::kVelocityCutoff_Hz);
  path.least_mass_kg = settings.least_mass_kg;
  return path;
}

}  // namespace

void validate(const ContactSettings& s) {
  require(s.stiffness_N_m > 0 && s.stiffness_N_m <= ContactSettings::kMaxStiffness_N_m, "Contact",
          "stiffness_N_m", "above 0 and at most 800", s.stiffness_N_m);
  require(std::isfinite(s.delay_s) && s.delay_s >= 0, "Contact", "delay_s", "finite and ≥ 0",
          s.delay_s);
  require(std::isfinite(s.damping) && s.damping >= 1, "Contact", "damping", "finite and ≥ 1",
          s.damping);
  require(std::isfinite(s.lateral_damping) && s.lateral_damping >= 0.5, "Contact",
          "lateral_damping", "finite and ≥ 0.5", s.lateral_damping);
  require(std::isfinite(s.friction) && s.friction >= 0, "Contact", "friction", "finite and ≥ 0",
          s.friction);
  require(std::isfinite(s.texture) && s.texture >= 0, "Contact", "texture", "finite and ≥ 0",
          s.texture);
  require(s.max_force_N > 0, "Contact", "max_force_N", "above 0", s.max_force_N);
  require(std::isfinite(s.max_slew_N_s) && s.max_slew_N_s > 0, "Contact", "max_slew_N_s",
          "finite and above 0", s.max_slew_N_s);
  require(s.beside_N.allFinite(), "Contact", "beside_N", "finite", s.beside_N.norm());
  require(std::isfinite(s.least_mass_kg) && s.least_mass_kg > 0, "Contact", "least_mass_kg",
          "finite and above 0", s.least_mass_kg);
}

void ContactForce::follow(const Eigen::Vector3d& grip_m, double dt_s) noexcept {
  // A tick gets the pose of the exchange that ended the last tick, so the time between the two
  // poses is the dt_s of the last tick.
  const double way_s = before_s_ > 0 ? before_s_ : dt_s;
  if (started_ && way_s > 0) {
    const double turns = 2 * M_PI * kVelocityCutoff_Hz * way_s;
    velocity_m_s_ += (1 - std::exp(-turns)) * ((grip_m - last_m_) / way_s - velocity_m_s_);
  }
  before_s_ = dt_s;
  last_m_ = grip_m;
  started_ = true;
}

Eigen::Vector3d ContactForce::tick(const MovingRelief& surface, const HeightField* texture,
                                   const ContactSettings& settings, const Eigen::Vector3d& grip_m,
                                   double dt_s) noexcept {
  if (!grip_m.allFinite()) {
    reset();
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d moved_m = started_ ? grip_m - last_m_ : Eigen::Vector3d(0, 0, 0);
  follow(grip_m, dt_s);
  proxy_.move(surface, settings.friction, grip_m, dt_s);
  Eigen::Vector3d force_N = wanted_N(texture, settings, grip_m);
  if (!(dt_s > 0)) return force_N;
  follow_energy(settings, moved_m, grip_m);
  const ForcePath path = path_of(settings);
  force_N *= budget_.allowed_fraction(force_N, path, dt_s);
  budget_.command(force_N, settings.beside_N, path, dt_s);
  return force_N;
}

/// Energy that a moving surface puts into the spring may be returned to the hand.
void ContactForce::follow_energy(const ContactSettings& settings, const Eigen::Vector3d& moved_m,
                                 const Eigen::Vector3d& grip_m) noexcept {
  if (!proxy_.touching()) {
    budget_.update(moved_m, velocity_m_s_, 0, 0);
    return;
  }
  // Above max_force_N the spring yields.
  const double length_m = (proxy_.position_m() - grip_m).norm();
  const double force_N = std::min(settings.stiffness_N_m * length_m, settings.max_force_N);
  const double stored_J = force_N * (length_m - 0.5 * force_N / settings.stiffness_N_m);
  double added_J = length_m > 0 ? 0.5 * force_N / length_m * proxy_.stretched_m2() : 0;
  // A receding surface takes energy out at the actual force, which may be below the spring force.
  if (added_J < 0) added_J *= std::min(1.0, budget_.force_N().norm() / force_N);
  budget_.update(moved_m, velocity_m_s_, added_J, stored_J);
}

/// The force before the energy bound is applied.
Eigen::Vector3d ContactForce::wanted_N(const HeightField* texture, const ContactSettings& settings,
                                       const Eigen::Vector3d& grip_m) const noexcept {
  if (!proxy_.touching()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d& normal = proxy_.normal();
  const Eigen::Vector3d spring_N = settings.stiffness_N_m * (proxy_.position_m() - grip_m);
  const double across_m_s = velocity_m_s_.dot(normal);
  const Eigen::Vector3d along_m_s = velocity_m_s_ - across_m_s * normal;
  const double damping_N_s_m = settings.damping_N_s_m();
  const double spring_across_N = spring_N.dot(normal);
  const double across_N = spring_across_N - damping_N_s_m * across_m_s;
  if (spring_across_N <= 0 || across_N <= 0) return Eigen::Vector3d::Zero();

  Eigen::Vector3d force_N = spring_N - damping_N_s_m * across_m_s * normal -
                            settings.lateral_damping * damping_N_s_m * along_m_s;
  if (texture != nullptr) {
    force_N.head<2>() -= std::min(spring_across_N, kMaxTexture_N) *
                         texture_slope(*texture, settings.texture, grip_m);
  }
  return force_N;
}

}  // namespace spidar::touch
