// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/device/haptic_output.h"

#include <algorithm>
#include <utility>

#include "core/grip/picture_size.h"
#include "plugin/device/session_stats.h"
#include "plugin/gobject/category.h"
#include "spidar/grip/string_grip.h"
#include "spidar/profiles/force_range.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/simulation/simulated_device.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar {
namespace {

/// More than a window that draws seldom takes from one picture to the next.
constexpr int64_t kLongestLook_ns = 500'000'000;

int64_t monotonic_now(void*) {
  return HapticSession::monotonic_now_ns();
}

/// `simulated`: the device "sim", otherwise null. If a test makes the ticks, only these move its
/// grip, so that the speed of the test does not matter.
std::unique_ptr<Grip> grip_for(const std::string& spec, const Profile& profile, bool threaded,
                               SimulatedDevice*& simulated) {
  simulated = nullptr;
  if (spec != "sim") return make_grip(spec, profile);
  std::unique_ptr<Device> device;
  if (threaded)
    device = make_device(spec, profile);
  else
    device = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
  simulated = dynamic_cast<SimulatedDevice*>(device.get());
  return std::make_unique<StringGrip>(profile, std::move(device));
}

}  // namespace

void HapticOutput::set_manual(PlaybackSync::Now now, void* user) {
  now_ = now;
  now_user_ = user;
}

std::string HapticOutput::open(const std::string& device, const std::string& profile_name,
                               const std::string& haptic_trace) {
  Profile profile;
  try {
    profile = profile_for(device, profile_name);
  } catch (const NoProfile& refusal) {
    GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS, ("%s", refusal.what()),
                        ("The video continues without force."));
    return {};
  }
  if (is_simulated(device)) profile.drive_lag_known = true;
  SessionSettings settings;
  settings.trace_path = haptic_trace;
  settings.threaded = now_ == nullptr;
  SimulatedDevice* simulated = nullptr;
  const auto make_session = [&] {
    return std::make_unique<HapticSession>(grip_for(device, profile, settings.threaded, simulated),
                                           settings);
  };
  std::string trace_problem;
  std::unique_ptr<HapticSession> session;
  try {
    session = make_session();
  } catch (const TraceError& error) {
    trace_problem = error.what();
    settings.trace_path.clear();
    session = make_session();
  }
  HapticLoop& loop = session->loop();
  auto follower = std::make_unique<PlaybackFollower>(
      element_,
      [this, &loop](const PlaybackClock& clock) {
        loop.set_playback_clock(clock);
        refreshed_();
      },
      now_ ? now_ : monotonic_now, now_user_, settings.threaded);
  double max_force_N = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Grip& grip = session->grip();
    most_force_N_ = std::max(kAnyForce_N, grip.abilities().largest_force_N);
    most_force_of_ = grip.traits().has_strings ? profile.name : device;
    said_too_much_ = false;
    max_force_N = limits_.max_force_N;
    follower->set_latency(latency_);
    follower->set_offset(offset_ns_);
    profile_ = profile;
    profile_.geometry = with_room(profile.geometry, grip.abilities().half_room_m);
    session_ = std::move(session);
    simulated_ = simulated;
    follower_ = std::move(follower);
  }
  set_max_force(max_force_N);
  return trace_problem;
}

void HapticOutput::close() {
  std::unique_ptr<HapticSession> session;
  std::unique_ptr<PlaybackFollower> follower;  // destroyed before the loop to which it publishes
  // Both are destroyed after the lock is released, because the ramp to rest takes 60 ms.
  const std::lock_guard<std::mutex> lock(mutex_);
  session = std::move(session_);
  simulated_ = nullptr;
  follower = std::move(follower_);
}

void HapticOutput::set_playing(bool playing) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (follower_) follower_->set_playing(playing);
}

void HapticOutput::set_latency(GstClockTime latency) {
  const std::lock_guard<std::mutex> lock(mutex_);
  latency_ = latency;
  if (follower_) follower_->set_latency(latency);
}

void HapticOutput::set_offset(GstClockTimeDiff offset_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  offset_ns_ = offset_ns;
  if (follower_) follower_->set_offset(offset_ns);
}

void HapticOutput::set_max_force(double max_force_N) {
  std::string too_much_for;
  double most_N = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    limits_.max_force_N = max_force_N;
    if (!session_) return;
    SafetyLimits limits = limits_;
    limits.max_force_N = std::min(max_force_N, most_force_N_);
    session_->loop().set_limits(limits);
    if (!(max_force_N > most_force_N_) || said_too_much_) return;
    said_too_much_ = true;
    too_much_for = most_force_of_;
    most_N = most_force_N_;
  }
  GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                      ("max-force=%g is more than the %.1f N that %s can give in every direction: "
                       "the force is limited to these.",
                       max_force_N, most_N, too_much_for.c_str()),
                      ("Set max-force to %.1f at most.", most_N));
}

void HapticOutput::set_skipped(int64_t skipped_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (follower_) follower_->set_skipped(skipped_ns);
}

void HapticOutput::look_for_sink() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (follower_) follower_->look_for_sink();
}

void HapticOutput::expect_base_time() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (follower_) follower_->expect_base_time();
}

void HapticOutput::refresh_clock() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (follower_) follower_->refresh();
}

std::optional<LoopSnapshot> HapticOutput::snapshot() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!session_) return std::nullopt;
  return session_->loop().snapshot();
}

bool HapticOutput::look_at_device(DeviceView& view) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!session_) return false;
  view.name = session_->grip().name();
  view.has_hand = simulated_ != nullptr;
  view.has_strings = session_->grip().traits().has_strings;
  const LoopSnapshot loop = session_->loop().snapshot();
  view.last = loop.last;
  view.overruns = loop.counters.overruns;
  view.ticks.clear();
  // Where nobody looked for long, the oldest ticks are there and the newest are not.
  const int64_t oldest_ns = view.last.monotonic_ns - kLongestLook_ns;
  ForceTick tick;
  while (session_->loop().pop_force(tick)) {
    if (tick.monotonic_ns >= oldest_ns) view.ticks.push_back(tick);
  }
  view.geometry = profile_.geometry;
  view.min_tension_N = profile_.min_tension_N();
  view.max_tension_N = profile_.max_tension_N();
  return true;
}

bool HapticOutput::lead_hand(const std::optional<Eigen::Vector3d>& to_m) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!simulated_) return false;
  simulated_->lead_hand(to_m);
  return true;
}

void HapticOutput::describe(GstStructure* structure) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (session_) describe_session(*session_, structure);
}

}  // namespace spidar
