// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// One line a frame, for those who want to look at it later.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "plugin/filter/frame/frame_report.h"

namespace spidar {

/// Where the name ends in .csv, CSV with a header line; in .jsonl, what json_line() gives, with
/// objects and background; numbers are written without regard to the locale, with the digits that
/// reading them back needs.
class FrameTrace {
 public:
  ~FrameTrace() { close(); }

  /// Empty string, or the reason why the file cannot be written.
  std::string open(const std::string& path);
  bool is_open() const { return file_ != nullptr; }

  /// False when the disk is full or gone: the trace is closed then.
  bool write(const FrameReport& report);

  /// False when the last rows could not be written.
  bool close();

 private:
  bool put();
  void append_csv(const FrameReport& report);

  std::FILE* file_ = nullptr;
  bool is_json_ = false;
  std::string line_;  ///< of the frame before: its memory is used again
};

}  // namespace spidar
