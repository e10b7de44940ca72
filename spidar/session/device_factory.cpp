// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/device_factory.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "spidar/devices/device_registry.h"
#include "spidar/devices/usb_search.h"
#include "spidar/link/force_grip.h"
#include "spidar/link/link_thread.h"
#include "spidar/loop/string_grip.h"
#include "spidar/text.h"

namespace spidar {
namespace {

/// "sim, sim:BOARD, none, usb, usb:ID, …"
std::string known_names(bool with_elements) {
  std::string names = std::string("sim, sim:BOARD") + (with_elements ? ", none, auto" : "");
  const char* last = "";
  for (const DeviceKind& kind : devices()) {
    if (kind.device != std::string(last)) names += std::string(", ") + kind.names;
    last = kind.device;
  }
  return names;
}

/// What people call their device, and the name of that device here.
constexpr std::pair<const char*, const char*> kWords[] = {
    {"gamepad", "ff"},
    {"joystick", "ff"},
    {"wheel", "ff"},
    {"controller", "ff"},
    {"spidar", "usb, or uart:PATH with UART motor boards"},
    {"haply", "inverse3"},
    {"shaker", "sound:CARD"},
    {"simulation", "sim"},
};

/// "; did you mean ff?"
std::string meant_device(const std::string& device) {
  std::vector<std::string> names = {"sim", "none", "auto"};
  for (const DeviceKind& kind : devices()) names.emplace_back(kind.device);
  return meant(device, names);
}

/// Returns the name for a word of kWords; else an empty text.
std::string called_here(const std::string& word) {
  for (const auto& [called, name] : kWords) {
    if (word == called) {
      return "unknown device \"" + word + "\": here it is called " + name +
             "; spidarctl list names what is plugged in";
    }
  }
  return {};
}

/// The error for a name that gives only the kind of a device; lists those that are plugged in.
DeviceError unclear(const DeviceKind& kind) {
  const std::string names = kind.names;
  std::string there;
  for (const DeviceInfo& board : kind.list()) there += (there.empty() ? "" : ", ") + board.device;
  return DeviceError(
      std::string("\"") + kind.device + "\" does not say which one: write " +
          names.substr(0, names.find(',')) +
          (there.empty() ? "; none is listed by name (spidarctl list)" : "; there are " + there),
      DeviceErrorCode::kSettings);
}

std::string simulated_names() {
  std::string names;
  for (const DeviceKind& kind : devices()) {
    if (kind.emulate) names += (names.empty() ? "sim:" : ", sim:") + std::string(kind.board);
  }
  return names;
}

/// Calls `make`, whose std::invalid_argument means that the profile's mechanics are impossible.
template <typename Make>
auto simulating(const std::string& text, const Profile& profile, const Make& make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw DeviceError(text + ": cannot simulate profile \"" + profile.name + "\": " + error.what(),
                      DeviceErrorCode::kSettings);
  }
}

boards::Settings settings_for(const std::string& text, const Profile& profile,
                              boards::Settings settings) {
  if (is_simulated(text)) return settings_of_simulation();
  if (settings.count_zero != boards::CountZero::kByProfile) return settings;
  const bool calibrated =
      std::any_of(profile.drives.begin(), profile.drives.end(),
                  [](const StringDrive& drive) { return drive.home_offset_m != 0; });
  settings.count_zero = calibrated ? boards::CountZero::kNever : boards::CountZero::kFirstOpen;
  return settings;
}

struct MadeDevice {
  std::unique_ptr<StringDevice> strings;
  std::unique_ptr<boards::ForceLink> force;
};

MadeDevice link_to(boards::AnyBoard board, const boards::Settings& settings) {
  if (auto* force = std::get_if<std::unique_ptr<boards::ForceBoard>>(&board)) {
    return {nullptr, std::make_unique<boards::ForceLink>(std::move(*force), settings)};
  }
  return {std::make_unique<boards::StringLink>(
              std::get<std::unique_ptr<boards::Board>>(std::move(board)), settings),
          nullptr};
}

template <typename Link, typename BoardType>
std::unique_ptr<Link> usb_link(const std::string& text, const std::string& id,
                               const Profile& profile, const std::vector<const DeviceKind*>& kinds,
                               const boards::Settings& settings) {
  std::vector<std::unique_ptr<BoardType>> boards;
  auto open = usb_opener(text, id, profile, kinds, boards);
  return std::make_unique<Link>(std::move(boards), std::move(open), settings);
}

MadeDevice make(const std::string& text, const Profile& profile, const boards::Settings& settings) {
  if (text == "sim") {
    return {make_simulation(profile), nullptr};
  }
  const DeviceName name(text);
  if (name.device == "sim" && name.has_end) {
    const DeviceKind* const kind = simulated_kind(name);
    if (!kind) {
      throw DeviceError(
          "unknown simulated board \"" + name.rest + "\"; known are: " + simulated_names(),
          DeviceErrorCode::kSettings);
    }
    return link_to(simulating(text, profile, [&] { return simulated_board(*kind, text, profile); }),
                   settings);
  }
  const auto kinds = kinds_called(name.device);
  if (!kinds.empty() && kinds[0]->needs_rest() && name.rest.empty()) throw unclear(*kinds[0]);
  const std::string called = called_here(text);
  if (!called.empty()) throw DeviceError(called, DeviceErrorCode::kSettings);
  if (kinds.empty() || !name.has_end) {
    // Only the element knows these names, for no device and for an automatic choice.
    const bool is_elements = text == "none" || text == "auto";
    throw DeviceError(
        (is_elements ? "\"" + text + "\" is not a device"
                     : "unknown device \"" + text + "\"" +
                           (kinds.empty() && name.has_end ? meant_device(name.device) : "")) +
            "; known are: " + known_names(!is_elements),
        DeviceErrorCode::kSettings);
  }
  if (kinds[0]->make) return link_to(kinds[0]->make(text, name.rest, profile), settings);
  if (kinds[0]->has_strings()) {
    return {usb_link<boards::StringLink, boards::Board>(text, name.rest, profile, kinds, settings),
            nullptr};
  }
  return {nullptr, usb_link<boards::ForceLink, boards::ForceBoard>(text, name.rest, profile, kinds,
                                                                   settings)};
}

}  // namespace

bool is_simulated(const std::string& spec) {
  return spec == "sim" || spec.compare(0, 4, "sim:") == 0;
}

boards::Settings settings_of_simulation() {
  boards::Settings settings;
  settings.count_zero = boards::CountZero::kNever;
  settings.guardian = false;
  settings.threaded = false;
  return settings;
}

std::unique_ptr<SimulatedDevice> make_simulation(const Profile& profile) {
  return simulating("sim", profile, [&] {
    return std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kClock,
                                             grip_model_of(profile));
  });
}

std::unique_ptr<StringDevice> make_device(const std::string& text, const Profile& profile,
                                          const boards::Settings& settings) {
  MadeDevice made = make(text, profile, settings_for(text, profile, settings));
  if (!made.strings) {
    throw DeviceError(text + ": takes a force; it has no strings, and no encoders",
                      DeviceErrorCode::kSettings);
  }
  return std::move(made.strings);
}

std::unique_ptr<Grip> make_grip(const std::string& text, const Profile& profile,
                                const boards::Settings& settings) {
  MadeDevice made = make(text, profile, settings_for(text, profile, settings));
  if (made.force) return std::make_unique<boards::ForceGrip>(std::move(made.force));
  return std::make_unique<StringGrip>(profile, std::move(made.strings));
}

}  // namespace spidar
