// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Functions that boards share for opening.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "spidar/guardian/last_will.h"
#include "spidar/link_fault.h"
#include "spidar/protocols/bytes.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Returns the transport's will with these packets; empty if no other process can reach the board.
inline std::vector<LastWill> wills(const Transport& transport,
                                   std::initializer_list<ByteView> packets) {
  std::optional<LastWill> will = transport.last_will();
  if (!will) return {};
  for (const ByteView packet : packets) {
    const size_t length = std::min(packet.size, LastWill::kMaxLength);
    std::copy_n(packet.data, length, will->packet[will->packets].begin());
    will->length[will->packets++] = static_cast<uint32_t>(length);
  }
  return {*will};
}

/// "usb:1-2: does not answer: stall"
inline std::string no_answer(const std::string& board, LinkFault fault) {
  return board + ": does not answer as it should: " + to_string(fault) +
         "; switch it off and on, and check cable and supply";
}

/// Tries the first exchange up to three times, because it may first receive data that an earlier
/// program left unread.
template <typename Exchange>
LinkFault open_exchange(const Exchange& exchange, Transport& transport) {
  constexpr int64_t kPatience_ns = 100'000'000;
  LinkFault fault = LinkFault::kNone;
  for (int attempt = 0; attempt < 3; ++attempt) {
    fault = exchange(monotonic_now_ns() + kPatience_ns);
    if (fault == LinkFault::kNone || fault == LinkFault::kGone) break;
    transport.recover();
  }
  return fault;
}

}  // namespace spidar
