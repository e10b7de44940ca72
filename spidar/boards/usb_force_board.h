// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device that takes a force and is plugged into USB.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/force_board.h"
#include "spidar/boards/usb_search.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

/// Finds it in every open(), see UsbSearch.
class UsbForceBoard final : public ForceBoard {
 public:
  /// `family` has one row in usb_kinds(). `id`: bus path or serial number. If empty, there must be
  /// only one. Throws DeviceError for a family of boards with strings.
  UsbForceBoard(UsbFamily family, const std::string& name, const std::string& id);

  void open() override;
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override {
    return board_->cycle(output, reading, deadline_ns);
  }
  void recover() noexcept override { board_->recover(); }
  void close() noexcept override { board_->close(); }
  std::vector<LastWill> last_wills() const override { return board_->last_wills(); }
  std::string description() const override { return "at " + path_ + ": " + board_->description(); }
  GripAbilities abilities() const noexcept override { return board_->abilities(); }
  const std::string& name() const noexcept override { return board_->name(); }

 private:
  const UsbSearch search_;
  UsbTransport* transport_ = nullptr;  // of the board
  std::unique_ptr<ForceBoard> board_;
  std::string path_;
};

}  // namespace spidar
