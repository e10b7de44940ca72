// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <array>
#include <iomanip>
#include <iostream>
#include <limits>

#include "spidar/conformance/force_hold.h"
#include "spidar/session/profile_choice.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/json_text.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr const char* kInfoHelp = R"(usage: spidarctl info DEVICE [--profile NAME] [--json]

Opens DEVICE, reads it for a tenth of a second with the motors at zero, and prints what it found:
its strings, or the axes in which it gives a force and a position.
)";

struct FoundBoard {
  DeviceReading reading;       // of a device with strings
  Eigen::Vector3d position_m;  // of a device without; not numbers while it is not known
  LinkHealth health;
  std::string description;  // reported by the open device
};

/// False when nothing was read.
bool read_strings(ChosenDevice& chosen, FoundBoard& found) {
  bool read = false;
  StringHold hold(*chosen.device, chosen.profile, every_millisecond());
  hold.stay(0.1, [&](const DeviceReading& reading) {
    found.reading = reading;
    return read = true;
  });
  found.health = chosen.device->health();
  found.description = chosen.device->description();
  return read;
}

bool read_position(ChosenDevice& chosen, FoundBoard& found) {
  bool read = false;
  ForceHold hold(*chosen.grip, every_millisecond());
  hold.stay(0.1, [&](const GripReading& reading) {
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
  if (!read && !interrupted())
    throw DeviceError(chosen.name() + ": no reading was received; check cable and power");
  return found;
}

/// Of a board for which nobody has named a profile.
void print_counts(const ChosenDevice& chosen, const FoundBoard& found) {
  std::cout << "profile   none, so its motors get no force; those that fit it:";
  for (const std::string& name : fitting_profiles(chosen.board)) std::cout << ' ' << name;
  std::cout << "\n\n  string     count\n";
  for (int i = 0; i < chosen.profile.geometry.count; ++i)
    std::cout << "  " << std::setw(6) << i << std::setw(10)
              << found.reading.count[static_cast<size_t>(i)] << '\n';
}

void print_strings(const Profile& profile, const FoundBoard& found) {
  std::cout << "profile   " << profile.name << ": " << profile.description << "\ncounts    "
            << (profile.calibration ? "calibrated"
                                    : "not calibrated: zero at the first position of the grip")
            << "\ninputs    0x" << std::hex << std::setw(4) << std::setfill('0')
            << found.reading.inputs << std::dec << std::setfill(' ');
  std::cout
      << "\n\n  string  N smallest  N largest  N/V       um/count  motor  encoder     count\n";
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    std::cout << "  " << std::setw(6) << i << std::setw(12) << drive.min_tension_N << std::setw(11)
              << drive.max_tension_N << "  " << std::left << std::setw(8) << drive.newtons_per_volt
              << "  " << std::setw(8) << 1e6 * drive.metres_per_count << std::right << std::showpos
              << std::setw(7) << drive.motor_sign << std::setw(9) << drive.encoder_sign
              << std::noshowpos << std::setw(10) << found.reading.count[k] << '\n';
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
    std::cout << "  " << std::left << std::setw(7) << kAxes[i] << std::right << std::setw(7)
              << (can.force[i] ? "yes" : "no");
    if (can.position[i] && !found.position_m.allFinite())
      std::cout << "  not known";
    else if (can.position[i])
      std::cout << std::setw(7) << std::fixed << std::setprecision(1)
                << 1e3 * found.position_m[static_cast<Eigen::Index>(i)] << " mm";
    else
      std::cout << "  no";
    std::cout << '\n';
  }
}

void print(const ChosenDevice& chosen, const FoundBoard& found) {
  std::cout << "device    " << chosen.board.device << "\nboard     " << chosen.board.name
            << "\nevidence  " << to_string(chosen.board.trial);
  if (!chosen.board.note.empty()) std::cout << "; " << chosen.board.note;
  if (!found.description.empty()) std::cout << "\nfound     " << found.description;
  if (!chosen.board.path.empty()) std::cout << "\npath      " << chosen.board.path;
  if (!chosen.board.serial.empty()) std::cout << "\nserial    " << chosen.board.serial;
  if (found.health.round_trip_median_ns > 0)
    std::cout << "\nexchange  " << found.health.round_trip_median_ns / 1000 << " us median, "
              << found.health.round_trip_max_ns / 1000 << " us at most";
  std::cout << '\n';
  if (chosen.grip)
    print_axes(chosen.grip->abilities(), found);
  else if (chosen.profile.name.empty())
    print_counts(chosen, found);
  else
    print_strings(chosen.profile, found);
}

void add_strings(const Profile& profile, const FoundBoard& found, toml::table& table) {
  toml::array counts;
  for (int i = 0; i < profile.geometry.count; ++i)
    counts.push_back(found.reading.count[static_cast<size_t>(i)]);
  table.insert("profile", profile.name);
  table.insert("calibrated", profile.calibration.has_value());
  table.insert("strings", profile.geometry.count);
  table.insert("inputs", found.reading.inputs);
  table.insert("counts", counts);
}

void add_axes(const GripAbilities& can, const FoundBoard& found, toml::table& table) {
  toml::array force;
  toml::table position_m;
  for (size_t i = 0; i < kAxes.size(); ++i) {
    if (can.force[i]) force.push_back(kAxes[i]);
    if (can.position[i] && found.position_m.allFinite())
      position_m.insert(kAxes[i], found.position_m[static_cast<Eigen::Index>(i)]);
  }
  table.insert("force_axes", force);
  table.insert("force_direction", can.direction);
  table.insert("largest_force_N", can.largest_force_N);
  table.insert("forces_per_s", can.rate_Hz);
  table.insert("position_m", position_m);
}

void print_json(const ChosenDevice& chosen, const FoundBoard& found) {
  toml::table table{{"device", chosen.board.device},
                    {"board", chosen.board.name},
                    {"evidence", to_string(chosen.board.trial)},
                    {"note", chosen.board.note},
                    {"found", found.description},
                    {"path", chosen.board.path},
                    {"serial", chosen.board.serial},
                    {"round_trip_median_ns", found.health.round_trip_median_ns},
                    {"round_trip_max_ns", found.health.round_trip_max_ns}};
  if (chosen.grip)
    add_axes(chosen.grip->abilities(), found, table);
  else
    add_strings(chosen.profile, found, table);
  std::cout << json_text(table);
}

}  // namespace

int info_command(int argc, char** argv) {
  bool json = false;
  const DeviceOptions options = parse_device_options(argc, argv, {json_option(json)});
  if (options.help) {
    std::cout << kInfoHelp;
    return kDone;
  }
  // Shows the counts as the board gives them, without a new zero.
  ChosenDevice chosen = choose_device(options, Motors::kOff, CountZero::kNever);
  catch_signals();
  const FoundBoard found = read(chosen);
  if (interrupted()) return kInterrupted;
  (json ? print_json : print)(chosen, found);
  return kDone;
}

}  // namespace spidar
