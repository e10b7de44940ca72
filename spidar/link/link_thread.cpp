// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/link/link_thread.h"

#include <algorithm>
#include <cerrno>
#include <type_traits>
#include <utility>

#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar::boards {
namespace {

/// A single fault on the wire may concern only one packet; several in a row do not.
constexpr int kErrorsToRecover = 3;

/// A stall lasts until it is cleared, and a late reply would be mistaken for the next one.
bool needs_recovery(LinkFault fault) noexcept {
  return fault == LinkFault::kStall || fault == LinkFault::kTimeout;
}

bool wait_until(sem_t& semaphore, int64_t monotonic_ns) noexcept {
  const timespec until = to_timespec(monotonic_ns);
  while (sem_clockwait(&semaphore, CLOCK_MONOTONIC, &until) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

template <typename BoardType>
std::vector<std::unique_ptr<BoardType>> one(std::unique_ptr<BoardType> board) {
  std::vector<std::unique_ptr<BoardType>> boards;
  boards.push_back(std::move(board));
  return boards;
}

}  // namespace

template <typename BoardType>
LinkThread<BoardType>::LinkThread(std::vector<std::unique_ptr<BoardType>> boards,
                                  std::function<BoardType&()> open, const Settings& settings)
    : LinkThread::DeviceOf(boards.front()->name()),
      boards_(std::move(boards)),
      open_board_(std::move(open)),
      board_(boards_.front().get()),
      settings_(settings) {
  sem_init(&requested_, 0, 0);
  sem_init(&replied_, 0, 0);
}

template <typename BoardType>
LinkThread<BoardType>::LinkThread(std::unique_ptr<BoardType> board, const Settings& settings)
    : LinkThread(one(std::move(board)), {}, settings) {}

template <typename BoardType>
LinkThread<BoardType>::~LinkThread() {
  close();
  sem_destroy(&requested_);
  sem_destroy(&replied_);
}

template <typename BoardType>
void LinkThread<BoardType>::open() {
  close();
  if (open_board_) board_ = &open_board_();
  try {
    if (!open_board_) board_->open();
    if (settings_.guardian) {
      for (const LastWill& will : board_->last_wills()) {
        guardians_.push_back(std::make_unique<Guardian>(board_->name(), will));
      }
    }
    zero_counts();
    last_ = {};
    errors_in_a_row_ = 0;
    pulling_ = false;
    unguarded_ = LinkFault::kNone;
    if (settings_.threaded) start();
  } catch (...) {
    guardians_.clear();
    board_->close();
    throw;
  }
  open_ = true;
}

template <typename BoardType>
void LinkThread<BoardType>::zero_counts() {
  if constexpr (std::is_base_of_v<Board, BoardType>) {
    if (settings_.count_zero != CountZero::kNever && !zeroed_) board_->counts().zero();
    zeroed_ = true;
    if (!board_->counts().restarted()) return;
    count(LinkFault::kCounterJump);
    throw DeviceError(board_->name() +
                      ": was without power, its counters do not say any more where the grip is: "
                      "hold the grip at the centre, and stop and start again");
  }
}

template <typename BoardType>
void LinkThread<BoardType>::start() {
  stop_ = false;
  thread_ = start_thread("spidar-link", [this] {
    request_exact_timers();
    request_real_time();
    run();
  });
}

template <typename BoardType>
void LinkThread<BoardType>::stop() noexcept {
  if (!thread_.joinable()) return;
  stop_ = true;
  sem_post(&requested_);
  // Transfers are cancelled at their deadline, and the kernel ends a request to clear a stalled
  // pipe after 5 s. Meanwhile the guardian gets no heartbeat and sets the motors to zero.
  thread_.join();
  Request request;
  Reply reply;
  while (requests_.pop(request)) {
  }
  while (replies_.pop(reply)) {
  }
  while (sem_trywait(&requested_) == 0) {
  }
  while (sem_trywait(&replied_) == 0) {
  }
}

template <typename BoardType>
void LinkThread<BoardType>::run() noexcept {
  while (!stop_) {
    if (sem_wait(&requested_) != 0) continue;
    Request request;
    if (stop_ || !requests_.pop(request)) continue;
    const Reply reply = handle_request(request);
    // The capacity of the queue is one reply more than there can be requests.
    replies_.push(reply);
    sem_post(&replied_);
  }
}

/// Returns false when a connection has lost its guardian.
template <typename BoardType>
bool LinkThread<BoardType>::guarded(bool pulling) noexcept {
  bool all = true;
  for (const auto& guardian : guardians_) all &= guardian->watch(pulling);
  return all;
}

template <typename BoardType>
LinkFault LinkThread<BoardType>::why_unguarded() const noexcept {
  const bool still = std::any_of(guardians_.begin(), guardians_.end(),
                                 [](const auto& guardian) { return guardian->was_suspended(); });
  return still ? LinkFault::kSuspended : LinkFault::kUnguarded;
}

template <typename BoardType>
typename LinkThread<BoardType>::Reply LinkThread<BoardType>::handle_request(
    const Request& request) noexcept {
  Reply reply;
  reply.number = request.number;
  reply.fault = unguarded_;
  if (unguarded_ != LinkFault::kNone) return reply;
  reply.fault = LinkFault::kUnguarded;
  const bool pulling = pulls(request.output);
  pulling_ |= pulling;
  if (guarded(pulling_)) exchange_now(request, reply);
  if (reply.fault == LinkFault::kNone) pulling_ = pulling;
  // Check again after the exchange: this process may have been stopped, and may have sent the
  // output after a guardian had sent zeros.
  if (guarded(pulling_)) return reply;
  unguarded_ = reply.fault = why_unguarded();
  send_zeros();
  count(unguarded_);
  return reply;
}

template <typename BoardType>
void LinkThread<BoardType>::exchange_now(const Request& request, Reply& reply) noexcept {
  const int64_t begin_ns = monotonic_now_ns();
  reply.fault = board_->cycle(request.output, reply.reading, begin_ns + kTransfer_ns);
  count(reply.fault);
  if (reply.fault == LinkFault::kNone) {
    const int64_t took_ns = monotonic_now_ns() - begin_ns;
    round_trip_.add(took_ns);
    // Board and bus take about as long before the reading as after it.
    reply.reading.read_ns = begin_ns + took_ns / 2;
    errors_in_a_row_ = 0;
  } else if (reply.fault != LinkFault::kGone &&
             (needs_recovery(reply.fault) || ++errors_in_a_row_ % kErrorsToRecover == 0)) {
    board_->recover();
  }
}

template <typename BoardType>
void LinkThread<BoardType>::count(LinkFault fault) noexcept {
  faults_[static_cast<size_t>(fault)].fetch_add(1, std::memory_order_relaxed);
  if (fault != LinkFault::kNone) last_fault_.store(fault, std::memory_order_relaxed);
}

template <typename BoardType>
LinkFault LinkThread<BoardType>::exchange(const Output& output, Reading& reading) noexcept {
  if (!open_) return LinkFault::kGone;
  last_ = output;
  const Request request{++number_, output};
  const std::optional<Reply> reply =
      settings_.threaded ? exchange_in_thread(request) : handle_request(request);
  if (!reply) return LinkFault::kTimeout;
  if (reply->fault == LinkFault::kNone) reading = reply->reading;
  return reply->fault;
}

/// Hands the request to the thread that exchanges, and waits for the reply, up to kReplyWait_ns.
/// Replies to earlier requests may come first. Returns the newest reply with a reading; when there
/// is none, the newest with a fault, or nothing.
template <typename BoardType>
std::optional<typename LinkThread<BoardType>::Reply> LinkThread<BoardType>::exchange_in_thread(
    const Request& request) noexcept {
  // A full queue means that the board has not answered for some time; this output is dropped.
  if (requests_.push(request)) sem_post(&requested_);
  const int64_t until_ns = monotonic_now_ns() + kReplyWait_ns;
  std::optional<Reply> best;
  do {
    for (Reply reply; replies_.pop(reply);) {
      if (!best || reply.fault == LinkFault::kNone || best->fault != LinkFault::kNone) best = reply;
      if (reply.number == request.number) return best;
      late_.fetch_add(1, std::memory_order_relaxed);
    }
  } while (wait_until(replied_, until_ns));
  return best;
}

template <typename BoardType>
bool LinkThread<BoardType>::ramp_to_zero() noexcept {
  // After a guardian has set the outputs to zero, the ramp must not raise them again.
  const Output from = unguarded_ == LinkFault::kNone ? last_ : Output{};
  Reading reading;
  for (int left = pulls(from) ? kRamp_ms - 1 : 0; left > 0; --left) {
    const int64_t now_ns = monotonic_now_ns();
    // If one of several lines is dead, the others must still ramp down.
    board_->cycle(scaled(from, 1.0 * left / kRamp_ms), reading, now_ns + kTransfer_ns);
    if (settings_.threaded) sleep_until_ns(now_ns + kSecond_ns / 1000);
  }
  return send_zeros();
}

template <typename BoardType>
bool LinkThread<BoardType>::send_zeros() noexcept {
  Reading reading;
  for (int attempt = 0; attempt < kErrorsToRecover; ++attempt) {
    const LinkFault fault = board_->cycle({}, reading, monotonic_now_ns() + kTransfer_ns);
    // After a counter jump, a wrong reply or surplus data, the board has received the output.
    if (fault == LinkFault::kNone || fault == LinkFault::kCounterJump ||
        fault == LinkFault::kWrongReply || fault == LinkFault::kBabble) {
      return true;
    }
    if (fault == LinkFault::kGone) break;
    board_->recover();
  }
  return false;
}

template <typename BoardType>
void LinkThread<BoardType>::close() noexcept {
  if (!open_) return;
  open_ = false;
  stop();
  const bool zero = ramp_to_zero();
  if (unguarded_ != LinkFault::kNone) board_->expect_reopening();
  board_->close();
  // The guardians keep trying for a while, and stop at once when the board is gone.
  if (!zero) {
    for (const auto& guardian : guardians_) guardian->carry_out();
  }
  guardians_.clear();
}

template <typename BoardType>
LinkHealth LinkThread<BoardType>::health() const noexcept {
  LinkHealth health;
  for (size_t i = 0; i < kLinkFaults; ++i) {
    health.faults[i] = faults_[i].load(std::memory_order_relaxed);
  }
  health.last_fault = last_fault_.load(std::memory_order_relaxed);
  health.late_replies = late_.load(std::memory_order_relaxed);
  health.round_trip_median_ns = round_trip_.quantile_ns(0.5);
  health.round_trip_p99_ns = round_trip_.quantile_ns(0.99);
  health.round_trip_max_ns = round_trip_.max_ns();
  return health;
}

template class LinkThread<Board>;
template class LinkThread<ForceBoard>;

}  // namespace spidar::boards
