// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
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

/// The output of `spidartrack record` about a batch of films. Prints a line for each film when it
/// is done, and at the end how many were recorded. A terminal has a line below with the films in
/// progress and the time that is left; elsewhere, this line is printed every ten seconds. The time
/// is estimated from the sizes of the files. Any thread.
class RecordReport {
 public:
  explicit RecordReport(std::vector<std::string> films);
  ~RecordReport() { erase(); }
  RecordReport(const RecordReport&) = delete;
  RecordReport& operator=(const RecordReport&) = delete;

  enum class Result { kRecorded, kThere, kTwice, kError };

  void progress(size_t film, int percent);
  void done(size_t film, Result result, const std::string& text);
  /// Prints a remark on a film that is not done.
  void note(size_t film, const std::string& text);

  /// Prints a remark on all films.
  void print(const std::string& text);

  /// Prints the summary, unless there was only one film. Returns whether no film failed.
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
  std::chrono::steady_clock::time_point reported_ = begin_;
  std::vector<double> sizes_;      ///< in bytes, at least 1
  double work_ = 0, skipped_ = 0;  ///< bytes of recorded films; of other films that are done
  std::map<size_t, int> in_work_;  ///< film and percent
  std::array<size_t, 4> count_{};  ///< by result
  std::vector<std::pair<size_t, std::string>> failures_;
};

}  // namespace spidar::tools
