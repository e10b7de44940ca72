// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The haptic trace: a CSV file with one row a tick.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "core/api.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// A trace that cannot be begun; names path and reason.
struct TraceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How far a trace has come.
struct TraceStatus {
  uint64_t rows = 0;       ///< handed to the operating system
  uint64_t lost_rows = 0;  ///< ticks that are missing
  /// errno of the write that failed and ended the trace; 0 while all is well.
  int error = 0;
};

/// Names of the columns, SI units at their ends, joined by commas; no line end.
SPIDAR_API std::string trace_header();

/// `record` as a row with line end, in the order of trace_header(). Numbers in the "C" locale, as
/// short as they can be read back exactly. A frame_ns of INT64_MIN, which is none, becomes −1.
SPIDAR_API void append_row(const TickRecord& record, std::string& csv);

/// The file. Rows are collected and written by flush(). One thread at a time.
class SPIDAR_API TickTrace {
 public:
  /// Creates or empties the file. Throws TraceError.
  explicit TickTrace(const std::string& path);
  /// flush()
  ~TickTrace();
  TickTrace(const TickTrace&) = delete;
  TickTrace& operator=(const TickTrace&) = delete;

  void add(const TickRecord& record) noexcept;

  /// A failure ends the trace: what comes later is counted as lost.
  void flush() noexcept;

  const TraceStatus& status() const noexcept { return status_; }

 private:
  int file_;
  std::string pending_;
  uint64_t pending_rows_ = 0;
  uint64_t last_tick_ = 0;
  TraceStatus status_;
};

}  // namespace spidar
