// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A board on USB, which is looked for in every open(): the one that is plugged in and meant.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/device_identity.h"
#include "spidar/transports/usb_transport.h"

namespace spidar::boards {

/// A kind of board, wherever it is connected.
struct BoardKind {
  const char* device = "";  ///< what its name for make_grip() begins with: "usb"
  const char* title = "";   ///< for people: "CyVerse USB 2.0 SH4"
  /// Profile::board of profiles for it; empty for one without strings.
  const char* profile_board = "";
  UsbId usb;  ///< nothing for one that is not on USB
  /// The board at the other end of this transport. Throws DeviceError when it cannot drive the
  /// profile.
  AnyBoard (*attach)(const std::string& name, const Profile& profile,
                     std::unique_ptr<Transport> transport) = nullptr;

  bool has_strings() const noexcept { return *profile_board != '\0'; }
};

/// What one name may mean: "usb" is an SH4 or a Simple. They live as long as the program.
using BoardKinds = std::vector<const BoardKind*>;

/// Position of the rotary switch that `id` of usb:ID means; −1 when it is none.
int rotary_of(const std::string& id);

/// To be used for every opening, because the address changes when a device is plugged in again.
/// Later openings find the device of the first one, wherever it is if it has a serial number.
class UsbSearch {
 public:
  struct Candidate {
    const BoardKind* kind = nullptr;
    UsbDeviceInfo device;

    DeviceIdentity identity() const;
  };
  /// Opens a candidate and returns its rotary switch, −1 without one. Throws DeviceError.
  using Open = std::function<int(const Candidate&)>;

  /// `id`: bus path, serial number, or position of the rotary switch, 0 … 15. If empty, there must
  /// be only one device.
  UsbSearch(BoardKinds kinds, std::string name, std::string id);

  /// Opens the device that is meant. `close` closes one that is another, or did not open. Throws
  /// DeviceError, which lists what there is.
  void open(const Open& open, const std::function<void()>& close);
  /// Throws as open() would before it opens anything.
  void require_one() const;

 private:
  std::vector<Candidate> plugged_in() const;
  bool is_clear(const std::vector<Candidate>& found) const;
  bool is_to_ask(const std::vector<Candidate>& found) const;
  std::vector<Candidate> candidates() const;
  bool is_named(const Candidate& candidate) const;
  Candidate open_matching(const std::vector<Candidate>& found, const Open& open,
                          const std::function<void()>& close) const;
  void open_again(const Open& open) const;

  const BoardKinds kinds_;
  const std::string name_;
  const std::string id_;
  FirstDevice first_;
  int first_rotary_ = -1;
};

/// Finds its board in every open(), see UsbSearch. `BoardType` is Board or ForceBoard.
template <typename BoardType>
class UsbBoardOf : public BoardType {
 public:
  /// All of `kinds` are of this type; for the rest, see UsbSearch. Throws DeviceError when the
  /// boards cannot drive the profile; so does open() when the profile is for another kind of board
  /// than the one that is found.
  UsbBoardOf(std::string name, std::string id, const Profile& profile, const BoardKinds& kinds);

  void open() override;
  LinkFault cycle(const typename BoardType::Output& output, typename BoardType::Reading& reading,
                  int64_t deadline_ns) noexcept override {
    return used_ ? used_->board->cycle(output, reading, deadline_ns) : LinkFault::kGone;
  }
  void recover() noexcept override {
    if (used_) used_->board->recover();
  }
  void zero_counts() noexcept override {
    if (used_) used_->board->zero_counts();
  }
  bool counts_restarted() const noexcept override {
    return used_ && used_->board->counts_restarted();
  }
  void close() noexcept override {
    if (used_) used_->board->close();
    used_ = nullptr;
  }
  std::vector<LastWill> last_wills() const override {
    return used_ ? used_->board->last_wills() : std::vector<LastWill>{};
  }
  std::string description() const override {
    return used_ ? "at " + used_path_ + ": " + used_->board->description() : "";
  }
  int rotary() const noexcept override { return used_ ? used_->board->rotary() : -1; }
  const std::string& name() const noexcept override { return name_; }

 protected:
  const BoardType& first() const noexcept { return *kinds_.front().board; }

 private:
  struct Kind {
    const BoardKind* known = nullptr;
    UsbTransport* transport = nullptr;  // of the board
    std::unique_ptr<BoardType> board;
  };

  void open_one(const UsbSearch::Candidate& candidate);

  const std::string name_;
  const std::string profile_name_, profile_board_;
  UsbSearch search_;
  std::vector<Kind> kinds_;
  Kind* used_ = nullptr;
  std::string used_path_;
};

using UsbBoard = UsbBoardOf<Board>;

/// Of one kind, whose abilities do not depend on what is plugged in.
class UsbForceBoard final : public UsbBoardOf<ForceBoard> {
 public:
  using UsbBoardOf::UsbBoardOf;
  GripAbilities abilities() const noexcept override { return first().abilities(); }
};

}  // namespace spidar::boards
