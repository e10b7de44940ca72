// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/cyverse/board.h"
#include "spidar/devices/cyverse/emulated.h"
#include "spidar/devices/cyverse/packets.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/device_parts.h"

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
  kind.dac = boards::cyverse_dac;
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

}  // namespace

std::vector<DeviceKind> cyverse_kinds() {
  return {sh4_kind(), simple_kind()};
}

}  // namespace spidar
