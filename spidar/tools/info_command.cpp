// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iomanip>
#include <iostream>

#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/json_text.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr const char* kInfoHelp = R"(usage: spidarctl info DEVICE [--profile NAME] [--json]

Opens DEVICE, reads it for a tenth of a second with the motors at zero, and prints what it found.
)";

struct FoundBoard {
  DeviceReading reading;
  LinkHealth health;
  std::string description;  // reported by the open device
};

FoundBoard read(ChosenDevice& chosen) {
  FoundBoard found;
  bool read = false;
  {
    StringHold hold(*chosen.device, chosen.profile, every_millisecond());
    hold.stay(0.1, [&](const DeviceReading& reading) {
      found.reading = reading;
      read = true;
      return true;
    });
    found.health = chosen.device->health();
    found.description = chosen.device->description();
  }
  if (!read && !interrupted())
    throw DeviceError(chosen.device->name() + ": no reading was received; check cable and power");
  return found;
}

void print(const ChosenDevice& chosen, const FoundBoard& found) {
  const Profile& profile = chosen.profile;
  std::cout << "device    " << chosen.board.device << "\nboard     " << chosen.board.name
            << "\nevidence  " << to_string(chosen.board.trial);
  if (!chosen.board.note.empty()) std::cout << "; " << chosen.board.note;
  if (!found.description.empty()) std::cout << "\nfound     " << found.description;
  if (!chosen.board.path.empty()) std::cout << "\npath      " << chosen.board.path;
  if (!chosen.board.serial.empty()) std::cout << "\nserial    " << chosen.board.serial;
  std::cout << "\nprofile   " << profile.name << ": " << profile.description << "\ncounts    "
            << (profile.calibration ? "calibrated"
                                    : "not calibrated: zero at the first position of the grip")
            << "\ninputs    0x" << std::hex << std::setw(4) << std::setfill('0')
            << found.reading.inputs << std::dec << std::setfill(' ');
  if (found.health.round_trip_median_ns > 0)
    std::cout << "\nexchange  " << found.health.round_trip_median_ns / 1000 << " us median, "
              << found.health.round_trip_max_ns / 1000 << " us at most";
  if (chosen.board.has_strings) {
    std::cout
        << "\n\n  string  N smallest  N largest  N/V       um/count  motor  encoder     count\n";
    for (int i = 0; i < profile.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      const StringDrive& drive = profile.drives[k];
      std::cout << "  " << std::setw(6) << i << std::setw(12) << drive.min_tension_N
                << std::setw(11) << drive.max_tension_N << "  " << std::left << std::setw(8)
                << drive.newtons_per_volt << "  " << std::setw(8) << 1e6 * drive.metres_per_count
                << std::right << std::showpos << std::setw(7) << drive.motor_sign << std::setw(9)
                << drive.encoder_sign << std::noshowpos << std::setw(10) << found.reading.count[k]
                << '\n';
    }
  } else {
    std::cout << '\n';
  }
}

void print_json(const ChosenDevice& chosen, const FoundBoard& found) {
  toml::array counts;
  for (int i = 0; i < chosen.profile.geometry.count; ++i)
    counts.push_back(found.reading.count[static_cast<size_t>(i)]);
  std::cout << json_text(toml::table{{"device", chosen.board.device},
                                     {"board", chosen.board.name},
                                     {"evidence", to_string(chosen.board.trial)},
                                     {"note", chosen.board.note},
                                     {"found", found.description},
                                     {"path", chosen.board.path},
                                     {"serial", chosen.board.serial},
                                     {"profile", chosen.profile.name},
                                     {"calibrated", chosen.profile.calibration.has_value()},
                                     {"strings", chosen.profile.geometry.count},
                                     {"inputs", found.reading.inputs},
                                     {"counts", counts},
                                     {"round_trip_median_ns", found.health.round_trip_median_ns},
                                     {"round_trip_max_ns", found.health.round_trip_max_ns}});
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
  ChosenDevice chosen = choose_device(options, CountZero::kNever);
  catch_signals();
  const FoundBoard found = read(chosen);
  if (interrupted()) return kInterrupted;
  (json ? print_json : print)(chosen, found);
  return kDone;
}

}  // namespace spidar
