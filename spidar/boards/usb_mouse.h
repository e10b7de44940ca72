// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The SPIDAR-mouse that is plugged in.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/mouse_board.h"
#include "spidar/boards/usb_search.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

/// Finds it in every open(), see UsbSearch.
class UsbMouse final : public ForceBoard {
 public:
  /// `id`: bus path or serial number. If empty, there must be only one.
  UsbMouse(const std::string& name, const std::string& id);

  void open() override;
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override {
    return mouse_.cycle(output, reading, deadline_ns);
  }
  void recover() noexcept override { mouse_.recover(); }
  void close() noexcept override { mouse_.close(); }
  std::vector<LastWill> last_wills() const override { return mouse_.last_wills(); }
  std::string description() const override { return "at " + path_ + ": " + mouse_.description(); }
  GripAbilities abilities() const noexcept override { return mouse_.abilities(); }
  const std::string& name() const noexcept override { return mouse_.name(); }

 private:
  UsbMouse(const std::string& name, const std::string& id, std::unique_ptr<UsbTransport> transport);

  const UsbSearch search_;
  UsbTransport& transport_;
  MouseBoard mouse_;
  std::string path_;
};

}  // namespace spidar
