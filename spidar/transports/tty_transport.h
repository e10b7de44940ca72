// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>
#include <vector>

#include "spidar/transports/device_identity.h"
#include "spidar/transports/transport.h"

namespace spidar {

struct TtyLine {
  std::string path;    ///< "/dev/ttyUSB0"
  bool named = false;  ///< "/dev/spidar…": a udev rule declares that motor boards are connected
};

/// The lines of USB adapters (ttyUSB…, ttyACM…) and named ones in `folder`, sorted. Opens none.
std::vector<TtyLine> list_tty_lines(const std::string& folder = "/dev");

/// The USB adapter of a line, with the number of its interface; the path identifies a line without
/// an adapter. `sysfs` is where the kernel describes its devices.
DeviceIdentity tty_identity(const std::string& path, const std::string& sysfs = "/sys");

/// A serial line in raw mode, 8N1, without flow control, with low latency where supported.
class TtyTransport final : public Transport {
 public:
  /// `name` is the device's, for error messages; `baud` any rate that the driver accepts.
  TtyTransport(std::string name, std::string path, int baud);
  ~TtyTransport() override;

  void open() override;
  /// Discards received data and data that is not yet sent.
  void recover() noexcept override;
  std::optional<LastWill> last_will() const override;
  void close() noexcept override;

 private:
  Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  StaleData drop_stale_data(int64_t until_ns) noexcept override;
  [[noreturn]] void fail(const std::string& what, SourceLocation location = SourceLocation::here());
  LinkFault wait_for(short events, int64_t deadline_ns) noexcept;

  const std::string name_;
  const std::string path_;
  const int baud_;
  FirstDevice first_;
  int file_ = -1;
};

}  // namespace spidar
