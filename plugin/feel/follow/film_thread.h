// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "plugin/feel/follow/film_plan.h"

namespace spidar::follow {

/// Requests of the debug window for the player.
struct FilmRequest {
  std::optional<bool> plays;
  std::optional<int64_t> position_ns;

  void add(const FilmRequest& later) {
    if (later.plays) plays = later.plays;
    if (later.position_ns) position_ns = later.position_ns;
  }
};

/// Which film a player plays, and its position.
struct FilmGoal {
  std::shared_ptr<const FilmPlan> plan;  ///< null: nothing is felt
  bool plays = false;                    ///< false: the force rests
  double rate = 1;
  int64_t at_ns = 0;                   ///< CLOCK_MONOTONIC
  std::optional<int64_t> position_ns;  ///< at the time at_ns, if known
};

class FilmThread {
 public:
  /// Opens, plays and closes followed films in a thread of its own: a file, a network or a device
  /// that does not answer delays that thread, and not the main loop. `properties` are those of
  /// spidarmotion, NAME=VALUE.
  explicit FilmThread(std::vector<std::string> properties);
  /// Call end() first.
  ~FilmThread();
  FilmThread(const FilmThread&) = delete;
  FilmThread& operator=(const FilmThread&) = delete;

  /// Sets the goal. Call this every few tens of milliseconds: else the force rests after 0.3 s.
  void set_goal(FilmGoal goal);
  /// Returns the requests since the last call.
  FilmRequest take_request();
  /// Closes what is open. Returns false if that takes longer than `limit`; the thread then still
  /// runs, and the process must end without this destructor.
  bool end(std::chrono::milliseconds limit);

 private:
  void run();

  const std::vector<std::string> properties_;
  std::mutex mutex_;
  std::condition_variable changed_;
  FilmGoal goal_;
  FilmRequest request_;
  bool ends_ = false, has_ended_ = false;
  std::thread thread_;
};

}  // namespace spidar::follow
