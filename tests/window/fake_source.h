// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An element that is not there, for windows.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin/window/window.h"

namespace spidar::test {

/// Notes what it is told. Functions that wait do so however long it takes.
class FakeSource : public window::Source {
 public:
  explicit FakeSource(window::ElementState state = {}) : state_(std::move(state)) {
    if (state_.name.empty()) state_.name = "fake";
  }

  /// What read() gives from now on.
  void change(const window::ElementState& state) {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = state;
    if (state_.name.empty()) state_.name = "fake";
  }
  void read(window::ElementState& state) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++reads_;
    state = state_;
  }
  void set(const std::string& setting, double value) override {
    note([&] { sets_.emplace_back(setting, value); });
  }
  void load_preset(const std::string&) override {}
  /// Only what differs from before.
  void lead_hand(const std::optional<Eigen::Vector3d>& to_m) override {
    note([&] {
      if (to_m != (led_.empty() ? std::nullopt : led_.back())) led_.push_back(to_m);
    });
  }
  void choose(const std::optional<Eigen::Vector2d>& position) override {
    note([&] { choices_.push_back(position); });
  }
  window::ChoicesSaved save(const std::string& film, const std::vector<FeelEdit>& edits) override {
    note([&] { saves_.emplace_back(film, edits); });
    return {true, "saved"};
  }
  void play(bool plays) override {
    note([&] { plays_.push_back(plays); });
  }
  void seek(int64_t to_ns) override {
    note([&] { seeks_.push_back(to_ns); });
  }
  void warn(const std::string& what, const std::string&) override {
    note([&] { warnings_.push_back(what); });
  }
  void closed() override {
    note([&] { is_closed_ = true; });
  }

  using Sets = std::vector<std::pair<std::string, double>>;
  Sets wait_for_sets(size_t count) { return wait_for(sets_, count); }
  std::vector<bool> wait_for_plays(size_t count) { return wait_for(plays_, count); }
  std::vector<int64_t> wait_for_seeks(size_t count) { return wait_for(seeks_, count); }
  using Led = std::vector<std::optional<Eigen::Vector3d>>;
  Led wait_for_led(size_t count) { return wait_for(led_, count); }
  using Places = std::vector<std::optional<Eigen::Vector2d>>;
  Places wait_for_choices(size_t count) { return wait_for(choices_, count); }
  using Saves = std::vector<std::pair<std::string, std::vector<FeelEdit>>>;
  Saves wait_for_saves(size_t count) { return wait_for(saves_, count); }
  int reads() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return reads_;
  }
  std::vector<std::string> warnings() { return wait_for(warnings_, 0); }
  void wait_until_closed() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return is_closed_; });
  }

 private:
  template <typename What>
  void note(const What& what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    what();
    changed_.notify_all();
  }
  template <typename Noted>
  Noted wait_for(const Noted& noted, size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return noted.size() >= count; });
    return noted;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  window::ElementState state_;
  Sets sets_;
  std::vector<bool> plays_;
  std::vector<int64_t> seeks_;
  Led led_;
  Places choices_;
  Saves saves_;
  std::vector<std::string> warnings_;
  bool is_closed_ = false;
  int reads_ = 0;
};

}  // namespace spidar::test
