// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/usb_kinds.h"

#include <cstdio>
#include <utility>

#include "spidar/boards/falcon_board.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/boards/sh4_board.h"
#include "spidar/boards/simple_board.h"

namespace spidar {
namespace {

template <typename BoardType>
std::unique_ptr<Board> make(const std::string& name, const Profile& profile,
                            std::unique_ptr<Transport> transport) {
  return std::make_unique<BoardType>(name, profile, std::move(transport));
}

template <typename BoardType>
std::unique_ptr<ForceBoard> make_force(const std::string& name,
                                       std::unique_ptr<Transport> transport) {
  return std::make_unique<BoardType>(name, std::move(transport));
}

}  // namespace

std::string UsbBoardKind::id() const {
  char text[16];
  std::snprintf(text, sizeof text, "%04x:%04x", vendor, product);
  return text;
}

const std::vector<UsbBoardKind>& usb_kinds() {
  // Never destroyed: when a player exits, another thread may still be reopening its board.
  static const auto& kinds = *new std::vector<UsbBoardKind>{
      {UsbFamily::kCyverse,
       sh4::kVendor,
       sh4::kProduct,
       "CyVerse USB 2.0 SH4",
       "usb-sh4",
       Trial::kEmulated,
       "endpoints and D/A range are inferred",
       {sh4::kEndpointOut, sh4::kEndpointIn, false},
       make<Sh4Board>,
       nullptr},
      {UsbFamily::kCyverse,
       usb_simple::kVendor,
       usb_simple::kProduct,
       "CyVerse USB 2.0 Simple",
       "usb-simple",
       Trial::kEmulated,
       "endpoints and D/A range are inferred",
       {usb_simple::kEndpointOut, usb_simple::kEndpointIn, false},
       make<SimpleBoard>,
       nullptr},
      {UsbFamily::kMouse,
       mouse::kVendor,
       mouse::kProduct,
       "SPIDAR-mouse",
       "",
       Trial::kInferred,
       "other devices have this id; asked when it is opened",
       {mouse::kEndpointOut, mouse::kEndpointIn, true},
       nullptr,
       make_force<MouseBoard>},
      {UsbFamily::kFalcon,
       falcon::kVendor,
       falcon::kProduct,
       "Novint Falcon",
       "",
       Trial::kEmulated,
       "reach and scale of the force are inferred",
       {falcon::kEndpointOut, falcon::kEndpointIn, false},
       nullptr,
       make_force<FalconBoard>},
  };
  return kinds;
}

const char* device_of(UsbFamily family) noexcept {
  switch (family) {
    case UsbFamily::kCyverse:
      return "usb";
    case UsbFamily::kMouse:
      return "mouse";
    case UsbFamily::kFalcon:
      return "falcon";
  }
  return "";
}

}  // namespace spidar
