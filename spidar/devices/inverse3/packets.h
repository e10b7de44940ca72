// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Messages of Haply's Inverse Service about an Inverse3: JSON text on a WebSocket.
///
/// Sources: docs.haply.co/inverseSDK (WebSocket protocol, control commands, mount and workspace)
/// for version 3.5 of the service; isaac-sim/IsaacLab devices/haply/se3_haply.py for version 3.1,
/// which has another key in the command; the crate haply 1.3.1 for the fields of a message. The
/// service answers each message with one that has the state of every device. Positions are in m,
/// forces in N, x to the right, y away from the user, z up.
///
/// Inferred: the version from the state, which has current_cursor_force since 3.5; the middle of
/// the workspace without the preset that puts the origin there (the crate's examples place their
/// objects there); the order of the buttons; and the largest force, which only distributors state.
/// The functions only convert text and numbers; the parser of JSON allocates.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "spidar/transports/bytes.h"

namespace spidar::inverse3 {

constexpr uint16_t kPort = 10001;
constexpr double kLargestForce_N = 10;
/// The published examples keep the cursor this close to the middle of the workspace.
constexpr double kReach_m = 0.1;
/// Every valid position is nearer to the foot of the device; a larger number has another unit.
constexpr double kFarthest_m = 1;
constexpr int kButtons = 3;
constexpr size_t kCommandSize = 512;  ///< longest message to the service
/// The capacity for the state of more devices than a computer has, with their configuration.
constexpr size_t kStateSize = 65536;

enum class Version {
  k31,  ///< the force is "values", the origin at the foot of the device
  k35,  ///< the force is "vector", and a preset puts the origin into the middle of the workspace
};

/// The state of a device in one message. Device frame: right, up, towards the viewer.
struct State {
  std::string id;
  Version version = Version::k31;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< from the middle of the workspace
  uint32_t buttons = 0;  ///< of the handle: a (or the only button), b, c
  bool calibrated = true;
  bool powered = true;
};

enum class Answer {
  kState,
  kAbsent,  ///< the service does not list the device
  kBroken,  ///< not JSON, a missing field, or an impossible number
};

/// Finds the device `id`, or the first device if `id` is empty.
Answer decode_state(ByteView message, std::string_view id, State& state) noexcept;

/// All three encoders return the length, or 0 if the message is larger than `bytes`. encode_query()
/// requests the state of everything; encode_start() names this program and, for k35, the preset.
size_t encode_query(MutableBytes bytes) noexcept;
size_t encode_start(const State& device, MutableBytes bytes) noexcept;
/// Reduces the force to kLargestForce_N; a force that is not a number counts as zero.
size_t encode_force(const State& device, const Eigen::Vector3d& force_N,
                    MutableBytes bytes) noexcept;

/// Decodes the force for the emulation, in the device frame. Returns false if there is none.
bool decode_force(ByteView message, std::string_view id, Eigen::Vector3d& force_N) noexcept;
size_t encode_state(const State& state, MutableBytes bytes) noexcept;

/// Encodes the text as a frame of a WebSocket client (RFC 6455, 5.2), masked by a key of zero, for
/// a guardian that has only the socket. Returns the length, or 0 if the frame does not fit; takes
/// texts of up to kCommandSize bytes.
size_t encode_frame(ByteView text, MutableBytes frame) noexcept;
constexpr size_t kFrameHead = 8;

}  // namespace spidar::inverse3
