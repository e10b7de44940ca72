// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An emulated force-feedback device that the kernel takes for a real one: the other end of
/// /dev/uinput.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>

namespace spidar::test {

enum class UinputKind { kStick, kWheel, kPad };

class UinputDevice {
 public:
  struct Effect {
    std::atomic<bool> used{false};
    std::atomic<bool> plays{false};
    std::atomic<int> right{0};
    std::atomic<int> up{0};
    std::atomic<int> rumble{0};
  };

  /// Plugged in when the constructor returns. Throws std::runtime_error.
  explicit UinputDevice(UinputKind kind, const std::string& name = "uinput device");
  /// Pulls it out.
  ~UinputDevice();
  UinputDevice(const UinputDevice&) = delete;
  UinputDevice& operator=(const UinputDevice&) = delete;

  /// −1000 … 1000: to the right, and to the user.
  void move(int x, int y);

  /// Sum of the playing effects.
  int right() const;
  int up() const;
  int rumble() const;
  bool at_rest() const { return right() == 0 && up() == 0 && rumble() == 0; }
  bool has_effects() const;

  std::atomic<int> gain{-1};        ///< −1: not set
  std::atomic<int> autocentre{-1};  ///< the same
  std::atomic<int> uploads{0};
  std::atomic<int> unchanged{0};
  std::atomic<int> upload_ms{0};       ///< that it takes for an upload
  std::atomic<bool> uploading{false};  ///< an upload has begun and not ended

 private:
  void run();
  void take_upload(uint32_t request);
  void take_erase(uint32_t request);
  int sum(std::atomic<int> Effect::*part) const;

  const UinputKind kind_;
  int file_ = -1;
  std::array<Effect, 16> effect_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Waits until the driver lists a device of that name, and returns its "ff:…".
std::string listed(const std::string& name = "uinput device");

}  // namespace spidar::test
