// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/emulation/emulated_force_devices.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <Eigen/LU>

#include "spidar/boards/falcon_kinematics.h"

namespace spidar::emulated {
namespace {

/// Data of a packet while the firmware runs: its answers come in two parts.
constexpr size_t kPart = 9;

bool is(const VendorRequest& request, const VendorRequest& other) noexcept {
  return request.request == other.request && request.value == other.value;
}

/// The force that these motors cause on the hand, N; zero where the arms determine nothing.
Eigen::Vector3d force_N(const std::array<int, 3>& digit, const Eigen::Vector3d& angles_rad,
                        const Eigen::Vector3d& position_m) noexcept {
  const auto jacobian = falcon::jacobian(angles_rad, position_m);
  if (!jacobian) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d torque_Nm =
      Eigen::Vector3d(digit[0], digit[1], digit[2]) / falcon::kDigitsPerNm;
  return jacobian->transpose().inverse() * torque_Nm;
}

}  // namespace

bool Falcon::control(const VendorRequest& request) noexcept {
  if (request.request == ftdi::kSetBaud) {
    memory_->baud = request.value;
    loader_ = loader_ && request.value != falcon::kRunBaud;
    taken_ = 0;
  } else if (is(request, ftdi::kDtrHigh) && memory_->baud == falcon::kHelloBaud) {
    loader_ = true;
    takes_firmware_ = memory_->loaded = false;
  } else if (is(request, ftdi::kDropReceived)) {
    due_ = 0;
  }
  return true;
}

void Falcon::receive(ByteView bytes) noexcept {
  for (size_t i = 0; i < bytes.size; ++i) {
    if (memory_->baud == falcon::kHelloBaud) {
      hello(bytes.u8(i));
    } else if (memory_->baud == falcon::kLoadBaud) {
      load(bytes.u8(i));
    } else if (memory_->baud == falcon::kRunBaud) {
      run(bytes.u8(i));
    }
  }
}

/// Returns true when `length` bytes have been collected.
bool Falcon::feed(uint8_t byte, size_t length) noexcept {
  packet_[taken_++] = byte;
  if (taken_ < length) return false;
  taken_ = 0;
  return true;
}

void Falcon::hello(uint8_t byte) noexcept {
  if (!loader_ || !feed(byte, falcon::kHello.size())) return;
  if (std::equal(falcon::kHello.begin(), falcon::kHello.end(), packet_.begin())) {
    answer(falcon::kHelloAnswer);
  }
}

/// Echoes everything; what follows the first byte is the firmware.
void Falcon::load(uint8_t byte) noexcept {
  if (!loader_) return;
  answer({&byte, 1});
  if (takes_firmware_) memory_->loaded = true;
  takes_firmware_ = true;
}

void Falcon::run(uint8_t byte) noexcept {
  falcon::Command command;
  if (!memory_->loaded || !feed(byte, falcon::kPacketSize)) return;
  if (falcon::decode_command(packet_, command)) handle(command);
}

void Falcon::handle(const falcon::Command& command) noexcept {
  const Eigen::Vector3d at_m = position_m(*motors_);
  // Beyond its reach, the grip stays where it was.
  angles_rad_ = falcon::arm_angles(at_m).value_or(angles_rad_);
  put_out_N(*motors_, force_N(command.digit, angles_rad_, at_m));
  falcon::Reading reading;
  for (size_t i = 0; i < 3; ++i) {
    reading.count[i] = falcon::count_at(angles_rad_[static_cast<Eigen::Index>(i)]);
  }
  const uint16_t inputs = motors_->inputs();
  reading.buttons = inputs & 0xF;
  if (command.homing) reading.homed = inputs >> 4 & 7;
  falcon::Packet packet;
  falcon::encode_reading(reading, packet);
  answer(packet);
}

void Falcon::answer(ByteView bytes) noexcept {
  timer_first_ = due_ == 0;
  const size_t length = std::min(bytes.size, answer_.size() - due_);
  std::copy_n(bytes.data, length, answer_.begin() + static_cast<long>(due_));
  due_ += length;
}

size_t Falcon::reply(MutableBytes bytes) noexcept {
  if (due_ == 0 || bytes.size <= ftdi::kStatusSize) return 0;
  bytes.put_u16(0, 0x6001);  // modem and line status of an idle chip
  const size_t part = memory_->baud == falcon::kRunBaud ? kPart : falcon::kPieceSize;
  const size_t length = timer_first_ ? 0 : std::min({due_, part, bytes.size - ftdi::kStatusSize});
  timer_first_ = false;
  std::copy_n(answer_.begin(), length, bytes.data + ftdi::kStatusSize);
  std::copy(answer_.begin() + static_cast<long>(length), answer_.begin() + static_cast<long>(due_),
            answer_.begin());
  due_ -= length;
  return ftdi::kStatusSize + length;
}

ff::Description ForceFeedback::stick() noexcept {
  ff::Description description;
  description.constant = description.rumble = description.gain = description.autocentre = 1;
  description.effects = 16;
  description.axes = 2;
  constexpr char kName[] = "emulated stick";
  std::copy(std::begin(kName), std::end(kName), description.name.begin());
  return description;
}

template <typename Structure>
void ForceFeedback::answer(const Structure& structure) noexcept {
  static_assert(sizeof structure <= sizeof(ff::Description));
  std::memcpy(reply_.data(), &structure, sizeof structure);
  due_ = sizeof structure;
}

void ForceFeedback::upload(const ff::Effect& effect) noexcept {
  const size_t room = std::min<size_t>(slots_.size(), description_.effects);
  size_t at = static_cast<size_t>(effect.number);
  if (effect.number == ff::kNewEffect) {
    at = 0;
    while (at < room && slots_[at].used) ++at;
  }
  if (at >= room) return;
  slots_[at].effect = effect;
  slots_[at].used = true;
  answer(static_cast<int16_t>(at));
  put_out();
}

void ForceFeedback::receive(ByteView bytes) noexcept {
  if (bytes.size == ff::kDescribeSize) {
    answer(description_);
  } else if (bytes.size == ff::kPositionSize) {
    const std::array<int32_t, kMaxStrings> counts = motors_->counts();
    answer(ff::Position{static_cast<int16_t>(counts[0]), static_cast<int16_t>(counts[1])});
  } else if (const auto effect = ff::decode_effect(bytes)) {
    upload(*effect);
  } else if (const auto event = ff::decode_event(bytes)) {
    if (event->code >= slots_.size()) return;  // gain or autocentre: no effect
    slots_[event->code].plays = event->value > 0;
    put_out();
  }
}

void ForceFeedback::put_out() noexcept {
  double right = 0, up = 0, rumble = 0;
  for (const Slot& slot : slots_) {
    if (!slot.plays) continue;
    right += slot.effect.right;
    up += slot.effect.up;
    rumble += slot.effect.rumble;
  }
  motors_->put_out({static_cast<int>(std::lround(right * ff::kFullLevel)),
                    static_cast<int>(std::lround(up * ff::kFullLevel)),
                    static_cast<int>(std::lround(rumble * ff::kFullStrength))});
}

size_t ForceFeedback::reply(MutableBytes bytes) noexcept {
  const size_t length = std::min(bytes.size, due_);
  std::copy_n(reply_.begin(), length, bytes.data);
  due_ = 0;
  return length;
}

void Inverse3::receive(ByteView bytes) noexcept {
  due_ = true;
  Eigen::Vector3d force_N;
  if (inverse3::decode_force(bytes, state.id, force_N)) put_out_N(*motors_, force_N);
}

size_t Inverse3::reply(MutableBytes bytes) noexcept {
  if (!due_) return 0;
  due_ = false;
  state.position_m = position_m(*motors_);
  state.buttons = motors_->inputs();
  return inverse3::encode_state(state, bytes);
}

void Sound::receive(ByteView bytes) noexcept {
  sound::Levels levels;
  if (bytes.size != sizeof levels) return;
  std::memcpy(&levels, bytes.data, sizeof levels);
  std::array<int, kMaxStrings> digits{};
  for (size_t i = 0; i < sound::kMaxChannels; ++i) {
    digits[i] = static_cast<int>(std::lround(1000 * levels.level[i]));
  }
  motors_->put_out(digits);
  due_ = true;
}

size_t Sound::reply(MutableBytes bytes) noexcept {
  if (!std::exchange(due_, false) || bytes.size < sizeof state) return 0;
  std::memcpy(bytes.data, &state, sizeof state);
  return sizeof state;
}

}  // namespace spidar::emulated
