// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/tick_trace.h"

#include <chrono>
#include <filesystem>
#include <stdexcept>

#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

constexpr size_t kMaxRow_bytes = 2048;                       // 51 fields of at most 32 characters
constexpr const char* kFirstColumns = "tick,monotonic_ns,";  // the same in every version

}  // namespace

void tick_fields(const TickRecord& record, FieldSink& to) {
  to("tick", "", record.tick, "number of the tick, 1 for the first after opening");
  to("monotonic", "ns", record.monotonic_ns, "CLOCK_MONOTONIC at which it began");
  to("lateness", "ns", record.lateness_ns, "how much later than its deadline it began");
  to("running", "ns", record.running_ns, "running time that is on the screen; 0 while not playing");
  to("frame", "ns", record.frame_ns == INT64_MIN ? -1 : record.frame_ns,
     "running time of the frame whose wrench was reached last; −1 before the first");
  to("found", "", to_string(record.found),
     "where the wrench comes from: `nothing`, `exact` (a frame), `interpolated`, `held`, "
     "`expired`");
  to("playing", "", record.playing, "1 while playing");
  to("device", "", to_string(record.device), "state of the device");
  to("acknowledged", "", record.acknowledged,
     "1 if the device has answered; otherwise it may not have got this tick's command");
  to("brakes", "", record.brakes,
     "1 while the brake of a released grip acts: then no limit of rate holds");
  to("wanted-force", "N", axes(record.wanted.force_N),
     "that of film and contact; zero while not playing");
  to("wanted-torque", "N m", axes(record.wanted.torque_Nm),
     "that of film and contact; zero while not playing");
  to("commanded-force", "N", axes(record.commanded.force_N),
     "after the limits and the ramp to rest");
  to("commanded-torque", "N m", axes(record.commanded.torque_Nm),
     "after the limits and the ramp to rest");
  to("delivered-force", "N", axes(record.delivered.force_N),
     "the part that the strings deliver at the pose of the row");
  to("delivered-torque", "N m", axes(record.delivered.torque_Nm),
     "the part that the strings deliver at the pose of the row");
  static_assert(kMaxStrings == 8);
  const StringVector& t = record.tension_N;
  to("tension", "N",
     Parts{{"0", t[0]},
           {"1", t[1]},
           {"2", t[2]},
           {"3", t[3]},
           {"4", t[4]},
           {"5", t[5]},
           {"6", t[6]},
           {"7", t[7]}},
     "tension of each string, as commanded; 0 for strings that the device does not have");
  to("position", "m", axes(record.pose.position_m),
     "position of the grip, from the newest good reading");
  const Eigen::Quaterniond& q = record.pose.orientation;
  to("orientation", "", Parts{{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}},
     "orientation of the grip, a quaternion w, x, y, z");
  to("pose-residual", "m", record.pose_residual_m,
     "how far the lengths of the strings contradict the pose");
  to("faulty-string", "", record.faulty_string,
     "number of the string that fits no pose; −1 if all fit");
  to("max-force", "N", record.max_force_N, "limit of the force in this tick");
  to("max-torque", "N m", record.max_torque_Nm, "limit of the torque in this tick");
  to("contact-depth", "m", record.contact.depth_m,
     "how deep the grip is below the touched surface");
  to("contact-force", "N", axes(record.contact.force_N),
     "contact force, which is part of the wanted force");
}

std::string trace_header() {
  std::string header;
  CsvLine names(CsvLine::Of::kNames, header);
  tick_fields({}, names);
  return header;
}

void append_row(const TickRecord& record, std::string& csv) {
  CsvLine values(CsvLine::Of::kValues, csv);
  tick_fields(record, values);
  csv += '\n';
}

TickTrace::TickTrace(const std::string& path) {
  const std::string reason = file_.open(path, kFirstColumns);
  if (!reason.empty()) {
    throw std::runtime_error("cannot write the haptic trace \"" + path + "\": " + reason);
  }
  row_.reserve(kMaxRow_bytes);
  file_.add(trace_header() + "\n");
}

void TickTrace::add(const TickRecord& record) noexcept {
  if (last_tick_ > 0 && record.tick > last_tick_) missing_ticks_ += record.tick - last_tick_ - 1;
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
  // The header is the first line, and is written or dropped with the others.
  uint64_t& with_header = status.lines > 0 ? status.lines : status.dropped;
  if (with_header > 0) --with_header;
  status.dropped += missing_ticks_;
  return status;
}

TraceThread::TraceThread(const std::string& path, HapticLoop& loop, bool threaded)
    : loop_(loop), trace_(path) {
  // If the loop has already dropped ticks, a gap would follow the stored ones: discard them.
  const bool is_late = loop_.snapshot().counters.ticks >= HapticLoop::kRecords;
  for (TickRecord old; is_late && loop_.pop_record(old);) continue;
  if (!threaded) return;
  // Only a file may be written in the background: the reader of a pipe waits for the rows.
  thread_ = start_thread("spidar-trace", [this, is_file = std::filesystem::is_regular_file(path)] {
    if (is_file) request_background();
    run(is_file);
  });
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

void TraceThread::run(bool is_file) noexcept {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    wake_.wait_for(lock, is_file ? LineWriter::kPeriod : std::chrono::milliseconds(1));
    take_records();
  }
}

/// Call this with the lock held.
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
