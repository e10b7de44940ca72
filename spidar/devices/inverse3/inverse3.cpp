// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The Haply Inverse3 behind the maker's service: three axes of force and position.
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "spidar/devices/inverse3/packets.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/link/spring_hand.h"
#include "spidar/text.h"
#include "spidar/transports/websocket_transport.h"

namespace spidar::boards {

/// Sends one force and receives one state in each cycle: the service answers every message. A force
/// is sent only after the answer to the previous one, so that no force arrives late.
class Inverse3 final : public OnTransport<ForceBoard> {
 public:
  /// `id` is the device's number in the service ("049D"); empty: the first device.
  Inverse3(std::string name, std::unique_ptr<Transport> transport, std::string id = {})
      : OnTransport(std::move(name), std::move(transport)),
        id_(std::move(id)),
        answer_(inverse3::kStateSize) {}

  void open() override {
    transport_->open();
    const LinkFault fault = open_exchange(
        [&](int64_t deadline_ns) {
          return ask(inverse3::encode_query(text_), device_, deadline_ns);
        },
        *transport_);
    if (fault == LinkFault::kGone) {
      refuse("Haply's service knows no Inverse3" + (wanted().empty() ? "" : " " + wanted()) +
                 ": plug it in, and wait until its light is steady",
             DeviceErrorCode::kAbsent);
    }
    if (fault != LinkFault::kNone) {
      refuse(std::string("Haply's service does not answer as it should: ") + to_string(fault) +
             "; version 3.1 or later is needed");
    }
    if (!device_.powered) {
      refuse("the Inverse3 " + device_.id + " has no power: connect its supply");
    }
    if (!device_.calibrated) {
      refuse("the Inverse3 " + device_.id +
             " is not calibrated: put its handle into the inkwell until its light is steady");
    }
    opened_ = true;
    // Without the preset, positions would refer to another origin.
    const LinkFault start = open_exchange(
        [&](int64_t deadline_ns) {
          return ask(inverse3::encode_start(device_, text_), now_, deadline_ns);
        },
        *transport_);
    if (start != LinkFault::kNone) {
      refuse(std::string("Haply's service does not answer the beginning of a session: ") +
             to_string(start) + "; restart it");
    }
  }
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override {
    const LinkFault fault =
        ask(inverse3::encode_force(device_, output.force_N, text_), now_, deadline_ns);
    if (fault != LinkFault::kNone) return fault;
    // Another version of the service has another origin of positions.
    if (now_.version != device_.version) return LinkFault::kWrongReply;
    if (!now_.powered || !now_.calibrated) return LinkFault::kRefused;
    reading.position_m = now_.position_m;
    reading.buttons = now_.buttons;
    return LinkFault::kNone;
  }
  void close() noexcept override {
    if (opened_) {
      ask(inverse3::encode_force(device_, Eigen::Vector3d::Zero(), text_), now_, soon_ns());
    }
    opened_ = false;
    OnTransport::close();
  }
  std::vector<LastWill> last_wills() const override {
    std::array<uint8_t, inverse3::kCommandSize> zero{};
    std::array<uint8_t, LastWill::kMaxLength> frame{};
    const size_t length = inverse3::encode_force(device_, Eigen::Vector3d::Zero(), zero);
    const size_t framed = inverse3::encode_frame({zero.data(), length}, frame);
    return wills(*transport_, {{frame.data(), framed}});
  }
  std::string description() const override {
    return "Haply Inverse3 " + device_.id + ", service " +
           (device_.version == inverse3::Version::k35 ? "3.5" : "3.1");
  }
  GripAbilities abilities() const noexcept override { return kAbilities; }

 private:
  /// Half the side of the square that fits into the circle of kReach_m.
  static constexpr double kHalfSide_m = 0.7 * inverse3::kReach_m;
  static constexpr GripAbilities kAbilities{
      .torque = false,
      .largest_force_N = inverse3::kLargestForce_N,
      .buttons = inverse3::kButtons,
      .half_workspace_m = {kHalfSide_m, kHalfSide_m, kHalfSide_m}};

  /// Sends the first `length` bytes of text_, and reads the state of the device.
  LinkFault ask(size_t length, inverse3::State& state, int64_t deadline_ns) noexcept {
    const Transfer transfer = transport_->exchange({{text_.data(), length}},
                                                   {answer_.data(), answer_.size()}, deadline_ns);
    // The answer does not fill the buffer, which is no fault.
    if (transfer.fault != LinkFault::kNone && transfer.fault != LinkFault::kShort) {
      return transfer.fault;
    }
    const ByteView text(answer_.data(), transfer.received);
    switch (inverse3::decode_state(text, wanted(), state)) {
      case inverse3::Answer::kState:
        return LinkFault::kNone;
      case inverse3::Answer::kAbsent:
        return LinkFault::kGone;
      case inverse3::Answer::kBroken:
        break;
    }
    return text.u8(text.size - 1) == '}' ? LinkFault::kWrongReply : LinkFault::kShort;
  }
  /// The id to look for. After a loss it stays, because another hand may hold another device.
  const std::string& wanted() const noexcept { return device_.id.empty() ? id_ : device_.id; }
  [[noreturn]] void refuse(const std::string& why, DeviceErrorCode code = DeviceErrorCode::kFailed,
                           SourceLocation location = SourceLocation::here()) const {
    throw DeviceError(name_ + ": " + why, code, location);
  }

  const std::string id_;
  inverse3::State device_;  ///< the state when the device was opened
  inverse3::State now_;
  bool opened_ = false;
  std::array<uint8_t, inverse3::kCommandSize> text_{};
  std::vector<uint8_t> answer_;
};

}  // namespace spidar::boards

namespace spidar::emulated {

/// The emulated service. Its digits are the force in millinewtons and its counts the position in
/// micrometres: right, up, towards the viewer. The inputs are the buttons.
class Inverse3 final : public Board {
 public:
  explicit Inverse3(std::shared_ptr<Motors> motors,
                    inverse3::Version version = inverse3::Version::k35)
      : Board(std::move(motors)) {
    state.id = "049D";
    state.version = version;
  }

  void receive(ByteView bytes) noexcept override {
    due_ = true;
    Eigen::Vector3d force_N;
    if (inverse3::decode_force(bytes, state.id, force_N)) set_force_N(*motors_, force_N);
  }
  size_t reply(MutableBytes bytes) noexcept override {
    if (!due_) return 0;
    due_ = false;
    state.position_m = position_m(*motors_);
    state.buttons = motors_->inputs();
    return inverse3::encode_state(state, bytes);
  }

  inverse3::State state;  ///< what the service reports, except for position and buttons

 private:
  bool due_ = false;
};

}  // namespace spidar::emulated

namespace spidar {
namespace {

/// `rest` is empty, ID, or ID,port=N.
boards::AnyBoard make_inverse3(const std::string& name, const std::string& rest, const Profile&) {
  constexpr int kLastPort = 65535;
  const size_t comma = rest.find(',');
  int port = inverse3::kPort;
  if (comma != std::string::npos) port = option_value(rest.substr(comma + 1), "port=", kLastPort);
  if (port == 0 || comma == 0) {
    throw DeviceError(name +
                          ": write inverse3, inverse3:ID or inverse3:ID,port=N, where N is the " +
                          "port of Haply's service, " + std::to_string(inverse3::kPort) +
                          " unless it was changed",
                      DeviceErrorCode::kSettings);
  }
  auto service = std::make_unique<WebSocketTransport>(
      name, static_cast<uint16_t>(port),
      "start Haply's Inverse Service (Haply Hub, or: systemctl start haply-inverse-service)");
  return std::make_unique<boards::Inverse3>(name, std::move(service), rest.substr(0, comma));
}

/// Does not query the service, because a query would open a session in it.
std::vector<DeviceInfo> list_inverse3() {
  if (!is_listening(inverse3::kPort)) return {};
  DeviceInfo board;
  board.device = "inverse3";
  board.path = "localhost:" + std::to_string(inverse3::kPort);
  board.note = "if it is plugged in, which only Haply's service knows";
  return {board};
}

}  // namespace

std::vector<DeviceKind> inverse3_kinds() {
  return {{.device = "inverse3",
           .board = "inverse3",
           .title = "Haply Inverse3",
           .names = "inverse3, inverse3:ID",
           .chosen_as = "a Haply Inverse3",
           .evidence = "inferred",
           .attach = attach<boards::Inverse3>,
           .emulate = emulate<emulated::Inverse3>,
           .hand = emulated::spring_hand<0>,
           .make = make_inverse3,
           .list = list_inverse3}};
}

}  // namespace spidar
