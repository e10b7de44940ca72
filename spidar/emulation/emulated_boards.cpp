// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The CyVerse boards and the SPIDAR-mouse.
#include "spidar/emulation/emulated_boards.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace spidar::emulated {
namespace {

template <size_t N>
std::array<int, kMaxStrings> as_ints(const std::array<uint16_t, N>& digits) noexcept {
  std::array<int, kMaxStrings> ints{};
  std::copy(digits.begin(), digits.end(), ints.begin());
  return ints;
}

size_t copy_out(ByteView packet, MutableBytes bytes, bool& due) noexcept {
  if (!due || bytes.size < packet.size) return 0;
  due = false;
  std::copy_n(packet.data, packet.size, bytes.data);
  return packet.size;
}

}  // namespace

void Sh4::receive(ByteView bytes) noexcept {
  CyverseDigits digits{};
  if (!sh4::decode_update(bytes, digits)) return;
  motors_->put_out(as_ints(digits));
  const std::array<int32_t, kMaxStrings> counts = motors_->counts();
  sh4::Reading reading;
  reading.dac_echo = digits;
  for (size_t i = 0; i < sh4::kChannels; ++i) {
    reading.counter[i] = 0u - static_cast<uint32_t>(counts[i]);
  }
  reading.inputs = motors_->inputs();
  sh4::encode_reading(reading, packet_);
  due_ = true;
}

size_t Sh4::reply(MutableBytes bytes) noexcept {
  return copy_out(packet_, bytes, due_);
}

void Simple::receive(ByteView bytes) noexcept {
  CyverseDigits digits{};
  const std::optional<usb_simple::Command> command = usb_simple::decode_command(bytes, digits);
  if (!command) return;
  switch (*command) {
    case usb_simple::Command::kSetDac:
      motors_->put_out(as_ints(digits));
      break;
    case usb_simple::Command::kLatchCounters: {
      const std::array<int32_t, kMaxStrings> counts = motors_->counts();
      CyverseReading reading;
      for (size_t i = 0; i < usb_simple::kChannels; ++i) {
        reading.counter[i] = static_cast<uint32_t>(counts[i]);
      }
      reading.inputs = motors_->inputs();
      usb_simple::encode_reading(reading, packet_);
      due_ = true;
      break;
    }
    case usb_simple::Command::kEncoderDirection:
      break;  // the wiring is right already
  }
}

size_t Simple::reply(MutableBytes bytes) noexcept {
  return copy_out(packet_, bytes, due_);
}

void Mouse::receive(ByteView bytes) noexcept {
  mouse::Command command{};
  Eigen::Vector2d force_N;
  if (!mouse::decode_command(bytes, command, force_N)) return;
  if (command == mouse::Command::kQuery) due_ = true;
  if (command == mouse::Command::kStart) started_ = true;
  if (command == mouse::Command::kStop) started_ = false;
  std::array<int, kMaxStrings> milli_N{};
  if (command == mouse::Command::kForce && started_) {
    milli_N[0] = static_cast<int>(std::lround(1000 * force_N.x()));
    milli_N[1] = static_cast<int>(std::lround(1000 * force_N.y()));
  }
  if (command == mouse::Command::kForce || command == mouse::Command::kStop) {
    motors_->put_out(milli_N);
  }
}

size_t Mouse::reply(MutableBytes bytes) noexcept {
  mouse::Report report;
  mouse::encode_state(report);
  return copy_out(report, bytes, due_);
}

void Uart::receive(ByteView bytes) noexcept {
  for (size_t i = 0; i < bytes.size; ++i) {
    if (!station_) {
      begin(bytes.u8(i));
    } else {
      command_[taken_++] = bytes.u8(i);
    }
    if (station_ && taken_ == length_) end_of_command();
  }
}

/// A byte between commands: a zero gives time for a reply, anything else is a header.
void Uart::begin(uint8_t header) noexcept {
  if (header == 0) return;
  first_ = 0;
  for (const Station& station : stations_) {
    const auto lengths = uart_motor::command_lengths(station.info.motors, station.info.forces);
    const size_t command = header >> 3;
    if (station.id == (header & 7) && command < lengths.size()) {
      station_ = &station;
      length_ = lengths[command];
      command_[0] = header;
      taken_ = 1;
      return;
    }
    first_ += station.info.motors;
  }
}

void Uart::put_reply(ByteView reply) noexcept {
  const size_t length = std::min(reply.size, reply_.size() - due_);
  std::copy_n(reply.data, length, reply_.begin() + static_cast<long>(due_));
  due_ += length;
}

void Uart::end_of_command() noexcept {
  const Station& station = *station_;
  station_ = nullptr;
  const ByteView command(command_.data(), taken_);
  std::array<int, uart_motor::kMaxMotors> digits{};
  if (command.u8(0) == uart_motor::header(station.id, uart_motor::Command::kBoardInfo)) {
    std::array<uint8_t, uart_motor::kInfoLength> info{};
    uart_motor::encode_info(station.info, station.id, info);
    put_reply(info);
  } else if (uart_motor::decode_current(command, station.id, station.info, digits)) {
    const size_t motors = std::min<size_t>(station.info.motors, kMaxStrings - first_);
    std::copy_n(digits.begin(), motors, digits_.begin() + static_cast<long>(first_));
    motors_->put_out(digits_);
    const std::array<int32_t, kMaxStrings> counts = motors_->counts();
    uart_motor::Reading reading;
    for (size_t i = 0; i < motors; ++i) {
      reading.position[i] = static_cast<uint16_t>(counts[first_ + i]);
    }
    std::array<uint8_t, uart_motor::kMaxReplyLength> reply{};
    const size_t length = uart_motor::encode_reading(reading, station.id, station.info, reply);
    put_reply({reply.data(), length});
  }
}

size_t Uart::reply(MutableBytes bytes) noexcept {
  const size_t length = std::min(bytes.size, due_);
  std::copy_n(reply_.begin(), length, bytes.data);
  std::copy(reply_.begin() + static_cast<long>(length), reply_.begin() + static_cast<long>(due_),
            reply_.begin());
  due_ -= length;
  return length;
}

}  // namespace spidar::emulated
