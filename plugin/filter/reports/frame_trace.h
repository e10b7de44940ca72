// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A file with one line for each frame, to be looked at later.
#pragma once

#include <cstdint>
#include <string>

#include "core/fields.h"
#include "plugin/frame/frame_report.h"
#include "spidar/realtime/line_writer.h"

namespace spidar::filter {

/// One JSON object and a line end, with `background` and `objects`. Keys carry their units;
/// positions are pixels from the centre of the frame, x right, y down. Numbers have as few digits
/// as can be read back exactly. A number that is not finite becomes null, because JSON cannot
/// express it.
std::string json_line(const FrameReport& report);

/// Writes CSV with a header line where the name ends in .csv; where it ends in .jsonl, what
/// json_line() gives, with objects and background; numbers are written without regard to the
/// locale, with the digits that reading them back needs.
class FrameTrace {
 public:
  /// Returns an empty string, or the reason why the file cannot be written.
  std::string open(const std::string& path);

  /// Does not wait for the file. Returns errno of the write that ended the trace; 0 if none did.
  int write(const FrameReport& report);

  /// Writes the last rows, as far as they are taken.
  LineWriter::Status close() { return file_.close(); }

 private:
  void add_line(const FrameReport& report, CsvLine::Of of);

  LineWriter file_;
  bool is_json_ = false;
  std::string line_;  ///< of the previous frame; its memory is reused
};

}  // namespace spidar::filter
