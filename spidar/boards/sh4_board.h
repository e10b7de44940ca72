/// The CyVerse USB 2.0 SH4 board: one packet out, one in.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/api.h"
#include "spidar/boards/board.h"
#include "spidar/boards/digits.h"
#include "spidar/protocols/count_unwrapper.h"
#include "spidar/protocols/sh4.h"
#include "spidar/transports/transport.h"

namespace spidar {

class SPIDAR_API Sh4Board final : public Board {
 public:
  /// Throws DeviceError when the profile wants negative volts.
  Sh4Board(std::string name, const Profile& profile, std::unique_ptr<Transport> transport);

  void open() override;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override { transport_->recover(); }
  void zero_counts() noexcept override { counts_.zero(); }
  void close() noexcept override { transport_->close(); }
  std::vector<LastWill> last_wills() const override;
  int rotary() const noexcept override { return rotary_; }
  const std::string& name() const noexcept override { return name_; }

 private:
  /// The echo may be of a packet before: how far back is not published.
  static constexpr size_t kEchoes = 4;

  LinkFault exchange(const sh4::DacDigits& digits, sh4::Reading& reading,
                     int64_t deadline_ns) noexcept;

  const std::string name_;
  const DacScale dac_;
  const std::unique_ptr<Transport> transport_;
  CountUnwrapper counts_{16};
  bool counted_ = false;
  int rotary_ = -1;
  sh4::Packet out_{};
  sh4::Packet in_{};
  std::array<sh4::DacDigits, kEchoes> sent_{};
  size_t sent_at_ = 0;
};

}  // namespace spidar
