// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/haptic_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/wrench_size.h"
#include "spidar/chain/wrench_chain.h"

namespace spidar {
namespace {

constexpr double kMaxRate = 10;

/// A rotation beyond this is that of a released grip: a forearm turns by 90°. The force ends before
/// the strings tangle and the pose is lost, which GripWatch::kMaxTurn_rad tells 20 ms later.
constexpr double kReleasedTurn_rad = 1.75;

/// Whether the film currently provides a wrench to render.
bool has_frame(const TickRecord& record) noexcept {
  return record.playing && (record.found == Found::kExact || record.found == Found::kInterpolated ||
                            record.found == Found::kHeld);
}

/// Whether the film, a surface or the application's callback currently provides a wrench to render.
bool has_wanted(const TickRecord& record) noexcept {
  return has_frame(record) || record.contact.has_surface || record.called_back;
}

}  // namespace

HapticLoop::HapticLoop(std::unique_ptr<Grip> grip, const SafetyLimits& limits)
    : grip_(std::move(grip)),
      limits_(limits, grip_->traits().most_force_N(), grip_->traits().most_torque_Nm()) {}

HapticLoop::~HapticLoop() {
  close();
}

void HapticLoop::open() {
  grip_->open();
  closing_.store(false, std::memory_order_release);
  counters_ = {};
  unfelt_ns_ = 0;
  ticked_ = false;
  energise();
}

bool HapticLoop::reopen() noexcept {
  ticked_ = false;
  grip_->close();
  try {
    grip_->open();
  } catch (const DeviceError& error) {
    refuse(error.code() == DeviceErrorCode::kAbsent ? "" : error.what());
    return false;
  } catch (...) {
    return false;
  }
  refuse("");
  energise();
  return true;
}

void HapticLoop::refuse(const std::string& reason) {
  const bool again = reason == std::exchange(newest_refusal_, reason);
  std::array<char, 512> text{};
  if (again) reason.copy(text.data(), text.size() - 1);
  refusal_.store(text);
}

std::string HapticLoop::refusal() const {
  return refusal_.load().data();
}

/// Starts from zero after the grip was opened.
void HapticLoop::energise() noexcept {
  state_ = DeviceState::kOpening;
  power_ = acknowledged_power_ = 0;
  missing_.reset();
  unanswered_ns_ = 0;
  late_s_ = 0;
  untrusted_ns_ = 0;
  brake_.reset();
  brake_.forget_place();
  safety_.reset();
  acknowledged_ = {};
  exerted_ = above_rest_ = {};
  idle_.reset();
}

void HapticLoop::lose() noexcept {
  ++counters_.times_lost;
  state_ = DeviceState::kLost;
}

bool HapticLoop::released() const noexcept {
  if (!closing_.load(std::memory_order_acquire)) return false;
  return state_ == DeviceState::kClosed || state_ == DeviceState::kLost ||
         (state_ == DeviceState::kClosing && power_ <= 0);
}

void HapticLoop::close() noexcept {
  if (state_ == DeviceState::kClosed) return;
  grip_->close();
  state_ = DeviceState::kClosed;
  LoopSnapshot closed{{}, counters_, limits_.in_effect()};
  closed.last.motor_heat = grip_->reading().motor_heat;
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
  const bool is_open = state_ != DeviceState::kLost && state_ != DeviceState::kClosed;
  unanswered_ns_ = is_open ? unanswered_ns_ + passed_ns : 0;
  const Step step{1e-9 * static_cast<double>(std::min(unanswered_ns_, kMaxStep_ns)),
                  1e-9 * static_cast<double>(unanswered_ns_)};
  if (is_open) {
    limits_.begin_tick(safety_.last(), exerted_, step.falls_s,
                       grip_->traits().most_force_N(late_s_),
                       grip_->traits().most_torque_Nm(late_s_));
  } else {
    limits_.begin_tick_at_rest();
  }
  find_wanted(record);
  grip_->advance(1e-9 * static_cast<double>(passed_ns));
  if (is_open) {
    grip_->check_age(now_ns);
    touch(record, passed_ns);
    run_callback(record, passed_ns);
    command(record, step, passed_ns);
    exchange(record, step);
    count_energy(record);
    vibration_.update(grip_->reading().delivered, 1e-9 * static_cast<double>(passed_ns), now_ns);
    untrusted_ns_ = grip_->reading().knows_pose() ? 0 : untrusted_ns_ + passed_ns;
  }
  unfelt_ns_ = size_N(record.commanded) < kFeltForce_N ? unfelt_ns_ + passed_ns : 0;
  record.max_force_N = limits_.in_effect().max_force_N;
  record.max_torque_Nm = limits_.in_effect().max_torque_Nm;
  record.device = state_;
  record.held = brake_.held();
  static_cast<GripReport&>(record) = grip_->reading();
  record.velocity = grip_->reading().motion.velocity();
  if (!is_open) {
    record.delivered = {};
    record.tension_N.setZero();
  }
  publish(record);
}

void HapticLoop::find_wanted(TickRecord& record) noexcept {
  // Rates are near 1: a much larger one, or NaN, does not come from a clock.
  record.playing =
      clock_.plays_at(record.monotonic_ns) && clock_.rate > 0 && clock_.rate < kMaxRate;
  if (record.playing) record.running_ns = clock_.running_at(record.monotonic_ns);
  // The device renders a command with the lag that it reports.
  const TimelineResult result =
      schedule_.find(record.playing, record.running_ns, grip_->reading().lag_ns);
  counters_.refused_wrenches += schedule_.take_refused();
  record.found = result.found;
  record.frame_ns = result.frame_time_ns;
  record.wanted = result.wrench;
  count_gap(record);
}

/// The time after the last frame of a film is no gap.
void HapticLoop::count_gap(const TickRecord& record) noexcept {
  if (record.playing && record.found == Found::kExpired) {
    ++gap_ticks_;
    return;
  }
  if (has_frame(record)) counters_.gap_ticks += gap_ticks_;
  gap_ticks_ = 0;
}

void HapticLoop::touch(TickRecord& record, int64_t passed_ns) noexcept {
  touch::Mailbox* const mailbox = touch_mailbox_.load(std::memory_order_acquire);
  if (mailbox == nullptr) return;
  if (!record.playing || !grip_->reading().knows_pose() ||
      closing_.load(std::memory_order_acquire)) {
    touch_.tick_without_contact(*mailbox);
    return;
  }
  // max-force may be 0, but the contact needs a limit above that; the safety chain then lets
  // nothing through.
  constexpr double kMin_N = 1e-3;
  touch_.set_limits(std::max(kMin_N, limits_.in_effect().max_force_N),
                    limits_.in_effect().max_slew_N_s);
  const bool finite = has_frame(record) && record.wanted.is_finite();
  touch_.set_beside(finite ? record.wanted.force_N : Eigen::Vector3d::Zero());
  record.contact = touch_.tick(*mailbox, record.running_ns, grip_->reading().pose.position_m,
                               1e-9 * static_cast<double>(passed_ns));
  if (!record.contact.has_surface) return;
  // An expired wrench is kept only for ramping down and must not be rendered.
  if (!has_frame(record)) record.wanted = {};
  record.wanted.force_N += record.contact.force_N;
}

void HapticLoop::run_callback(TickRecord& record, int64_t passed_ns) noexcept {
  if (!callback_.is_set()) return;
  const GripReading& grip = grip_->reading();
  if (!grip.knows_pose() || closing_.load(std::memory_order_acquire)) return callback_.rest();
  if (!has_wanted(record)) record.wanted = {};
  const bool finite = record.wanted.is_finite();
  const Eigen::Vector3d beside_N =
      finite ? record.wanted.force_N : Eigen::Vector3d(Eigen::Vector3d::Zero());
  record.wanted =
      record.wanted + callback_.call({grip.pose, grip.motion.velocity(),
                                      1e-9 * static_cast<double>(passed_ns), grip.buttons},
                                     beside_N, limits_.in_effect());
  record.called_back = true;
}

/// Whether a wrench is wanted, and may be exerted: limits of zero are a pause. Call this after
/// command() has found the state of this tick.
bool HapticLoop::is_fresh(const TickRecord& record) const noexcept {
  return has_wanted(record) && grip_->reading().knows_pose() && state_ != DeviceState::kClosing &&
         (limits_.as_set().max_force_N > 0 || limits_.as_set().max_torque_Nm > 0);
}

/// The strings at rest alone can throw a grip. Whatever the limits are, the damper may therefore
/// exert as much as they do.
SafetyLimits HapticLoop::braking_limits() const noexcept {
  SafetyLimits limits = limits_.in_effect();
  const Wrench& at_rest = grip_->reading().at_rest;
  limits.max_force_N = std::max(limits.max_force_N, at_rest.force_N.norm());
  limits.max_torque_Nm = std::max(limits.max_torque_Nm, at_rest.torque_Nm.norm());
  return limits;
}

void HapticLoop::command(TickRecord& record, const Step& step, int64_t passed_ns) noexcept {
  const double passed_s = 1e-9 * static_cast<double>(passed_ns);
  const bool closing = closing_.load(std::memory_order_acquire);
  const bool nothing = !has_wanted(record) || record.wanted.stacked().isZero(0);
  const bool idle = idle_.idle(!nothing, grip_->reading().pose.position_m, passed_s);
  if (closing || idle) {
    power_ = std::max(power_ - step.falls_s / kRelease_s, 0.0);
    state_ = closing ? DeviceState::kClosing : DeviceState::kIdle;
  } else {
    power_ = std::min(power_ + step.rises_s / kEnergise_s, 1.0);
    state_ = power_ < 1 ? DeviceState::kOpening : DeviceState::kRunning;
  }
  limit(record, step, passed_s);
}

/// Call this after command() has found the state of this tick.
void HapticLoop::limit(TickRecord& record, const Step& step, double passed_s) noexcept {
  const bool fresh = is_fresh(record);
  const GripTraits& grip = grip_->traits();
  const double dt_s = fresh ? step.rises_s : step.falls_s;
  WrenchChain chain{limits_.as_set(),
                    limits_.in_effect(),
                    braking_limits(),
                    vibration_,
                    brake_,
                    safety_,
                    grip,
                    grip_->reading().motion,
                    acknowledged_,
                    fresh,
                    dt_s,
                    passed_s};
  record.commanded = chain.apply(record.wanted);
  record.brakes = chain.brakes;
  counters_.rejected_wrenches += chain.rejected;
}

void HapticLoop::exchange(TickRecord& record, const Step& step) noexcept {
  GripCommand command;
  command.wrench = record.commanded;
  command.fresh = is_fresh(record) || (record.brakes && grip_->reading().knows_pose());
  command.power = power_;
  command.limits = limits_.in_effect();
  command.brakes = record.brakes;
  command.dt_s = is_fresh(record) ? step.rises_s : step.falls_s;
  command.now_ns = record.monotonic_ns;
  const GripReading& grip = grip_->reading();
  const uint64_t pose_errors = grip.pose_errors, string_faults = grip.string_faults;
  const LinkFault fault = grip_->exchange(command);
  if (grip.held_back) ++counters_.held_back_ticks;
  counters_.pose_errors += grip.pose_errors - pose_errors;
  counters_.string_faults += grip.string_faults - string_faults;
  missing_.count(fault == LinkFault::kNone);
  if (fault == LinkFault::kNone) {
    acknowledged_power_ = power_;
    acknowledged_ = record.commanded;
    exerted_ = grip.delivered;
    // A longer interval means that the program was suspended, or the device would be lost.
    const double interval_s = std::min(step.falls_s, kMaxErrors * kTick_s);
    late_s_ +=
        fraction_passed(interval_s, kLateness_s) * (std::max(0.0, interval_s - kTick_s) - late_s_);
    unanswered_ns_ = 0;
    above_rest_ = exerted_ - grip.at_rest;
    above_rest_.torque_Nm -= power_ * record.commanded.torque_Nm;
    return follow(step.falls_s);
  }
  undo(record);
  ++counters_.exchange_errors;
  if (is_lost(fault) || missing_.is_lost()) lose();
}

/// Neither a surface nor a passive callback requests a torque, so a torque beyond the film's is an
/// error of the strings. While the wrench ramps up, the strings exert only a part of the contact
/// force; that must not make the surface softer, so those ticks do not count for it.
void HapticLoop::count_energy(const TickRecord& record) noexcept {
  const Eigen::Vector3d turn_rad = GripMotion::turn_rad(at_, grip_->reading().pose);
  at_ = grip_->reading().pose;
  const bool is_alone = record.wanted.force_N == record.contact.force_N;
  if (record.contact.has_surface && is_alone && safety_.is_ramped()) {
    touch_.set_delivered(above_rest_, turn_rad);
  }
  if (record.called_back) callback_.set_delivered(above_rest_, turn_rad);
}

/// A grip that cannot fly needs no brake. `passed_s` is not limited as a rising force is: however
/// late a tick is, the strings have pulled all the time.
void HapticLoop::follow(double passed_s) noexcept {
  const GripReading& grip = grip_->reading();
  if (!grip_->traits().can_fly) return;
  if (std::fabs(grip.pose.orientation.w()) < std::cos(0.5 * kReleasedTurn_rad)) brake_.release();
  if (!grip.motion.is_known()) return brake_.reset();
  brake_.update(grip.pose.position_m, grip.motion, grip.stored_J, passed_s);
  brake_.pull(grip.delivered.force_N, grip.at_rest.force_N, passed_s);
}

/// The grip may not have received this command, so the next one starts from the last acknowledged.
void HapticLoop::undo(TickRecord& record) noexcept {
  safety_.undo();
  limits_.undo();
  record.commanded = limit_total(acknowledged_, limits_.in_effect());
  record.acknowledged = false;
  power_ = acknowledged_power_;
}

void HapticLoop::publish(const TickRecord& record) noexcept {
  records_.push(record);
  forces_.push({record.monotonic_ns, record.wanted.force_N, record.delivered.force_N});
  LoopSnapshot snapshot{record, counters_, limits_.in_effect()};
  snapshot.untrusted_ns = untrusted_ns_;
  snapshot.unfelt_ns = unfelt_ns_;
  snapshot.vibration = vibration_.state();
  snapshot.late_ns = record.playing ? schedule_.late_ns() : 0;
  snapshot.motion_late_ns = schedule_.motion_late_ns();
  snapshot_.store(snapshot);
}

}  // namespace spidar
