// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The USB devices that have a driver, one row for each, and the one among them that is plugged in
/// and meant.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

enum class UsbFamily {
  kCyverse,  ///< "usb": SH4 or Simple
  kMouse,    ///< "mouse": SPIDAR-mouse, whose USB id other devices also use
  kFalcon,   ///< "falcon": Novint Falcon
};

struct UsbBoardKind {
  UsbFamily family;
  uint16_t vendor;
  uint16_t product;
  const char* name;           ///< "CyVerse USB 2.0 SH4"
  const char* profile_board;  ///< Profile::board of profiles for it; empty for one without strings
  Trial trial;
  const char* note;  ///< what is inferred
  UsbPipes pipes;
  /// Throws DeviceError when the board cannot drive the profile. Null for one without strings.
  std::unique_ptr<Board> (*make)(const std::string& name, const Profile& profile,
                                 std::unique_ptr<Transport> transport);

  /// Null for one with strings.
  std::unique_ptr<ForceBoard> (*make_force)(const std::string& name,
                                            std::unique_ptr<Transport> transport);

  /// "0cec:0205"
  std::string id() const;
};

const std::vector<UsbBoardKind>& usb_kinds();

/// "usb", "mouse" or "falcon", for make_grip().
const char* device_of(UsbFamily family) noexcept;

/// Position of the rotary switch that `id` of usb:ID means; −1 when it is none.
int rotary_of(const std::string& id);

/// To be used for every opening, because the address changes when a device is plugged in again.
class UsbSearch {
 public:
  struct Candidate {
    const UsbBoardKind* kind = nullptr;
    UsbDeviceInfo device;
  };
  /// Opens a candidate and returns its rotary switch, −1 without one. Throws DeviceError.
  using Open = std::function<int(const Candidate&)>;

  /// `id`: bus path, serial number, or position of the rotary switch, 0 … 15. If empty, there must
  /// be only one device.
  UsbSearch(UsbFamily family, std::string name, std::string id);

  /// Opens the device that is meant. `close` closes one that was opened and is another. Throws
  /// DeviceError, which lists what there is.
  void open(const Open& open, const std::function<void()>& close) const;

 private:
  std::vector<Candidate> candidates() const;
  void open_matching(const std::vector<Candidate>& found, const Open& open,
                     const std::function<void()>& close) const;

  const UsbFamily family_;
  const std::string name_;
  const std::string id_;
};

/// Finds its board in every open(), see UsbSearch.
class UsbBoard final : public Board {
 public:
  /// `id`: bus path, serial number, or position of the rotary switch, 0 … 15. If empty, there must
  /// be only one board. Throws DeviceError when the boards cannot drive the profile; so does open()
  /// when the profile is for the other kind of board than the one that is found.
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
  const std::string profile_name_, profile_board_;
  const UsbSearch search_;
  std::vector<Kind> kinds_;
  Kind* used_ = nullptr;
  std::string used_path_;
};

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
