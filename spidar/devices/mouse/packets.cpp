// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/mouse/packets.h"

#include <cmath>
#include <cstring>

namespace spidar::mouse {
namespace {

// The published constants from force to duty, whose meaning is not published.
constexpr float kDutyA = 47.9867F;
constexpr float kDutyB = 13.1215F;
constexpr size_t kNumbersAt = 1;

void begin(Command command, Report& report) noexcept {
  report.fill(0);
  report[0] = static_cast<uint8_t>(command);
}

void write_float(Report& report, size_t index, float value) noexcept {
  uint32_t bits = 0;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  MutableBytes(report).put_u32(kNumbersAt + 4 * index, bits);
}

float get_float(ByteView report, size_t index) noexcept {
  const uint32_t bits = report.u32(kNumbersAt + 4 * index);
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

void encode_query(Report& report) noexcept {
  begin(Command::kQuery, report);
}

void encode_start(Report& report) noexcept {
  begin(Command::kStart, report);
  write_float(report, 0, static_cast<float>(kMinForce_N));
  write_float(report, 1, static_cast<float>(kMaxForce_N));
  write_float(report, 2, kDutyA);
  write_float(report, 3, kDutyB);
}

void encode_force(const Eigen::Vector2d& force_N, Report& report) noexcept {
  begin(Command::kForce, report);
  const double total_N = std::hypot(force_N.x(), force_N.y());
  if (!std::isfinite(total_N) || total_N <= 0) return;
  // Numbers 0 and 1 are the position of the grip, which no sensor measures.
  write_float(report, 2, static_cast<float>(std::fmin(total_N, kMaxForce_N)));
  write_float(report, 3, static_cast<float>(force_N.x() / total_N));
  write_float(report, 4, static_cast<float>(force_N.y() / total_N));
}

void encode_stop(Report& report) noexcept {
  begin(Command::kStop, report);
}

bool decode_command(ByteView report, Command& command, Eigen::Vector2d& force_N) noexcept {
  if (report.size != kReportSize) return false;
  switch (static_cast<Command>(report.u8(0))) {
    case Command::kForce: {
      const double magnitude_N = static_cast<double>(get_float(report, 2));
      force_N = {magnitude_N * static_cast<double>(get_float(report, 3)),
                 magnitude_N * static_cast<double>(get_float(report, 4))};
      break;
    }
    case Command::kStart:
    case Command::kQuery:
    case Command::kStop:
      break;
    default:
      return false;
  }
  command = static_cast<Command>(report.u8(0));
  return true;
}

bool is_state(ByteView report) noexcept {
  return report.size == kReportSize && report.u8(0) == static_cast<uint8_t>(Command::kQuery);
}

void encode_state(Report& report) noexcept {
  begin(Command::kQuery, report);
}

}  // namespace spidar::mouse
