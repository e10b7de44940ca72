// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Boards that come and go.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "spidar/session/board_list.h"

namespace spidar {

/// What spidarmotion can be given: the boards that there are, and one simulated device. None is
/// opened.
std::vector<BoardInfo> playable_boards();

/// Lists the boards again and again on a thread of its own. libusb's hotplug events would not be
/// enough: they tell nothing of serial lines, and come before udev has given the permission.
class BoardWatch {
 public:
  static constexpr std::chrono::milliseconds kInterval{500};

  /// `changed` is called on the thread, with what is gone and what is there in addition to `known`.
  using Changed =
      std::function<void(const std::vector<BoardInfo>& gone, const std::vector<BoardInfo>& come)>;
  BoardWatch(std::vector<BoardInfo> known, Changed changed);
  ~BoardWatch();
  BoardWatch(const BoardWatch&) = delete;
  BoardWatch& operator=(const BoardWatch&) = delete;

 private:
  void run();

  std::vector<BoardInfo> known_;
  const Changed changed_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace spidar
