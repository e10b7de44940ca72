// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A board as the haptic loop sees it.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <semaphore.h>
#include <thread>
#include <vector>

#include "core/api.h"
#include "spidar/boards/board.h"
#include "spidar/boards/board_settings.h"
#include "spidar/device.h"
#include "spidar/guardian/guardian.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/realtime/spsc_ring.h"

namespace spidar {

/// Exchanges are made by a thread of their own, for they go through libusb and the kernel, which
/// take locks, memory and time as they like; the haptic thread only waits for them, up to
/// kReplyWait_ns. A reply that comes later serves the next tick. Volts that are given while an
/// exchange is under way are queued, so that the link never idles.
///
/// Motors pull only as long as every connection has its guardian: without one they are taken to
/// zero at once, and the device is lost until it is opened again, with a new guardian.
class SPIDAR_API BoardDevice final : public Device {
 public:
  /// Of a tick of 1 ms; the rest is for the loop.
  static constexpr int64_t kReplyWait_ns = 700'000;
  /// A board that takes longer has failed.
  static constexpr int64_t kTransfer_ns = 5'000'000;
  /// close() takes the volts down in so many milliseconds, when that was not done before.
  static constexpr int kRamp_ms = 20;

  /// CountZero::kByProfile is for make_device(), here it means kFirstOpen.
  BoardDevice(std::unique_ptr<Board> board, const BoardSettings& settings);
  ~BoardDevice() override;

  void open() override;
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override;
  /// Ramps to zero, then releases. Takes kRamp_ms, and longer when the board does not answer.
  void close() noexcept override;
  std::string description() const override { return open_ ? board_->description() : ""; }
  const std::string& name() const noexcept override { return board_->name(); }
  LinkHealth health() const noexcept override;

 private:
  struct Request {
    uint32_t number = 0;
    MotorVolts volts;
  };
  struct Reply {
    uint32_t number = 0;
    LinkFault fault = LinkFault::kNone;
    DeviceReading reading;
  };

  void start();
  void stop() noexcept;
  void run() noexcept;
  std::optional<Reply> ask(const Request& request) noexcept;
  Reply answer(const Request& request) noexcept;
  void exchange_now(const Request& request, Reply& reply) noexcept;
  bool guarded(bool pulling) noexcept;
  /// True when the motors have got their zero; bring_to_zero() by a ramp.
  bool put_out_zero() noexcept;
  bool bring_to_zero() noexcept;
  void count(LinkFault fault) noexcept;

  const std::unique_ptr<Board> board_;
  const BoardSettings settings_;
  std::vector<std::unique_ptr<Guardian>> guardians_;
  bool open_ = false;
  bool zeroed_ = false;  // counts, once
  MotorVolts last_;
  uint32_t number_ = 0;
  // Of the thread that exchanges.
  int errors_in_a_row_ = 0;
  bool pulling_ = false;    // the board may have other volts than zero
  bool unguarded_ = false;  // its motors are at zero until it is opened again

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

}  // namespace spidar
