#include "spidar/haptic_loop.h"

#include <algorithm>

namespace spidar {
namespace {

constexpr double kMaxRate = 10;

}  // namespace

HapticLoop::HapticLoop(const Profile& profile, Device& device, const SafetyLimits& limits)
    : profile_(profile),
      zero_length_m_(profile.zero_count_length_m()),
      device_(device),
      shared_limits_(limits),
      limits_(limits),
      tension_slew_(profile),
      pose_solver_(profile.geometry, profile.max_pose_residual_m()) {
  problem_.count = profile_.geometry.count;
  problem_.t_min_N = profile_.min_tension_N();
  problem_.t_max_N = profile_.max_tension_N();
  problem_.t_ref_N = problem_.t_min_N;
  const double radius_m = profile_.geometry.grip_radius_m();
  // A grip without extent feels no torque, whatever a torque is compared with.
  if (radius_m > 0) problem_.torque_length_m = radius_m;
}

HapticLoop::~HapticLoop() {
  close();
}

bool HapticLoop::schedule(const TimedWrench& entry) noexcept {
  return scheduled_.push({generation_.load(std::memory_order_acquire), entry});
}

void HapticLoop::open() {
  device_.open();
  closing_.store(false, std::memory_order_release);
  counters_ = {};
  ticked_ = false;
  energise();
}

bool HapticLoop::reopen() noexcept {
  ticked_ = false;
  device_.close();
  try {
    device_.open();
  } catch (...) {
    return false;
  }
  energise();
  return true;
}

/// The device was opened: from zero again, and nothing known about the grip but that it is at home.
void HapticLoop::energise() noexcept {
  state_ = DeviceState::kOpening;
  energised_ = 0;
  errors_in_a_row_ = 0;
  located_ = false;
  pose_ = {};
  faulty_string_ = -1;
  pose_solver_.reset();
  tension_solver_.reset();
  safety_.reset();
  tension_slew_.reset(profile_);
}

void HapticLoop::lose() noexcept {
  ++counters_.times_lost;
  state_ = DeviceState::kLost;
}

bool HapticLoop::released() const noexcept {
  if (!closing_.load(std::memory_order_acquire)) return false;
  return state_ == DeviceState::kClosed || state_ == DeviceState::kLost ||
         (state_ == DeviceState::kClosing && energised_ <= 0);
}

void HapticLoop::close() noexcept {
  if (state_ == DeviceState::kClosed) return;
  device_.close();
  state_ = DeviceState::kClosed;
  LoopSnapshot closed{{}, counters_, limits_};
  closed.last.tick = counters_.ticks;
  closed.last.monotonic_ns = last_now_ns_;
  snapshot_.store(closed);
}

void HapticLoop::tick(int64_t deadline_ns, int64_t now_ns) noexcept {
  TickRecord record;
  record.tick = ++counters_.ticks;
  record.monotonic_ns = now_ns;
  record.lateness_ns = now_ns - deadline_ns;
  if (record.lateness_ns > kTick_ns) ++counters_.overruns;
  int64_t step_ns = kTick_ns;
  if (ticked_) {
    step_ns = std::clamp<int64_t>(now_ns - last_now_ns_, 0, kMaxStep_ns);
    const int64_t left_out = (deadline_ns - last_deadline_ns_) / kTick_ns - 1;
    if (left_out > 0) counters_.missed_deadlines += static_cast<uint64_t>(left_out);
  }
  ticked_ = true;
  last_now_ns_ = now_ns;
  last_deadline_ns_ = deadline_ns;

  // Held from the last tick when the writer is just at it.
  shared_clock_.try_load(clock_);
  shared_limits_.try_load(limits_);
  record.max_force_N = limits_.max_force_N;
  record.max_torque_Nm = limits_.max_torque_Nm;
  find_wanted(record);
  if (state_ != DeviceState::kLost && state_ != DeviceState::kClosed) {
    const double dt_s = 1e-9 * static_cast<double>(step_ns);
    command(record, dt_s);
    pull(record, dt_s);
    exchange(record);
  }
  record.device = state_;
  record.pose = pose_;
  record.pose_residual_m = pose_residual_m_;
  record.faulty_string = faulty_string_;
  publish(record);
}

void HapticLoop::forget_timeline(uint32_t generation) noexcept {
  timeline_.clear();
  timeline_generation_ = generation;
  newest_ns_ = INT64_MIN;
  reached_ns_ = INT64_MIN;
}

void HapticLoop::take_scheduled(bool playing, int64_t running_ns) noexcept {
  const uint32_t generation = generation_.load(std::memory_order_acquire);
  if (generation != timeline_generation_) forget_timeline(generation);
  while (const Scheduled* next = scheduled_.front()) {
    if (next->generation == timeline_generation_) {
      const bool soon = timeline_.size() < 2 || before_newest_ns_ - kHorizon_ns <= running_ns;
      // At a high frame rate the horizon holds more frames than the timeline, which would forget
      // the frame that is on the screen.
      const bool has_room = timeline_.size_after(running_ns) < WrenchTimeline::kCapacity / 2;
      if (!playing || !soon || !has_room) return;
      if (timeline_.push(next->entry)) {
        before_newest_ns_ = newest_ns_;
        newest_ns_ = next->entry.time_ns;
      } else {
        ++counters_.refused_wrenches;
      }
    } else if (static_cast<int32_t>(next->generation - timeline_generation_) > 0) {
      return;  // flushed just now: for the next tick. Signed, for the number wraps round.
    }
    scheduled_.drop();
  }
}

void HapticLoop::find_wanted(TickRecord& record) noexcept {
  // Rates are near 1: anything else, or not a number, is not a clock.
  record.playing =
      clock_.plays_at(record.monotonic_ns) && clock_.rate > 0 && clock_.rate < kMaxRate;
  if (record.playing) record.running_ns = clock_.running_at(record.monotonic_ns);
  take_scheduled(record.playing, record.running_ns);
  if (!record.playing) return;
  const TimelineResult result = timeline_.at(record.running_ns);
  record.found = result.found;
  record.frame_ns = result.frame_time_ns;
  record.wanted = result.wrench;
  if (result.found == Found::kNothing || result.frame_time_ns == reached_ns_) return;
  reached_ns_ = result.frame_time_ns;
  skew_.add(record.running_ns - reached_ns_);
}

void HapticLoop::command(TickRecord& record, double dt_s) noexcept {
  const bool closing = closing_.load(std::memory_order_acquire);
  if (closing) {
    state_ = DeviceState::kClosing;
    energised_ = std::max(energised_ - dt_s / kRelease_s, 0.0);
  } else {
    energised_ = std::min(energised_ + dt_s / kEnergise_s, 1.0);
    state_ = energised_ < 1 ? DeviceState::kOpening : DeviceState::kRunning;
  }
  const bool valid = record.found == Found::kExact || record.found == Found::kInterpolated ||
                     record.found == Found::kHeld;
  const bool fresh = record.playing && valid && located_at(record.monotonic_ns) && !closing;
  record.commanded = safety_.apply(record.wanted, fresh, dt_s, limits_);
  counters_.rejected_wrenches = safety_.rejected();
}

bool HapticLoop::located_at(int64_t now_ns) const noexcept {
  return located_ && now_ns - located_ns_ <= kPoseTimeout_ns;
}

void HapticLoop::pull(TickRecord& record, double dt_s) noexcept {
  problem_.W = structure_matrix(profile_.geometry, pose_);
  problem_.wrench = record.commanded;
  const TensionResult result = tension_solver_.solve(problem_);
  const StringVector tension_N = tension_slew_.apply(result.tension_N, profile_, dt_s);
  record.tension_N = bound_tensions(tension_N, profile_, energised_);
  const Eigen::Matrix<double, 6, 1> delivered = problem_.W * record.tension_N;
  record.delivered = {delivered.head<3>(), delivered.tail<3>()};
}

void HapticLoop::exchange(TickRecord& record) noexcept {
  DeviceReading reading;
  const ExchangeStatus status = device_.exchange(to_volts(record.tension_N, profile_), reading);
  if (status == ExchangeStatus::kOk) {
    errors_in_a_row_ = 0;
    locate(reading, record.monotonic_ns);
    return;
  }
  ++counters_.exchange_errors;
  if (status == ExchangeStatus::kLost || ++errors_in_a_row_ >= kMaxErrors) lose();
}

void HapticLoop::locate(const DeviceReading& reading, int64_t now_ns) noexcept {
  StringVector lengths_m = StringVector::Zero();
  for (int i = 0; i < profile_.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile_.drives[k];
    lengths_m[i] = zero_length_m_[i] + drive.encoder_sign * drive.metres_per_count *
                                           static_cast<double>(reading.count[k]);
  }
  const PoseResult result = pose_solver_.solve(lengths_m);
  pose_residual_m_ = result.residual_m;
  if (result.status == PoseStatus::kSolved) {
    if (result.faulty_string >= 0 && result.faulty_string != faulty_string_)
      ++counters_.string_faults;
    faulty_string_ = result.faulty_string;
    pose_ = result.pose;
    located_ = true;
    located_ns_ = now_ns;
    return;
  }
  ++counters_.pose_errors;
  // What was near the last pose is long gone: search from the centre.
  if (!located_at(now_ns)) pose_solver_.reset();
}

void HapticLoop::publish(const TickRecord& record) noexcept {
  records_.push(record);
  snapshot_.store({record, counters_, limits_});
}

}  // namespace spidar
