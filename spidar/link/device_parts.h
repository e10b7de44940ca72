// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Functions for the members of a DeviceKind.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "spidar/link/board.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// For DeviceKind::attach.
template <typename BoardType>
boards::AnyBoard attach(const std::string& name, const Profile& profile,
                        std::unique_ptr<Transport> transport) {
  if constexpr (std::is_base_of_v<boards::Board, BoardType>) {
    return std::unique_ptr<boards::Board>(
        std::make_unique<BoardType>(name, profile, std::move(transport)));
  } else {
    return std::unique_ptr<boards::ForceBoard>(
        std::make_unique<BoardType>(name, std::move(transport)));
  }
}

/// For DeviceKind::emulate.
template <typename Emulated>
std::unique_ptr<emulated::Board> emulate(std::shared_ptr<emulated::Motors> motors) {
  return std::make_unique<Emulated>(std::move(motors));
}

/// The number from 1 to `largest` in "NAME=NUMBER", of which `name` has the equals sign; 0 if
/// `option` is something else.
inline int option_value(const std::string& option, const std::string& name, int largest) {
  if (option.compare(0, name.size(), name) != 0) return 0;
  const std::string digits = option.substr(name.size());
  if (digits.empty() || digits.size() > 5) return 0;
  if (digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  const int value = std::stoi(digits);
  return value <= largest ? value : 0;
}

}  // namespace spidar
