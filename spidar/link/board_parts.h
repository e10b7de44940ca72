// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Common parts of boards: opening, wills, conversion from volts to digits of a D/A converter.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "spidar/device.h"
#include "spidar/guardian/guardian.h"
#include "spidar/link/board.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/transports/bytes.h"
#include "spidar/transports/transport.h"

namespace spidar::boards {

template <typename BoardType>
class OnTransport : public BoardType {
 public:
  template <typename... Rest>
  OnTransport(std::string name, std::unique_ptr<Transport> transport, Rest... rest)
      : BoardType(std::move(name), rest...), transport_(std::move(transport)) {}

  void recover() noexcept override { transport_->recover(); }
  void close() noexcept override { transport_->close(); }

 protected:
  using BoardType::name_;
  const std::unique_ptr<Transport> transport_;
};

/// Returns the transport's will with these packets; empty if no other process can reach the board.
inline std::vector<LastWill> wills(const Transport& transport,
                                   std::initializer_list<ByteView> packets) {
  std::optional<LastWill> will = transport.last_will();
  if (!will) return {};
  for (const ByteView packet : packets) {
    const size_t length = std::min(packet.size, LastWill::kMaxLength);
    std::copy_n(packet.data, length, will->packet[will->packets].begin());
    will->length[will->packets++] = static_cast<uint32_t>(length);
  }
  return {*will};
}

/// The deadline for a board's answer outside the ticks of the loop, CLOCK_MONOTONIC: in 0.1 s.
inline int64_t soon_ns() noexcept {
  return monotonic_now_ns() + kSecond_ns / 10;
}

/// "usb:1-2: does not answer as it should: stall; switch it off and on, and check cable and supply"
inline DeviceError no_answer(const std::string& board, LinkFault fault,
                             SourceLocation location = SourceLocation::here()) {
  return DeviceError(
      board + ": does not answer as it should: " + to_string(fault) +
          "; switch it off and on, and check cable and supply",
      fault == LinkFault::kGone ? DeviceErrorCode::kAbsent : DeviceErrorCode::kFailed, location);
}

/// Tries the first exchange up to three times, because the first answers may be data that an
/// earlier program left unread.
template <typename Exchange>
LinkFault open_exchange(const Exchange& exchange, Transport& transport) {
  LinkFault fault = LinkFault::kNone;
  for (int attempt = 0; attempt < 3; ++attempt) {
    fault = exchange(soon_ns());
    if (fault == LinkFault::kNone || fault == LinkFault::kGone) break;
    transport.recover();
  }
  return fault;
}

/// A D/A converter whose digit zero is zero volts.
struct DacScale {
  double digits_per_V = 1;
  int min_digit = 0;
  int max_digit = 0;

  /// A voltage that is not a number counts as zero.
  int digit(double volt) const noexcept {
    const double digits = volt * digits_per_V;
    if (!std::isfinite(digits)) return 0;
    return static_cast<int>(std::lround(
        std::clamp(digits, static_cast<double>(min_digit), static_cast<double>(max_digit))));
  }
  double volt(int digits) const noexcept { return digits / digits_per_V; }
};

/// The properties of every board with this protocol.
struct Traits {
  int dac_bits = 12;
  double max_V = 0;         ///< the largest voltage; 0: not published, the profile states it
  double digits_per_V = 0;  ///< 0: the largest digit is the largest voltage
  bool negative = false;    ///< whether the D/A converter has negative volts
  int counter_bits = 16;    ///< bits of the encoder counters

  DacScale dac(const Profile& profile) const noexcept {
    const int max_digit = (1 << dac_bits) - 1;
    const double range_V = max_V > 0 ? max_V : profile.dac_max_V;
    return {digits_per_V > 0 ? digits_per_V : max_digit / range_V, negative ? -max_digit : 0,
            max_digit};
  }
};

/// Returns why the profile cannot be for this board, as the end of a sentence that names the field:
/// "has dac_bits = 16, …". Empty if the profile fits.
std::string misfit(const Profile& profile, const Traits& board);

void require_fitting(const std::string& device, const Profile& profile, const Traits& board);

/// A board that takes a digit for the motor of each string and answers with the string's counter.
class StringBoard : public OnTransport<Board> {
 public:
  /// Throws DeviceError when the profile describes another board, see require_fitting().
  StringBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport,
              const Traits& traits);

  void open() final;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept final;
  std::vector<LastWill> last_wills() const final;

 protected:
  using Digits = std::array<int, kMaxStrings>;
  struct Answer {
    std::array<uint32_t, kMaxStrings> counter{};  ///< only the bits that the board's counters have
    uint32_t inputs = 0;
    int rotary = -1;  ///< position of the ID switch; −1: none
  };

  virtual LinkFault exchange(const Digits& digits, Answer& answer,
                             int64_t deadline_ns) noexcept = 0;
  virtual std::vector<uint8_t> zero_packet() const = 0;
  /// Called before the first exchange after opening.
  virtual LinkFault reset(int64_t) noexcept { return LinkFault::kNone; }

 private:
  const DacScale dac_;
};

}  // namespace spidar::boards
