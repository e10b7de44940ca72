// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/sim/simulated_device.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/seqlock.h"
#include "spidar/realtime/spsc_ring.h"

namespace spidar {
namespace {

constexpr int64_t kStep_ns = 1'000'000;
constexpr int64_t kMaxElapsed_ns = 50'000'000;  // limits the step after the process was suspended

/// Steady-state tension of the motor of `drive`, after the range and the steps of the D/A converter
/// and the limit of the motor.
double settled_tension_N(double volt, const StringDrive& drive, const Profile& profile) noexcept {
  const double pulling_V = volt * drive.motor_sign;
  if (!(pulling_V > 0) || !std::isfinite(pulling_V)) return 0;
  const double step_V = profile.dac_max_V / static_cast<double>((1 << profile.dac_bits) - 1);
  const double put_out_V = step_V * std::round(std::min(pulling_V, profile.dac_max_V) / step_V);
  return std::min(put_out_V * drive.newtons_per_volt, drive.max_tension_N);
}

}  // namespace

struct SimulatedDevice::Impl {
  Impl(const Profile& of, Time how, const GripModel& model, std::function<int64_t()> to_read)
      : profile(of),
        time(how),
        clock(to_read ? std::move(to_read) : std::function<int64_t()>(monotonic_now_ns)),
        model_lag_s(model.motor_time_constant_s),
        delay_ns(std::llround(1e9 * model.motor_delay_s)),
        dynamics(of.geometry, of.max_tension_N(), model),
        zero_length_m(of.zero_count_length_m()) {}

  void set_volts(const MotorVolts& volts) noexcept {
    StringVector target_N = StringVector::Zero();
    for (int i = 0; i < profile.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      target_N[i] = settled_tension_N(volts.volt[k], profile.drives[k], profile);
    }
    delayed.push(time_ns, delay_ns, target_N);
  }

  void advance(int64_t elapsed_ns) noexcept {
    hand_shared.try_load(hand);
    lead_shared.try_load(lead_to_m);
    const int64_t end_ns = time_ns + elapsed_ns;
    while (time_ns < end_ns) {
      const StringVector acting_N = delayed.at(time_ns);
      const int64_t step_ns = std::min(end_ns, delayed.next_ns()) - time_ns;
      const double step_s = 1e-9 * static_cast<double>(step_ns);
      dynamics.advance(acting_N, guided_hand.advance(hand, lead_to_m, step_s), step_s, state);
      time_ns += step_ns;
    }
  }

  int64_t elapsed_ns() noexcept {
    if (time == Time::kFixedStep) return kStep_ns;
    const int64_t now_ns = clock();
    const int64_t passed_ns = now_ns - last_ns;
    last_ns = now_ns;
    return std::clamp<int64_t>(passed_ns, 0, kMaxElapsed_ns);
  }

  void read_counters(DeviceReading& reading) const noexcept {
    const StringVector length_m = string_lengths_m(profile.geometry, state.pose);
    reading = {};
    for (int i = 0; i < profile.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      const StringDrive& drive = profile.drives[k];
      const double counts = (length_m[i] - zero_length_m[i]) / drive.metres_per_count;
      reading.count[k] = drive.encoder_sign * static_cast<int32_t>(std::lround(counts)) +
                         count_error[k].load(std::memory_order_relaxed);
    }
  }

  void publish() noexcept {
    const FeltState now{time_ns,    state.tension_N,    dynamics.string_wrench(state),
                        state.pose, state.velocity_m_s, state.angular_velocity_rad_s};
    felt.store(now);
    history.push(now);
  }

  void release() noexcept {
    if (!open) return;
    open = false;
    // A loss of power discards pending commands.
    delayed.clear();
    // After ten time constants less than 5e-5 of any tension is left.
    const auto steps = static_cast<int64_t>(std::ceil(10 * model_lag_s * 1e9 / kStep_ns));
    for (int64_t i = 0; i < std::min(steps, kMaxElapsed_ns / kStep_ns); ++i) {
      advance(kStep_ns);
      publish();
    }
    state.tension_N.setZero();
    publish();
  }

  const Profile profile;
  const Time time;
  const std::function<int64_t()> clock;
  const double model_lag_s;
  const int64_t delay_ns;
  const GripDynamics dynamics;
  const StringVector zero_length_m;
  // Only the thread that calls exchange() uses these members.
  bool open = false;
  int64_t time_ns = 0;
  int64_t last_ns = 0;
  Pose hand;
  std::optional<Eigen::Vector3d> lead_to_m;
  GuidedHand guided_hand;
  GripDynamics::State state;
  DelayedTensions delayed;
  // All threads share these members.
  std::mutex hand_writers;
  Seqlock<Pose> hand_shared;
  Seqlock<std::optional<Eigen::Vector3d>> lead_shared;
  std::atomic<LinkFault> fault{LinkFault::kNone};
  std::array<std::atomic<int32_t>, kMaxStrings> count_error{};
  Seqlock<FeltState> felt;
  SpscRing<FeltState, 4096> history;
};

GripModel grip_model_of(const Profile& profile) {
  GripModel model;
  model.motor_time_constant_s = profile.drive_lag_s;
  if (const Eigen::Vector3d& moments = profile.moment_of_inertia_kg_m2; !moments.isZero(0)) {
    model.inertia_kg_m2 = moments.mean();
  }
  return model;
}

SimulatedDevice::SimulatedDevice(const Profile& profile, Time time, const GripModel& model,
                                 std::function<int64_t()> clock)
    : StringDevice("sim"), impl_(std::make_unique<Impl>(profile, time, model, std::move(clock))) {}

SimulatedDevice::~SimulatedDevice() = default;

void SimulatedDevice::open() {
  const LinkFault fault = impl_->fault.load();
  if (fault != LinkFault::kNone) {
    throw DeviceError("sim: cannot be opened: a fault is simulated; end it with set_fault(kNone)");
  }
  impl_->time_ns = 0;
  impl_->last_ns = impl_->clock();
  impl_->state = {};
  impl_->guided_hand = {};
  impl_->delayed.clear();
  impl_->open = true;
  impl_->publish();
}

LinkFault SimulatedDevice::exchange(const MotorVolts& volts, DeviceReading& reading) noexcept {
  if (!impl_->open) return LinkFault::kGone;
  const LinkFault fault = impl_->fault.load(std::memory_order_relaxed);
  if (is_lost(fault)) {
    impl_->release();
    return fault;
  }
  impl_->advance(impl_->elapsed_ns());
  if (fault != LinkFault::kTimeout) impl_->set_volts(volts);
  impl_->publish();
  if (fault == LinkFault::kNone) {
    impl_->read_counters(reading);
    if (impl_->time == Time::kClock) reading.read_ns = impl_->last_ns;
  }
  return fault;
}

void SimulatedDevice::close() noexcept {
  impl_->release();
}

void SimulatedDevice::set_hand(const Pose& pose) noexcept {
  const double norm = pose.orientation.norm();
  if (!pose.position_m.allFinite() || !std::isfinite(norm) || !(norm > 0)) return;
  const std::lock_guard<std::mutex> lock(impl_->hand_writers);
  impl_->hand_shared.store({pose.position_m, pose.orientation.normalized()});
}

void SimulatedDevice::lead_hand(const std::optional<Eigen::Vector3d>& to_m) noexcept {
  if (to_m && !to_m->allFinite()) return;
  const Eigen::Vector3d& limit_m = impl_->dynamics.limit_m();
  std::optional<Eigen::Vector3d> within_m;
  if (to_m) within_m = to_m->cwiseMax(-limit_m).cwiseMin(limit_m);
  const std::lock_guard<std::mutex> lock(impl_->hand_writers);
  impl_->lead_shared.store(within_m);
}

void SimulatedDevice::set_fault(LinkFault fault) noexcept {
  impl_->fault.store(fault);
}

void SimulatedDevice::set_count_error(int string, int32_t counts) {
  const int strings = impl_->profile.geometry.count;
  if (string < 0 || string >= strings) {
    throw std::out_of_range("sim: there is no string " + std::to_string(string) +
                            "; known are 0 to " + std::to_string(strings - 1));
  }
  impl_->count_error[static_cast<size_t>(string)] = counts;
}

FeltState SimulatedDevice::felt() const noexcept {
  return impl_->felt.load();
}

bool SimulatedDevice::pop_felt(FeltState& felt) noexcept {
  return impl_->history.pop(felt);
}

}  // namespace spidar
