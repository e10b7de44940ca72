/// What is to be sent to a board when its host process is gone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar {

/// Packets of one connection. Plain bytes: it goes through a pipe to another program.
struct LastWill {
  enum class Wire : uint32_t {
    kUsb,       ///< usbfs: bulk or interrupt packets to one endpoint
    kTerminal,  ///< a tty
  };
  static constexpr size_t kMaxPackets = 8;  // as many UART boards as a line has
  static constexpr size_t kMaxLength = 512;
  static constexpr uint32_t kMagic = 0x53504731;  // "SPG1": this layout

  uint32_t magic = kMagic;
  Wire wire = Wire::kUsb;
  uint32_t interface_number = 0;
  uint32_t endpoint = 0;
  uint32_t packets = 0;
  std::array<uint32_t, kMaxPackets> length{};
  std::array<std::array<uint8_t, kMaxLength>, kMaxPackets> packet{};
  std::array<char, 256> path{};  ///< of the device file, zero-terminated
};

/// What the host says at last when the will is not to be carried out.
constexpr char kDismissed = 'q';

}  // namespace spidar
