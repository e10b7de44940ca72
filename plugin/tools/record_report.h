// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The output of `spidartrack record` about a batch of films.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace spidar::tools {

/// Prints a line for each film when it is done, and at the end how many were recorded. A terminal
/// has a line below with the films that are being recorded and the time that is left; elsewhere, it
/// is printed once in ten seconds. The time is estimated by the sizes of the files. The functions
/// can be called from any thread.
class RecordReport {
 public:
  explicit RecordReport(std::vector<std::string> films);
  ~RecordReport() { erase(); }
  RecordReport(const RecordReport&) = delete;
  RecordReport& operator=(const RecordReport&) = delete;

  enum class Result { kRecorded, kThere, kTwice, kError };

  void progress(size_t film, int percent);
  void done(size_t film, Result result, const std::string& text);
  /// Something else about a film that is not done.
  void note(size_t film, const std::string& text);

  /// Something about all of them.
  void print(const std::string& text);

  /// Prints the summary, unless it was for one film. Returns whether no film failed.
  bool finish();

 private:
  void print(std::ostream& out, size_t film, const std::string& text);
  std::string in_work() const;
  std::string time_left() const;
  void draw() const;
  void erase() const;

  const std::vector<std::string> films_;
  const bool is_terminal_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::chrono::steady_clock::time_point told_ = begin_;
  std::vector<double> sizes_;      ///< of the films, in bytes, at least 1
  double work_ = 0, skipped_ = 0;  ///< bytes of films that were recorded; of others done
  std::map<size_t, int> in_work_;  ///< film and percent
  std::array<size_t, 4> count_{};  ///< of each result
  std::vector<std::pair<size_t, std::string>> failures_;
};

}  // namespace spidar::tools
