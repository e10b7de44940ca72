// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reports of the SPIDAR-mouse: a HID with two force axes.
///
/// Source: micuat/SPIDAR-mouse-UNIX src/spidarMouse.cpp. The USB id belongs to Microchip's
/// demonstrations, so other devices have it, too; we infer that the endpoints are those of the
/// demonstrations. The functions only convert bytes.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "spidar/transports/bytes.h"

namespace spidar::mouse {

constexpr uint16_t kVendor = 0x04D8;
constexpr uint16_t kProduct = 0x003F;
constexpr uint8_t kEndpointOut = 0x01;
constexpr uint8_t kEndpointIn = 0x81;
constexpr size_t kReportSize = 64;
/// The limit of the total force. The published program limits each axis to this value, so its
/// diagonal is stronger.
constexpr double kMaxForce_N = 1.5;
constexpr double kMinForce_N = 0.3;

using Report = std::array<uint8_t, kReportSize>;

enum class Command : uint8_t {
  kStart = 0x80,
  kQuery = 0x82,  ///< Microchip's demonstrations do not answer this command
  kForce = 0x97,
  kStop = 0x99,
};

void encode_query(Report& report) noexcept;
/// Contains the published constants from force to duty.
void encode_start(Report& report) noexcept;
/// Encodes the force on the hand, x right, y away from the user (its sign is inferred), reduced to
/// kMaxForce_N; NaN counts as zero. The position of the grip is sent as the centre.
void encode_force(const Eigen::Vector2d& force_N, Report& report) noexcept;
void encode_stop(Report& report) noexcept;

/// Decodes a report to the device. Returns false unless the report is one of the commands and has
/// kReportSize bytes. `force_N` is written only with kForce.
bool decode_command(ByteView report, Command& command, Eigen::Vector2d& force_N) noexcept;

/// We infer that the answer to kQuery begins with the number of kQuery.
bool is_state(ByteView report) noexcept;
void encode_state(Report& report) noexcept;

}  // namespace spidar::mouse
