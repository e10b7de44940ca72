// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "core/fields.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/tick_record.h"
#include "spidar/realtime/line_writer.h"

namespace spidar {

/// Passes the columns of the haptic trace, with the values of `record`, to `to`. A frame_ns of
/// INT64_MIN, which means no frame, becomes −1.
void tick_fields(const TickRecord& record, FieldSink& to);

/// Names of the columns, ending in their SI units, separated by commas, without a line end.
std::string trace_header();

/// Appends `record` as a row with a line end, in the order of trace_header(). Numbers are in the
/// "C" locale, with the fewest digits that restore their exact values.
void append_row(const TickRecord& record, std::string& csv);

/// The haptic trace: a CSV file with one row for each tick. Used by one thread at a time, which
/// does not wait for the file (LineWriter).
class TickTrace {
 public:
  /// Creates or empties the file. Throws std::runtime_error with path and reason.
  explicit TickTrace(const std::string& path);

  void add(const TickRecord& record) noexcept;

  /// Returns when all rows are written, or the other end of the file stands still.
  void flush() noexcept;

  /// The status of the rows. Missing ticks count as dropped, as do all rows after a failure, which
  /// ends the trace.
  LineWriter::Status status() const noexcept;

 private:
  LineWriter file_;
  std::string row_;  ///< a member so that its memory is reused
  uint64_t last_tick_ = 0;
  uint64_t missing_ticks_ = 0;
};

/// Reads the records of a loop every LineWriter::kPeriod, for a pipe every ms. The loop can store
/// more than four seconds of them.
class TraceThread {
 public:
  /// Throws std::runtime_error when the file cannot be written. `loop` must outlive this object.
  /// Unless `threaded`, records are only read by drain() and at the end.
  TraceThread(const std::string& path, HapticLoop& loop, bool threaded);
  ~TraceThread();

  /// Writes all records so far, as far as the file accepts them.
  void drain() noexcept;

  /// The status when records were last taken. Does not wait for the file.
  LineWriter::Status status() const noexcept;

 private:
  void run(bool is_file) noexcept;
  void take_records() noexcept;
  void note_status() noexcept;

  HapticLoop& loop_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  TickTrace trace_;
  mutable std::mutex status_mutex_;
  LineWriter::Status status_;
  std::thread thread_;
};

}  // namespace spidar
