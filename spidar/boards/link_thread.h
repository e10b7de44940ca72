// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What all boards share while they are open: the thread of their link, their guardians, and the
/// ramp to zero.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <semaphore.h>
#include <string>
#include <thread>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/device.h"
#include "spidar/guardian/guardian.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/realtime/spsc_ring.h"

namespace spidar {

/// A separate thread makes the exchanges, because libusb and the kernel may take locks, allocate
/// memory and need any amount of time. The haptic thread only waits for them, up to kReplyWait_ns.
/// A later reply is used in the next tick. Outputs that arrive during an exchange are queued, so
/// that the link never idles.
///
/// Motors pull only as long as every connection has its guardian. Without it, they are set to zero
/// at once, and the device is lost until it is opened again with a new guardian.
///
/// `Output` has a function pulls(output), whether it differs from rest, and scaled(output, share).
template <typename Output, typename Reading>
class LinkThread {
 public:
  /// Share of a tick of 1 ms; the loop uses the rest.
  static constexpr int64_t kReplyWait_ns = 700'000;
  /// Time after which an exchange counts as failed.
  static constexpr int64_t kTransfer_ns = 5'000'000;
  /// Duration of the ramp to zero in close(), in milliseconds, if the outputs are not at zero
  /// before.
  static constexpr int kRamp_ms = 20;

  /// `board` outlives the link. Of the settings, those of the guardian and the thread are used.
  LinkThread(BoardOf<Output, Reading>& board, const BoardSettings& settings);
  ~LinkThread();

  /// `prepare` is called with the open board, under guard, before the first exchange. Throws
  /// DeviceError, and what it throws.
  void open(const std::function<void()>& prepare = {});
  /// See Device.
  ExchangeStatus exchange(const Output& output, Reading& reading) noexcept;
  /// Ramps to zero, then releases the board. Takes kRamp_ms, or longer if the board does not
  /// answer.
  void close() noexcept;
  std::string description() const { return open_ ? board_.description() : ""; }
  LinkHealth health() const noexcept;
  /// Adds a fault to the statistics.
  void count(LinkFault fault) noexcept;

 private:
  struct Request {
    uint32_t number = 0;
    Output output;
  };
  struct Reply {
    uint32_t number = 0;
    LinkFault fault = LinkFault::kNone;
    Reading reading;
  };

  void start();
  void stop() noexcept;
  void run() noexcept;
  std::optional<Reply> ask(const Request& request) noexcept;
  Reply answer(const Request& request) noexcept;
  void exchange_now(const Request& request, Reply& reply) noexcept;
  bool guarded(bool pulling) noexcept;
  LinkFault why_unguarded() const noexcept;
  /// Both return true if the motors have received their zeros; bring_to_zero() uses a ramp.
  bool put_out_zero() noexcept;
  bool bring_to_zero() noexcept;

  BoardOf<Output, Reading>& board_;
  const BoardSettings settings_;
  std::vector<std::unique_ptr<Guardian>> guardians_;
  bool open_ = false;
  Output last_;
  uint32_t number_ = 0;
  // Used by the thread that exchanges.
  int errors_in_a_row_ = 0;
  bool pulling_ = false;  // the output of the board may differ from zero
  // Not kNone: a guardian failed, or zeroed the motors, which stay at zero until open().
  LinkFault unguarded_ = LinkFault::kNone;

  std::thread thread_;
  std::atomic<bool> stop_{false};
  SpscRing<Request, 2> requests_;
  SpscRing<Reply, 4> replies_;
  sem_t requested_{};
  sem_t replied_{};

  // Written by the thread that exchanges, or by whoever calls exchange(): never both at a time.
  std::array<std::atomic<uint64_t>, kLinkFaults> faults_{};
  std::atomic<LinkFault> last_fault_{LinkFault::kNone};
  std::atomic<uint64_t> late_{0};
  LatencyHistogram round_trip_;
};

/// Decides when the counts are set to zero, and leaves all else to the link.
class BoardDevice final : public Device {
 public:
  using Link = LinkThread<MotorVolts, DeviceReading>;
  static constexpr int64_t kReplyWait_ns = Link::kReplyWait_ns;
  static constexpr int64_t kTransfer_ns = Link::kTransfer_ns;
  static constexpr int kRamp_ms = Link::kRamp_ms;

  /// CountZero::kByProfile is for make_device(); here it means kFirstOpen.
  BoardDevice(std::unique_ptr<Board> board, const BoardSettings& settings);

  void open() override;
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    return link_.exchange(volts, reading);
  }
  void close() noexcept override { link_.close(); }
  std::string description() const override { return link_.description(); }
  const std::string& name() const noexcept override { return board_->name(); }
  LinkHealth health() const noexcept override { return link_.health(); }

 private:
  const std::unique_ptr<Board> board_;
  const CountZero count_zero_;
  bool zeroed_ = false;  // the counts have been zeroed once
  Link link_;
};

}  // namespace spidar
