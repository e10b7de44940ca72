// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An element that is not there, for windows.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin/window/model/window_source.h"

namespace spidar::test {

class FakeSource final : public WindowSource {
 public:
  explicit FakeSource(ElementState state = {}) : state_(std::move(state)) {
    if (state_.name.empty()) state_.name = "fake";
  }

  bool read(ElementState& state) override {
    std::unique_lock<std::mutex> lock(mutex_);
    ++reads_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return reads_ <= reads_let_through_; });
    state = state_;
    return true;
  }
  void set(const std::string& setting, double value) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    sets_.emplace_back(setting, value);
    changed_.notify_all();
  }
  void lead_hand(const std::optional<Eigen::Vector3d>& to_m) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    led_.push_back(to_m);
    changed_.notify_all();
  }
  void choose(const std::optional<Eigen::Vector2d>& place) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    choices_.push_back(place);
    changed_.notify_all();
  }
  Saved save(const std::string& film, const std::vector<FeelEdit>& edits) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    saves_.emplace_back(film, edits);
    changed_.notify_all();
    return {true, "saved"};
  }
  void warn(const std::string& what, const std::string&) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    warnings_.push_back(what);
    changed_.notify_all();
  }
  void closed() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
  }

  /// Stops the window in the middle of its next drawing, or of the one after where it stands
  /// stopped, and returns when it has.
  void hold_next_drawing() {
    std::unique_lock<std::mutex> lock(mutex_);
    reads_let_through_ = reads_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return reads_ > reads_let_through_; });
  }
  void draw_on() {
    const std::lock_guard<std::mutex> lock(mutex_);
    reads_let_through_ = kAll;
    changed_.notify_all();
  }

  using Sets = std::vector<std::pair<std::string, double>>;
  /// Waits until there are as many, however long that takes.
  Sets wait_for_sets(size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return sets_.size() >= count; });
    return sets_;
  }
  using Led = std::vector<std::optional<Eigen::Vector3d>>;
  /// The same of places that the hand was led to.
  Led wait_for_led(size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return led_.size() >= count; });
    return led_;
  }
  using Places = std::vector<std::optional<Eigen::Vector2d>>;
  /// The same of objects that were chosen.
  Places wait_for_choices(size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return choices_.size() >= count; });
    return choices_;
  }
  using Saves = std::vector<std::pair<std::string, std::vector<FeelEdit>>>;
  /// The same of what was saved.
  Saves wait_for_saves(size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return saves_.size() >= count; });
    return saves_;
  }
  void wait_until_closed() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return is_closed_; });
  }
  std::vector<std::string> wait_for_warning() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return !warnings_.empty(); });
    return warnings_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  ElementState state_;
  Sets sets_;
  Led led_;
  Places choices_;
  Saves saves_;
  std::vector<std::string> warnings_;
  bool is_closed_ = false;
  static constexpr uint64_t kAll = std::numeric_limits<uint64_t>::max();
  uint64_t reads_ = 0, reads_let_through_ = kAll;
};

}  // namespace spidar::test
