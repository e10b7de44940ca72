// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/output/haptic_output.h"

#include <algorithm>
#include <utility>

#include <gst/gst.h>

#include "core/grip/string_geometry.h"
#include "plugin/gobject/category.h"
#include "plugin/output/card_reservation.h"
#include "spidar/devices/device_registry.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/devices/sound/sound_cards.h"
#include "spidar/grip/string_grip.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "spidar/session/profile_choice.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar {
namespace {

guint64 not_negative(int64_t ns) {
  return static_cast<guint64>(std::max<int64_t>(ns, 0));
}

/// Adds the fields of the device; docs/fields.toml says what they mean.
void describe_session(const HapticSession& session, GstStructure* structure) {
  const HapticLoop& loop = session.loop();
  const LoopSnapshot snapshot = loop.snapshot();
  const LoopCounters& counters = snapshot.counters;
  const Scheduling& scheduling = session.scheduling();
  gst_structure_set(
      structure, "device", G_TYPE_STRING, session.grip().name().c_str(), "device-state",
      G_TYPE_STRING, to_string(snapshot.last.device), "real-time", G_TYPE_BOOLEAN,
      scheduling.real_time ? TRUE : FALSE, "scheduling", G_TYPE_STRING, scheduling.detail.c_str(),
      "ticks", G_TYPE_UINT64, counters.ticks, "overruns", G_TYPE_UINT64, counters.overruns,
      "missed-ticks", G_TYPE_UINT64, counters.missed_deadlines, "gap-ticks", G_TYPE_UINT64,
      counters.gap_ticks, "exchange-errors", G_TYPE_UINT64, counters.exchange_errors, "pose-errors",
      G_TYPE_UINT64, counters.pose_errors, "times-lost", G_TYPE_UINT64, counters.times_lost,
      "pose-fault", G_TYPE_STRING, to_string(snapshot.last.pose_fault), "motor-heat", G_TYPE_DOUBLE,
      snapshot.last.motor_heat, "held-back", G_TYPE_BOOLEAN, snapshot.last.held_back ? TRUE : FALSE,
      "held-back-ticks", G_TYPE_UINT64, counters.held_back_ticks, "faulty-string", G_TYPE_INT,
      snapshot.last.faulty_string, "grip-held", G_TYPE_BOOLEAN, snapshot.last.held ? TRUE : FALSE,
      "grip-speed", G_TYPE_DOUBLE, snapshot.last.velocity.linear_m_s.norm(), "vibration-fraction",
      G_TYPE_DOUBLE, snapshot.vibration.fraction, "vibration-left", G_TYPE_DOUBLE,
      snapshot.vibration.left, "wakeup-median", G_TYPE_UINT64,
      not_negative(session.timing().lateness.quantile_ns(0.5)), "wakeup-p999", G_TYPE_UINT64,
      not_negative(session.timing().lateness.quantile_ns(0.999)), "skew-median", G_TYPE_UINT64,
      not_negative(loop.skew().quantile_ns(0.5)), "skew-p99", G_TYPE_UINT64,
      not_negative(loop.skew().quantile_ns(0.99)), "device-late", G_TYPE_UINT64,
      not_negative(snapshot.late_ns), "motion-late", G_TYPE_UINT64,
      not_negative(snapshot.motion_late_ns), nullptr);
  const Wrench& delivered = snapshot.last.delivered;
  gst_structure_set(structure, "force-x", G_TYPE_DOUBLE, delivered.force_N.x(), "force-y",
                    G_TYPE_DOUBLE, delivered.force_N.y(), "force-z", G_TYPE_DOUBLE,
                    delivered.force_N.z(), "torque-x", G_TYPE_DOUBLE, delivered.torque_Nm.x(),
                    "torque-y", G_TYPE_DOUBLE, delivered.torque_Nm.y(), "torque-z", G_TYPE_DOUBLE,
                    delivered.torque_Nm.z(), nullptr);
  GValue tensions = G_VALUE_INIT;
  g_value_init(&tensions, GST_TYPE_ARRAY);
  for (const double tension_N : snapshot.last.tension_N) {
    GValue tension = G_VALUE_INIT;
    g_value_init(&tension, G_TYPE_DOUBLE);
    g_value_set_double(&tension, tension_N);
    gst_value_array_append_and_take_value(&tensions, &tension);
  }
  gst_structure_take_value(structure, "tensions", &tensions);
  const touch::Contact& contact = snapshot.last.contact;
  gst_structure_set(structure, "touching", G_TYPE_BOOLEAN, contact.touching ? TRUE : FALSE,
                    "touch-depth-mm", G_TYPE_DOUBLE, 1e3 * contact.depth_m, "touch-force",
                    G_TYPE_DOUBLE, contact.force_N.norm(), "touch-stiffness-fraction",
                    G_TYPE_DOUBLE, contact.stiffness_fraction, nullptr);
  const LinkHealth link = session.grip().health();
  gst_structure_set(structure, "link-fault", G_TYPE_STRING, to_string(link.last_fault),
                    "link-timeouts", G_TYPE_UINT64, link.count(LinkFault::kTimeout), "link-errors",
                    G_TYPE_UINT64, link.errors(), "link-late-replies", G_TYPE_UINT64,
                    link.late_replies, "round-trip-median", G_TYPE_UINT64,
                    not_negative(link.round_trip_median_ns), "round-trip-p99", G_TYPE_UINT64,
                    not_negative(link.round_trip_p99_ns), nullptr);
}

/// `simulated`: the device "sim", otherwise null. If a test makes the ticks, only these move its
/// grip, so that the speed of the test does not matter.
std::unique_ptr<Grip> grip_for(const std::string& spec, const Profile& profile, bool threaded,
                               SimulatedDevice*& simulated) {
  simulated = nullptr;
  if (spec != "sim") return make_grip(spec, profile);
  std::unique_ptr<StringDevice> device;
  if (threaded) {
    device = make_device(spec, profile);
  } else {
    device = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kFixedStep);
  }
  simulated = dynamic_cast<SimulatedDevice*>(device.get());
  return std::make_unique<StringGrip>(profile, std::move(device));
}

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

/// Null for a device that no sound server uses.
std::unique_ptr<CardReservation> reserve(GstElement* element, const std::string& device) {
  const DeviceName name(device);
  if (name.device != "sound") return nullptr;
  const std::optional<int> card = card_number(name.rest.substr(0, name.rest.find(',')));
  if (!card) return nullptr;
  std::string refused;
  std::unique_ptr<CardReservation> taken = CardReservation::take(*card, refused);
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
  if (device != kAutoDevice) return open_named(device, profile_name, max_force_N, haptic_trace);
  std::string refused;
  const auto choose = [&](const AutoDevice& found, const std::string& profile) {
    const std::string trace_error = open_named(found.device, profile, max_force_N, haptic_trace);
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
      // Others than a SPIDAR have no profile.
      const bool has_strings = kinds_called(DeviceName(found.device).device)[0]->has_strings();
      return choose(found, has_strings ? profile_name : "");
    } catch (const std::runtime_error& error) {
      refused += std::string("; not ") + error.what();
    }
  }
  return choose({"sim", "simulated, because nothing that gives a force can be used", ""},
                profile_name);
}

std::string HapticOutput::open_named(const std::string& device, const std::string& profile_name,
                                     double max_force_N, const std::string& haptic_trace) {
  Profile profile = profile_for(device, profile_name);
  const std::string doubt = other_than_confirmed(device, profile_name);
  if (is_simulated(device)) profile.drive_lag_known = true;
  SessionSettings settings;
  settings.trace_path = haptic_trace;
  settings.threaded = !now_;
  SimulatedDevice* simulated = nullptr;
  const auto make_session = [&] {
    return std::make_unique<HapticSession>(grip_for(device, profile, settings.threaded, simulated),
                                           settings);
  };
  std::string trace_error;
  std::unique_ptr<CardReservation> reservation = reserve(element_, device);
  std::unique_ptr<HapticSession> session;
  try {
    session = make_session();
  } catch (const TraceError& error) {
    trace_error = error.what();
    settings.trace_path.clear();
    session = make_session();
  }
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
    most_force_N_ = std::max(kDefaultForce_N, grip.abilities().largest_force_N);
    most_force_of_ = grip.traits().has_strings ? profile.name : device;
    said_too_much_ = false;
    doubt_ = doubt;
    profile_ = profile;
    profile_.geometry = with_room(profile.geometry, grip.abilities().half_room_m);
    reservation_ = std::move(reservation);
    session_ = std::move(session);
    simulated_ = simulated;
  }
  set_max_force(max_force_N);
  return trace_error;
}

void HapticOutput::close() {
  follower_.end();
  // Destroyed after the lock is released, because the ramp to rest takes 60 ms, and the session
  // before its card is given back.
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
    most_N = most_force_N_;
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

bool HapticOutput::look_at_device(DeviceView& view) {
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
  // Where nobody looked for long, the oldest ticks are there and the newest are not: a gap that can
  // be seen is better than one between them.
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

void HapticOutput::describe(GstStructure* structure) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (session_) describe_session(*session_, structure);
}

}  // namespace spidar
