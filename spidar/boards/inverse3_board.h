// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The Haply Inverse3 behind the maker's service: three axes of force and position.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/protocols/inverse3.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// One force and one state in each cycle: the service answers every message. A force is sent only
/// when the one before has been answered, so that none can arrive late.
class Inverse3Board final : public ForceBoard {
 public:
  /// `id` is the device's number in the service ("049D"); empty: the first one.
  Inverse3Board(std::string name, std::string id, std::unique_ptr<Transport> transport);

  void open() override;
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override { transport_->recover(); }
  void close() noexcept override;
  std::vector<LastWill> last_wills() const override;
  std::string description() const override;
  GripAbilities abilities() const noexcept override { return kAbilities; }
  const std::string& name() const noexcept override { return name_; }

 private:
  /// Half of the side of the square in the circle of kReach_m.
  static constexpr double kRoom_m = 0.7 * inverse3::kReach_m;
  static constexpr GripAbilities kAbilities{{true, true, true},
                                            false,
                                            true,
                                            {true, true, true},
                                            inverse3::kLargestForce_N,
                                            1000,
                                            inverse3::kButtons,
                                            {kRoom_m, kRoom_m, kRoom_m}};

  /// Sends the first bytes of text_, and reads the state of the device.
  LinkFault ask(size_t length, inverse3::State& state, int64_t deadline_ns) noexcept;
  /// After it was lost, the same device is looked for: another hand may hold another one.
  const std::string& wanted() const noexcept { return device_.id.empty() ? id_ : device_.id; }
  [[noreturn]] void refuse(const std::string& why);

  const std::string name_;
  const std::string id_;
  const std::unique_ptr<Transport> transport_;
  inverse3::State device_;  ///< as it was when it was opened
  inverse3::State now_;
  bool opened_ = false;
  std::array<uint8_t, inverse3::kCommandSize> text_{};
  std::vector<uint8_t> answer_;
};

}  // namespace spidar
