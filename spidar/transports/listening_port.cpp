// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/listening_port.h"

#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace spidar {
namespace {

/// Reads the table that proc_pid_net(5) describes: number, local address, remote address, state.
bool has_listener(const char* path, uint16_t port) {
  const std::string kListen = "0A";
  std::ifstream list(path);
  list.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string number, local, remote, state;
    words >> number >> local >> remote >> state;
    const size_t colon = local.find(':');
    if (state != kListen || colon == std::string::npos) continue;
    if (std::stoul(local.substr(colon + 1), nullptr, 16) == port) return true;
  }
  return false;
}

}  // namespace

bool is_listening(uint16_t port) {
  return has_listener("/proc/net/tcp", port) || has_listener("/proc/net/tcp6", port);
}

}  // namespace spidar
