// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/haptic_loop.h"

#include <algorithm>

#include "core/analysis/no_force_reason.h"

namespace spidar {
namespace {

constexpr double kMaxRate = 10;

/// Whether the film currently provides a wrench to render.
bool has_frame(const TickRecord& record) noexcept {
  return record.playing && (record.found == Found::kExact || record.found == Found::kInterpolated ||
                            record.found == Found::kHeld);
}

/// Whether the film or a surface currently provides a wrench to render.
bool has_wanted(const TickRecord& record) noexcept {
  return has_frame(record) || record.contact.has_surface;
}

}  // namespace

HapticLoop::HapticLoop(const Profile& profile, Device& device, const SafetyLimits& limits)
    : profile_(profile),
      device_(device),
      shared_limits_(limits),
      limits_(limits),
      grip_(profile),
      brake_(profile),
      tension_command_(profile),
      tension_slew_(profile),
      heat_(profile) {}

HapticLoop::~HapticLoop() {
  close();
}

bool HapticLoop::schedule(const TimedWrench& entry) noexcept {
  return scheduled_.push({generation_.load(std::memory_order_acquire), entry});
}

bool HapticLoop::schedule(const TrackBlock& block) noexcept {
  return scheduled_blocks_.push({generation_.load(std::memory_order_acquire), block});
}

void HapticLoop::open() {
  device_.open();
  closing_.store(false, std::memory_order_release);
  counters_ = {};
  unfelt_ns_ = 0;
  grip_.clear_counters();
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

/// Starts from zero after the device was opened, when only the home position of the grip is known.
void HapticLoop::energise() noexcept {
  state_ = DeviceState::kOpening;
  energised_ = acknowledged_energised_ = 0;
  acknowledged_N_.setZero();
  errors_in_a_row_ = 0;
  untrusted_ns_ = 0;
  grip_.reset();
  motion_.reset();
  brake_.reset();
  tension_command_.reset();
  safety_.reset();
  idle_.reset();
  tension_slew_.reset(acknowledged_N_);
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
  closed.motor_heat = heat_.hottest();
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
  int64_t passed_ns = kTick_ns;
  if (ticked_) {
    passed_ns = std::max<int64_t>(now_ns - last_now_ns_, 0);
    const int64_t left_out = (deadline_ns - last_deadline_ns_) / kTick_ns - 1;
    if (left_out > 0) counters_.missed_deadlines += static_cast<uint64_t>(left_out);
  }
  ticked_ = true;
  last_now_ns_ = now_ns;
  last_deadline_ns_ = deadline_ns;

  // Keeps the values of the last tick while the writer is updating them.
  shared_clock_.try_load(clock_);
  shared_limits_.try_load(limits_);
  record.max_force_N = limits_.max_force_N;
  record.max_torque_Nm = limits_.max_torque_Nm;
  find_wanted(record);
  // The last acknowledged tensions have acted until now.
  heat_.pass(acknowledged_N_, 1e-9 * static_cast<double>(passed_ns));
  if (state_ != DeviceState::kLost && state_ != DeviceState::kClosed) {
    const double dt_s = 1e-9 * static_cast<double>(std::min(passed_ns, kMaxStep_ns));
    grip_.check_age(now_ns);
    touch(record, passed_ns);
    command(record, dt_s);
    pull(record, dt_s);
    exchange(record, dt_s);
    vibration_.pass(record.delivered, dt_s, now_ns);
    untrusted_ns_ = grip_.trusted() ? 0 : untrusted_ns_ + passed_ns;
  }
  unfelt_ns_ = size_N(record.commanded) < kFeltForce_N ? unfelt_ns_ + passed_ns : 0;
  record.device = state_;
  record.pose = grip_.pose();
  record.pose_residual_m = grip_.residual_m();
  record.velocity = motion_.velocity();
  record.held = brake_.held();
  record.faulty_string = grip_.faulty_string();
  publish(record);
}

void HapticLoop::forget_timeline(uint32_t generation) noexcept {
  timeline_.clear();
  track_.clear();
  timeline_generation_ = generation;
  newest_ns_ = INT64_MIN;
  reached_ns_ = INT64_MIN;
}

/// Whether an entry was scheduled after a flush that has just taken place: it is for the next tick.
bool HapticLoop::is_of_the_future(uint32_t generation) const noexcept {
  return static_cast<int32_t>(generation - timeline_generation_) > 0;  // the number wraps around
}

void HapticLoop::take_scheduled(bool playing, int64_t running_ns) noexcept {
  const uint32_t generation = generation_.load(std::memory_order_acquire);
  if (generation != timeline_generation_) forget_timeline(generation);
  while (const auto* next = scheduled_.front()) {
    if (next->generation == timeline_generation_) {
      const bool soon = timeline_.size() < 2 || before_newest_ns_ - kHorizon_ns <= running_ns;
      // At a high frame rate there are more frames within the horizon than fit into the timeline,
      // which would drop the frame that is on the screen.
      const bool has_room = timeline_.size_after(running_ns) < WrenchTimeline::kCapacity / 2;
      if (!playing || !soon || !has_room) return;
      const bool holds_on = next->entry.repeated && timeline_.size() > 0;
      if (holds_on) {
        timeline_.push(next->entry);
      } else if (timeline_.push(next->entry)) {
        before_newest_ns_ = newest_ns_;
        newest_ns_ = next->entry.time_ns;
      } else {
        ++counters_.refused_wrenches;
      }
    } else if (is_of_the_future(next->generation)) {
      return;
    }
    scheduled_.drop();
  }
}

TimelineResult HapticLoop::read_track(bool playing, int64_t running_ns) noexcept {
  const TrackBlock* next = nullptr;
  while (const auto* oldest = scheduled_blocks_.front()) {
    if (is_of_the_future(oldest->generation)) break;
    if (oldest->generation == timeline_generation_) {
      if (!playing) break;
      next = track_.read(oldest->entry, running_ns) ? nullptr : &oldest->entry;
      if (next) break;
    }
    scheduled_blocks_.drop();
  }
  return playing ? track_.at(running_ns, next) : TimelineResult();
}

void HapticLoop::find_wanted(TickRecord& record) noexcept {
  // Rates are near 1: a much larger one, or NaN, does not come from a clock.
  record.playing =
      clock_.plays_at(record.monotonic_ns) && clock_.rate > 0 && clock_.rate < kMaxRate;
  if (record.playing) record.running_ns = clock_.running_at(record.monotonic_ns);
  take_scheduled(record.playing, record.running_ns);
  const TimelineResult of_track = read_track(record.playing, record.running_ns);
  if (!record.playing) return;
  const TimelineResult of_frames = timeline_.at(record.running_ns);
  // After a film with a track there may be one without: its frames come later than every sample.
  const bool track_is_over =
      of_track.found == Found::kExpired && of_frames.frame_time_ns > of_track.frame_time_ns;
  const bool has_track = of_track.found != Found::kNothing && !track_is_over;
  const TimelineResult& result = has_track ? of_track : of_frames;
  record.found = result.found;
  record.frame_ns = result.frame_time_ns;
  record.wanted = result.wrench;
  if (result.found == Found::kNothing || result.frame_time_ns == reached_ns_) return;
  reached_ns_ = result.frame_time_ns;
  skew_.add(record.running_ns - reached_ns_);
}

void HapticLoop::touch(TickRecord& record, int64_t passed_ns) noexcept {
  TouchMailbox* const mailbox = touch_mailbox_.load(std::memory_order_acquire);
  if (mailbox == nullptr) return;
  if (!record.playing || !grip_.trusted() || closing_.load(std::memory_order_acquire)) {
    touch_.rest(*mailbox);
    return;
  }
  // max-force may be 0, but the contact needs a limit above that; the safety chain then lets
  // nothing through.
  constexpr double kLeast_N = 1e-3;
  touch_.set_limits(std::max(kLeast_N, limits_.max_force_N), limits_.max_slew_N_s);
  const bool finite = has_frame(record) && record.wanted.is_finite();
  touch_.set_beside(finite ? record.wanted.force_N : Eigen::Vector3d::Zero());
  record.contact = touch_.tick(*mailbox, record.running_ns, grip_.pose().position_m,
                               1e-9 * static_cast<double>(passed_ns));
  if (!record.contact.has_surface) return;
  // An expired wrench is kept only for ramping down and must not be rendered.
  if (!has_frame(record)) record.wanted = {};
  record.wanted.force_N += record.contact.force_N;
}

void HapticLoop::command(TickRecord& record, double dt_s) noexcept {
  const bool wanted = has_wanted(record);
  const bool closing = closing_.load(std::memory_order_acquire);
  const bool nothing = !wanted || record.wanted.stacked().isZero(0);
  const bool idle = idle_.idle(!nothing, grip_.pose().position_m, dt_s);
  if (closing || idle) {
    energised_ = std::max(energised_ - dt_s / kRelease_s, 0.0);
    state_ = closing ? DeviceState::kClosing : DeviceState::kIdle;
  } else {
    energised_ = std::min(energised_ + dt_s / kEnergise_s, 1.0);
    state_ = energised_ < 1 ? DeviceState::kOpening : DeviceState::kRunning;
  }
  const bool fresh = wanted && grip_.trusted() && !closing;
  const Wrench braked = brake_.apply(vibration_.share() * record.wanted, motion_, dt_s);
  record.commanded = safety_.apply(braked, fresh, dt_s, limits_);
  counters_.rejected_wrenches = safety_.rejected();
}

void HapticLoop::pull(TickRecord& record, double dt_s) noexcept {
  tension_command_.leave_out(grip_.faulty_string());
  const StructureMatrix W = structure_matrix(profile_.geometry, grip_.pose());
  // Near the end of the ramp to rest the wrench may still be large. If it were solved for, the
  // tensions would not have enough time left to fall.
  const bool fresh = has_wanted(record) && grip_.trusted() && state_ != DeviceState::kClosing;
  StringVector wanted_N;
  if (fresh) {
    tension_command_.solve(W, record.commanded, heat_.limit_N());
    wanted_N = tension_command_.limit(W, limits_, grip_.pose(), motion_);
  } else {
    const double pace = grip_.trusted() ? 1 : TensionCommand::kLostPace;
    wanted_N = tension_command_.fade(record.commanded, pace);
  }
  const StringVector limited_N = tension_slew_.apply(energised_ * wanted_N, profile_, dt_s);
  record.tension_N = bound_tensions(limited_N, profile_);
  const Eigen::Matrix<double, 6, 1> delivered = W * record.tension_N;
  record.delivered = {delivered.head<3>(), delivered.tail<3>()};
  if (tension_command_.held_back()) ++counters_.held_back_ticks;
}

void HapticLoop::exchange(TickRecord& record, double dt_s) noexcept {
  DeviceReading reading;
  const ExchangeStatus status = device_.exchange(to_volts(record.tension_N, profile_), reading);
  if (status == ExchangeStatus::kOk) {
    errors_in_a_row_ = 0;
    acknowledged_N_ = record.tension_N;
    acknowledged_energised_ = energised_;
    const bool at_rest = record.commanded.stacked().isZero(0);
    grip_.see(reading, record.delivered, at_rest, record.monotonic_ns);
    follow(reading.encoders, record.delivered, dt_s);
    counters_.pose_errors = grip_.pose_errors();
    counters_.string_faults = grip_.string_faults();
    return;
  }
  undo(record);
  grip_.miss(record.monotonic_ns);
  ++counters_.exchange_errors;
  if (status == ExchangeStatus::kLost || ++errors_in_a_row_ >= kMaxErrors) lose();
}

/// Joysticks have no strings that could pull their stick in all directions, and no encoders.
void HapticLoop::follow(bool encoders, const Wrench& strings, double dt_s) noexcept {
  if (!grip_.trusted() || !encoders) {
    motion_.reset();
    brake_.reset();
    return;
  }
  motion_.see(grip_.pose(), grip_.located_ns());
  brake_.see(motion_, dt_s);
  brake_.pull(strings, dt_s);
}

/// The motors may not have received this tick, so the next one starts from the last acknowledged
/// one.
void HapticLoop::undo(TickRecord& record) noexcept {
  safety_.undo();
  record.commanded = limit_total(safety_.last(), limits_);
  record.tension_N = acknowledged_N_;
  record.acknowledged = false;
  tension_slew_.reset(acknowledged_N_);
  energised_ = acknowledged_energised_;
}

void HapticLoop::publish(const TickRecord& record) noexcept {
  records_.push(record);
  LoopSnapshot snapshot{record, counters_, limits_};
  snapshot.pose_trouble = grip_.trouble();
  snapshot.untrusted_ns = untrusted_ns_;
  snapshot.unfelt_ns = unfelt_ns_;
  snapshot.motor_heat = heat_.hottest();
  snapshot.held_back = tension_command_.held_back();
  snapshot.vibration = vibration_.state();
  snapshot_.store(snapshot);
}

}  // namespace spidar
