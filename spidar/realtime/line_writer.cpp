// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/realtime/line_writer.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <condition_variable>
#include <fcntl.h>
#include <mutex>
#include <poll.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "spidar/realtime/standard_descriptors.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/realtime/uninterrupted.h"

namespace spidar {
namespace {

uint64_t lines_in(std::string_view text) {
  return static_cast<uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Shorter for a pipe, because its reader may act on the lines, for example drive a motor.
std::chrono::milliseconds period_of(int file) {
  constexpr std::chrono::milliseconds kOfPipe{1};
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode) ? LineWriter::kPeriod : kOfPipe;
}

/// The first whole lines of `text` that have at most `capacity` bytes; one line if that is longer.
std::string_view first_lines(std::string_view text, size_t capacity) {
  size_t end = text.rfind('\n', capacity - 1);
  if (end == std::string_view::npos) end = text.find('\n');
  return text.substr(0, end == std::string_view::npos ? text.size() : end + 1);
}

}  // namespace

/// Shared with the thread, which may outlive the writer.
struct LineWriter::Output {
  explicit Output(int opened) : file(opened), period(period_of(opened)) {}
  ~Output() { ::close(file); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  /// Runs until the writer ends, or the writing fails.
  void run() noexcept {
    std::unique_lock<std::mutex> lock(mutex);
    while (true) {
      changed.wait_for(lock, period, [this] { return hurries || ends; });
      hurries = false;
      if (waiting.empty()) {
        changed.notify_all();
        if (ends) break;
        continue;
      }
      std::string taken;
      taken.swap(waiting);
      in_work = std::exchange(waiting_lines, 0);
      lock.unlock();
      const Status done = write_lines(taken);
      lock.lock();
      in_work = 0;
      status.lines += done.lines;
      status.dropped += done.dropped;
      if (done.error != 0) status.error = done.error;
      if (status.error != 0) drop_waiting();
      changed.notify_all();
    }
    has_ended = true;
    changed.notify_all();
  }

  /// Call this without the lock.
  Status write_lines(std::string_view text) {
    const SigpipeBlock no_sigpipe;
    Status done;
    while (!text.empty()) {
      // A pipe accepts PIPE_BUF bytes completely or not at all. When the process is killed, a write
      // to a file ends at the end of a page, which is a multiple of PIPE_BUF.
      const std::string_view lines = first_lines(text, PIPE_BUF - written_bytes % PIPE_BUF);
      done.error = write_all(lines);
      if (done.error != 0) break;
      done.lines += lines_in(lines);
      text.remove_prefix(lines.size());
    }
    done.dropped = lines_in(text);
    if (done.error == EAGAIN) done.error = 0;
    return done;
  }

  /// Returns 0, EAGAIN when it gives up, or the error.
  int write_all(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written =
          uninterrupted([&] { return ::write(file, text.data(), text.size()); });
      if (written >= 0) {
        text.remove_prefix(static_cast<size_t>(written));
        written_bytes += static_cast<uint64_t>(written);
      } else if (errno == EAGAIN) {
        if (is_given_up()) return EAGAIN;
        pollfd writable{file, POLLOUT, 0};
        poll(&writable, 1, static_cast<int>(kPeriod.count()));
      } else {
        return errno;
      }
    }
    return 0;
  }

  bool is_given_up() {
    const std::lock_guard<std::mutex> lock(mutex);
    return gives_up;
  }

  /// Call this with the lock held.
  void drop_waiting() {
    status.dropped += std::exchange(waiting_lines, 0);
    waiting.clear();
  }

  bool is_done() const { return waiting.empty() && in_work == 0; }

  const int file;
  const std::chrono::milliseconds period;  // the interval between writes
  std::atomic<uint64_t> written_bytes{0};
  std::mutex mutex;  // guards all members below
  std::condition_variable changed;
  std::string waiting;
  uint64_t waiting_lines = 0;
  uint64_t in_work = 0;  // lines that are being written
  bool hurries = false;  // flush() waits
  bool ends = false, gives_up = false, has_ended = false;
  Status status;
};

std::string LineWriter::open(const std::string& path, std::string_view begin) {
  close();
  last_ = {};
  std::string reason;
  const int opened = open_own_output(path.c_str(), begin, reason);
  if (opened < 0) return reason;
  const auto output = std::make_shared<Output>(opened);
  try {
    thread_ = start_thread("spidar-output", [output] { output->run(); });
  } catch (const std::system_error& error) {
    return error.what();
  }
  output_ = output;
  return {};
}

bool LineWriter::is_stuck() {
  stuck_ = stuck_ && output_->written_bytes == stuck_at_;
  return stuck_;
}

/// Waits for `condition`, which is called with the lock held, or until the other end stands still.
template <typename Condition>
void LineWriter::await(Condition condition) {
  std::unique_lock<std::mutex> lock(output_->mutex);
  const auto begin = std::chrono::steady_clock::now();
  auto progress = begin;
  uint64_t written = output_->written_bytes;
  while (!is_stuck() && !condition()) {
    output_->hurries = true;
    output_->changed.notify_all();
    output_->changed.wait_for(lock, kPeriod, condition);
    const auto now = std::chrono::steady_clock::now();
    if (output_->written_bytes != written) progress = now;
    written = output_->written_bytes;
    stuck_ = now - progress > kStandstill || now - begin > kLongestWait;
    stuck_at_ = written;
  }
}

void LineWriter::add(std::string_view lines) {
  if (!output_) return;
  const auto fits = [this, lines] {
    return output_->status.error != 0 ||
           output_->waiting.size() + lines.size() <= kMaxWaiting_bytes;
  };
  await(fits);
  const std::lock_guard<std::mutex> lock(output_->mutex);
  if (output_->status.error == 0 && fits()) {
    output_->waiting.append(lines);
    output_->waiting_lines += lines_in(lines);
  } else {
    output_->status.dropped += lines_in(lines);
  }
}

void LineWriter::flush() {
  if (output_) await([this] { return output_->is_done(); });
}

LineWriter::Status LineWriter::close() {
  if (!output_) return last_;
  flush();
  std::unique_lock<std::mutex> lock(output_->mutex);
  output_->ends = true;
  if (!output_->is_done()) {
    output_->gives_up = true;
    output_->drop_waiting();
  }
  output_->changed.notify_all();
  const bool ended =
      output_->changed.wait_for(lock, 4 * kPeriod, [this] { return output_->has_ended; });
  last_ = output_->status;
  if (!ended) last_.dropped += output_->in_work;
  lock.unlock();
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
  output_ = nullptr;
  return last_;
}

LineWriter::Status LineWriter::status() const {
  if (!output_) return last_;
  const std::lock_guard<std::mutex> lock(output_->mutex);
  Status now = output_->status;
  now.waiting = output_->waiting_lines + output_->in_work;
  return now;
}

}  // namespace spidar
