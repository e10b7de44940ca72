// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/tick_watch.h"

#include "spidar/chain/brake_table.h"
#include "spidar/limits/wrench_limits.h"
#include "spidar/loop/tick_trace.h"
#include "tests/support/test.h"

namespace spidar::test {
namespace {

constexpr double kRest_s = 0.0505;  // 50 ticks, and rounding
/// Far from the centre; within 2 cm, the strings at rest pull by 1.13 N at most.
constexpr double kMaxAtRest_N = 3;
/// No frame is held longer.
constexpr int64_t kOldest_ns = 100 * 1'000'000;
/// Before the next frame is due; with a tick for the last frame.
constexpr int64_t kFadeIn_ns = 40 * 1'000'000 + kTick_ns;
/// A vector is shortened by a product, a quotient and a root.
constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();

bool to_be_felt(const TickRecord& record) {
  return record.playing && (record.found == Found::kExact || record.found == Found::kInterpolated ||
                            record.found == Found::kHeld);
}

/// A surface pushes for as long as the grip is in it, at any age of its frame.
bool is_pushed(const TickRecord& record) {
  return record.playing && record.contact.force_N.norm() > 0;
}

/// One row of a trace by the names of its columns.
class Row {
 public:
  Row(const std::map<std::string, size_t>& columns, const std::string& line) : columns_(columns) {
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields_.push_back(field);
  }

  const std::string& text(const std::string& column) const {
    return fields_.at(columns_.at(column));
  }
  double number(const std::string& column) const { return std::stod(text(column)); }
  int64_t integer(const std::string& column) const { return std::stoll(text(column)); }

 private:
  const std::map<std::string, size_t>& columns_;
  std::vector<std::string> fields_;
};

TickRecord record_of(const Row& row) {
  TickRecord record;
  record.tick = static_cast<uint64_t>(row.integer("tick"));
  record.monotonic_ns = row.integer("monotonic_ns");
  record.playing = row.integer("playing") != 0;
  record.running_ns = row.integer("running_ns");
  record.frame_ns = row.integer("frame_ns");
  for (const Found found : {Found::kExact, Found::kInterpolated, Found::kHeld, Found::kExpired}) {
    if (row.text("found") == to_string(found)) record.found = found;
  }
  for (const DeviceState state : {DeviceState::kOpening, DeviceState::kRunning,
                                  DeviceState::kClosing, DeviceState::kIdle, DeviceState::kLost}) {
    if (row.text("device") == to_string(state)) record.device = state;
  }
  record.acknowledged = row.integer("acknowledged") != 0;
  record.brakes = row.integer("brakes") != 0;
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    record.wanted.force_N[i] = row.number("wanted_force_" + axis + "_N");
    record.commanded.force_N[i] = row.number("commanded_force_" + axis + "_N");
    record.commanded.torque_Nm[i] = row.number("commanded_torque_" + axis + "_Nm");
    record.contact.force_N[i] = row.number("contact_force_" + axis + "_N");
  }
  for (int i = 0; i < kMaxStrings; ++i) {
    record.tension_N[i] = row.number("tension_" + std::to_string(i) + "_N");
  }
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    record.pose.position_m[i] = row.number("position_" + axis + "_m");
  }
  record.max_force_N = row.number("max_force_N");
  record.max_torque_Nm = row.number("max_torque_Nm");
  return record;
}

}  // namespace

TickRecord TickWatch::tick(HapticLoop& loop, int64_t now_ns) {
  loop.tick(now_ns, now_ns);
  const LoopSnapshot snapshot = loop.snapshot();
  check(snapshot.last, snapshot.limits);
  return snapshot.last;
}

void TickWatch::check(const TickRecord& record, const SafetyLimits& limits) {
  // The loop is another one, or was reopened, or the trace has a gap.
  if (record.tick != last_.tick + 1) following_ = false;
  if (!following_) motion_.reset();
  const int64_t step_ns = following_ ? record.monotonic_ns - last_.monotonic_ns : kTick_ns;
  const double dt_s = 1e-9 * static_cast<double>(std::clamp<int64_t>(step_ns, 0,  //
                                                                     HapticLoop::kMaxStep_ns));
  unanswered_s_ = following_ ? unanswered_s_ + 1e-9 * static_cast<double>(step_ns) : dt_s;
  const auto change_s = [&](double before, double now) {
    const double longest_s = 1e-9 * static_cast<double>(HapticLoop::kMaxStep_ns);
    return now < before ? unanswered_s_ : std::min(unanswered_s_, longest_s);
  };
  largest_N_ = std::max(largest_N_, limits.max_force_N);
  largest_Nm_ = std::max(largest_Nm_, limits.max_torque_Nm);
  const double ramp = StaleRamp::kSteepest / limits.ramp_s;
  const double rate_N_s = std::max(limits.max_slew_N_s, ramp * largest_N_);

  motion_.update(record.pose, record.monotonic_ns);

  // A step towards w shortens a force s by at least (s − w) / (s + w) of the step. The ramp to rest
  // begins more slowly than the slew limit.
  const double wanted_N = limit_total(record.wanted, limits).force_N.norm();
  if (!following_) slewed_N_ = largest_N_;
  if (!to_be_felt(record) && !is_pushed(record)) {
    if (stopped_s_ > kRest_s) slewed_N_ = 0;
  } else if (wanted_N >= slewed_N_) {
    slewed_N_ = std::min(wanted_N, slewed_N_ + rate_N_s * dt_s);
  } else if (record.acknowledged) {
    slewed_N_ -= limits.max_slew_N_s * dt_s * (slewed_N_ - wanted_N) / (slewed_N_ + wanted_N);
    slewed_N_ = std::max(slewed_N_, wanted_N);
  }

  const Wrench& now = record.commanded;
  if (!now.is_finite()) fail(record, "not finite");
  // A damper takes back what the strings at rest give, whatever the limit.
  const bool damps = record.brakes && limits.max_force_N < kMaxAtRest_N;
  if (!damps && now.force_N.norm() > limits.max_force_N * (1 + kRounding)) {
    fail(record, "force too large");
  }
  if (!damps && now.torque_Nm.norm() > limits.max_torque_Nm * (1 + kRounding)) {
    fail(record, "torque too large");
  }

  // See WrenchLimits. A lost device gets no command.
  const bool lost = record.device == DeviceState::kLost || last_.device == DeviceState::kLost;
  const bool brakes = record.brakes || last_.brakes;
  if (following_ && !lost && brakes) {
    const std::string fault = fault_of_brake(record);
    if (!fault.empty()) fail(record, fault);
  }
  if (following_ && !lost && !brakes) {
    const double rate_Nm_s = std::max(limits.max_slew_Nm_s, ramp * largest_Nm_);
    const Wrench& before = last_.commanded;
    if ((now.force_N - before.force_N).norm() >
        rate_N_s * change_s(before.force_N.norm(), now.force_N.norm()) + 1e-12) {
      fail(record, "force changes too fast");
    }
    if ((now.torque_Nm - before.torque_Nm).norm() >
        rate_Nm_s * change_s(before.torque_Nm.norm(), now.torque_Nm.norm()) + 1e-12) {
      fail(record, "torque changes too fast");
    }
  }

  // A device that does not answer keeps its last command.
  if (to_be_felt(record) || is_pushed(record)) {
    stopped_s_ = 0;
  } else if (record.acknowledged) {
    stopped_s_ += unanswered_s_;
  }
  if (stopped_s_ > kRest_s && !brakes && now.stacked().norm() > 0) fail(record, "not at rest");
  look_at_age(record, dt_s);
  if (record.acknowledged) unanswered_s_ = 0;
  last_ = record;
  following_ = true;
  ++ticks_;
  if (now.stacked().norm() > 0) ++felt_;
}

/// Checks the brake, which leaves a part of the force that follows the wanted one at the slew
/// limit, and adds a damper against the motion. The error of the speed that the brake sees is
/// kSpeedError_m_s at most.
std::string TickWatch::fault_of_brake(const TickRecord& record) const {
  const Eigen::Vector3d& now_N = record.commanded.force_N;
  const Eigen::Vector3d velocity_m_s = motion_.velocity_in(0).linear_m_s;
  const double speed_m_s = velocity_m_s.norm();
  const double most_W = slewed_N_ * speed_m_s + brake::kSpeedError_m_s * now_N.norm();
  if (now_N.dot(velocity_m_s) > most_W + 1e-12) return "the brake pushes the grip";
  // No band of the brake begins below the error of the speed.
  const double damper_N = brake::kDamping_N_s_m * speed_m_s;
  const double largest_N = slewed_N_ + damper_N;
  return now_N.norm() > largest_N + 1e-12 ? "the brake acts on a grip that is slow" : "";
}

void TickWatch::look_at_age(const TickRecord& record, double dt_s) {
  if (!following_ || !record.playing || record.found == Found::kNothing) {
    newest_frame_ns_ = INT64_MIN;
    fading_in_ = false;
  }
  if (!record.playing || record.found == Found::kNothing) return;
  if (record.frame_ns > newest_frame_ns_) {
    newest_frame_ns_ = record.frame_ns;
    newest_since_ns_ = record.monotonic_ns;
    old_s_ = 0;
    fading_in_ = false;
  }
  if (is_pushed(record)) {
    old_s_ = 0;
    fading_in_ = false;
    return;
  }
  const bool old = record.monotonic_ns - newest_since_ns_ > kOldest_ns ||
                   record.running_ns - record.frame_ns > kOldest_ns;
  if (old) old_s_ += dt_s;
  const bool felt = !record.brakes && record.commanded.stacked().norm() > 0;
  if (old_s_ <= kRest_s || !felt) {
    fading_in_ = false;
    return;
  }
  if (!fading_in_) {
    fading_in_ = true;
    fading_in_since_ns_ = record.monotonic_ns;
  }
  if (record.monotonic_ns - fading_in_since_ns_ > kFadeIn_ns) fail(record, "force on an old frame");
}

void TickWatch::check_trace(const std::string& path, const SafetyLimits& limits) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) {
    ADD_FAILURE() << "no haptic trace " << path;
    return;
  }
  std::map<std::string, size_t> columns;
  std::istringstream names(line);
  for (std::string name; std::getline(names, name, ',');) columns.emplace(name, columns.size());
  SafetyLimits held = limits;
  while (std::getline(file, line)) {
    const TickRecord record = record_of(Row(columns, line));
    held.max_force_N = record.max_force_N;
    held.max_torque_Nm = record.max_torque_Nm;
    check(record, held);
  }
}

void TickWatch::fail(const TickRecord& record, const std::string& what) {
  if (failed_) return;
  failed_ = true;
  std::string rows;
  append_row(last_, rows);
  append_row(record, rows);
  ADD_FAILURE() << what << ", after " << stopped_s_ << " s without a wrench to be felt:\n"
                << trace_header() << '\n'
                << rows;
}

}  // namespace spidar::test
