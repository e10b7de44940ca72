/// A process that takes the motors to zero when this one is killed.
#pragma once

#include <string>
#include <sys/types.h>
#include <vector>

#include "core/api.h"
#include "spidar/guardian/last_will.h"

namespace spidar {

/// Boards keep their last value when the host goes silent, and nothing in a process runs when it is
/// killed. A guardian is a small program of its own (spidar-guardian), with the device file open
/// and packets of zeros at hand: it sends them when its socket to this process closes unasked.
class SPIDAR_API Guardian {
 public:
  /// Starts one for the connection. Throws DeviceError when the program is not found or cannot open
  /// the device. The program is $SPIDAR_GUARDIAN, or the installed one.
  Guardian(const std::string& device, const LastWill& will);
  /// Sends it away; its will is not carried out.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// Its will is carried out now: when the board is released but the motors could not be zeroed.
  void carry_out() noexcept;

 private:
  void finish(bool dismissed) noexcept;

  int socket_ = -1;
  pid_t process_ = -1;
};

}  // namespace spidar
