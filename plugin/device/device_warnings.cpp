// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/device/device_warnings.h"

#include <array>
#include <cmath>
#include <utility>

#include "plugin/gobject/bus_messages.h"
#include "plugin/gobject/category.h"
#include "plugin/gobject/structure_fields.h"
#include "spidar/chain/tension_command.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/string_causes.h"
#include "spidar/session/device_factory.h"
#include "spidar/text.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar {
namespace {

/// A shorter loss of the pose is not reported: a hand that swings a slack string causes it.
constexpr int64_t kPoseLost_ns = 500'000'000;

/// A force with a longer delay does not feel like a part of its picture: on average, people notice
/// a delay from 45 ms on (docs/feeling.md).
constexpr int64_t kPointless_ns = 40'000'000;
constexpr int64_t kLasting_ns = 2'000'000'000;  ///< a shorter delay is not reported

/// Returns why the device was lost, with the last fault of the link, if there is a link.
std::string why_lost(const HapticSession& session) {
  const LinkFault fault = session.grip().health().last_fault;
  switch (fault) {
    case LinkFault::kNone:
      return "The haptic device does not answer.";
    case LinkFault::kSuspended:
      return "The haptic device was set to rest, because the player stood still.";
    case LinkFault::kUnguarded:
      return "The haptic device was set to rest, because its guardian has ended.";
    case LinkFault::kBabble:
      return "The haptic device sends more than it is asked for, so that nobody knows how old its "
             "answers are.";
    default:
      return std::string("The haptic device does not answer: ") + to_string(fault) + ".";
  }
}

std::string directions_text(const std::array<bool, 3>& force) {
  constexpr std::array<const char*, 3> kDirections{"to the sides", "up and down",
                                                   "towards and away from you"};
  std::string text;
  bool all = true;
  for (size_t i = 0; i < force.size(); ++i) {
    if (force[i]) text += (text.empty() ? "" : ", ") + std::string(kDirections[i]);
    all = all && force[i];
  }
  return all ? "in every direction" : text.empty() ? "in no direction" : text;
}

/// "force to the sides, up and down, up to 3.0 N (1 N by max-force), no torque"
std::string rendered_text(const GripAbilities& can, double max_force_N) {
  const double accepted_N = std::floor(10 * can.largest_force_N) / 10;  // by max-force
  std::string most = formatted("%.1f N", accepted_N);
  if (max_force_N < can.largest_force_N) most += formatted(" (%g N by max-force)", max_force_N);
  if (!can.direction) return "the strength of the force, not its direction, up to " + most;
  return "force " + directions_text(can.force) + ", up to " + most +
         (can.torque ? ", and torque" : ", no torque");
}

}  // namespace

void device_message_fields(const char* state, const std::string& device, const std::string& why,
                           FieldSink& to) {
  to("state", "", state,
     "`opened`; `refused`: it cannot be opened, also not again, and there is no force; `lost`; "
     "`back`: it is driven again");
  to("device", "", device.c_str(), "its name, as for the property `device`");
  to("reason", "", why.c_str(),
     "of `opened`, what it is, empty for `device=sim`; of `refused` and `lost`, why; empty for "
     "`back`");
  to("simulated", "", is_simulated(device), "the device moves nothing real");
}

void DeviceWarnings::post(const char* state, const std::string& device,
                          const std::string& why) const {
  GST_INFO_OBJECT(element_, "device %s: %s: %s", device.c_str(), state, why.c_str());
  GstStructure* const what = gst_structure_new_empty("spidar-device");
  StructureFields to(what);
  device_message_fields(state, device, why, to);
  gst_element_post_message(element_, gst_message_new_element(GST_OBJECT(element_), what));
}

bool DeviceWarnings::open(HapticOutput& output, const std::string& device, OnDeviceError policy,
                          const std::function<std::string()>& opens) {
  try {
    const std::string trace_error = opens();
    profile_ = output.profile().name;
    GST_INFO_OBJECT(element_, "opened device '%s' with profile '%s'", device.c_str(),
                    output.profile().name.c_str());
    report_haptic_trace(trace_error);
    check_opened(output);
    return true;
  } catch (const std::exception& refusal) {
    return check_refused(device, refusal, policy);
  }
}

bool DeviceWarnings::check_refused(const std::string& device, const std::exception& refusal,
                                   OnDeviceError policy, SourceLocation location) const {
  post("refused", device, refusal.what());
  if (policy == OnDeviceError::kError) {
    post_exception(element_, GST_MESSAGE_ERROR, refusal, "on-device-error=error", location);
    return false;
  }
  post_exception(element_, GST_MESSAGE_WARNING, refusal,
                 what_ +
                     " goes on without force. The device is opened again in the next change from "
                     "NULL to READY.",
                 location);
  return true;
}

void DeviceWarnings::check_opened(const HapticOutput& output) const {
  const HapticSession* const session = output.session();
  const std::string& chosen = output.chosen();
  if (!session) return;
  if (!output.doubt().empty()) {
    GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS, ("%s.", output.doubt().c_str()),
                        ("Without profile=, the confirmed one is used; spidarctl choose confirms "
                         "another one."));
  }
  const Grip& grip = session->grip();
  post("opened", grip.name(), chosen.empty() ? session->opened() : chosen);
  const std::string error = session->vibration_error();
  if (!error.empty()) {
    GST_ELEMENT_WARNING(element_, RESOURCE, OPEN_READ_WRITE, ("%s", error.c_str()),
                        ("A file that can be read and written there is enough."));
  }
  const GripAbilities can = grip.abilities();
  // Most devices have no torque or no force towards the viewer, as their pages say. The abilities
  // and the strength of a force-feedback device are known only once it is open.
  const bool force_feedback = grip.name().compare(0, 2, "ff") == 0;
  const bool whole = can.force[0] && can.force[1] && can.direction;
  if (chosen.empty() && whole && is_simulated(grip.name())) return;
  std::string text;
  if (!chosen.empty()) text = grip.name() + ": " + chosen + ". ";
  const bool is_sound = grip.name().compare(0, 5, "sound") == 0;
  if (!force_feedback && !is_sound && chosen.empty()) text = grip.name() + ": ";
  if (force_feedback || chosen.empty()) text += session->opened() + ". ";
  if (!force_feedback) text += "It renders " + rendered_text(can, output.max_force_N()) + ". ";
  text.pop_back();
  std::string advice;
  if (!chosen.empty()) advice = "spidarctl list names what is plugged in; device= chooses one.";
  if (force_feedback) {
    advice += std::string(advice.empty() ? "" : " ") +
              "device=ff:PATH,gain=PERCENT sets how much of its strength is used, and spidarctl "
              "selftest ff tests its directions.";
  }
  post_information(element_, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_SETTINGS, text, advice);
}

void DeviceWarnings::start() {
  strings_ = 0;
  pose_lost_ = held_back_ = vibrated_ = shaken_ = late_ = remarked_ = false;
  late_from_ns_ = 0;
  haptic_trace_ = false;
  state_ = DeviceState::kClosed;
  refusal_.clear();
}

void DeviceWarnings::report_haptic_trace(const std::string& error) {
  if (error.empty()) return;
  GST_ELEMENT_WARNING(element_, RESOURCE, OPEN_WRITE, ("%s", error.c_str()),
                      ("%s and the force continue without it.", what_.c_str()));
}

void DeviceWarnings::check_haptic_trace(const HapticSession* session) {
  const int error = session ? session->trace_status().error : 0;
  if (error == 0 || std::exchange(haptic_trace_, true)) return;
  GST_ELEMENT_WARNING(element_, RESOURCE, WRITE,
                      ("The haptic trace can no longer be written: %s.", g_strerror(error)),
                      ("%s and the force continue without it.", what_.c_str()));
}

void DeviceWarnings::end_haptic_trace(HapticSession* session) {
  if (!session) return;
  session->drain_trace();
  check_haptic_trace(session);
  const LineWriter::Status status = session->trace_status();
  if (status.error == 0) {
    warn_of_missing_rows(element_, "The haptic trace", status.dropped + status.waiting);
  }
}

void DeviceWarnings::check_strings(const LoopSnapshot& loop) {
  const int string = loop.last.faulty_string;
  if (string < 0 || (strings_ & 1u << string) != 0) return;
  strings_ |= 1u << string;
  GST_ELEMENT_WARNING(
      element_, RESOURCE, READ,
      ("String %d of the haptic device is slack or broken, or its encoder is faulty.", string),
      ("Its length fits no pose that the other strings allow. The string is not used, and the "
       "force is limited to what the others can deliver. Causes, the likeliest first: %s. The "
       "profile is %s. Start again with the grip at the centre, or calibrate the device (spidarctl "
       "calibrate).",
       kStringCauses, profile_.c_str()));
}

void DeviceWarnings::check_pose(const LoopSnapshot& loop, bool has_strings) {
  if (loop.untrusted_ns == 0 && std::exchange(pose_lost_, false)) {
    GST_INFO_OBJECT(element_, "the pose of the grip is known again");
  }
  if (loop.untrusted_ns > kPoseLost_ns && !std::exchange(pose_lost_, true)) {
    GST_ELEMENT_WARNING(
        element_, RESOURCE, READ,
        ("The pose of the grip is unknown: %s. There is no force until it is known again.",
         to_string(loop.last.pose_fault)),
        ("%s", has_strings
                   ? ("The strings have their minimum tension. Causes, the likeliest first: " +
                      std::string(kStringCauses) + ". The profile is " + profile_ +
                      ". Start again with the grip at the centre, or calibrate the device "
                      "(spidarctl calibrate).")
                         .c_str()
                   : "spidarctl info shows what the device says of itself."));
  }
}

void DeviceWarnings::check_force(const LoopSnapshot& loop) {
  const bool is_warm = loop.last.held_back && loop.last.motor_heat > MotorHeat::kLimitFrom;
  if (is_warm && !std::exchange(held_back_, true)) {
    GST_ELEMENT_WARNING(element_, RESOURCE, WRITE,
                        ("A motor of the haptic device is warm: the force is reduced."),
                        ("The motor is at %.2f of its continuous rating (continuous_tension_N of "
                         "the profile). The full force returns when the motor has cooled.",
                         loop.last.motor_heat));
  }
  if (loop.last.contact.stiffness_fraction < 1 && !std::exchange(shaken_, true)) {
    GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                        ("The touched surface shook the grip: its stiffness is lowered."),
                        ("The drives lag more than the profile says. Measure them with spidarctl "
                         "selftest --lag, write drive_lag_s into the profile, or set a lower "
                         "touch-stiffness."));
  }
  if (loop.vibration.lowered() && !std::exchange(vibrated_, true)) {
    GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                        ("The force is lowered because it has shaken the hand for long."),
                        ("What is left for this day comes back with time (docs/safety.md). Calm "
                         "scenes are felt as before. A smaller max-force or filter-min-cutoff "
                         "makes it last longer."));
  }
}

void DeviceWarnings::check_late(const LoopSnapshot& loop) {
  const int64_t now_ns = loop.last.monotonic_ns;
  if (loop.late_ns <= kPointless_ns || late_from_ns_ == 0) late_from_ns_ = now_ns;
  if (now_ns - late_from_ns_ < kLasting_ns || std::exchange(late_, true)) return;
  GST_ELEMENT_WARNING(
      element_, RESOURCE, SETTINGS,
      ("The haptic device renders the force %.0f ms after its picture: it lags by more than the "
       "film is known ahead.",
       1e-6 * static_cast<double>(loop.late_ns)),
      ("Put a queue behind this element, so that frames come earlier; set ts-offset of the sinks "
       "of "
       "picture and sound to %.0f ms more; or use a device or a card that lags less.",
       1e-6 * static_cast<double>(loop.late_ns)));
}

void DeviceWarnings::check_remarks(const HapticSession& session) {
  if (remarked_) return;
  const std::string remark = session.grip().warning();
  if (remark.empty()) return;
  remarked_ = true;
  GST_ELEMENT_WARNING(element_, RESOURCE, WRITE, ("%s", remark.c_str()),
                      ("%s continues.", what_.c_str()));
}

void DeviceWarnings::check_refusal(const HapticSession& session) {
  const std::string refusal = session.loop().refusal();
  if (refusal.empty() || refusal == std::exchange(refusal_, refusal)) return;
  post("refused", session.grip().name(), refusal);
  GST_ELEMENT_WARNING(element_, RESOURCE, OPEN_READ_WRITE, ("%s.", refusal.c_str()),
                      ("The device that was lost is still looked for."));
}

bool DeviceWarnings::check(const HapticSession* session, OnDeviceError policy) {
  const LoopSnapshot loop = session ? session->loop().snapshot() : LoopSnapshot{};
  if (session) {
    check_strings(loop);
    check_pose(loop, session->grip().traits().has_strings);
    check_force(loop);
    check_late(loop);
    check_remarks(*session);
    check_haptic_trace(session);
  }
  const DeviceState state = loop.last.device;
  const DeviceState before = state_;
  // A device may be lost and come back between two frames.
  const bool lost_since = before != DeviceState::kClosed && loop.counters.times_lost > times_lost_;
  state_ = state;
  times_lost_ = loop.counters.times_lost;
  if (state == before && !lost_since) {
    if (state == DeviceState::kLost) check_refusal(*session);
    return true;
  }
  const std::string device = session ? session->grip().name() : "";
  if (before == DeviceState::kLost) post("back", device, "");
  if (state != DeviceState::kLost) refusal_.clear();
  if (state != DeviceState::kLost && !lost_since) return true;
  const std::string text = why_lost(*session);
  post("lost", device, text);
  // The device was away for less than a frame.
  if (state != DeviceState::kLost) post("back", device, "");
  if (policy == OnDeviceError::kError) {
    GST_ELEMENT_ERROR(element_, RESOURCE, WRITE, ("%s", text.c_str()), ("on-device-error=error"));
    return false;
  }
  GST_ELEMENT_WARNING(element_, RESOURCE, WRITE,
                      ("%s %s continues without it.", text.c_str(), what_.c_str()),
                      ("The device is reopened when it returns."));
  return true;
}

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

void warn_of_missing_rows(GstElement* element, const char* trace, uint64_t rows) {
  if (rows == 0) return;
  GST_ELEMENT_WARNING(
      element, RESOURCE, WRITE,
      ("%s lacks %" G_GUINT64_FORMAT " rows, which what it is written to did not take in time.",
       trace, static_cast<guint64>(rows)),
      ("A reader of a pipe that stands still, or a slow disk or network folder."));
}

}  // namespace spidar
