// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/play/trace_reader.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

namespace {

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

template <typename T>
T parse(std::string_view field) {
  T value{};
  std::from_chars(field.data(), field.data() + field.size(), value);
  return value;
}

}  // namespace

double to_number(std::string_view field) {
  return parse<double>(field);
}
int64_t to_integer(std::string_view field) {
  return parse<int64_t>(field);
}

TraceReader::TraceReader(std::string path, const std::string& copy_path,
                         std::vector<std::string> columns,
                         std::function<void(const Fields&)> on_row)
    : path_(std::move(path)),
      copy_path_(copy_path),
      columns_(std::move(columns)),
      on_row_(std::move(on_row)),
      fields_(columns_.size()) {
  if (!copy_path_.empty()) {
    copy_.open(copy_path_);
    if (!copy_) throw std::runtime_error(copy_path_ + ": " + std::strerror(errno));
  }
  if (mkfifo(path_.c_str(), 0600) != 0) {
    throw std::runtime_error(path_ + ": " + std::strerror(errno));
  }
  // Non-blocking, because a writer may never come.
  pipe_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (pipe_ < 0 || pipe2(stop_, O_CLOEXEC) != 0) {
    throw std::runtime_error(path_ + ": " + std::strerror(errno));
  }
  thread_ = std::thread([this] { read(); });
}

TraceReader::~TraceReader() {
  if (thread_.joinable()) {
    close(stop_[1]);
    thread_.join();
    close(stop_[0]);
  }
  close(pipe_);
  unlink(path_.c_str());
}

void TraceReader::finish() {
  close(stop_[1]);
  thread_.join();
  close(stop_[0]);
  if (copy_.is_open()) {
    copy_.close();
    if (!copy_) throw std::runtime_error(copy_path_ + ": could not be written");
  }
  if (!error_.empty()) throw std::runtime_error(error_);
}

void TraceReader::read() {
  std::string pending;
  char chunk[65536];
  bool stopping = false;
  for (;;) {
    const ssize_t size = ::read(pipe_, chunk, sizeof(chunk));
    if (size > 0) {
      if (copy_.is_open()) copy_.write(chunk, size);
      pending.append(chunk, static_cast<size_t>(size));
      size_t begin = 0;
      for (size_t end; (end = pending.find('\n', begin)) != std::string::npos; begin = end + 1) {
        take_line(std::string_view(pending).substr(begin, end - begin));
      }
      pending.erase(0, begin);
      continue;
    }
    // No data at present: no writer (0), or none that has written more (EAGAIN).
    if (stopping) return;
    pollfd fds[2] = {{pipe_, POLLIN, 0}, {stop_[0], POLLIN, 0}};
    poll(fds, 2, -1);
    stopping = fds[1].revents != 0;
    // A pipe whose writer has closed it is always ready; it may be opened again.
    if (!stopping && (fds[0].revents & POLLIN) == 0) usleep(10'000);
  }
}

void TraceReader::take_line(std::string_view line) {
  split(line, line_fields_);
  const bool is_header = !line.empty() && std::isalpha(static_cast<unsigned char>(line.front()));
  if (is_header) {  // repeated when the element opens the trace again
    wanted_.clear();
    for (const std::string& column : columns_) {
      const auto found = std::find(line_fields_.begin(), line_fields_.end(), column);
      if (found == line_fields_.end()) {
        error_ = "the trace has no column " + column;
        wanted_.clear();
        return;
      }
      wanted_.push_back(static_cast<size_t>(found - line_fields_.begin()));
    }
    return;
  }
  if (wanted_.empty()) return;
  for (size_t i = 0; i < wanted_.size(); ++i) {
    if (wanted_[i] >= line_fields_.size()) return;  // truncated by a full disk or a crash
    fields_[i] = line_fields_[wanted_[i]];
  }
  on_row_(fields_);
}
