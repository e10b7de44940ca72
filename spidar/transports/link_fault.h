// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What can go wrong between host and board, by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar {

enum class LinkFault : uint8_t {
  kNone,
  kTimeout,      ///< no answer in time
  kStall,        ///< the endpoint says that it does not understand
  kShort,        ///< fewer bytes than the packet has
  kBabble,       ///< more bytes than there is room for
  kBusError,     ///< broken packets on the wire; what an unplugged board often gives first
  kGone,         ///< unplugged
  kWrongReply,   ///< of the right length, but not the answer
  kWrongEcho,    ///< the D/A values that the board repeats were not sent
  kCounterJump,  ///< a counter moved further than a hand can
  kUnguarded,    ///< the guardian has ended: killed, or this process was stopped for too long
};
constexpr size_t kLinkFaults = 11;

/// "none", "time-out", "stall", "short packet", …
constexpr const char* to_string(LinkFault fault) noexcept {
  switch (fault) {
    case LinkFault::kNone:
      return "none";
    case LinkFault::kTimeout:
      return "time-out";
    case LinkFault::kStall:
      return "stall";
    case LinkFault::kShort:
      return "short packet";
    case LinkFault::kBabble:
      return "babble";
    case LinkFault::kBusError:
      return "bus error";
    case LinkFault::kGone:
      return "unplugged";
    case LinkFault::kWrongReply:
      return "wrong reply";
    case LinkFault::kWrongEcho:
      return "wrong echo";
    case LinkFault::kCounterJump:
      return "counter jump";
    case LinkFault::kUnguarded:
      return "guardian ended";
  }
  return "unknown";
}

/// What a link has been through since the device was made.
struct LinkHealth {
  std::array<uint64_t, kLinkFaults> faults{};  ///< by LinkFault; kNone: exchanges that went well
  LinkFault last_fault = LinkFault::kNone;
  uint64_t late_replies = 0;  ///< came too late for their tick, and served the next one
  /// From giving a packet to the link to its answer; 0 when nothing is measured.
  int64_t round_trip_median_ns = 0;
  int64_t round_trip_p99_ns = 0;
  int64_t round_trip_max_ns = 0;

  /// All faults but time-outs.
  uint64_t errors() const noexcept {
    uint64_t sum = 0;
    for (size_t i = 2; i < kLinkFaults; ++i) sum += faults[i];
    return sum;
  }
  uint64_t count(LinkFault fault) const noexcept { return faults[static_cast<size_t>(fault)]; }
};

}  // namespace spidar
