// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The Novint Falcon: three axes of force and position, and four buttons.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "spidar/devices/falcon/emulated.h"
#include "spidar/devices/falcon/kinematics.h"
#include "spidar/devices/falcon/packets.h"
#include "spidar/folders.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/spring_hand.h"
#include "spidar/whole_file.h"

namespace spidar::boards {

/// The device forgets its firmware without power, and this project may not ship the firmware. If
/// the device does not answer, open() loads the firmware from the file that $SPIDAR_FALCON_FIRMWARE
/// names, or from ~/.local/share/gst-spidar/novint-falcon.bin. Loading takes up to three seconds.
///
/// Until every encoder has passed its mark there is no position and no force: the user pulls the
/// grip all the way out and pushes it all the way in.
class Falcon final : public OnTransport<ForceBoard> {
 public:
  using OnTransport::OnTransport;

  void open() override;
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override;
  std::vector<LastWill> last_wills() const override;
  std::string description() const override;
  GripAbilities abilities() const noexcept override { return kAbilities; }

 private:
  /// The force that the motors can exert in every direction within 50 mm of the centre, by
  /// libnifalcon's scale. 8.9 N (2 lb) are often quoted, without a source.
  static constexpr double kMostForce_N = 4.4;
  /// The corners of a picture are 49.5 mm from the centre, those of the whole workspace 54.6 mm.
  static constexpr GripAbilities kAbilities{.torque = false,
                                            .largest_force_N = kMostForce_N,
                                            .buttons = 4,
                                            .half_workspace_m = {0.035, 0.035, 0.023}};

  /// The position of the grip in the last answer.
  struct Position {
    Eigen::Vector3d position_m;
    Eigen::Matrix3d jacobian;
  };

  template <typename Requests>
  LinkFault set_line(const Requests& requests) noexcept;
  LinkFault transact(ByteView bytes, MutableBytes answer, int64_t deadline_ns) noexcept;
  LinkFault ask(const falcon::Command& command, int64_t deadline_ns) noexcept;
  LinkFault start() noexcept;
  LinkFault greet_loader() noexcept;
  LinkFault load(const std::vector<uint8_t>& firmware) noexcept;
  void update() noexcept;
  std::array<int, 3> digits_for(const Eigen::Vector3d& force_N) const noexcept;

  falcon::Packet out_{};
  falcon::Reading seen_;
  std::optional<Position> position_;
  bool stale_ = false;  ///< bytes of a failed exchange may still arrive
};

namespace {

/// The published program says hello up to a hundred times; few are needed.
constexpr int kHellos = 10;
constexpr size_t kMaxFirmware = 65'536;  ///< the published firmware files have 7 to 9 kB

std::string firmware_path() {
  if (const char* named = secure_getenv("SPIDAR_FALCON_FIRMWARE"); named && *named) return named;
  const std::filesystem::path folder = user_folder("XDG_DATA_HOME", ".local/share");
  return folder.empty() ? "" : folder / "gst-spidar/novint-falcon.bin";
}

std::vector<uint8_t> read_firmware(const std::string& name, LinkFault answer) {
  const std::string path = firmware_path();
  std::string text;
  try {
    text = read_regular_file(path, size_t{1} << 20);
  } catch (const std::runtime_error& error) {
    throw DeviceError(name + ": has not got its firmware (" + to_string(answer) + "). " + path +
                          ": " + error.what() +
                          "; SPIDAR_FALCON_FIRMWARE names the file, which is "
                          "firmware/nvent_firmware.bin in the sources of libnifalcon",
                      DeviceErrorCode::kSettings);
  }
  const std::vector<uint8_t> firmware(text.begin(), text.end());
  if (firmware.empty() || firmware.size() > kMaxFirmware) {
    throw DeviceError(name + ": " + path + " has " + std::to_string(firmware.size()) +
                          " bytes and is no firmware of a Falcon, which has some 8 kB",
                      DeviceErrorCode::kSettings);
  }
  return firmware;
}

}  // namespace

template <typename Requests>
LinkFault Falcon::set_line(const Requests& requests) noexcept {
  for (const VendorRequest& request : requests) {
    const LinkFault fault = transport_->control(request, soon_ns());
    if (fault != LinkFault::kNone) return fault;
  }
  return LinkFault::kNone;
}

/// Sends the bytes and waits until the answer is complete. Packets from the chip begin with its
/// status and contain any part of an answer, or nothing: the chip sends its status even while the
/// device is silent, until the transport stops at the deadline.
LinkFault Falcon::transact(ByteView bytes, MutableBytes answer, int64_t deadline_ns) noexcept {
  if (std::exchange(stale_, true)) transport_->control(ftdi::kDropReceived, deadline_ns);
  std::array<uint8_t, ftdi::kPacketSize> in{};
  for (size_t filled = 0, sent = 0; filled < answer.size; sent = 1) {
    const Transfer transfer = sent ? transport_->exchange({}, in, deadline_ns)
                                   : transport_->exchange({bytes}, in, deadline_ns);
    if (transfer.fault != LinkFault::kNone && transfer.fault != LinkFault::kShort) {
      return transfer.fault;
    }
    if (transfer.received < ftdi::kStatusSize) return LinkFault::kShort;
    const size_t came = transfer.received - ftdi::kStatusSize;
    if (came > answer.size - filled) return LinkFault::kBabble;
    std::copy_n(in.begin() + ftdi::kStatusSize, came, answer.data + filled);
    filled += came;
  }
  stale_ = false;
  return LinkFault::kNone;
}

LinkFault Falcon::ask(const falcon::Command& command, int64_t deadline_ns) noexcept {
  falcon::encode_command(command, out_);
  falcon::Packet answer{};
  const LinkFault fault = transact(out_, answer, deadline_ns);
  if (fault != LinkFault::kNone) return fault;
  if (falcon::decode_reading(answer, seen_)) return LinkFault::kNone;
  stale_ = true;
  return LinkFault::kWrongReply;
}

/// Returns kNone if the firmware answers.
LinkFault Falcon::start() noexcept {
  const LinkFault fault = set_line(falcon::kRunLine);
  if (fault != LinkFault::kNone) return fault;
  return open_exchange([this](int64_t deadline_ns) { return ask({}, deadline_ns); }, *transport_);
}

LinkFault Falcon::greet_loader() noexcept {
  LinkFault fault = set_line(falcon::kHelloLine);
  std::array<uint8_t, falcon::kHelloAnswer.size()> answer{};
  for (int i = 0; i < kHellos && fault == LinkFault::kNone; ++i) {
    const LinkFault loader_fault = transact(falcon::kHello, answer, soon_ns());
    if (loader_fault == LinkFault::kGone) return loader_fault;
    // If a zero byte comes first, the last byte of the answer does not fit.
    const size_t zero = answer[0] == 0 ? 1 : 0;
    if (std::equal(answer.begin() + zero, answer.end(), falcon::kHelloAnswer.begin())) {
      return set_line(falcon::kLoadLine);
    }
    if (i + 1 == kHellos) {
      fault = loader_fault == LinkFault::kNone ? LinkFault::kWrongReply : loader_fault;
    }
  }
  return fault;
}

/// The device echoes every piece, which reveals errors on the line.
LinkFault Falcon::load(const std::vector<uint8_t>& firmware) noexcept {
  LinkFault fault = greet_loader();
  std::array<uint8_t, falcon::kPieceSize> echo{};
  const auto send = [&](ByteView piece) {
    if (fault != LinkFault::kNone) return;
    fault = transact(piece, {echo.data(), piece.size}, soon_ns());
    if (fault == LinkFault::kNone &&
        !std::equal(piece.data, piece.data + piece.size, echo.begin())) {
      fault = LinkFault::kWrongEcho;
    }
  };
  send(falcon::kLoad);
  for (size_t at = 0; at < firmware.size(); at += falcon::kPieceSize) {
    send({firmware.data() + at, std::min(falcon::kPieceSize, firmware.size() - at)});
  }
  return fault;
}

void Falcon::open() {
  transport_->open();
  LinkFault fault = start();
  if (fault == LinkFault::kTimeout || fault == LinkFault::kWrongReply) {
    fault = load(read_firmware(name_, fault));
    if (fault == LinkFault::kNone) fault = start();
  }
  if (fault != LinkFault::kNone) throw no_answer(name_, fault);
  update();
}

/// Computes the position from the counts, if every encoder has passed its mark.
void Falcon::update() noexcept {
  position_.reset();
  if (!seen_.all_homed()) return;
  const Eigen::Vector3d angles_rad(falcon::angle_rad(seen_.count[0]),
                                   falcon::angle_rad(seen_.count[1]),
                                   falcon::angle_rad(seen_.count[2]));
  const auto position_m = falcon::grip_position(angles_rad);
  const auto jacobian = position_m ? falcon::jacobian(angles_rad, *position_m) : std::nullopt;
  if (jacobian) position_ = {*position_m, *jacobian};
}

/// Reduces all three digits together where one motor cannot exert its part, so that the direction
/// of the force remains.
std::array<int, 3> Falcon::digits_for(const Eigen::Vector3d& force_N) const noexcept {
  std::array<int, 3> digits{};
  if (!position_ || !force_N.allFinite()) return digits;
  Eigen::Vector3d wanted = falcon::kDigitsPerNm * (position_->jacobian.transpose() * force_N);
  const double most = wanted.cwiseAbs().maxCoeff();
  if (most > falcon::kMostDigit) wanted *= falcon::kMostDigit / most;
  for (size_t i = 0; i < digits.size(); ++i) {
    digits[i] = static_cast<int>(std::lround(wanted[static_cast<Eigen::Index>(i)]));
  }
  return digits;
}

LinkFault Falcon::cycle(const ForceOutput& output, ForceReading& reading,
                        int64_t deadline_ns) noexcept {
  falcon::Command command;
  command.digit = digits_for(output.force_N);
  command.light = seen_.all_homed() ? falcon::Light::kGreen : falcon::Light::kRed;
  const LinkFault fault = ask(command, deadline_ns);
  if (fault != LinkFault::kNone) return fault;
  update();
  reading.position_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (position_) reading.position_m = position_->position_m;
  reading.pose_fault = seen_.all_homed() ? PoseFault::kNoFit : PoseFault::kNotHomed;
  reading.buttons = seen_.buttons;
  return LinkFault::kNone;
}

void Falcon::recover() noexcept {
  OnTransport::recover();
  stale_ = true;
}

std::vector<LastWill> Falcon::last_wills() const {
  falcon::Packet rest;
  falcon::encode_command({}, rest);
  return wills(*transport_, {rest});
}

std::string Falcon::description() const {
  return transport_->where() + "Novint Falcon" +
         (seen_.all_homed() ? "" : "; pull its grip all the way out, then push it all the way in");
}

}  // namespace spidar::boards

namespace spidar {

std::vector<DeviceKind> falcon_kinds() {
  return {{.device = "falcon",
           .board = "falcon",
           .title = "Novint Falcon",
           .names = "falcon, falcon:ID",
           .usb = {.vendor = falcon::kVendor,
                   .product = falcon::kProduct,
                   .out = falcon::kEndpointOut,
                   .in = falcon::kEndpointIn,
                   .full_speed = true},
           .chosen_as = "a Novint Falcon",
           .note = "reach and scale of the force are inferred",
           .attach = attach<boards::Falcon>,
           .emulate = emulate<emulated::Falcon>,
           .hand = emulated::spring_hand<emulated::Falcon::kHomed>}};
}

}  // namespace spidar
