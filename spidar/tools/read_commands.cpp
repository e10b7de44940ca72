// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl list and info.
#include <algorithm>
#include <array>
#include <iomanip>
#include <iostream>
#include <limits>

#include "core/json_text.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/text.h"
#include "spidar/tools/device_command.h"
#include "spidar/transports/tty_transport.h"

namespace spidar::tools {
namespace {

/// The list as JSON, from which the text is made, too.
Json found_devices() {
  Json devices = Json::array(), lines = Json::array(), profiles = Json::array();
  for (const DeviceInfo& board : list_boards()) {
    devices.push_back({{"device", board.device},
                       {"board", board.name},
                       {"evidence", board.evidence},
                       {"path", board.path},
                       {"serial", board.serial},
                       {"usb_id", board.usb_id},
                       {"profile", board.profile},
                       {"has_strings", board.has_strings},
                       {"accessible", board.accessible},
                       {"note", board.note}});
  }
  for (const TtyLine& line : list_tty_lines()) {
    if (!line.named) lines.push_back("uart:" + line.path);
  }
  for (const std::string& name : list_profiles()) {
    try {
      profiles.push_back({{"name", name}, {"description", load_profile(name).description}});
    } catch (const ProfileError& error) {
      profiles.push_back({{"name", name}, {"error", error.what()}});
    }
  }
  return {{"devices", devices}, {"serial_lines", lines}, {"profiles", profiles}};
}

std::string text_of(const Json& object, const char* name) {
  return object.value(name, std::string());
}

int list(const bool& as_json) {
  const Json found = found_devices();
  if (as_json) {
    std::cout << json_text(found, 2) << '\n';
    return kDone;
  }
  std::cout << "devices\n";
  const Json& devices = found["devices"];
  const bool any_real = std::any_of(devices.begin(), devices.end(), [](const Json& board) {
    return !is_simulated(text_of(board, "device"));
  });
  if (!any_real) {
    std::cout << "  none is plugged in: no board on USB, no joystick or gamepad with force "
                 "feedback, no sound card\n";
  }
  for (const Json& board : devices) {
    const std::string serial = text_of(board, "serial"), note = text_of(board, "note");
    // For a board with strings, the only profile is the one that was confirmed.
    const bool is_chosen = board.value("has_strings", false) && !serial.empty();
    const std::string profile = is_chosen ? text_of(board, "profile") : "";
    std::cout << "  " << std::left << std::setw(12) << text_of(board, "device") << "  "
              << text_of(board, "board") << "; " << text_of(board, "evidence")
              << (serial.empty() ? "" : "; serial number " + serial)
              << (profile.empty() ? "" : "; confirmed profile " + profile)
              << (note.empty() ? "" : "; " + note) << '\n';
  }
  std::cout << "\nserial lines (motor boards may be connected to them)\n";
  for (const Json& line : found["serial_lines"]) {
    std::cout << "  " << line.get<std::string>() << '\n';
  }
  if (found["serial_lines"].empty()) std::cout << "  none\n";
  std::cout << "\nprofiles\n";
  for (const Json& profile : found["profiles"]) {
    std::cout << "  " << text_of(profile, "name") << "  "
              << (profile.contains("error") ? "cannot be used: " + text_of(profile, "error")
                                            : text_of(profile, "description"))
              << '\n';
  }
  return kDone;
}

struct FoundBoard {
  DeviceReading reading;       // of a device with strings
  Eigen::Vector3d position_m;  // of a device without strings; NaN while unknown
  LinkHealth health;
  std::string description;  // what the open device reports
};

/// Returns false when nothing was read.
bool read_strings(ChosenDevice& chosen, FoundBoard& found) {
  bool read = false;
  selftest::StringHold hold(*chosen.device, chosen.profile, every_millisecond());
  hold.hold_for(0.1, [&](const DeviceReading& reading) {
    found.reading = reading;
    return read = true;
  });
  found.health = chosen.device->health();
  found.description = chosen.device->description();
  return read;
}

bool read_position(ChosenDevice& chosen, FoundBoard& found) {
  bool read = false;
  selftest::ForceHold hold(*chosen.grip, every_millisecond());
  hold.hold_for(0.1, [&](const GripReading& reading) {
    found.position_m.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (reading.knows_pose()) found.position_m = reading.pose.position_m;
    return read = true;
  });
  found.health = chosen.grip->health();
  found.description = chosen.grip->description();
  return read;
}

FoundBoard read(ChosenDevice& chosen) {
  FoundBoard found;
  const bool read = chosen.grip ? read_position(chosen, found) : read_strings(chosen, found);
  if (!read && !interrupted()) {
    throw DeviceError(selftest::loss_text(chosen.name(), found.health.last_fault, 0));
  }
  return found;
}

/// Prints the counts of a board for which nobody has named a profile.
void print_counts(const ChosenDevice& chosen, const FoundBoard& found) {
  std::cout << "profile   none, so its motors get no force; those that fit it:";
  for (const std::string& name : fitting_profiles(chosen.board)) std::cout << ' ' << name;
  std::cout << "\n\n  string     count\n";
  for (int i = 0; i < chosen.profile.geometry.count; ++i) {
    std::cout << formatted("  %6d%10d\n", i, found.reading.count[static_cast<size_t>(i)]);
  }
}

void print_strings(const Profile& profile, const FoundBoard& found) {
  std::cout
      << "profile   " << profile.name << ": " << profile.description << "\ncounts    "
      << (profile.calibration ? "calibrated"
                              : "not calibrated: zero at the first position of the grip")
      << formatted("\ninputs    0x%04x", found.reading.inputs)
      << "\n\n  string  N smallest  N largest  N/V       um/count  motor  encoder     count\n";
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    std::cout << formatted("  %6d%12g%11g  %-8g  %-8g%+7d%+9d%10d\n", i, drive.min_tension_N,
                           drive.max_tension_N, drive.newtons_per_volt,
                           1e6 * drive.metres_per_count, drive.motor_sign, drive.encoder_sign,
                           found.reading.count[k]);
  }
}

constexpr std::array<const char*, 3> kAxes{"right", "up", "forward"};

void print_axes(const GripAbilities& can, const FoundBoard& found) {
  std::cout << "force     " << can.largest_force_N << " N at most, " << can.rate_Hz
            << " times a second"
            << (can.direction ? "" : "; its strength is felt, not its direction")
            << "\n\n  axis     force  position\n";
  for (size_t i = 0; i < kAxes.size(); ++i) {
    if (!can.force[i] && !can.position[i]) continue;
    std::cout << formatted("  %-7s%7s", kAxes[i], can.force[i] ? "yes" : "no");
    if (!can.position[i]) {
      std::cout << "  no\n";
    } else if (!found.position_m.allFinite()) {
      std::cout << "  not known\n";
    } else {
      std::cout << formatted("%7.1f mm\n", 1e3 * found.position_m[static_cast<Eigen::Index>(i)]);
    }
  }
}

void print(const ChosenDevice& chosen, const FoundBoard& found) {
  std::cout << "device    " << chosen.board.device << "\nboard     " << chosen.board.name
            << "\nevidence  " << chosen.board.evidence;
  if (!chosen.board.note.empty()) std::cout << "; " << chosen.board.note;
  if (!found.description.empty()) std::cout << "\nfound     " << found.description;
  if (!chosen.board.path.empty()) std::cout << "\npath      " << chosen.board.path;
  if (!chosen.board.serial.empty()) std::cout << "\nserial    " << chosen.board.serial;
  if (found.health.round_trip_median_ns > 0) {
    std::cout << "\nexchange  " << found.health.round_trip_median_ns / 1000 << " us median, "
              << found.health.round_trip_max_ns / 1000 << " us at most";
  }
  std::cout << '\n';
  if (chosen.grip) {
    print_axes(chosen.grip->abilities(), found);
  } else if (chosen.profile.name.empty()) {
    print_counts(chosen, found);
  } else {
    print_strings(chosen.profile, found);
  }
}

Json counts_of(const Profile& profile, const DeviceReading& reading) {
  const auto begin = reading.count.begin();
  return std::vector<int32_t>(begin, begin + profile.geometry.count);
}

Json json_of(const ChosenDevice& chosen, const FoundBoard& found) {
  Json json{{"device", chosen.board.device},
            {"board", chosen.board.name},
            {"evidence", chosen.board.evidence},
            {"note", chosen.board.note},
            {"found", found.description},
            {"path", chosen.board.path},
            {"serial", chosen.board.serial},
            {"round_trip_median_ns", found.health.round_trip_median_ns},
            {"round_trip_max_ns", found.health.round_trip_max_ns}};
  if (!chosen.grip) {
    json.update({{"profile", chosen.profile.name},
                 {"calibrated", chosen.profile.calibration.has_value()},
                 {"strings", chosen.profile.geometry.count},
                 {"inputs", found.reading.inputs},
                 {"counts", counts_of(chosen.profile, found.reading)}});
    return json;
  }
  const GripAbilities can = chosen.grip->abilities();
  Json force = Json::array(), position_m = Json::object();
  for (size_t i = 0; i < kAxes.size(); ++i) {
    if (can.force[i]) force.push_back(kAxes[i]);
    if (can.position[i] && found.position_m.allFinite()) {
      position_m[kAxes[i]] = found.position_m[static_cast<Eigen::Index>(i)];
    }
  }
  json.update({{"force_axes", force},
               {"force_direction", can.direction},
               {"largest_force_N", can.largest_force_N},
               {"forces_per_s", can.rate_Hz},
               {"position_m", position_m}});
  return json;
}

int info(const DeviceOptions& options) {
  // The counts are shown as the board gives them, without a new zero.
  ChosenDevice chosen = choose_device(options, Motors::kOff, boards::CountZero::kNever);
  catch_signals();
  const FoundBoard found = read(chosen);
  if (interrupted()) return kInterrupted;
  if (options.json) {
    std::cout << json_text(json_of(chosen, found), 2) << '\n';
  } else {
    print(chosen, found);
  }
  return kDone;
}

}  // namespace

void add_list(Program& program) {
  const auto [app, as_json] = add_command(program, "list", "list devices and profiles", list);
  add_json(app, as_json);
  app.footer(
      "Lists the devices, how far the driver of each has been tested, the serial lines to which\n"
      "motor boards may be connected, and the profiles. No device is opened.");
}

void add_info(Program& program) {
  const auto [app, options] =
      add_command(program, "info", "identify a device and read it once", info);
  add_device(app, options);
  add_json(app, options.json);
  app.footer(
      "Opens DEVICE, reads it for a tenth of a second with the motors at zero, and prints what it\n"
      "found: its strings, or the axes in which it gives a force and a position.");
}

}  // namespace spidar::tools
