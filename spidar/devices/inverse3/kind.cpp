// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/inverse3/board.h"
#include "spidar/devices/inverse3/emulated.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/device_parts.h"
#include "spidar/link/spring_hand.h"
#include "spidar/transports/websocket_transport.h"

namespace spidar {
namespace {

/// `rest` is empty, ID, or ID,port=N.
boards::AnyBoard make_inverse3(const std::string& name, const std::string& rest, const Profile&) {
  constexpr int kLastPort = 65535;
  const size_t comma = rest.find(',');
  int port = inverse3::kPort;
  if (comma != std::string::npos) port = option_value(rest.substr(comma + 1), "port=", kLastPort);
  if (port == 0 || comma == 0) {
    throw DeviceError(name +
                          ": write inverse3, inverse3:ID or inverse3:ID,port=N, where N is the " +
                          "port of Haply's service, " + std::to_string(inverse3::kPort) +
                          " unless it was changed",
                      DeviceErrorCode::kSettings);
  }
  return std::unique_ptr<boards::ForceBoard>(std::make_unique<boards::Inverse3>(
      name, rest.substr(0, comma),
      std::make_unique<WebSocketTransport>(
          name, static_cast<uint16_t>(port),
          "start Haply's Inverse Service (Haply Hub, or: systemctl start haply-inverse-service)")));
}

boards::AnyBoard attach_inverse3(const std::string& name, const Profile&,
                                 std::unique_ptr<Transport> transport) {
  return std::unique_ptr<boards::ForceBoard>(
      std::make_unique<boards::Inverse3>(name, "", std::move(transport)));
}

/// To ask the service would be a session there.
std::vector<DeviceInfo> list_inverse3() {
  if (!is_listening(inverse3::kPort)) return {};
  DeviceInfo board;
  board.device = "inverse3";
  board.path = "localhost:" + std::to_string(inverse3::kPort);
  board.note = "if it is plugged in, which only Haply's service knows";
  return {board};
}

}  // namespace

std::vector<DeviceKind> inverse3_kinds() {
  DeviceKind kind;
  kind.device = "inverse3";
  kind.title = "Haply Inverse3";
  kind.board = "inverse3";
  kind.names = "inverse3, inverse3:ID";
  kind.chosen_as = "a Haply Inverse3";
  kind.evidence = "inferred";
  kind.attach = attach_inverse3;
  kind.emulate = emulate<emulated::Inverse3>;
  kind.hand = emulated::spring_hand<0>;
  kind.make = make_inverse3;
  kind.list = list_inverse3;
  return {kind};
}

}  // namespace spidar
