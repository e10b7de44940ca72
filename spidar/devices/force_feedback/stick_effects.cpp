// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/force_feedback/stick_effects.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "spidar/link/board_parts.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar::boards {
namespace {

constexpr int64_t kMs = kSecond_ns / 1000;
constexpr int64_t kUpdate_ns = StickEffects::kUpdate_ms * kMs;
constexpr int64_t kRefresh_ns = StickEffects::kRefresh_ms * kMs;
/// The centring spring of a stick returns gradually in this time: a jump could hurt a hand.
constexpr int kCentring_ms = 100;

template <typename Structure>
MutableBytes bytes_of(Structure& structure) noexcept {
  return {reinterpret_cast<uint8_t*>(&structure), sizeof structure};
}

LastWill::InputEvent event_of(const ff::EventBytes& bytes) noexcept {
  const std::optional<ff::Event> event = ff::decode_event(bytes);
  return {event->code, event->value};
}

std::array<uint8_t, sizeof(LastWill::InputEvent)> to_packet(const ff::EventBytes& bytes) noexcept {
  const LastWill::InputEvent kept = event_of(bytes);
  std::array<uint8_t, sizeof kept> packet{};
  std::memcpy(packet.data(), &kept, sizeof kept);
  return packet;
}

/// Returns why the driver has not accepted an effect, and what to do.
std::string reason(const Transfer& transfer) {
  const std::string why =
      transfer.error != 0 ? std::strerror(transfer.error) : to_string(transfer.fault);
  switch (transfer.error) {
    case ENOMEM:
    case ENOSPC:
      return why + "; close other programs that use its force feedback";
    case EINVAL:
    case ENOSYS:
      return why +
             "; its driver does not support this effect, a newer kernel may: hid-pidff drives "
             "more devices since Linux 6.15";
    default:
      return why + "; plug the device in again, and look for messages of its driver in dmesg";
  }
}

}  // namespace

StickEffects::StickEffects(std::string name, std::unique_ptr<Transport> transport, Updates updates,
                           const Options& options)
    : name_(std::move(name)),
      transport_(std::move(transport)),
      updates_(updates),
      options_(options) {}

/// True while a driver has not returned.
bool StickEffects::thread_runs() const {
  return ended_.valid() && ended_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

void StickEffects::open() {
  if (thread_runs()) {
    throw DeviceError(
        name_ + ": its driver has not returned from a call yet; plug the device in again",
        DeviceErrorCode::kBusy);
  }
  transport_->open();
  try {
    const LinkFault fault = open_exchange(
        [&](int64_t deadline_ns) {
          return transport_->exchange({ff::kDescribe}, bytes_of(description_), deadline_ns).fault;
        },
        *transport_);
    if (fault != LinkFault::kNone) throw no_answer(name_, fault);
    former_settings_ = former_settings();
    begin_effects();
    start_updates();
  } catch (...) {
    effect_count_ = 0;
    transport_->close();
    throw;
  }
}

void StickEffects::start_updates() {
  cycle_ = 0;
  for (auto& force_N : force_N_) force_N = 0;
  pulled_ = reopening_ = false;
  has_settings_ = false;
  ff::Position position;
  const LinkFault fault =
      transport_->exchange({ff::kPosition}, bytes_of(position), soon_ns()).fault;
  if (fault != LinkFault::kNone) throw no_answer(name_, fault);
  position_.start(position, now_ns());
  updated_.start(now_ns());
  cycled_ns_ = now_ns();
  if (updates_ == Updates::kInCycle) return;
  stop_ = false;
  std::promise<void> end;
  ended_ = end.get_future();
  thread_ = start_thread("spidar-ff", [self = shared_from_this(), end = std::move(end)]() mutable {
    request_exact_timers();
    request_real_time();
    self->run();
    self.reset();
    end.set_value();
  });
}

void StickEffects::begin_effects() {
  const std::string device = name_ + ": \"" + description_.name.data() + "\" ";
  if (!description_.constant && !description_.rumble) {
    throw DeviceError(
        device +
            "has no force feedback (neither FF_CONSTANT nor FF_RUMBLE); spidarctl list "
            "names devices that have",
        DeviceErrorCode::kSettings);
  }
  if (description_.effects == 0) {
    throw DeviceError(device + "has no room for an effect; another driver may help");
  }
  const bool both = description_.constant && description_.axes > 1 && description_.effects > 1;
  effect_count_ = both ? 2 : 1;
  effects_ = {};
  for (size_t i = 0; i < effect_count_; ++i) {
    Transfer transfer = upload(i, 0);
    if (transfer.fault == LinkFault::kNone) transfer = play(i);
    if (transfer.fault != LinkFault::kNone) {
      throw DeviceError(device + "does not take an effect: " + reason(transfer),
                        transfer.error == ENOMEM || transfer.error == ENOSPC
                            ? DeviceErrorCode::kBusy
                            : DeviceErrorCode::kFailed);
    }
  }
}

Transfer StickEffects::send(ByteView event) noexcept {
  return transport_->exchange({event}, {}, soon_ns());
}

Transfer StickEffects::play(size_t effect) noexcept {
  const Transfer transfer = send(ff::encode_play(effects_[effect].number, true));
  if (transfer.fault == LinkFault::kNone) effects_[effect].played_ns = now_ns();
  return transfer;
}

LinkFault StickEffects::apply_settings() noexcept {
  if (has_settings_ || !pulled_) return LinkFault::kNone;
  LinkFault fault = LinkFault::kNone;
  // A call that fails also counts, because the setting may have arrived nevertheless.
  settings_changed_ = true;
  if (description_.gain) {
    fault = send(ff::encode_gain(static_cast<int>(std::lround(ff::kFullGain * gain())))).fault;
  }
  if (fault == LinkFault::kNone && description_.autocentre) {
    fault = send(ff::encode_autocentre(0)).fault;
  }
  has_settings_ = fault == LinkFault::kNone;
  return fault;
}

std::vector<ff::EventBytes> StickEffects::former_settings() const {
  std::vector<ff::EventBytes> events;
  if (description_.gain && gain() < 1) events.push_back(ff::encode_gain(ff::kFullGain));
  if (!description_.autocentre || !description_.starts_centred) return events;
  for (int ms = kUpdate_ms; ms <= kCentring_ms; ms += kUpdate_ms) {
    events.push_back(ff::encode_autocentre(ff::kFullGain * ms / kCentring_ms));
  }
  return events;
}

void StickEffects::restore_settings() noexcept {
  if (!std::exchange(settings_changed_, false)) return;
  for (const ff::EventBytes& event : former_settings_) {
    if (send(event).fault != LinkFault::kNone) return;
    if (updates_ == Updates::kOwnThread) sleep_until_ns(monotonic_now_ns() + kUpdate_ns);
  }
}

void StickEffects::return_settings_later() noexcept {
  if (thread_runs() || !settings_changed_) return;
  try {
    transport_->open();
  } catch (const std::exception&) {
    return;  // the device was unplugged: its driver resets the settings when it is plugged in
  }
  restore_settings();
  transport_->close();
}

Transfer StickEffects::upload(size_t effect, int level) noexcept {
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

int StickEffects::wanted_level(size_t effect) const noexcept {
  const double right = force_N_[0] / ff::kFullForce_N, up = force_N_[1] / ff::kFullForce_N;
  if (!std::isfinite(right) || !std::isfinite(up)) return 0;
  // A driver without a gain gets smaller levels instead.
  const double fraction_used = description_.gain ? 1 : gain();
  if (!description_.constant) {
    return static_cast<int>(
        std::lround(fraction_used * ff::kFullStrength * std::min(1.0, std::hypot(right, up))));
  }
  // The limit keeps the direction of a force that is too strong.
  const double largest =
      effect_count_ > 1 ? std::max(std::abs(right), std::abs(up)) : std::abs(right);
  const double side = options_.flipped[effect] ? -1 : 1;
  const double fraction = side * (effect == 0 ? right : up) / std::max(1.0, largest);
  return static_cast<int>(std::lround(fraction_used * ff::kFullLevel * fraction));
}

int64_t StickEffects::now_ns() const noexcept {
  return updates_ == Updates::kInCycle ? cycle_ * kSecond_ns / 1000 : monotonic_now_ns();
}

LinkFault StickEffects::read_and_set() noexcept {
  ff::Position position;
  LinkFault fault = transport_->exchange({ff::kPosition}, bytes_of(position), soon_ns()).fault;
  if (fault != LinkFault::kNone) return fault;
  position_.update(position, now_ns());
  fault = apply_settings();
  if (fault == LinkFault::kNone) fault = set_one_level();
  return fault == LinkFault::kNone ? refresh() : fault;
}

LinkFault StickEffects::set_one_level() noexcept {
  for (size_t i = 0; i < effect_count_; ++i) {
    const size_t effect = (turn_ + i) % effect_count_;
    const int level = wanted_level(effect);
    if (effects_[effect].known && effects_[effect].level == level) continue;
    turn_ = effect + 1;
    return upload(effect, level).fault;
  }
  return LinkFault::kNone;
}

/// Restarts effects that are not at rest. An upload does not prolong an effect with every driver:
/// hid-pidff sends only what has changed.
LinkFault StickEffects::refresh() noexcept {
  const int64_t time_ns = now_ns();
  // Effects of a loop that hangs must end.
  if (time_ns - cycled_ns_ > kRefresh_ns) return LinkFault::kNone;
  for (size_t i = 0; i < effect_count_; ++i) {
    // The guardian may have stopped an effect that is about to be set to rest.
    const bool rests = effects_[i].level == 0 || wanted_level(i) == 0;
    if (rests || time_ns - effects_[i].played_ns < kRefresh_ns) continue;
    const LinkFault fault = play(i).fault;
    if (fault != LinkFault::kNone) return fault;
  }
  return LinkFault::kNone;
}

void StickEffects::update() noexcept {
  const LinkFault fault = read_and_set();
  if (fault != LinkFault::kNone && fault != LinkFault::kGone) transport_->recover();
  updated_.finish(fault, now_ns());
}

void StickEffects::run() noexcept {
  while (!stop_) {
    update();
    // The pause begins at the end of the update, so that a slow driver is not called more often.
    sleep_until_ns(monotonic_now_ns() + kUpdate_ns);
  }
  end_effects();
}

LinkFault StickEffects::cycle(const Eigen::Vector2d& force_N, bool pulls) noexcept {
  force_N_[0] = force_N.x();
  force_N_[1] = force_N.y();
  if (pulls) pulled_ = true;
  cycled_ns_ = now_ns();
  if (updates_ == Updates::kInCycle && cycle_++ % kUpdate_ms == 0) update();
  const int64_t now = now_ns();
  const LinkFault fault = updated_.report(now);
  if (fault == LinkFault::kNone) position_.advance(now);
  return fault;
}

void StickEffects::close(bool reopening) noexcept {
  reopening_ = reopening;
  if (!thread_.joinable()) {
    // If the driver hangs, the thread ends the effects later.
    if (updates_ == Updates::kInCycle && effect_count_ > 0) end_effects();
    if (!reopening) return_settings_later();
    return;
  }
  stop_ = true;
  const auto limit = std::chrono::milliseconds(kCentring_ms + kHang_ms);
  if (ended_.wait_for(limit) == std::future_status::ready) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void StickEffects::end_effects() noexcept {
  bool rests = true;
  for (size_t i = 0; i < effect_count_; ++i) {
    if (effects_[i].number == ff::kNewEffect) continue;
    if (effects_[i].level != 0 || !effects_[i].known) upload(i, 0);
    const bool stopped = send(ff::encode_play(effects_[i].number, false)).fault == LinkFault::kNone;
    rests = rests && (stopped || (effects_[i].level == 0 && effects_[i].known));
  }
  // A higher gain would strengthen an effect that still plays: wait until it ends by itself.
  if (!rests && !reopening_ && updates_ == Updates::kOwnThread) {
    sleep_until_ns(monotonic_now_ns() + kEffect_ms * kMs);
  }
  if (!reopening_) restore_settings();
  effect_count_ = 0;
  transport_->close();
}

std::vector<LastWill> StickEffects::last_wills() const {
  const auto first = to_packet(ff::encode_play(effects_[0].number, false));
  const auto last = to_packet(ff::encode_play(effects_[effect_count_ - 1].number, false));
  std::vector<LastWill> will = wills(*transport_, {first, last});
  static_assert(1 + kCentring_ms / kUpdate_ms <= LastWill::kMaxSettings);
  static_assert(kUpdate_ms == kSetting_ms);
  for (LastWill& last_will : will) {
    for (const ff::EventBytes& event : former_settings_) {
      last_will.setting[last_will.settings++] = event_of(event);
    }
  }
  return will;
}

}  // namespace spidar::boards
