// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/force_feedback_board.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "spidar/boards/opening.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

constexpr int64_t kUpdate_ns = ForceFeedbackBoard::kUpdate_ms * kSecond_ns / 1000;
/// Full deflection of the stick, as a share of the distance from the centre to the strings' exits.
constexpr double kReach = 0.5;
/// The centring spring of a stick returns within this time, because a jump could hurt a hand.
constexpr int kCentring_ms = 100;

template <typename Structure>
MutableBytes bytes_of(Structure& structure) noexcept {
  return {reinterpret_cast<uint8_t*>(&structure), sizeof structure};
}

std::array<uint8_t, sizeof(LastWill::InputEvent)> in_will(const ff::EventBytes& bytes) noexcept {
  const std::optional<ff::Event> event = ff::decode_event(bytes);
  const LastWill::InputEvent kept{event->code, event->value};
  std::array<uint8_t, sizeof kept> packet{};
  std::memcpy(packet.data(), &kept, sizeof kept);
  return packet;
}

int64_t soon_ns() noexcept {
  return monotonic_now_ns() + kSecond_ns / 10;
}

/// Why the driver has not accepted an effect, and what to do.
std::string reason(const Transfer& transfer) {
  const std::string why =
      transfer.error != 0 ? std::strerror(transfer.error) : to_string(transfer.fault);
  switch (transfer.error) {
    case ENOMEM:
    case ENOSPC:
      return why + "; close other programs that use its force feedback";
    case EINVAL:
    case ENOSYS:
      return why + "; its driver does not support this effect, a newer kernel may";
    default:
      return why + "; plug the device in again, and look for messages of its driver in dmesg";
  }
}

}  // namespace

ForceFeedbackBoard::ForceFeedbackBoard(std::string name, const Profile& profile,
                                       std::unique_ptr<Transport> transport, Updates updates)
    : name_(std::move(name)),
      profile_(profile),
      rest_N_(profile.min_tension_N()),
      encoders_(profile),
      transport_(std::move(transport)),
      updates_(updates) {
  for (int i = 0; i < profile.geometry.count; ++i)
    reach_m_ = reach_m_.cwiseMax(
        kReach * profile.geometry.exit_m[static_cast<size_t>(i)].head<2>().cwiseAbs());
}

void ForceFeedbackBoard::open() {
  transport_->open();
  try {
    const LinkFault fault = open_exchange(
        [&](int64_t deadline_ns) {
          return transport_->exchange({ff::kDescribe}, bytes_of(description_), deadline_ns).fault;
        },
        *transport_);
    if (fault != LinkFault::kNone) throw DeviceError(no_answer(name_, fault));
    begin_effects();
    start_updates();
  } catch (...) {
    effect_count_ = 0;
    transport_->close();
    throw;
  }
}

void ForceFeedbackBoard::start_updates() {
  cycle_ = 0;
  for (auto& force_N : force_N_) force_N = 0;
  pulled_ = false;
  has_settings_ = centring_off_ = reopening_ = false;
  ff::Position position;
  const LinkFault fault =
      transport_->exchange({ff::kPosition}, bytes_of(position), soon_ns()).fault;
  if (fault != LinkFault::kNone) throw DeviceError(no_answer(name_, fault));
  place_.start(position, now_ns());
  updated_.start(now_ns());
  if (updates_ == Updates::kInCycle) return;
  stop_ = false;
  thread_ = start_thread("spidar-ff", [this] {
    request_exact_timers();
    request_real_time();
    run();
  });
}

void ForceFeedbackBoard::begin_effects() {
  const std::string device = name_ + ": \"" + description_.name.data() + "\" ";
  if (!description_.constant && !description_.rumble)
    throw DeviceError(device +
                      "has no force feedback (neither FF_CONSTANT nor FF_RUMBLE); spidarctl list "
                      "names devices that have");
  if (description_.effects == 0)
    throw DeviceError(device + "has no room for an effect; another driver may help");
  const bool both = description_.constant && description_.axes > 1 && description_.effects > 1;
  effect_count_ = both ? 2 : 1;
  felt_axes_ = both ? 2 : description_.constant;
  effects_ = {};
  for (size_t i = 0; i < effect_count_; ++i) {
    Transfer transfer = upload(i, 0);
    if (transfer.fault == LinkFault::kNone)
      transfer = send(ff::encode_play(effects_[i].number, true));
    if (transfer.fault != LinkFault::kNone)
      throw DeviceError(device + "does not take an effect: " + reason(transfer));
  }
}

Transfer ForceFeedbackBoard::send(ByteView event) noexcept {
  return transport_->exchange({event}, {}, soon_ns());
}

LinkFault ForceFeedbackBoard::take_settings() noexcept {
  if (has_settings_ || !pulled_) return LinkFault::kNone;
  LinkFault fault = LinkFault::kNone;
  if (description_.gain) fault = send(ff::encode_gain(ff::kFullGain)).fault;
  if (fault == LinkFault::kNone && description_.autocentre) {
    // Also when it fails, because it may have arrived nevertheless.
    centring_off_ = true;
    fault = send(ff::encode_autocentre(0)).fault;
  }
  has_settings_ = fault == LinkFault::kNone;
  return fault;
}

void ForceFeedbackBoard::return_settings() noexcept {
  if (!centring_off_ || !description_.starts_centred) return;
  centring_off_ = false;
  for (int ms = kUpdate_ms; ms <= kCentring_ms; ms += kUpdate_ms) {
    if (send(ff::encode_autocentre(ff::kFullGain * ms / kCentring_ms)).fault != LinkFault::kNone)
      return;
    if (updates_ == Updates::kOwnThread) sleep_until_ns(monotonic_now_ns() + kUpdate_ns);
  }
}

Transfer ForceFeedbackBoard::upload(size_t effect, int level) noexcept {
  Effect& of = effects_[effect];
  const ff::EffectBytes bytes = !description_.constant ? ff::encode_rumble(of.number, level)
                                : effect == 0
                                    ? ff::encode_constant(of.number, ff::Direction::kLeft, -level)
                                    : ff::encode_constant(of.number, ff::Direction::kUp, level);
  const Transfer transfer = transport_->exchange({bytes}, bytes_of(of.number), soon_ns());
  of.known = transfer.fault == LinkFault::kNone;
  if (of.known) of.level = level;
  return transfer;
}

int ForceFeedbackBoard::wanted_level(size_t effect) const noexcept {
  const double right = force_N_[0] / ff::kFullForce_N, up = force_N_[1] / ff::kFullForce_N;
  if (!std::isfinite(right) || !std::isfinite(up)) return 0;
  if (!description_.constant)
    return static_cast<int>(std::lround(ff::kFullStrength * std::min(1.0, std::hypot(right, up))));
  // A force that is too strong keeps its direction.
  const double largest =
      effect_count_ > 1 ? std::max(std::abs(right), std::abs(up)) : std::abs(right);
  const double share = (effect == 0 ? right : up) / std::max(1.0, largest);
  return static_cast<int>(std::lround(ff::kFullLevel * share));
}

int64_t ForceFeedbackBoard::now_ns() const noexcept {
  return updates_ == Updates::kInCycle ? cycle_ * kSecond_ns / 1000 : monotonic_now_ns();
}

LinkFault ForceFeedbackBoard::read_and_set() noexcept {
  ff::Position position;
  LinkFault fault = transport_->exchange({ff::kPosition}, bytes_of(position), soon_ns()).fault;
  if (fault != LinkFault::kNone) return fault;
  place_.see(position, now_ns());
  fault = take_settings();
  if (fault != LinkFault::kNone) return fault;
  for (size_t i = 0; i < effect_count_; ++i) {
    const size_t effect = (turn_ + i) % effect_count_;
    const int level = wanted_level(effect);
    if (effects_[effect].known && effects_[effect].level == level) continue;
    turn_ = effect + 1;
    return upload(effect, level).fault;
  }
  return LinkFault::kNone;
}

void ForceFeedbackBoard::update() noexcept {
  const LinkFault fault = read_and_set();
  if (fault != LinkFault::kNone && fault != LinkFault::kGone) transport_->recover();
  updated_.finish(fault, now_ns());
}

void ForceFeedbackBoard::run() noexcept {
  while (!stop_) {
    update();
    // Counted from the end of the update, so that a slow driver is not called more often.
    sleep_until_ns(monotonic_now_ns() + kUpdate_ns);
  }
}

Pose ForceFeedbackBoard::stick_pose() const noexcept {
  Pose pose;
  pose.position_m.head<2>() = reach_m_.cwiseProduct(place_.share());
  return pose;
}

Eigen::Vector2d ForceFeedbackBoard::force_at(const Pose& pose,
                                             const MotorVolts& volts) const noexcept {
  StringVector tension_N = StringVector::Zero();
  double above = 0;  // how far tensions are above their minimum, as a share of it
  for (int i = 0; i < profile_.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile_.drives[k];
    tension_N[i] = volts.volt[k] * drive.motor_sign * drive.newtons_per_volt;
    if (rest_N_[i] > 0) above = std::max(above, tension_N[i] / rest_N_[i] - 1);
  }
  // The tension of the strings at rest is subtracted, and fades out when tensions rise above their
  // minimum to produce a force. Below the minimum the strings are being ramped to zero.
  StringVector rest_N = std::max(0.0, 1 - above) * rest_N_;
  rest_N = rest_N.cwiseMin(tension_N.cwiseMax(0));
  return structure_matrix(profile_.geometry, pose).topRows<2>() * (tension_N - rest_N);
}

LinkFault ForceFeedbackBoard::cycle(const MotorVolts& volts, DeviceReading& reading,
                                    int64_t) noexcept {
  // The volts were computed for the pose of the previous reading.
  const Eigen::Vector2d force_N = force_at(stick_pose(), volts);
  force_N_[0] = force_N.x();
  force_N_[1] = force_N.y();
  if (std::any_of(volts.volt.begin(), volts.volt.end(), [](double volt) { return volt != 0; }))
    pulled_ = true;
  if (updates_ == Updates::kInCycle && cycle_++ % kUpdate_ms == 0) update();
  const int64_t now = now_ns();
  const LinkFault fault = updated_.report(now);
  if (fault != LinkFault::kNone) return fault;
  place_.advance(now);
  encoders_.to_counts(string_lengths_m(profile_.geometry, stick_pose()), reading.count);
  reading.inputs = 0;
  reading.encoders = false;
  return LinkFault::kNone;
}

void ForceFeedbackBoard::close() noexcept {
  if (thread_.joinable()) {
    stop_ = true;
    thread_.join();
  }
  for (size_t i = 0; i < effect_count_; ++i) {
    if (effects_[i].number == ff::kNewEffect) continue;
    if (effects_[i].level != 0 || !effects_[i].known) upload(i, 0);
    send(ff::encode_play(effects_[i].number, false));
  }
  if (!reopening_) return_settings();
  effect_count_ = 0;
  transport_->close();
}

std::vector<LastWill> ForceFeedbackBoard::last_wills() const {
  const auto first = in_will(ff::encode_play(effects_[0].number, false));
  const auto last = in_will(ff::encode_play(effects_[effect_count_ - 1].number, false));
  return wills(*transport_, {first, last});
}

FeltParts ForceFeedbackBoard::felt_parts() const noexcept {
  const int axes = felt_axes_;
  return {true, axes != 1, false, false, axes != 0};
}

std::string ForceFeedbackBoard::description() const {
  std::string text = std::string(description_.name.data()) + ", ";
  if (!description_.constant)
    return text + "rumble only: the strength of the force is felt, not its direction";
  if (effect_count_ > 1) return text + "force feedback on two axes";
  return text + "force feedback on one axis: forces up and down are not felt";
}

}  // namespace spidar
