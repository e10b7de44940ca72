// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The common part of open boards: the thread that exchanges, the guardians, the ramp to zero.
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

#include "spidar/device.h"
#include "spidar/guardian/guardian.h"
#include "spidar/link/board.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/realtime/spsc_ring.h"

namespace spidar::boards {

/// A separate thread makes the exchanges, because libusb and the kernel may take locks, allocate
/// memory and need any amount of time. The haptic thread only waits for them, up to kReplyWait_ns.
/// A later reply is used in the next tick. Outputs that arrive during an exchange are queued, so
/// that the link never idles.
///
/// Motors pull only as long as every connection has its guardian. Without a guardian, the motors
/// are set to zero at once, and the device is lost until it is reopened with a new guardian.
///
/// The board's `Output` needs two functions: pulls(output), which returns whether the output
/// differs from rest, and scaled(output, fraction).
template <typename BoardType>
class LinkThread final : public DeviceOf<typename BoardType::Output, typename BoardType::Reading> {
 public:
  using Output = typename BoardType::Output;
  using Reading = typename BoardType::Reading;
  /// The longest wait for a reply in a tick of 1 ms; the loop uses the rest.
  static constexpr int64_t kReplyWait_ns = 700'000;
  static constexpr int64_t kTransfer_ns = 5'000'000;
  /// Duration of the ramp to zero in close(), in milliseconds, if the outputs are not yet zero.
  static constexpr int kRamp_ms = 20;

  /// Here, CountZero::kByProfile means kFirstOpen; make_grip() resolves it.
  LinkThread(std::unique_ptr<BoardType> board, const Settings& settings);
  /// For several boards, of which `open` opens and returns one; if `open` throws, none is open.
  LinkThread(std::vector<std::unique_ptr<BoardType>> boards, std::function<BoardType&()> open,
             const Settings& settings);
  ~LinkThread() override;

  void open() override;
  LinkFault exchange(const Output& output, Reading& reading) noexcept override;
  /// Ramps to zero, then releases the board, in kRamp_ms or longer if the board does not answer.
  void close() noexcept override;
  std::string description() const override { return open_ ? board_->description() : ""; }
  LinkHealth health() const noexcept override;
  /// The board that was opened last; the first board before any opening.
  const BoardType& board() const noexcept { return *board_; }

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

  void zero_counts();
  void count(LinkFault fault) noexcept;
  void start();
  void stop() noexcept;
  void run() noexcept;
  std::optional<Reply> exchange_in_thread(const Request& request) noexcept;
  Reply handle_request(const Request& request) noexcept;
  void exchange_now(const Request& request, Reply& reply) noexcept;
  bool guarded(bool pulling) noexcept;
  LinkFault why_unguarded() const noexcept;
  /// Both return true if the motors have received zeros; ramp_to_zero() ramps the outputs first.
  bool send_zeros() noexcept;
  bool ramp_to_zero() noexcept;

  const std::vector<std::unique_ptr<BoardType>> boards_;
  const std::function<BoardType&()> open_board_;
  BoardType* board_;  ///< the board that was opened last
  const Settings settings_;
  bool zeroed_ = false;  ///< whether the counts have been set to zero once
  std::vector<std::unique_ptr<Guardian>> guardians_;
  bool open_ = false;
  Output last_;
  uint32_t number_ = 0;
  // Only the thread that exchanges uses these members.
  int errors_in_a_row_ = 0;
  bool pulling_ = false;  ///< the output of the board may differ from zero
  // If not kNone, a guardian failed or this process was suspended; the motors rest until open().
  LinkFault unguarded_ = LinkFault::kNone;

  std::thread thread_;
  std::atomic<bool> stop_{false};
  SpscRing<Request, 2> requests_;
  SpscRing<Reply, 4> replies_;
  sem_t requested_{};
  sem_t replied_{};

  // Written by the thread that exchanges or by the caller of exchange(), never by both at a time.
  std::array<std::atomic<uint64_t>, kLinkFaults> faults_{};
  std::atomic<LinkFault> last_fault_{LinkFault::kNone};
  std::atomic<uint64_t> late_{0};
  LatencyHistogram round_trip_;
};

using StringLink = LinkThread<Board>;
using ForceLink = LinkThread<ForceBoard>;

}  // namespace spidar::boards
