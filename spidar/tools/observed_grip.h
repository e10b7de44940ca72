// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A grip whose exchanges are measured.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "spidar/grip/grip.h"
#include "spidar/tools/observed_device.h"

namespace spidar {

/// Forwards all calls to the grip. Not thread-safe.
class ObservedGrip final : public Grip {
 public:
  explicit ObservedGrip(std::unique_ptr<Grip> grip) : grip_(std::move(grip)) {}

  void open() override {
    grip_->open();
    seen_.begin(grip_->description());
  }
  void pass(double passed_s) noexcept override { grip_->pass(passed_s); }
  void check_age(int64_t now_ns) noexcept override { grip_->check_age(now_ns); }
  ExchangeStatus exchange(const GripCommand& command) noexcept override {
    return seen_.timed([&] { return grip_->exchange(command); });
  }
  const GripReading& reading() const noexcept override { return grip_->reading(); }
  void close() noexcept override { grip_->close(); }
  const GripTraits& traits() const noexcept override { return grip_->traits(); }
  std::string description() const override { return grip_->description(); }
  GripAbilities abilities() const noexcept override { return grip_->abilities(); }
  LinkHealth health() const noexcept override { return grip_->health(); }
  const std::string& name() const noexcept override { return grip_->name(); }

  const Observation& seen() const noexcept { return seen_; }

 private:
  const std::unique_ptr<Grip> grip_;
  Observation seen_;
};

}  // namespace spidar
