// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the boards' packets; tests/README.md says how to run it under libFuzzer.
// The first byte chooses a decoder and its parameters, the rest is the packet. Nothing may be read
// beyond its end, and an accepted packet must be the same after it is written and read again.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "numbers.h"
#include "spidar/devices/cyverse/packets.h"
#include "spidar/devices/falcon/packets.h"
#include "spidar/devices/force_feedback/packets.h"
#include "spidar/devices/inverse3/packets.h"
#include "spidar/devices/mouse/packets.h"
#include "spidar/devices/uart/packets.h"
#include "spidar/link/encoder_counts.h"

using namespace spidar;

namespace {

void fuzz_sh4(ByteView bytes) {
  sh4::Packet packet;
  sh4::Reading reading;
  if (sh4::decode_reading(bytes, reading)) {
    sh4::Reading again;
    sh4::encode_reading(reading, packet);
    require(sh4::decode_reading(packet, again), "fuzz_protocols: an SH4 reading is refused");
    require(again.counter == reading.counter && again.dac_echo == reading.dac_echo &&
                again.adc == reading.adc && again.inputs == reading.inputs,
            "fuzz_protocols: an SH4 reading is another");
    require(reading.rotary() >= 0 && reading.rotary() < 16, "fuzz_protocols: rotary switch");
  }
  CyverseDigits digits{}, digits_again{};
  if (!sh4::decode_update(bytes, digits)) return;
  sh4::encode_update(digits, packet);
  for (int& digit : digits) digit = std::min(digit, sh4::kMaxDigit);
  require(sh4::decode_update(packet, digits_again) && digits == digits_again,
          "fuzz_protocols: SH4 digits are others");
}

void fuzz_simple(ByteView bytes) {
  usb_simple::Packet packet;
  CyverseReading reading;
  if (usb_simple::decode_reading(bytes, reading)) {
    CyverseReading again;
    usb_simple::encode_reading(reading, packet);
    require(usb_simple::decode_reading(packet, again) && again.counter == reading.counter &&
                again.inputs == reading.inputs,
            "fuzz_protocols: a Simple reading is another");
  }
  CyverseDigits digits{};
  usb_simple::decode_command(bytes, digits);
}

void fuzz_uart(ByteView bytes, int board) {
  uart_motor::BoardInfo info;
  const ByteView head(bytes.data, bytes.size < 7 ? bytes.size : 7);
  // Sizes that no decoder has checked must be harmless too.
  info.motors = bytes.u8(3);
  info.forces = bytes.u8(5);
  const ByteView rest(bytes.data + head.size, bytes.size - head.size);
  uart_motor::Reading reading;
  std::array<int, uart_motor::kMaxMotors> digits{};
  uart_motor::decode_reading(rest, board, info, reading);
  uart_motor::decode_current(rest, board, info, digits);
  if (!uart_motor::decode_info(head, board, info)) return;
  std::array<uint8_t, uart_motor::kMaxReplyLength> reply{};
  if (uart_motor::decode_reading(rest, board, info, reading)) {
    const size_t length = uart_motor::encode_reading(reading, board, info, reply);
    uart_motor::Reading again;
    require(uart_motor::decode_reading({reply.data(), length}, board, info, again) &&
                again.position == reading.position && again.velocity == reading.velocity,
            "fuzz_protocols: a UART reading is another");
  }
  std::array<uint8_t, uart_motor::kMaxCycleLength> command{};
  if (uart_motor::decode_current(rest, board, info, digits))
    require(uart_motor::encode_current(board, info, digits, command) > 0,
            "fuzz_protocols: UART digits are refused");
}

void fuzz_mouse(ByteView bytes) {
  mouse::Command command{};
  Eigen::Vector2d force_N;
  if (!mouse::decode_command(bytes, command, force_N) || command != mouse::Command::kForce) return;
  mouse::Report report;
  mouse::encode_force(force_N, report);
  require(mouse::decode_command(report, command, force_N), "fuzz_protocols: a force is refused");
  // Magnitude and direction are single precision: three roundings of 6e-8.
  require(std::hypot(force_N.x(), force_N.y()) <= mouse::kMaxForce_N * (1 + 2e-7),
          "fuzz_protocols: the mouse pulls too hard");
}

void fuzz_force_feedback(ByteView bytes) {
  if (const auto effect = ff::decode_effect(bytes)) {
    // Level −32768 is a step more than full, on both axes at 45°.
    require(std::hypot(effect->right, effect->up) < 1.0001 && effect->rumble >= 0 &&
                effect->rumble <= 1,
            "fuzz_protocols: an effect is stronger than full");
  }
  if (const auto event = ff::decode_event(bytes)) {
    const auto again = ff::decode_event(ff::encode_gain(event->value));
    require(again && again->value == event->value, "fuzz_protocols: an event is another");
  }
}

void fuzz_inverse3(ByteView bytes) {
  inverse3::State state;
  std::array<uint8_t, inverse3::kCommandSize> text{};
  if (inverse3::decode_state(bytes, "", state) == inverse3::Answer::kState) {
    const size_t length = inverse3::encode_state(state, text);
    inverse3::State again;
    require(inverse3::decode_state({text.data(), length}, state.id, again) ==
                    inverse3::Answer::kState &&
                (again.position_m - state.position_m).norm() < 2e-6 &&
                again.buttons == state.buttons,
            "fuzz_protocols: a state of an Inverse3 is another");
  }
  Eigen::Vector3d force_N;
  if (!inverse3::decode_force(bytes, "", force_N)) return;
  state.id = "1";
  const size_t length = inverse3::encode_force(state, force_N, text);
  require(inverse3::decode_force({text.data(), length}, "1", force_N),
          "fuzz_protocols: a force is refused by an Inverse3");
  // Three roundings to a millionth.
  require(force_N.norm() <= inverse3::kLargestForce_N + 2e-6,
          "fuzz_protocols: an Inverse3 pulls too hard");
}

void fuzz_falcon(ByteView bytes) {
  falcon::Packet packet;
  falcon::Reading reading, again;
  if (falcon::decode_reading(bytes, reading)) {
    falcon::encode_reading(reading, packet);
    require(falcon::decode_reading(packet, again) && again.count == reading.count &&
                again.buttons == reading.buttons && again.homed == reading.homed,
            "fuzz_protocols: a reading of a Falcon is another");
  }
  falcon::Command command, command_again;
  if (!falcon::decode_command(bytes, command)) return;
  falcon::encode_command(command, packet);
  require(falcon::decode_command(packet, command_again) && command_again.digit == command.digit &&
              command_again.light == command.light && command_again.homing == command.homing,
          "fuzz_protocols: a command to a Falcon is another");
}

void fuzz_counts(ByteView bytes, int bits) {
  boards::CountUnwrapper unwrapper(bits);
  std::array<uint32_t, kMaxStrings> raw{};
  for (size_t at = 0; at < bytes.size; at += 4 * kMaxStrings) {
    for (size_t i = 0; i < kMaxStrings; ++i) raw[i] = bytes.u32(at + 4 * i);
    const auto before = unwrapper.counts();
    const bool followed = unwrapper.update(raw, kMaxStrings);
    for (size_t i = 0; i < kMaxStrings; ++i) {
      const int64_t step = int64_t{unwrapper.counts()[i]} - before[i];
      require(followed || step == 0, "fuzz_protocols: a count jumped");
      // Back from a step that was wrong, and on.
      require(std::abs(step) <= 2 * boards::CountUnwrapper::kMaxStep ||
                  std::abs(step) > (int64_t{1} << 31),
              "fuzz_protocols: a count went too far");
    }
    if (!followed) unwrapper.begin(raw, kMaxStrings);
  }
}

/// Its beginning: packets are taken in their own length only, which a fuzzer seldom meets.
ByteView first(ByteView bytes, size_t size) {
  return {bytes.data, bytes.size < size ? bytes.size : size};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const ByteView rest(data + 1, size - 1);
  switch (data[0] % 5) {
    case 0:
      fuzz_sh4(data[0] & 128 ? rest : first(rest, sh4::kPacketSize));
      break;
    case 1:
      fuzz_simple(data[0] & 128 ? rest : first(rest, usb_simple::kPacketSize));
      break;
    case 2:
      fuzz_uart(rest, data[0] >> 5);
      break;
    case 3:
      fuzz_mouse(data[0] & 128 ? rest : first(rest, mouse::kReportSize));
      break;
    default:
      if (data[0] & 32) {
        fuzz_inverse3(rest);
        break;
      }
      if (data[0] & 16) {
        fuzz_falcon(data[0] & 128 ? rest : first(rest, falcon::kPacketSize));
        break;
      }
      if (data[0] & 64) {
        fuzz_force_feedback(
            first(rest, data[0] & 128 ? size_t{ff::kEffectSize} : size_t{ff::kEventSize}));
        break;
      }
      fuzz_counts(rest, data[0] & 128 ? 16 : 24);
      break;
  }
  return 0;
}
