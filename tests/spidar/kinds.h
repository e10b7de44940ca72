// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The boards that there are, as parameters of tests.
#pragma once

#include "spidar/devices/device_registry.h"
#include "spidar/link/emulated_transport.h"
#include "tests/support/test.h"

namespace spidar::test {

/// DeviceKind::board of those with strings, or of those that take a force.
inline std::vector<std::string> boards_that_there_are(bool with_strings) {
  std::vector<std::string> boards;
  for (const DeviceKind& kind : devices())
    if (kind.has_strings() == with_strings) boards.emplace_back(kind.board);
  return boards;
}

inline const DeviceKind& kind_of(const std::string& board) {
  return *simulated_kind(DeviceName("sim:" + board));
}

/// Those with strings on USB.
inline std::vector<std::string> string_boards_on_usb() {
  std::vector<std::string> boards;
  for (const std::string& board : boards_that_there_are(true))
    if (kind_of(board).usb.vendor != 0) boards.push_back(board);
  return boards;
}

inline std::string name_of(const testing::TestParamInfo<std::string>& board) {
  return board.param;
}

inline std::unique_ptr<Transport> wire_to(std::unique_ptr<emulated::Board> emulated,
                                          const std::shared_ptr<std::atomic<LinkFault>>& wire) {
  return std::make_unique<emulated::Transport>(std::move(emulated), wire);
}

}  // namespace spidar::test
