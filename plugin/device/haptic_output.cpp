// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/device/haptic_output.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/grip/string_geometry.h"
#include "plugin/device/card_reservation.h"
#include "plugin/gobject/category.h"
#include "spidar/devices/device_registry.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/devices/sound/sound_cards.h"
#include "spidar/loop/string_grip.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar {
namespace fs = std::filesystem;
namespace {

int64_t not_negative(int64_t ns) {
  return std::max<int64_t>(ns, 0);
}

void session_fields(const HapticSession& session, FieldSink& to) {
  const HapticLoop& loop = session.loop();
  const LoopSnapshot snapshot = loop.snapshot();
  const LoopCounters& counters = snapshot.counters;
  const TickRecord& last = snapshot.last;
  const Scheduling& scheduling = session.scheduling();
  to("device", "", session.grip().name().c_str(), "name of the device");
  to("device-state", "", to_string(last.device),
     "`closed`, `opening`, `running`, `closing`, `idle` (motors off) or `lost`");
  to("real-time", "", scheduling.real_time, "the haptic loop has real-time priority");
  to("scheduling", "", scheduling.detail.c_str(),
     "its scheduling, or why it has no real-time priority");
  to("ticks", "", counters.ticks, "ticks of the haptic loop since it was opened");
  to("overruns", "", counters.overruns, "ticks that began more than a period late");
  to("missed-ticks", "", counters.missed_deadlines, "ticks that were left out because of that");
  to("gap-ticks", "", counters.gap_ticks,
     "ticks without a force while playing, because the next frame or sample came too late");
  to("exchange-errors", "", counters.exchange_errors, "exchanges with the device that failed");
  to("pose-errors", "", counters.pose_errors, "readings that gave no pose");
  to("times-lost", "", counters.times_lost, "how often the device was lost");
  to("pose-fault", "", to_string(last.pose_fault), "why the pose is not trusted; `none` if it is");
  to("motor-heat", "", last.motor_heat,
     "heat of the hottest motor by the model; 1 is as much as it can sustain");
  to("held-back", "", last.held_back,
     "the strings get less than was wanted, to protect a motor or the hand");
  to("held-back-ticks", "", counters.held_back_ticks, "ticks in which that was so");
  to("faulty-string", "", last.faulty_string,
     "number of the string whose length fits no pose; −1 if all fit");
  to("grip-held", "", last.held, "somebody holds the grip, as far as its motion tells");
  to("grip-speed", "m/s", last.velocity.linear_m_s.norm(), "speed of the grip");
  to("vibration-fraction", "", snapshot.vibration.fraction,
     "what the force is multiplied by, because it shook the hand for long; else 1");
  to("vibration-left", "", snapshot.vibration.left,
     "what is left of the store of vibration, 0 … 1 ([Safety](../safety.md#vibration))");
  const auto& lateness = session.timing().lateness;
  to("wakeup", "ns",
     Parts{{"median", not_negative(lateness.quantile_ns(0.5))},
           {"p999", not_negative(lateness.quantile_ns(0.999))}},
     "lateness of the loop's ticks: `median`, `p999` (99.9 %)");
  to("skew", "ns",
     Parts{{"median", not_negative(loop.skew().quantile_ns(0.5))},
           {"p99", not_negative(loop.skew().quantile_ns(0.99))}},
     "time from when a frame was due to the tick that reached it: `median`, `p99`");
  to("device-late", "ns", not_negative(snapshot.late_ns),
     "how much later than its picture the device renders the force, because it lags by more than "
     "the film is known ahead");
  to("motion-late", "ns", not_negative(snapshot.motion_late_ns),
     "how much later than [the motion that it shows](../playback.md#between-two-frames) the newest "
     "frame's force came; 0 with a queue behind the element");
  to("force", "N", axes(last.delivered.force_N),
     "force at the grip in the newest tick: x right, y up, z towards the viewer");
  to("torque", "N m", axes(last.delivered.torque_Nm), "torque about these axes");
  to("tensions", "N", Eigen::MatrixXd(last.tension_N),
     "tension of each string; 0 for strings that the device does not have");
  const touch::Contact& contact = last.contact;
  to("touching", "", contact.touching, "the grip touches the surface");
  to("touch-depth-mm", "mm", 1e3 * contact.depth_m, "how deep the grip is below the surface");
  to("touch-force", "N", contact.force_N.norm(), "contact force");
  to("touch-stiffness-fraction", "", contact.stiffness_fraction,
     "what is left of the stiffness; 1 unless the surface has shaken the grip");
  const LinkHealth link = session.grip().health();
  to("link-fault", "", to_string(link.last_fault),
     "the last fault of the link to the board; `none` if there was none");
  to("link-timeouts", "", link.count(LinkFault::kTimeout),
     "exchanges that the board did not answer in time");
  to("link-errors", "", link.errors(), "faults of all kinds");
  to("link-late-replies", "", link.late_replies, "answers that came after their tick");
  to("round-trip", "ns",
     Parts{{"median", not_negative(link.round_trip_median_ns)},
           {"p99", not_negative(link.round_trip_p99_ns)}},
     "time of an exchange: `median`, `p99`");
}

/// Sets `simulated` to the device "sim", or to null. Unless `threaded`, only the ticks of a test
/// move the grip, so that the speed of the test does not matter.
std::unique_ptr<Grip> grip_for(const std::string& spec, const Profile& profile, bool threaded,
                               SimulatedDevice*& simulated) {
  simulated = nullptr;
  if (spec != "sim") return make_grip(spec, profile);
  auto device = threaded
                    ? make_simulation(profile)
                    : std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
  simulated = device.get();
  return std::make_unique<StringGrip>(profile, std::move(device));
}

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

/// Returns null for a device that no sound server uses.
std::unique_ptr<CardReservation> reserve(GstElement* element, const std::string& device) {
  const DeviceName name(device);
  if (name.device != "sound") return nullptr;
  const std::optional<int> card = card_number(name.rest.substr(0, name.rest.find(',')));
  if (!card) return nullptr;
  std::string refused;
  std::unique_ptr<CardReservation> taken = CardReservation::reserve(*card, refused);
  if (!refused.empty()) {
    GST_INFO_OBJECT(element, "the sound server keeps %s: %s", device.c_str(), refused.c_str());
  }
  return taken;
}

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

}  // namespace

HapticOutput::HapticOutput(GstElement* element, std::function<void()> refreshed)
    : element_(element), refreshed_(std::move(refreshed)), follower_(element) {}

HapticOutput::~HapticOutput() = default;

void HapticOutput::set_manual(std::function<int64_t()> now) {
  now_ = std::move(now);
}

std::string HapticOutput::open(const std::string& device, const std::string& profile_name,
                               double max_force_N, const std::string& haptic_trace) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    chosen_.clear();
  }
  next_trace_ = haptic_trace;
  if (device != kAutoDevice) return open_named(device, profile_name, max_force_N);
  std::string refused;
  const auto choose = [&](const AutoDevice& found, const std::string& profile) {
    const std::string trace_error = open_named(found.device, profile, max_force_N);
    const std::lock_guard<std::mutex> lock(mutex_);
    chosen_ = found.why + " (device=auto)" + refused;
    return trace_error;
  };
  for (const AutoDevice& found : auto_devices(profile_name)) {
    if (!found.why_not.empty()) {
      refused += "; not " + found.device + ": " + found.why_not;
      continue;
    }
    try {
      // Only a SPIDAR has a profile.
      const bool has_strings = kinds_called(DeviceName(found.device).device)[0]->has_strings();
      return choose(found, has_strings ? profile_name : "");
    } catch (const std::runtime_error& error) {
      refused += std::string("; not ") + error.what();
    }
  }
  return choose({"sim", "simulated, because nothing that gives a force can be used", ""},
                profile_name);
}

std::string HapticOutput::begin_trace(bool has_film) {
  std::error_code none;
  const bool has_rows = fs::is_regular_file(next_trace_, none) && !fs::is_empty(next_trace_, none);
  if (!session_ || next_trace_.empty() || (has_rows && !has_film)) return {};
  try {
    session_->begin_trace(std::exchange(next_trace_, ""));
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

std::string HapticOutput::open_named(const std::string& device, const std::string& profile_name,
                                     double max_force_N) {
  Profile profile = profile_for(device, profile_name);
  const std::string doubt = other_than_confirmed(device, profile_name);
  if (is_simulated(device)) profile.drive_lag_known = true;
  SessionSettings settings;
  settings.threaded = !now_;
  SimulatedDevice* simulated = nullptr;
  std::unique_ptr<CardReservation> reservation = reserve(element_, device);
  auto session = std::make_unique<HapticSession>(
      grip_for(device, profile, settings.threaded, simulated), settings);
  HapticLoop& loop = session->loop();
  follower_.begin(
      [this, &loop](const PlaybackClock& clock) {
        loop.set_playback_clock(clock);
        refreshed_();
      },
      now_ ? now_ : HapticSession::monotonic_now_ns, settings.threaded);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Grip& grip = session->grip();
    most_force_N_ = grip.abilities().max_limit_N();
    most_force_of_ = grip.traits().has_strings ? profile.name : device;
    said_too_much_ = false;
    doubt_ = doubt;
    profile_ = profile;
    profile_.geometry = with_workspace(profile.geometry, grip.abilities().half_workspace_m);
    reservation_ = std::move(reservation);
    session_ = std::move(session);
    simulated_ = simulated;
  }
  set_max_force(max_force_N);
  return begin_trace(false);
}

void HapticOutput::close() {
  follower_.end();
  // Destroyed after the lock is released, because the ramp to zero takes 60 ms: first the session,
  // then the reservation.
  std::unique_ptr<CardReservation> reservation;
  std::unique_ptr<HapticSession> session;
  const std::lock_guard<std::mutex> lock(mutex_);
  reservation = std::move(reservation_);
  session = std::move(session_);
  simulated_ = nullptr;
}

void HapticOutput::set_max_force(double max_force_N) {
  std::string too_much_for;
  double most_N = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!session_) return;
    SafetyLimits limits;
    max_force_N_ = limits.max_force_N = std::min(max_force_N, most_force_N_);
    session_->loop().set_limits(limits);
    if (!(max_force_N > most_force_N_) || said_too_much_) return;
    said_too_much_ = true;
    too_much_for = most_force_of_;
    most_N = std::floor(10 * most_force_N_) / 10;  // the stated number is accepted
  }
  GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                      ("max-force=%g is more than the %.1f N that %s can give in every direction "
                       "without throwing a grip that is let go: the force is limited to these.",
                       max_force_N, most_N, too_much_for.c_str()),
                      ("Set max-force to %.1f at most.", most_N));
}

std::optional<LoopSnapshot> HapticOutput::snapshot() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!session_) return std::nullopt;
  return session_->loop().snapshot();
}

bool HapticOutput::read_device(DeviceView& view) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!session_) return false;
  view.name = session_->grip().name();
  if (!chosen_.empty()) view.name += " (" + chosen_ + ")";
  view.has_hand = simulated_ != nullptr;
  view.has_strings = session_->grip().traits().has_strings;
  const LoopSnapshot loop = session_->loop().snapshot();
  view.last = loop.last;
  view.overruns = loop.counters.overruns;
  view.ticks.clear();
  ForceTick tick;
  while (session_->loop().pop_force(tick)) view.ticks.push_back(tick);
  // After a long pause of the reader, the full queue has lost the newest ticks. Drop all of them: a
  // visible gap is better than a hidden one between ticks.
  if (view.ticks.size() >= HapticLoop::kForces) view.ticks.clear();
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

void HapticOutput::describe(FieldSink& to) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (session_) session_fields(*session_, to);
}

}  // namespace spidar
