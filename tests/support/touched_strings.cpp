// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/touched_strings.h"

#include <cmath>
#include <memory>
#include <string>

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"

namespace spidar::test {
namespace {

constexpr double kTick_s = 1e-9 * static_cast<double>(kTick_ns);
constexpr int64_t kFrame_ns = 33 * kTick_ns;

/// Scales the rotational stiffness and damping of the hand like the translational ones.
GripModel model_of(const Hand& hand, const StringTouch& touch) {
  GripModel model;
  model.motor_time_constant_s += touch.more_lag_s;
  model.inertia_kg_m2 *= touch.mass_kg / model.mass_kg;
  model.mass_kg = touch.mass_kg;
  model.hand_stiffness_Nm_rad *= hand.stiffness_N_m / model.hand_stiffness_N_m;
  model.hand_damping_Nm_s_rad *= hand.damping_N_s_m / model.hand_damping_N_s_m;
  model.hand_stiffness_N_m = hand.stiffness_N_m;
  model.hand_damping_N_s_m = hand.damping_N_s_m;
  return model;
}

/// The simulated device; records its encoder readings.
class ReadDevice final : public StringDevice {
 public:
  explicit ReadDevice(SimulatedDevice& device) : StringDevice(device.name()), device_(device) {}
  void open() override { device_.open(); }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    const LinkFault status = device_.exchange(volts, reading);
    last_ = reading;
    return status;
  }
  void close() noexcept override { device_.close(); }
  const DeviceReading& last() const { return last_; }

 private:
  SimulatedDevice& device_;
  DeviceReading last_;
};

/// Simulates only the drives; the encoder readings come from the device of another loop.
class ShadowDevice final : public StringDevice {
 public:
  ShadowDevice(const Profile& profile, const ReadDevice& of, double lag_s)
      : StringDevice("shadow"), profile_(profile), of_(of), kept_(std::exp(-kTick_s / lag_s)) {}
  void open() override {}
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    tension_N_ = target_N_ + kept_ * (tension_N_ - target_N_);
    const double step_V = profile_.dac_max_V / static_cast<double>((1 << profile_.dac_bits) - 1);
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      const StringDrive& drive = profile_.drives[k];
      const double pulling_V = std::fmax(0.0, volts.volt[k] * drive.motor_sign);
      target_N_[i] = std::fmin(step_V * std::round(pulling_V / step_V) * drive.newtons_per_volt,
                               drive.max_tension_N);
    }
    reading = of_.last();
    return LinkFault::kNone;
  }
  void close() noexcept override {}
  const StringVector& tension_N() const { return tension_N_; }

 private:
  const Profile& profile_;
  const ReadDevice& of_;
  const double kept_;
  StringVector target_N_ = StringVector::Zero();
  StringVector tension_N_ = StringVector::Zero();
};

struct Strings {
  StringVector length_m;
  StringVector speed_m_s;  // rate of lengthening
  StringVector added_N;    // tension added by the contact
};

/// Work of the added tensions on the grip in a tick, by Simpson's rule. The tensions approach their
/// commanded values exponentially; the lengths follow a cubic with the given end values and slopes.
double work_J(const Strings& from, const Strings& to, double lag_s) {
  const double left = std::exp(-kTick_s / lag_s);
  const double half_left = std::exp(-0.5 * kTick_s / lag_s);
  const StringVector target_N = (to.added_N - left * from.added_N) / (1 - left);
  const StringVector middle_N = target_N + half_left * (from.added_N - target_N);
  const StringVector middle_m_s =
      1.5 / kTick_s * (to.length_m - from.length_m) - 0.25 * (from.speed_m_s + to.speed_m_s);
  return -kTick_s / 6 *
         (from.added_N.dot(from.speed_m_s) + 4 * middle_N.dot(middle_m_s) +
          to.added_N.dot(to.speed_m_s));
}

Wrench film_wrench(double amplitude_N, double time_s) {
  const double turn = 2 * M_PI * time_s;
  return {
      amplitude_N / std::sqrt(3.0) *
          Eigen::Vector3d(std::sin(0.7 * turn), std::sin(1.1 * turn + 1), std::sin(0.9 * turn + 2)),
      Eigen::Vector3d::Zero()};
}

void publish(touch::Mailbox& mailbox, const TouchScene& scene, const StringTouch& touch) {
  touch::Surface& frame = *mailbox.begin(mailbox.generation());
  frame.has_surface = true;
  frame.has_texture = touch.texture;
  frame.contact = touch.contact;
  frame.relief = scene.relief;
  frame.texture = scene.texture;
  mailbox.publish();
}

WrenchCallback::Function wall_of(const StringTouch& touch) {
  return [stiffness_N_m = touch.wall_N_m](const CallbackInput& input) {
    Wrench wrench;
    wrench.force_N.z() = stiffness_N_m * std::fmax(0.0, -input.pose.position_m.z());
    return wrench;
  };
}

/// A loop with contact and its reference loop without contact.
class Pair {
 public:
  Pair(const TouchScene& scene, const StringTouch& touch, const Hand& hand)
      : model_(model_of(hand, touch)),
        film_N_(touch.film_N),
        mailbox_(kPictureWidth_m, kPictureHeight_m, touch::Mailbox::kMinSlots) {
    if (touch.wall_N_m > 0) {
      loop_->callback().set(wall_of(touch), touch.passive, profile_.drive_lag_s);
    } else {
      publish(mailbox_, scene, touch);
      loop_->connect_touch(&mailbox_);
    }
    for (HapticLoop* loop : {loop_.get(), untouched_.get()}) {
      loop->open();
      loop->set_playback_clock({kStart_ns, 0, 1.0, true});
    }
  }

  void tick(const Eigen::Vector3d& hand_m) {
    if (film_N_ > 0 && now_ns_ % kFrame_ns == kStart_ns % kFrame_ns) {
      const int64_t shown_ns = now_ns_ - kStart_ns + 2 * kFrame_ns;
      const Wrench wrench = film_wrench(film_N_, 1e-9 * static_cast<double>(shown_ns));
      loop_->schedule({shown_ns, 2 * kFrame_ns, wrench});
      untouched_->schedule({shown_ns, 2 * kFrame_ns, wrench});
    }
    Pose pose;
    pose.position_m = hand_m;
    device_.set_hand(pose);
    now_ns_ += kTick_ns;
    loop_->tick(now_ns_, now_ns_);
    untouched_->tick(now_ns_, now_ns_);
    const Strings now = strings();
    given_J_ -= work_J(strings_, now, model_.motor_time_constant_s);
    strings_ = now;
  }

  double stiffness_fraction() const { return loop_->snapshot().last.contact.stiffness_fraction; }
  /// Whether the grip counts as released in one of the loops, where the film's force then rests,
  /// too.
  bool apart() const { return loop_->snapshot().last.held != untouched_->snapshot().last.held; }
  bool touching() const {
    const TickRecord last = loop_->snapshot().last;
    return last.called_back ? last.pose.position_m.z() < 0 : last.contact.touching;
  }
  /// The work of the grip against the added tensions.
  double given_J() const { return given_J_; }

 private:
  static constexpr int64_t kStart_ns = 1'000'000'000'000;

  Strings strings() const {
    const FeltState felt = device_.felt();
    Eigen::Matrix<double, 6, 1> twist;
    twist << felt.velocity_m_s, felt.angular_velocity_rad_s;
    const StringGeometry& geometry = profile_.geometry;
    return {string_lengths_m(geometry, felt.pose),
            -structure_matrix(geometry, felt.pose).transpose() * twist,
            felt.tension_N - shadow_.tension_N()};
  }

  const GripModel model_;
  const double film_N_;
  const Profile profile_ = load_profile(kDefaultProfile);
  touch::Mailbox mailbox_;
  SimulatedDevice device_{profile_, SimulatedDevice::Time::kFixedStep, model_};
  ReadDevice read_{device_};
  ShadowDevice shadow_{profile_, read_, model_.motor_time_constant_s};
  std::unique_ptr<HapticLoop> loop_ =
      std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile_, read_));
  std::unique_ptr<HapticLoop> untouched_ =
      std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile_, shadow_));
  int64_t now_ns_ = kStart_ns;
  Strings strings_{string_lengths_m(profile_.geometry, {}), StringVector::Zero(),
                   StringVector::Zero()};
  double given_J_ = 0;
};

}  // namespace

ContactEnergy touch_through_strings(const TouchScene& scene, const StringTouch& touch,
                                    const Hand& hand, long ticks, const HandPath& path_m) {
  constexpr int kFaded = 20;       // in ticks: ten times the drive's lag
  constexpr long kArrived = 1000;  // in ticks: the strings are taut and the hand has arrived
  Pair pair(scene, touch, hand);
  ContactEnergy result;
  bool in_contact = false, apart = false;
  int ticks_away = 0;
  double begin_J = 0;
  for (long tick = 0; tick < ticks; ++tick) {
    const double before_J = pair.given_J();
    pair.tick(path_m(kTick_s * static_cast<double>(tick)));
    apart |= pair.apart();
    if (pair.touching()) {
      result.stiffness_fraction = pair.stiffness_fraction();
      if (!in_contact) begin_J = before_J;
      in_contact = true;
      ticks_away = 0;
    } else if (in_contact && ++ticks_away == kFaded) {
      in_contact = false;
      if (tick > kArrived && !apart) result.add(begin_J - pair.given_J());
      apart = false;
    }
  }
  return result;
}

ContactEnergy explore_through_strings(const TouchScene& scene, const StringTouch& touch,
                                      const Hand& hand, long ticks, unsigned seed) {
  const RandomHand random(seed);
  return touch_through_strings(scene, touch, hand, ticks,
                               [&](double time_s) { return random.at_m(time_s); });
}

}  // namespace spidar::test
