// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/tick_trace.h"

#include <chrono>
#include <initializer_list>

#include "spidar/realtime/line_writer.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

constexpr size_t kMaxRow_bytes = 2048;                       // 51 fields of at most 32 characters
constexpr const char* kFirstColumns = "tick,monotonic_ns,";  // of every version

}  // namespace

std::string trace_header() {
  std::string header;
  CsvRow row(header);
  for (const char* name : {"tick", "monotonic_ns", "lateness_ns", "running_ns", "frame_ns", "found",
                           "playing", "device", "acknowledged", "brakes"}) {
    row.field(name);
  }
  for (const char* which : {"wanted", "commanded", "delivered"}) {
    for (const char* part : {"_force_x_N", "_force_y_N", "_force_z_N", "_torque_x_Nm",
                             "_torque_y_Nm", "_torque_z_Nm"}) {
      row.field(std::string(which) + part);
    }
  }
  for (int i = 0; i < kMaxStrings; ++i) row.field("tension_" + std::to_string(i) + "_N");
  for (const char* name : {"position_x_m", "position_y_m", "position_z_m", "orientation_w",
                           "orientation_x", "orientation_y", "orientation_z", "pose_residual_m",
                           "faulty_string", "max_force_N", "max_torque_Nm", "contact_depth_m",
                           "contact_force_x_N", "contact_force_y_N", "contact_force_z_N"}) {
    row.field(name);
  }
  return header;
}

void append_row(const TickRecord& record, std::string& csv) {
  CsvRow row(csv);
  row.number(record.tick).number(record.monotonic_ns).number(record.lateness_ns);
  row.number(record.running_ns).number(record.frame_ns == INT64_MIN ? -1 : record.frame_ns);
  row.field(to_string(record.found)).number(record.playing ? 1 : 0).field(to_string(record.device));
  row.number(record.acknowledged ? 1 : 0).number(record.brakes ? 1 : 0);
  row.wrench(record.wanted).wrench(record.commanded).wrench(record.delivered);
  for (int i = 0; i < kMaxStrings; ++i) row.number(record.tension_N[i]);
  const Eigen::Quaterniond& q = record.pose.orientation;
  row.vector(record.pose.position_m).number(q.w()).number(q.x()).number(q.y()).number(q.z());
  row.number(record.pose_residual_m)
      .number(record.faulty_string)
      .number(record.max_force_N)
      .number(record.max_torque_Nm)
      .number(record.contact.depth_m)
      .vector(record.contact.force_N);
  csv += '\n';
}

TickTrace::TickTrace(const std::string& path) {
  const std::string reason = file_.open(path, kFirstColumns);
  if (!reason.empty()) {
    throw TraceError("cannot write the haptic trace \"" + path + "\": " + reason);
  }
  row_.reserve(kMaxRow_bytes);
  file_.add(trace_header() + "\n");
}

void TickTrace::add(const TickRecord& record) noexcept {
  if (record.tick > last_tick_ + 1) missing_ticks_ += record.tick - last_tick_ - 1;
  last_tick_ = record.tick;
  row_.clear();
  append_row(record, row_);
  file_.add(row_);
}

void TickTrace::flush() noexcept {
  file_.flush();
}

LineWriter::Status TickTrace::status() const noexcept {
  LineWriter::Status status = file_.status();
  // The header is the first line: it is written, or dropped.
  uint64_t& with_header = status.lines > 0 ? status.lines : status.dropped;
  if (with_header > 0) --with_header;
  status.dropped += missing_ticks_;
  return status;
}

TraceThread::TraceThread(const std::string& path, HapticLoop& loop, bool threaded)
    : loop_(loop), trace_(path) {
  if (!threaded) return;
  thread_ = start_thread("spidar-trace", [this] { run(); });
}

TraceThread::~TraceThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  drain();
}

void TraceThread::run() noexcept {
  request_background();
  std::unique_lock lock(mutex_);
  while (!stop_) {
    wake_.wait_for(lock, std::chrono::milliseconds(50));
    take_records();
  }
}

/// With the lock.
void TraceThread::take_records() noexcept {
  TickRecord record;
  while (loop_.pop_record(record)) trace_.add(record);
  note_status();
}

void TraceThread::note_status() noexcept {
  const LineWriter::Status now = trace_.status();
  const std::lock_guard lock(status_mutex_);
  status_ = now;
}

void TraceThread::drain() noexcept {
  const std::lock_guard lock(mutex_);
  take_records();
  trace_.flush();
  note_status();
}

LineWriter::Status TraceThread::status() const noexcept {
  const std::lock_guard lock(status_mutex_);
  return status_;
}

}  // namespace spidar
