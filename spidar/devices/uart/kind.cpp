// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <unistd.h>
#include <utility>

#include "spidar/devices/uart/board.h"
#include "spidar/devices/uart/emulated.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/device_parts.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/tty_transport.h"

namespace spidar {
namespace {

boards::AnyBoard uart_board(const std::string& name, const Profile& profile,
                            std::vector<std::unique_ptr<Transport>> lines) {
  return std::unique_ptr<boards::Board>(
      std::make_unique<boards::Uart>(name, profile, std::move(lines)));
}

boards::AnyBoard attach_uart(const std::string& name, const Profile& profile,
                             std::unique_ptr<Transport> line) {
  std::vector<std::unique_ptr<Transport>> lines;
  lines.push_back(std::move(line));
  return uart_board(name, profile, std::move(lines));
}

/// `paths` are separated by commas.
boards::AnyBoard make_uart(const std::string& name, const std::string& paths,
                           const Profile& profile) {
  std::vector<std::unique_ptr<Transport>> lines;
  for (size_t begin = 0; begin <= paths.size();) {
    const size_t end = std::min(paths.find(',', begin), paths.size());
    if (end == begin) {
      throw DeviceError(name + ": a path is empty; write uart:/dev/ttyUSB0",
                        DeviceErrorCode::kSettings);
    }
    const std::string path = paths.substr(begin, end - begin);
    lines.push_back(std::make_unique<TtyTransport>("uart:" + path, path, uart_motor::kBaud));
    begin = end + 1;
  }
  return uart_board(name, profile, std::move(lines));
}

/// Two boards of four motors, like the published pair of a SPIDAR-G.
std::unique_ptr<emulated::Board> emulate_uart(std::shared_ptr<emulated::Motors> motors) {
  constexpr uart_motor::BoardInfo kB3M{5, 1, 4, 4, 0, 0};
  return std::make_unique<emulated::Uart>(
      std::move(motors), std::vector<emulated::Uart::Station>{{0, kB3M}, {1, kB3M}});
}

std::vector<DeviceInfo> list_uart() {
  std::vector<DeviceInfo> boards;
  for (const TtyLine& line : list_tty_lines()) {
    if (!line.named) continue;
    DeviceInfo& board = boards.emplace_back();
    board.device = "uart:" + line.path;
    board.path = line.path;
    board.accessible = access(line.path.c_str(), R_OK | W_OK) == 0;
    if (!board.accessible) board.note = "no permission: join the group dialout";
  }
  return boards;
}

}  // namespace

std::vector<DeviceKind> uart_kinds() {
  DeviceKind kind;
  kind.device = "uart";
  kind.title = "UART motor boards";
  kind.profile_board = "uart";
  kind.board = "uart";
  kind.names = "uart:PATH";
  kind.profile = "spidar-g6x4";
  kind.traits = boards::kUartTraits;
  kind.attach = attach_uart;
  kind.emulate = emulate_uart;
  kind.dac = boards::uart_dac;
  kind.make = make_uart;
  kind.list = list_uart;
  return {kind};
}

}  // namespace spidar
