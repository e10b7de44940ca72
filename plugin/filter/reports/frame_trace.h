// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <string>

#include "core/fields.h"
#include "plugin/frame/frame_report.h"
#include "spidar/realtime/line_writer.h"

namespace spidar::filter {

/// Returns the report as one line of JSON with `background` and `objects`. Keys end in their units;
/// positions are in pixels from the centre of the frame, x right, y down. Numbers have the fewest
/// digits from which they can be read back exactly. A number that is not finite becomes null.
std::string json_line(const FrameReport& report);

/// A file with one line for each frame. If its name ends in .csv, the file is CSV with a header
/// line; if the name ends in .jsonl, each line is json_line(), with objects and background. Numbers
/// do not depend on the locale and have enough digits to be read back exactly.
class FrameTrace {
 public:
  /// Returns an empty string, or the reason why the file cannot be written.
  std::string open(const std::string& path);

  /// Writes without waiting. Returns errno of the write that ended the trace; 0 if none.
  int write(const FrameReport& report);

  /// Writes the last rows, as far as the file accepts them.
  LineWriter::Status close() { return file_.close(); }

 private:
  void add_line(const FrameReport& report, CsvLine::Of of);

  LineWriter file_;
  bool is_json_ = false;
  std::string line_;  ///< kept because its memory is reused
};

}  // namespace spidar::filter
