// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/cyverse_board.h"
#include "spidar/devices/device_kind.h"
#include "spidar/devices/device_parts.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/profiles/profile.h"
#include "spidar/protocols/cyverse.h"

namespace spidar {
namespace {

/// Of simulations: the boards output positive volts only, which the usual profile is not made for.
/// Real boards have no default (see profile_choice.h).
constexpr const char* kPositiveProfile = "spidar-g6x3-v2-r";

/// What both boards have in common.
DeviceKind cyverse_kind() {
  DeviceKind kind;
  kind.device = "usb";
  kind.names = "usb, usb:ID";
  kind.profile = kPositiveProfile;
  kind.note = "endpoints and D/A range are inferred";
  kind.traits = kCyverseTraits;
  kind.simulated_motors = simulated_strings<unipolar_dac>;
  return kind;
}

}  // namespace

DeviceKind sh4_kind() {
  DeviceKind kind = cyverse_kind();
  kind.title = "CyVerse USB 2.0 SH4";
  kind.profile_board = board_name::kSh4;
  kind.usb = {sh4::kVendor, sh4::kProduct, {sh4::kEndpointOut, sh4::kEndpointIn}};
  kind.board = "sh4";
  kind.attach = attach<Sh4Board>;
  kind.emulate = emulate<emulated::Sh4>;
  return kind;
}

DeviceKind simple_kind() {
  DeviceKind kind = cyverse_kind();
  kind.title = "CyVerse USB 2.0 Simple";
  kind.profile_board = board_name::kSimple;
  kind.usb = {usb_simple::kVendor,
              usb_simple::kProduct,
              {usb_simple::kEndpointOut, usb_simple::kEndpointIn}};
  kind.board = "simple";
  kind.attach = attach<SimpleBoard>;
  kind.emulate = emulate<emulated::Simple>;
  return kind;
}

}  // namespace spidar
