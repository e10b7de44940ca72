// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <sys/ioctl.h>
#include <unistd.h>

namespace spidar::tools {
namespace {

constexpr std::chrono::seconds kReportInterval{10};
/// An estimate from less work is too uncertain.
constexpr double kMinWork_s = 2;

/// Replaces control characters: a name may contain line breaks or terminal escape sequences.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return text;
}

size_t width_of_terminal() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col : 80;
}

/// Shortens UTF-8 to at most `bytes`, without splitting a character.
std::string shortened(std::string text, size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  text.resize(bytes);
  return text;
}

}  // namespace

RecordReport::RecordReport(std::vector<std::string> films)
    : films_(std::move(films)), is_terminal_(isatty(STDOUT_FILENO) != 0) {
  for (const std::string& film : films_) {
    std::error_code unknown;
    const auto bytes = std::filesystem::file_size(film, unknown);
    sizes_.push_back(unknown ? 1 : static_cast<double>(std::max<std::uintmax_t>(bytes, 1)));
  }
}

void RecordReport::progress(size_t film, int percent) {
  const std::lock_guard<std::mutex> lock(mutex_);
  in_work_[film] = percent;
  erase();
  draw();
  const auto now = std::chrono::steady_clock::now();
  if (is_terminal_ || now - reported_ < kReportInterval) return;
  reported_ = now;
  std::cout << in_work() << std::endl;
}

void RecordReport::done(size_t film, Result result, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++count_[static_cast<size_t>(result)];
  (in_work_.erase(film) > 0 ? work_ : skipped_) += sizes_[film];
  const bool failed = result == Result::kError;
  if (failed) failures_.emplace_back(film, text);
  print(failed ? std::cerr : std::cout, film, failed ? "failed: " + text : text);
}

void RecordReport::note(size_t film, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  print(std::cout, film, text);
}

void RecordReport::print(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  erase();
  std::cout << one_line(text) << std::endl;
  draw();
}

bool RecordReport::finish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (films_.size() > 1) {
    const auto [recorded, there, twice, failed] = count_;
    std::cout << recorded << " recorded, " << there << " there, "
              << (twice > 0 ? std::to_string(twice) + " given twice, " : "") << failed << " failed"
              << (failed == 0 ? "" : ":") << '\n';
    for (const auto& [film, cause] : failures_) {
      std::cout << "  " << one_line(films_[film]) << ": " << one_line(cause) << '\n';
    }
    std::cout << std::flush;
  }
  return failures_.empty();
}

void RecordReport::print(std::ostream& out, size_t film, const std::string& text) {
  erase();
  out << '[' << film + 1 << '/' << films_.size() << "] " << one_line(films_[film]) << ": "
      << one_line(text) << std::endl;
  draw();
}

std::string RecordReport::in_work() const {
  const size_t done = std::accumulate(count_.begin(), count_.end(), size_t{0});
  std::string line = std::to_string(done) + " of " + std::to_string(films_.size()) + " done";
  for (const auto& [film, percent] : in_work_) {
    const std::string& name = films_[film];
    line +=
        "; " + one_line(name.substr(name.rfind('/') + 1)) + " " + std::to_string(percent) + " %";
  }
  return line + time_left();
}

/// Extrapolates the work so far; empty as long as that is unknown.
std::string RecordReport::time_left() const {
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin_;
  double done = work_;
  for (const auto& [film, percent] : in_work_) done += sizes_[film] * percent / 100;
  if (taken.count() < kMinWork_s || done <= 0) return {};
  const double all = std::accumulate(sizes_.begin(), sizes_.end(), -skipped_);
  const long left_s = std::lround(taken.count() * std::max(0.0, all - done) / done);
  constexpr long kMinute_s = 60;
  const std::string seconds = std::to_string(left_s % kMinute_s) + " s left";
  return "; about " + (left_s < kMinute_s ? "" : std::to_string(left_s / kMinute_s) + " min ") +
         seconds;
}

void RecordReport::draw() const {
  if (!is_terminal_ || in_work_.empty()) return;
  std::cout << shortened(in_work(), width_of_terminal() - 1) << std::flush;
}

void RecordReport::erase() const {
  if (is_terminal_) std::cout << "\r\033[K" << std::flush;
}

}  // namespace spidar::tools
