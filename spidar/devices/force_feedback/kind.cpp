// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/force_feedback/board.h"
#include "spidar/devices/force_feedback/emulated.h"
#include "spidar/devices/force_feedback/evdev_list.h"
#include "spidar/devices/force_feedback/evdev_transport.h"
#include "spidar/link/device_kind.h"
#include "spidar/text.h"

namespace spidar {
namespace {

/// Parses axes=N, gain=PERCENT, flip=x, flip=y or flip=xy. Returns false for any other text, and
/// for an option that was given before.
bool parse_option(const std::string& option, int& axes, boards::StickEffects::Options& options) {
  if (axes == 0 && (axes = option_value(option, "axes=", 2)) != 0) return true;
  if (options.gain == 0 && (options.gain = option_value(option, "gain=", 100) / 100.0) != 0) {
    return true;
  }
  if (options.flipped[0] || options.flipped[1]) return false;
  options.flipped = {option == "flip=x" || option == "flip=xy",
                     option == "flip=y" || option == "flip=xy"};
  return options.flipped[0] || options.flipped[1];
}

/// `rest` is empty, PATH, or PATH with options after commas.
boards::AnyBoard make_force_feedback(const std::string& name, const std::string& rest,
                                     const Profile& profile) {
  const size_t comma = rest.find(',');
  const std::string path = rest.substr(0, comma);
  int axes = 0;
  boards::StickEffects::Options options;
  for (size_t at = comma; at != std::string::npos;) {
    const size_t end = rest.find(',', at + 1);
    const std::string option = rest.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    at = end;
    if (path.empty()) {
      throw DeviceError(name + ": the path is empty; write ff:/dev/input/eventN," + option,
                        DeviceErrorCode::kSettings);
    }
    if (!parse_option(option, axes, options)) {
      throw DeviceError(
          name + ": \"" + option + "\" is unknown, out of range or given twice; write ff:" + path +
              ",axes=1 for a wheel, ff:" + path + ",axes=2 for a joystick, ff:" + path +
              ",gain=50 for 50 % of the device's strength (1 to 100), or ff:" + path +
              ",flip=x if it pushes to the wrong side",
          DeviceErrorCode::kSettings);
    }
  }
  return std::make_unique<boards::ForceFeedback>(
      name, profile, std::make_unique<EvdevTransport>(name, path, axes),
      boards::StickEffects::Updates::kOwnThread, options);
}

boards::AnyBoard attach_force_feedback(const std::string& name, const Profile& profile,
                                       std::unique_ptr<Transport> transport) {
  return std::make_unique<boards::ForceFeedback>(name, profile, std::move(transport),
                                                 boards::StickEffects::Updates::kInCycle);
}

std::vector<DeviceInfo> list_force_feedback_boards() {
  std::vector<DeviceInfo> boards;
  for (const EvdevInfo& device : list_force_feedback()) {
    DeviceInfo& board = boards.emplace_back();
    board.device = "ff:" + device.path;
    board.name = device.name;
    board.path = device.path;
    board.serial = device.serial;
    board.usb_id = device.id;
    board.directional = device.constant;
    if (!device.constant) board.note = "rumble only: strength without direction";
    if (!device.accessible) board.note = kNoUdevRule;
    board.accessible = device.accessible;
  }
  return boards;
}

}  // namespace

std::vector<DeviceKind> force_feedback_kinds() {
  return {{.device = "ff",
           .board = "ff",
           .title = "force-feedback device",
           .names = "ff, ff:PATH, ff:PATH,axes=N, ff:PATH,gain=PERCENT",
           .chosen_as = "a joystick or wheel with directional force",
           .attach = attach_force_feedback,
           .emulate = emulate<emulated::ForceFeedback>,
           .make = make_force_feedback,
           .list = list_force_feedback_boards}};
}

}  // namespace spidar
