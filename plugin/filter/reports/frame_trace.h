// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// One line a frame, for those who want to look at it later.
#pragma once

#include <cstdint>
#include <string>

#include "plugin/frame/frame_report.h"
#include "spidar/realtime/line_writer.h"

namespace spidar::filter {

/// Where the name ends in .csv, CSV with a header line; in .jsonl, what json_line() gives, with
/// objects and background; numbers are written without regard to the locale, with the digits that
/// reading them back needs.
class FrameTrace {
 public:
  /// Empty string, or the reason why the file cannot be written.
  std::string open(const std::string& path);

  /// Does not wait for the file. errno of the write that ended the trace; 0 if none did.
  int write(const FrameReport& report);

  /// Writes the last rows, as far as they are taken.
  LineWriter::Status close() { return file_.close(); }

 private:
  void append_csv(const FrameReport& report);

  LineWriter file_;
  bool is_json_ = false;
  std::string line_;  ///< of the frame before: its memory is used again
};

}  // namespace spidar::filter
