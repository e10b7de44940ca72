// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The CyVerse board that is plugged in.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/boards/usb_kinds.h"
#include "spidar/boards/usb_search.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

/// Finds its board in every open(), see UsbSearch.
class UsbBoard final : public Board {
 public:
  /// `id`: bus path, serial number, or position of the rotary switch, 0 … 15. If empty, there must
  /// be only one board. Throws DeviceError when the boards cannot drive the profile.
  UsbBoard(std::string name, std::string id, const Profile& profile);

  void open() override;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override;
  void zero_counts() noexcept override;
  bool counts_restarted() const noexcept override {
    return used_ && used_->board->counts_restarted();
  }
  void close() noexcept override;
  std::vector<LastWill> last_wills() const override;
  std::string description() const override;
  int rotary() const noexcept override { return used_ ? used_->board->rotary() : -1; }
  const std::string& name() const noexcept override { return name_; }

 private:
  struct Kind {
    const UsbBoardKind* known = nullptr;
    UsbTransport* transport = nullptr;  // of the board
    std::unique_ptr<Board> board;
  };

  void open_one(const UsbSearch::Candidate& candidate);

  const std::string name_;
  const UsbSearch search_;
  std::vector<Kind> kinds_;
  Kind* used_ = nullptr;
  std::string used_path_;
};

}  // namespace spidar
