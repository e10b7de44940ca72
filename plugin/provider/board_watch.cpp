// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/provider/board_watch.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

/// Boards count as different when the serial number or the permission to open them differs.
bool same(const BoardInfo& a, const BoardInfo& b) {
  return std::tie(a.device, a.usb_id, a.serial, a.accessible) ==
         std::tie(b.device, b.usb_id, b.serial, b.accessible);
}

/// The elements of `boards` that are not in `others`.
std::vector<BoardInfo> without(const std::vector<BoardInfo>& boards,
                               const std::vector<BoardInfo>& others) {
  std::vector<BoardInfo> left;
  std::copy_if(boards.begin(), boards.end(), std::back_inserter(left), [&](const BoardInfo& board) {
    return std::none_of(others.begin(), others.end(),
                        [&](const BoardInfo& other) { return same(board, other); });
  });
  return left;
}

}  // namespace

std::vector<BoardInfo> playable_boards() {
  std::vector<BoardInfo> boards = list_boards();
  // The device behind the packets of an emulated board is the same simulated one.
  boards.erase(std::remove_if(
                   boards.begin(), boards.end(),
                   [](const BoardInfo& board) { return board.device.compare(0, 4, "sim:") == 0; }),
               boards.end());
  return boards;
}

BoardWatch::BoardWatch(std::vector<BoardInfo> known, Changed changed)
    : known_(std::move(known)), changed_(std::move(changed)) {
  thread_ = start_thread("spidar-boards", [this] { run(); });
}

BoardWatch::~BoardWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void BoardWatch::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_.wait_for(lock, kInterval, [this] { return end_; })) {
    lock.unlock();
    std::vector<BoardInfo> now = playable_boards();
    const std::vector<BoardInfo> gone = without(known_, now), come = without(now, known_);
    known_ = std::move(now);
    if (!gone.empty() || !come.empty()) changed_(gone, come);
    lock.lock();
  }
}

}  // namespace spidar
