/// The CyVerse USB 2.0 Simple board: D/A and latch out, counters in.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/api.h"
#include "spidar/boards/board.h"
#include "spidar/boards/digits.h"
#include "spidar/protocols/count_unwrapper.h"
#include "spidar/protocols/usb_simple.h"
#include "spidar/transports/transport.h"

namespace spidar {

class SPIDAR_API SimpleBoard final : public Board {
 public:
  /// Throws DeviceError when the profile wants negative volts.
  SimpleBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport);

  void open() override;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override { transport_->recover(); }
  /// On the host: the board's own counters are left to whom they belong.
  void zero_counts() noexcept override { counts_.zero(); }
  void close() noexcept override { transport_->close(); }
  std::vector<LastWill> last_wills() const override;
  int rotary() const noexcept override { return rotary_; }
  const std::string& name() const noexcept override { return name_; }

 private:
  LinkFault exchange(const usb_simple::DacDigits& digits, usb_simple::Reading& reading,
                     int64_t deadline_ns) noexcept;

  const std::string name_;
  const DacScale dac_;
  const std::unique_ptr<Transport> transport_;
  CountUnwrapper counts_{24};
  bool counted_ = false;
  int rotary_ = -1;
  usb_simple::Packet set_dac_{};
  usb_simple::Packet latch_{};
  usb_simple::Packet in_{};
};

}  // namespace spidar
