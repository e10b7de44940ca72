// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/uart/board.h"

#include <algorithm>
#include <unistd.h>
#include <utility>

#include "spidar/devices/uart/emulated.h"
#include "spidar/link/device_kind.h"
#include "spidar/transports/tty_transport.h"

namespace spidar::boards {
namespace {

constexpr int64_t kEnquiry_ns = 10'000'000;  // the published wait

static_assert(LastWill::kMaxPackets >= uart_motor::kMaxBoards);
static_assert(LastWill::kMaxLength >= uart_motor::kZerosBefore + uart_motor::kMaxCycleLength);

}  // namespace

Uart::Uart(std::string name, const Profile& profile, std::vector<std::unique_ptr<Transport>> lines)
    : Board(std::move(name), kTraits.counter_bits),
      strings_(static_cast<size_t>(profile.geometry.count)),
      dac_(kTraits.dac(profile)),
      lines_(std::move(lines)) {
  require_fitting(name_, profile, kTraits);
}

void Uart::find_stations(Transport& line, int64_t patience_ns) {
  std::array<uint8_t, uart_motor::kEnquiryLength> enquiry{};
  std::array<uint8_t, uart_motor::kInfoLength> reply{};
  const size_t before = stations_.size();
  for (int id = 0; id < uart_motor::kMaxBoards; ++id) {
    uart_motor::encode_enquiry(id, enquiry);
    const Transfer transfer = line.exchange({enquiry}, reply, monotonic_now_ns() + patience_ns);
    Station station{&line, id, {}, motors_};
    if (transfer.fault != LinkFault::kNone ||
        !uart_motor::decode_info({reply.data(), transfer.received}, id, station.info)) {
      line.recover();
      continue;
    }
    motors_ += station.info.motors;
    stations_.push_back(station);
  }
  for (size_t i = before; i < stations_.size(); ++i) {
    // The zeros let the board recognise the end of its packet.
    constexpr std::array<uint8_t, 5> kZeros{};
    std::array<uint8_t, uart_motor::kSetLengthsLength> lengths{};
    uart_motor::encode_lengths(stations_[i].id, stations_[i].info, lengths);
    line.exchange({lengths, kZeros}, {}, monotonic_now_ns() + patience_ns);
  }
}

void Uart::find_all(int64_t patience_ns) {
  stations_.clear();
  motors_ = 0;
  for (const auto& line : lines_) {
    line->recover();
    find_stations(*line, patience_ns);
  }
}

/// Throws if other boards answer than before: they may now be connected to the same adapter.
void Uart::require_same_stations() {
  if (first_description_.empty()) first_description_ = description();
  if (description() == first_description_) return;
  throw DeviceError(name_ + ": these are other boards than those that were lost, " +
                        first_description_ + ": now " + description() +
                        "; they get no force: stop and start to use them",
                    DeviceErrorCode::kSettings);
}

void Uart::open() {
  for (const auto& line : lines_) line->open();
  // On a busy computer the host may miss an answer.
  for (const int64_t patience_ns : {kEnquiry_ns, 5 * kEnquiry_ns}) {
    find_all(patience_ns);
    if (motors_ >= strings_) break;
  }
  if (motors_ < strings_ || motors_ > kMaxStrings) {
    throw DeviceError(
        name_ + ": " + std::to_string(stations_.size()) + " motor boards answer, with " +
            std::to_string(motors_) + " motors; the profile has " + std::to_string(strings_) +
            " strings: name the lines of all boards (uart:PATH,PATH), and check their "
            "supply",
        stations_.empty() ? DeviceErrorCode::kAbsent : DeviceErrorCode::kFailed);
  }
  require_same_stations();
  std::array<uint32_t, kMaxStrings> raw{};
  LinkFault fault = LinkFault::kTimeout;
  for (int attempt = 0; attempt < 3 && fault != LinkFault::kNone; ++attempt) {
    if (attempt > 0) recover();
    fault = exchange_all({}, raw, monotonic_now_ns() + 10 * kEnquiry_ns);
  }
  if (fault != LinkFault::kNone) throw no_answer(name_, fault);
  counts_.open(raw, motors_);
}

LinkFault Uart::exchange(const Station& station, const MotorVolts& volts,
                         uart_motor::Reading& reading, int64_t deadline_ns) noexcept {
  std::array<int, uart_motor::kMaxMotors> digits{};
  for (size_t i = 0; i < station.info.motors; ++i) {
    digits[i] = dac_.digit(volts.volt[station.first + i]);
  }
  const size_t length = uart_motor::encode_current(station.id, station.info, digits, out_);
  const size_t reply = uart_motor::current_reply_length(station.info.motors, station.info.forces);
  const Transfer transfer =
      station.line->exchange({{out_.data(), length}}, {in_.data(), reply}, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  const bool right = uart_motor::decode_reading({in_.data(), transfer.received}, station.id,
                                                station.info, reading);
  return right ? LinkFault::kNone : LinkFault::kWrongReply;
}

/// Sends every board its command, whether or not earlier commands failed. Returns the first fault,
/// or kGone if any board is gone.
LinkFault Uart::exchange_all(const MotorVolts& volts, std::array<uint32_t, kMaxStrings>& raw,
                             int64_t deadline_ns) noexcept {
  LinkFault worst = LinkFault::kNone;
  for (const Station& station : stations_) {
    uart_motor::Reading reading;
    const LinkFault fault = exchange(station, volts, reading, deadline_ns);
    if (worst == LinkFault::kNone || fault == LinkFault::kGone) worst = fault;
    for (size_t i = 0; i < station.info.motors; ++i) raw[station.first + i] = reading.position[i];
  }
  return worst;
}

LinkFault Uart::cycle(const MotorVolts& volts, DeviceReading& reading,
                      int64_t deadline_ns) noexcept {
  std::array<uint32_t, kMaxStrings> raw{};
  const LinkFault fault = exchange_all(volts, raw, deadline_ns);
  return fault == LinkFault::kNone ? update_counts(raw, reading) : fault;
}

void Uart::recover() noexcept {
  for (const auto& line : lines_) line->recover();
}

void Uart::close() noexcept {
  for (const auto& line : lines_) line->close();
}

std::string Uart::description() const {
  std::string text = "UART motor boards:";
  for (const Station& station : stations_) {
    text += (text.back() == ':' ? " number " : ", number ") + std::to_string(station.id) +
            " of model " + std::to_string(station.info.model) + " with " +
            std::to_string(station.info.motors) + " motors";
  }
  return text;
}

std::vector<LastWill> Uart::last_wills() const {
  std::vector<LastWill> result;
  for (const auto& line : lines_) {
    std::optional<LastWill> will = line->last_will();
    if (!will) continue;
    for (const Station& station : stations_) {
      if (station.line != line.get()) continue;
      auto& packet = will->packet[will->packets];
      // If the host stopped within a packet, the board is still waiting for the rest.
      const size_t before = will->packets == 0 ? uart_motor::kZerosBefore : 0;
      const size_t length = uart_motor::encode_current(
          station.id, station.info, {}, {packet.data() + before, packet.size() - before});
      will->length[will->packets++] = static_cast<uint32_t>(before + length);
    }
    result.push_back(*will);
  }
  return result;
}

}  // namespace spidar::boards

namespace spidar {
namespace {

boards::AnyBoard attach_uart(const std::string& name, const Profile& profile,
                             std::unique_ptr<Transport> line) {
  std::vector<std::unique_ptr<Transport>> lines;
  lines.push_back(std::move(line));
  return std::make_unique<boards::Uart>(name, profile, std::move(lines));
}

boards::AnyBoard make_uart(const std::string& name, const std::string& paths,
                           const Profile& profile) {
  std::vector<std::unique_ptr<Transport>> lines;
  for (size_t begin = 0; begin <= paths.size();) {
    const size_t end = std::min(paths.find(',', begin), paths.size());
    if (end == begin) {
      throw DeviceError(name + ": a path is empty; write uart:/dev/ttyUSB0",
                        DeviceErrorCode::kSettings);
    }
    const std::string path = paths.substr(begin, end - begin);
    lines.push_back(std::make_unique<TtyTransport>("uart:" + path, path, uart_motor::kBaud));
    begin = end + 1;
  }
  return std::make_unique<boards::Uart>(name, profile, std::move(lines));
}

/// Emulates two boards of four motors, like the published pair of a SPIDAR-G.
std::unique_ptr<emulated::Board> emulate_uart(std::shared_ptr<emulated::Motors> motors) {
  constexpr uart_motor::BoardInfo kB3M{5, 1, 4, 4, 0, 0};
  return std::make_unique<emulated::Uart>(
      std::move(motors), std::vector<emulated::Uart::Station>{{0, kB3M}, {1, kB3M}});
}

std::vector<DeviceInfo> list_uart() {
  std::vector<DeviceInfo> boards;
  for (const TtyLine& line : list_tty_lines()) {
    if (!line.named) continue;
    DeviceInfo& board = boards.emplace_back();
    board.device = "uart:" + line.path;
    board.path = line.path;
    board.accessible = access(line.path.c_str(), R_OK | W_OK) == 0;
    if (!board.accessible) board.note = "no permission: join the group dialout";
  }
  return boards;
}

}  // namespace

std::vector<DeviceKind> uart_kinds() {
  return {{.device = "uart",
           .board = "uart",
           .title = "UART motor boards",
           .names = "uart:PATH",
           .profile_board = "uart",
           .profile = "spidar-g6x4",
           .traits = boards::Uart::kTraits,
           .attach = attach_uart,
           .emulate = emulate_uart,
           .make = make_uart,
           .list = list_uart}};
}

}  // namespace spidar
