// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Emulated boards, which answer as their published descriptions say, and the transport to them.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "core/grip/string_geometry.h"
#include "spidar/device.h"
#include "spidar/transports/bytes.h"
#include "spidar/transports/ftdi.h"
#include "spidar/transports/transport.h"

namespace spidar::emulated {

/// The device behind an emulated board. This base class has neither motors nor encoders.
class Motors {
 public:
  virtual ~Motors() = default;
  /// Called when the board has set the D/A converters to these digits.
  virtual void set_outputs(const std::array<int, kMaxStrings>&) noexcept {}
  /// Returns counts as the host should receive them.
  virtual std::array<int32_t, kMaxStrings> counts() noexcept { return {}; }
  /// Returns 16 inputs; bits 4–7 are the rotary ID switch.
  virtual uint16_t inputs() noexcept { return 0; }
};

/// The state of a device that outlives programs. Initially as after plugging in.
struct Memory {
  std::atomic<bool> loaded{false};  ///< whether the firmware is loaded
  std::atomic<uint16_t> baud{0};    ///< divisor
};

/// A board without its wire, and the motors that it drives. Not thread-safe.
class Board {
 public:
  explicit Board(std::shared_ptr<Motors> motors) : motors_(std::move(motors)) {}
  virtual ~Board() = default;
  /// Receives bytes from the host: one packet, or any piece of a stream.
  virtual void receive(ByteView bytes) noexcept = 0;
  /// Writes the next due reply and returns its length; 0 if none or if `bytes` is too small.
  virtual size_t reply(MutableBytes bytes) noexcept = 0;
  /// Starts with the given memory and keeps its state there; the memory must outlive the board.
  /// Without a memory, the board starts as one that was used before.
  virtual void remember(Memory&) noexcept {}
  /// Handles a vendor request; returns false if the board does not know the request.
  virtual bool control(const VendorRequest&) noexcept { return false; }

 protected:
  std::shared_ptr<Motors> motors_;
};

/// Writes `packet` if it is due, and returns its length; 0 otherwise, or if `bytes` is too small.
inline size_t copy_out(ByteView packet, MutableBytes bytes, bool& due) noexcept {
  if (!due || bytes.size < packet.size) return 0;
  due = false;
  std::copy_n(packet.data, packet.size, bytes.data);
  return packet.size;
}

/// The transport to an emulated board. No time passes: a reply is available at once or not at all.
class Transport final : public spidar::Transport {
 public:
  /// `fault` is the result of every exchange. With kStall and kGone packets do not arrive; kBabble,
  /// kShort and kWrongReply spoil the reply.
  explicit Transport(std::unique_ptr<Board> board,
                     std::shared_ptr<const std::atomic<LinkFault>> fault =
                         std::make_shared<std::atomic<LinkFault>>(LinkFault::kNone))
      : board_(std::move(board)), fault_(std::move(fault)) {}

  void open() override {
    if (*fault_ == LinkFault::kGone) throw DeviceError("emulated board: not plugged in");
    // A real interface, too, stays claimed until it is closed.
    if (open_) throw DeviceError("emulated board: in use");
    open_ = true;
  }
  Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t) noexcept override {
    const LinkFault fault = fault_->load(std::memory_order_relaxed);
    // A device that was pulled out must be opened again.
    if (fault == LinkFault::kGone) open_ = false;
    if (!open_) return {LinkFault::kGone, 0};
    if (fault == LinkFault::kStall) return {fault, 0};
    for (const ByteView packet : packets) board_->receive(packet);
    if (reply.size == 0) return {};
    const size_t received = board_->reply(reply);
    switch (fault) {
      case LinkFault::kNone:
        break;
      case LinkFault::kShort:
        return {fault, received / 2};
      case LinkFault::kWrongReply:
        for (size_t i = 0; i < received; ++i) reply.data[i] ^= 0xA5;
        return {LinkFault::kNone, received};
      default:
        return {fault, 0};
    }
    if (received == 0) return {LinkFault::kTimeout, 0};
    return {received < reply.size ? LinkFault::kShort : LinkFault::kNone, received};
  }
  LinkFault control(const VendorRequest& request, int64_t) noexcept override {
    const LinkFault fault = fault_->load(std::memory_order_relaxed);
    if (fault == LinkFault::kGone) open_ = false;
    if (!open_) return LinkFault::kGone;
    if (fault == LinkFault::kStall || fault == LinkFault::kTimeout) return fault;
    return board_->control(request) ? LinkFault::kNone : LinkFault::kStall;
  }
  void recover() noexcept override { drop_stale_data(0); }
  std::optional<LastWill> last_will() const override { return std::nullopt; }
  void close() noexcept override { open_ = false; }

 private:
  StaleData drop_stale_data(int64_t) noexcept override {
    std::array<uint8_t, 512> old{};
    StaleData result = StaleData::kNone;
    while (board_->reply(old) > 0) result = StaleData::kDropped;
    return result;
  }

  const std::unique_ptr<Board> board_;
  const std::shared_ptr<const std::atomic<LinkFault>> fault_;
  bool open_ = false;
};

}  // namespace spidar::emulated
