// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/cyverse_board.h"
#include "spidar/boards/falcon_board.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/devices/device_kind.h"
#include "spidar/devices/device_parts.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/emulation/emulated_force_devices.h"
#include "spidar/profiles/profile.h"
#include "spidar/protocols/cyverse.h"
#include "spidar/protocols/novint_falcon.h"
#include "spidar/protocols/spidar_mouse.h"

namespace spidar {
namespace {

/// The profile of a simulation of these boards, which output positive voltages only: the usual one
/// needs both signs. Real boards have no default (see profile_choice.h).
constexpr const char* kUnipolarProfile = "spidar-g6x3-v2-r";

/// What both boards have in common.
DeviceKind cyverse_kind() {
  DeviceKind kind;
  kind.device = "usb";
  kind.names = "usb, usb:ID";
  kind.profile = kUnipolarProfile;
  kind.note = "endpoints and D/A range are inferred";
  kind.traits = boards::kCyverseTraits;
  kind.simulated_motors = simulated_strings<boards::cyverse_dac>;
  return kind;
}

DeviceKind sh4_kind() {
  DeviceKind kind = cyverse_kind();
  kind.title = "CyVerse USB 2.0 SH4";
  kind.profile_board = "usb-sh4";
  kind.usb = {sh4::kVendor, sh4::kProduct, sh4::kEndpointOut, sh4::kEndpointIn};
  kind.board = "sh4";
  kind.attach = attach<boards::Sh4>;
  kind.emulate = emulate<emulated::Sh4>;
  return kind;
}

DeviceKind simple_kind() {
  DeviceKind kind = cyverse_kind();
  kind.title = "CyVerse USB 2.0 Simple";
  kind.profile_board = "usb-simple";
  kind.usb = {usb_simple::kVendor, usb_simple::kProduct, usb_simple::kEndpointOut,
              usb_simple::kEndpointIn};
  kind.board = "simple";
  kind.attach = attach<boards::Simple>;
  kind.emulate = emulate<emulated::Simple>;
  return kind;
}

DeviceKind falcon_kind() {
  DeviceKind kind;
  kind.device = "falcon";
  kind.title = "Novint Falcon";
  kind.usb = {falcon::kVendor, falcon::kProduct, falcon::kEndpointOut, falcon::kEndpointIn};
  kind.usb.full_speed = true;
  kind.board = "falcon";
  kind.names = "falcon, falcon:ID";
  kind.chosen_as = "a Novint Falcon";
  kind.note = "reach and scale of the force are inferred";
  kind.attach = attach<boards::Falcon>;
  kind.emulate = emulate<emulated::Falcon>;
  kind.simulated_motors = simulated_hand<emulated::Falcon::kHomed>;
  return kind;
}

DeviceKind mouse_kind() {
  DeviceKind kind;
  kind.device = "mouse";
  kind.title = "SPIDAR-mouse";
  kind.usb = {mouse::kVendor, mouse::kProduct, mouse::kEndpointOut, mouse::kEndpointIn, true};
  kind.usb.shared = kind.usb.full_speed = true;
  kind.board = "mouse";
  kind.names = "mouse, mouse:ID";
  kind.evidence = "inferred";
  kind.note = "other devices have this id: it is asked when it is opened";
  kind.attach = attach<boards::Mouse>;
  kind.emulate = emulate<emulated::Mouse>;
  kind.simulated_motors = unconnected_motors;
  return kind;
}

}  // namespace

std::vector<DeviceKind> usb_kinds() {
  return {sh4_kind(), simple_kind(), falcon_kind(), mouse_kind()};
}

}  // namespace spidar
