// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

namespace spidar {

/// Writes lines to a file, a pipe or a device whose other end may stop accepting them: a stopped
/// reader, or a network folder. A thread of its own writes, so that the caller does not
/// wait. Lines that the other end does not accept are dropped as a whole, and counted. A slow
/// reader loses nothing. Even when the process is killed, the last line of the output is complete,
/// and lines that were added more than kPeriod ago are there.
///
/// One thread at a time calls the methods.
class LineWriter {
 public:
  static constexpr std::chrono::milliseconds kPeriod{50};
  /// The most data that may wait: ten seconds of a haptic trace, which has 0.4 MB a second.
  static constexpr size_t kMaxWaiting_bytes = size_t{4} << 20;
  /// The other end stands still when it has taken nothing for this time.
  static constexpr std::chrono::milliseconds kStandstill{500};
  /// The longest wait of a call for a slow other end.
  static constexpr std::chrono::milliseconds kLongestWait{5000};

  struct Status {
    uint64_t lines = 0;    ///< handed to the operating system
    uint64_t dropped = 0;  ///< not taken, or after an error
    uint64_t waiting = 0;  ///< not taken yet
    int error = 0;         ///< errno of the write that failed and ended the output; 0: none
  };

  LineWriter() = default;
  ~LineWriter() { close(); }
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// Opens `path` as open_own_output() does; a pipe that nobody reads is an error. Returns an empty
  /// text, or why the file cannot be written.
  std::string open(const std::string& path, std::string_view begin);
  bool is_open() const { return output_ != nullptr; }

  /// Adds whole lines, each with its line end. Waits only if more than kMaxWaiting_bytes wait, and
  /// once for each standstill.
  void add(std::string_view lines);
  /// Returns when all lines are written, or the other end stands still.
  void flush();
  /// Calls flush(), and drops lines that have not been taken by then. If the thread is blocked in
  /// the system, it is detached and ends later.
  Status close();

  /// The counts so far; after close(), those at close().
  Status status() const;

 private:
  struct Output;

  bool is_stuck();
  template <typename Condition>
  void await(Condition condition);

  std::shared_ptr<Output> output_;
  std::thread thread_;
  Status last_;  ///< status of the closed output
  bool stuck_ = false;
  uint64_t stuck_at_ = 0;  ///< bytes written when the other end got stuck
};

}  // namespace spidar
