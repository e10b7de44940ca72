// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The Novint Falcon: three axes of force and position, and four buttons.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spidar/devices/falcon/packets.h"
#include "spidar/link/board.h"
#include "spidar/link/board_parts.h"
#include "spidar/transports/transport.h"

namespace spidar::boards {

/// The device forgets its firmware without power, and this project may not ship it. If the device
/// does not answer without firmware, open() loads it from the file that $SPIDAR_FALCON_FIRMWARE
/// names, or from ~/.local/share/gst-spidar/novint-falcon.bin. That takes up to three seconds.
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
  /// At libnifalcon's scale, the force that the motors can give in every direction within 50 mm of
  /// the centre. 8.9 N (2 lb) are often quoted, without a source.
  static constexpr double kMostForce_N = 4.4;
  /// The corners of a picture are 49.5 mm from the centre, those of the whole room 54.6 mm.
  static constexpr GripAbilities kAbilities{{true, true, true}, false, true, {true, true, true},
                                            kMostForce_N,       1000,  4,    {0.035, 0.035, 0.023}};

  /// Where the grip was in the last answer.
  struct Position {
    Eigen::Vector3d position_m;
    Eigen::Matrix3d jacobian;
  };

  template <typename Requests>
  LinkFault set_line(const Requests& requests) noexcept;
  LinkFault say(ByteView bytes, MutableBytes answer, int64_t deadline_ns) noexcept;
  LinkFault ask(const falcon::Command& command, int64_t deadline_ns) noexcept;
  LinkFault start() noexcept;
  LinkFault greet_loader() noexcept;
  LinkFault load(const std::vector<uint8_t>& firmware) noexcept;
  void update() noexcept;
  std::array<int, 3> digits_for(const Eigen::Vector3d& force_N) const noexcept;

  falcon::Packet out_{};
  falcon::Reading seen_;
  std::optional<Position> position_;
  bool stale_ = false;  ///< bytes of an exchange that failed may still arrive
};

}  // namespace spidar::boards
