// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include <gst-spidar/device.h>

#include "core/grip/string_geometry.h"
#include "spidar/api/of_this_process.h"
#include "spidar/api/surface.h"
#include "spidar/api/vectors.h"
#include "spidar/loop/stiffness_limit.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "spidar/session/profile_choice.h"

namespace gst_spidar {
inline namespace v0 {
namespace {

using spidar::HapticSession;

constexpr const char* kOtherProcess =
    "the device was opened by the process that this one is a copy of (fork): open it in this one";

constexpr int64_t kHold_ns = std::chrono::nanoseconds(Device::kHold).count();
static_assert(kHold_ns <= spidar::WrenchTimeline::kLongestHold_ns, "longer than any frame is held");

spidar::Profile profile_for(const std::string& device, const std::string& profile) {
  for (const std::string& name : {device, profile}) {
    if (name.find('\0') != std::string::npos) {
      throw std::invalid_argument("a name has a NUL in it, behind \"" + std::string(name.c_str()) +
                                  "\"");
    }
  }
  if (device == "none") throw std::runtime_error("\"none\" cannot be opened");
  spidar::Profile found = spidar::profile_for(device, profile);
  // A simulated device has the drive lag of its own model.
  if (spidar::is_simulated(device)) found.drive_lag_known = true;
  return found;
}

/// The running time of this clock is CLOCK_MONOTONIC, so a wrench that is pushed is due at once.
spidar::PlaybackClock now_is_now() {
  spidar::PlaybackClock clock;
  clock.monotonic_ns = HapticSession::monotonic_now_ns();
  clock.running_ns = clock.monotonic_ns;
  clock.playing = true;
  return clock;
}

/// Whether this thread is in a callback of any device: two callbacks could wait for each other.
thread_local bool calls_back = false;

/// The haptic thread must not wait: waiting for the end of the callback, it would wait for itself.
void require_no_callback() {
  if (calls_back) {
    throw std::logic_error(
        "not within a callback, which must not wait; return the wrench from it, and do this in "
        "another thread");
  }
}

struct Driven {
  Driven(const std::string& device, const spidar::Profile& profile)
      : session(spidar::make_grip(device, profile)) {
    session.loop().set_playback_clock(now_is_now());
  }

  std::mutex calls;        // serialises the calls that change anything
  TouchedSurface surface;  // the loop must not outlive it
  HapticSession session;
  int64_t pushed_ns = 0;
};

struct DeviceRange {
  DeviceRange(const std::string& device, const spidar::Profile& profile, const spidar::Grip& grip) {
    const spidar::GripAbilities can = grip.abilities();
    const bool has_strings = grip.traits().has_strings;
    giver = has_strings ? profile.name : device;
    largest_force_N = std::floor(10 * can.max_limit_N()) / 10;
    if (has_strings) {
      const double most_Nm =
          std::min(spidar::largest_torque_Nm(profile), grip.traits().most_torque_Nm());
      largest_torque_Nm = std::floor(1000 * most_Nm) / 1000;
    }
    const Eigen::Vector3d half_m =
        spidar::half_workspace_m(spidar::with_workspace(profile.geometry, can.half_workspace_m));
    for (int axis = 0; axis < 3; ++axis) {
      if (can.position[static_cast<size_t>(axis)]) workspace_m[axis] = 2 * half_m[axis];
    }
    if (can.force[2]) surface.half_size_m = workspace_m.head<2>() / 2;
    surface.most_stiffness_N_m =
        has_strings ? spidar::most_stiffness_N_m(profile) : spidar::kUnmeasuredStiffness_N_m;
    surface.drive_lag_s = has_strings ? spidar::assumed_lag_s(profile) : spidar::kUnmeasuredLag_s;
  }

  /// Throws std::invalid_argument unless the device can keep the limit `wanted`.
  void require(double wanted, double most, const char* what, const char* unit) const {
    if (wanted >= 0 && wanted <= most) return;
    std::ostringstream text;
    text << what << " must be 0 to " << std::setprecision(4) << most << ' ' << unit << ", which "
         << giver << " can give in every direction without throwing a grip that is let go, got "
         << wanted;
    throw std::invalid_argument(text.str());
  }

  std::string giver;  ///< what sets the bounds: a profile, or the device
  double largest_force_N = 0;
  double largest_torque_Nm = spidar::kDefaultTorque_Nm;
  Eigen::Vector3d workspace_m = Eigen::Vector3d::Zero();
  SurfaceRange surface;
};

}  // namespace

// A nested class has the visibility of the enclosing class unless it states its own.
struct __attribute__((visibility("hidden"))) Device::Impl {
  Impl(const std::string& device, const spidar::Profile& profile)
      : driven(device, profile),
        name(driven.get()->session.grip().name()),
        abilities(driven.get()->session.grip().abilities()),
        range(device, profile, driven.get()->session.grip()) {}

  /// Throws std::logic_error within a callback, and std::runtime_error after fork() in the child.
  Locked<Driven> alone() const {
    require_no_callback();
    Driven* const mine = driven.get();
    if (!mine) throw std::runtime_error(kOtherProcess);
    return Locked(*mine);
  }
  /// Returns nothing after fork() in the child.
  std::optional<spidar::LoopSnapshot> snapshot() const {
    const Driven* const mine = driven.get();
    if (!mine) return std::nullopt;
    return mine->session.loop().snapshot();
  }

  const OfThisProcess<Driven> driven;
  const std::string name;
  const spidar::GripAbilities abilities;
  const DeviceRange range;
};

Device::Device(const std::string& name, const std::string& profile)
    : impl_(std::make_unique<Impl>(name, profile_for(name, profile))) {}

Device::~Device() = default;

Device::Device(Device&& other) noexcept = default;

Device& Device::operator=(Device&& other) noexcept {
  Device taken(std::move(other));
  std::swap(impl_, taken.impl_);
  return *this;
}

bool Device::push(const Wrench& wrench) {
  spidar::TimedWrench entry;
  entry.wrench = from_api(wrench);
  if (!entry.wrench.is_finite()) throw std::invalid_argument("a wrench must be six finite numbers");
  const auto alone = impl_->alone();
  // The clock may read the same in two calls, but the times of entries must rise.
  entry.time_ns = std::max(HapticSession::monotonic_now_ns(), alone->pushed_ns + 1);
  entry.hold_ns = kHold_ns;
  alone->pushed_ns = entry.time_ns;
  return state() != DeviceState::kLost && alone->session.loop().schedule(entry);
}

void Device::rest() {
  if (Driven* const mine = impl_->driven.get()) mine->session.loop().cancel_scheduled();
}

void Device::set_callback(Callback callback, Energy energy) {
  spidar::WrenchCallback::Function function;
  if (callback) {
    function = [callback = std::move(callback)](const spidar::CallbackInput& input) {
      struct Flag {
        Flag() { calls_back = true; }
        ~Flag() { calls_back = false; }
      } const flag;
      GripState state;
      state.pose = to_api(input.pose);
      state.velocity_m_s = to_api(input.velocity.linear_m_s);
      state.angular_velocity_rad_s = to_api(input.velocity.angular_rad_s);
      state.interval_s = input.dt_s;
      state.buttons = input.buttons;
      return from_api(callback(state));
    };
  }
  const auto alone = impl_->alone();
  alone->session.loop().callback().set(std::move(function), energy == Energy::kPassive,
                                       impl_->range.surface.drive_lag_s);
}

std::string Device::callback_error() const {
  // While a callback runs there is no error. The text of a callback that threw stays valid until
  // the next callback is set.
  Driven* const mine = impl_->driven.get();
  if (calls_back || !mine) return {};
  const std::lock_guard<std::mutex> alone(mine->calls);
  const spidar::WrenchCallback& callback = mine->session.loop().callback();
  switch (callback.state()) {
    case spidar::WrenchCallback::State::kThrew:
      return std::string("the callback has thrown an exception: ") + callback.thrown();
    case spidar::WrenchCallback::State::kTooSlow:
      return "the callback has taken longer than 0.5 ms twenty times in a row";
    case spidar::WrenchCallback::State::kNone:
    case spidar::WrenchCallback::State::kRuns:
      break;
  }
  return {};
}

void Device::set_limits(double max_force_N, double max_torque_Nm) {
  const DeviceRange& range = impl_->range;
  range.require(max_force_N, range.largest_force_N, "the largest force", "N");
  range.require(max_torque_Nm, range.largest_torque_Nm, "the largest torque", "N m");
  spidar::SafetyLimits limits;
  limits.max_force_N = max_force_N;
  limits.max_torque_Nm = max_torque_Nm;
  impl_->alone()->session.loop().set_limits(limits);
}

bool Device::set_surface(const Surface& surface) {
  const auto alone = impl_->alone();
  return alone->surface.set(surface, impl_->range.surface, alone->session.loop());
}

void Device::clear_surface() {
  if (Driven* const mine = impl_->driven.get()) mine->surface.clear();
}

std::optional<Pose> Device::pose() const {
  const auto snapshot = impl_->snapshot();
  if (!snapshot || snapshot->last.pose_fault != spidar::PoseFault::kNone) return std::nullopt;
  return to_api(snapshot->last.pose);
}

std::optional<Vector3> Device::velocity() const {
  const auto snapshot = impl_->snapshot();
  if (!snapshot || snapshot->last.pose_fault != spidar::PoseFault::kNone) return std::nullopt;
  const Eigen::Vector3d& velocity_m_s = snapshot->last.velocity.linear_m_s;
  return Vector3{velocity_m_s.x(), velocity_m_s.y(), velocity_m_s.z()};
}

std::uint32_t Device::buttons() const {
  const auto snapshot = impl_->snapshot();
  const bool known = snapshot && snapshot->last.device != spidar::DeviceState::kLost;
  return known ? snapshot->last.buttons : 0;
}

bool Device::held() const {
  const auto snapshot = impl_->snapshot();
  return snapshot && snapshot->last.held;
}

double Device::vibration_fraction() const {
  const auto snapshot = impl_->snapshot();
  return snapshot ? snapshot->vibration.fraction : 1;
}

Wrench Device::felt() const {
  const auto snapshot = impl_->snapshot();
  // The strings already pull while the tensions ramp up, and they still pull while they ramp down.
  if (!snapshot || snapshot->last.device == spidar::DeviceState::kLost) return {};
  return to_api(snapshot->last.delivered);
}

DeviceState Device::state() const {
  const auto snapshot = impl_->snapshot();
  if (!snapshot) return DeviceState::kLost;
  switch (snapshot->last.device) {
    case spidar::DeviceState::kLost:
      return DeviceState::kLost;
    case spidar::DeviceState::kIdle:
      return DeviceState::kIdle;
    case spidar::DeviceState::kRunning:
      return DeviceState::kRunning;
    case spidar::DeviceState::kOpening:
    case spidar::DeviceState::kClosed:   // before the first tick
    case spidar::DeviceState::kClosing:  // not while this object lives
      break;
  }
  return DeviceState::kOpening;
}

bool Device::wait_until_running(std::chrono::milliseconds timeout) const {
  require_no_callback();
  // A longer time would overflow the clock.
  constexpr std::chrono::milliseconds kYears = std::chrono::hours(24 * 365 * 100);
  const auto until = std::chrono::steady_clock::now() + std::min(timeout, kYears);
  while (state() != DeviceState::kRunning || !pose()) {
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

std::string Device::last_fault() const {
  const Driven* const mine = impl_->driven.get();
  if (!mine) return kOtherProcess;
  const spidar::LinkFault fault = mine->session.grip().health().last_fault;
  const std::string refusal = mine->session.loop().refusal();
  return (fault == spidar::LinkFault::kNone ? "" : to_string(fault)) +
         (refusal.empty() ? "" : "; " + refusal);
}

std::string Device::warning() const {
  const Driven* const mine = impl_->driven.get();
  if (!mine) return {};
  const std::string error = mine->session.vibration_error();
  return error.empty() ? mine->session.grip().warning() : error;
}

Capabilities Device::capabilities() const {
  const spidar::GripAbilities& abilities = impl_->abilities;
  Capabilities found;
  found.force_x = abilities.force[0];
  found.force_y = abilities.force[1];
  found.force_z = abilities.force[2];
  found.torque = abilities.torque;
  found.direction = abilities.direction;
  const DeviceRange& range = impl_->range;
  found.largest_force_N = range.largest_force_N;
  found.largest_torque_Nm = range.largest_torque_Nm;
  found.largest_stiffness_N_m = range.surface.most_stiffness_N_m;
  found.rate_Hz = abilities.rate_Hz;
  found.workspace_m = to_api(range.workspace_m);
  found.buttons = abilities.buttons;
  return found;
}

const std::string& Device::name() const {
  return impl_->name;
}

std::vector<std::string> list_devices() {
  std::vector<std::string> names;
  for (const spidar::DeviceInfo& board : spidar::list_boards()) names.push_back(board.device);
  return names;
}

std::vector<std::string> list_profiles() {
  return spidar::list_profiles();
}

}  // namespace v0
}  // namespace gst_spidar
