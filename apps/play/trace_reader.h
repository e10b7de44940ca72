// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads one of the element's CSV traces while it is being written.
#pragma once

#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

/// The trace passes through a named pipe, because an hour at 1 kHz would take gigabytes on disk.
class TraceReader {
 public:
  /// Fields of one row in the order of the requested columns.
  using Fields = std::vector<std::string_view>;

  /// Creates the pipe `path` and waits for a writer in a thread of its own, which calls `on_row`
  /// for every row. A copy is written to the file `copy_path` unless that is empty. Throws
  /// std::runtime_error when pipe or copy cannot be created.
  TraceReader(std::string path, const std::string& copy_path, std::vector<std::string> columns,
              std::function<void(const Fields&)> on_row);
  ~TraceReader();

  /// Call this when the writer has closed the trace or never opened it: returns when everything has
  /// been read. Throws std::runtime_error when columns are missing or the copy failed.
  void finish();

 private:
  void read();
  void take_line(std::string_view line);

  const std::string path_;
  const std::string copy_path_;
  std::ofstream copy_;
  const std::vector<std::string> columns_;
  const std::function<void(const Fields&)> on_row_;
  std::vector<size_t> wanted_;  ///< indices of the columns; empty before the header
  std::vector<std::string_view> line_fields_;
  Fields fields_;
  std::string error_;
  int pipe_ = -1;
  int stop_[2] = {-1, -1};  ///< a pipe that ends the wait
  std::thread thread_;
};

/// A number of a trace; 0 for a field that is not a number.
double to_number(std::string_view field);
int64_t to_integer(std::string_view field);
