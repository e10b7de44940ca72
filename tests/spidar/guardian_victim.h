// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Processes for tests of the guardian: players that are killed or stopped.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <unistd.h>

#include "spidar/device.h"
#include "tests/spidar/device_test.h"
#include "tests/support/child_process.h"

namespace spidar::test {

/// Its source names no board: it is for each of both.
constexpr const char* kUsbProfile = "spidar-g645";
constexpr const char* kUartProfile = "spidar-g6x5-r";

/// For every string.
inline MotorVolts one_volt() {
  MotorVolts volts;
  volts.volt.fill(1);
  return volts;
}

inline void sleep_1ms() {
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// Waits without a limit; the test has one.
template <typename Condition>
void wait_for(const Condition& condition) {
  while (!condition()) sleep_1ms();
}

/// This program, pulling.
class Victim : public ChildProcess {
 public:
  Victim(const std::string& spec, const std::string& profile, const char* how = "--pull")
      : ChildProcess({"/proc/self/exe", how, spec, profile}) {}

  /// Waits for the condition. Throws if the player has ended before.
  template <typename Condition>
  void lives_until(const Condition& condition) {
    wait_for([&] { return condition() || !lives(); });
    if (!lives()) throw std::runtime_error("the player has ended");
  }
};

/// Exchanges until the condition holds. Opens the device again when it is lost: on a busy machine,
/// the guardian may have found that this process stood still.
template <typename Condition>
void exchange_until(StringDevice& device, const MotorVolts& volts, const Condition& condition) {
  DeviceReading reading;
  wait_for([&] {
    if (is_lost(device.exchange(volts, reading))) device.open();
    return condition();
  });
}

/// What spidarctl says on a machine that is too busy: it, its guardian, or the thread that talks to
/// its board had no processor time.
inline bool was_suspended(const std::string& log) {
  return log.find("this program stood still") != std::string::npos;
}
inline bool is_unguarded(const std::string& log) {
  return log.find("the guardian (spidar-guardian), without which no motor pulls") !=
         std::string::npos;
}
inline bool is_disturbed(const std::string& log) {
  return was_suspended(log) || is_unguarded(log) ||
         log.find(": does not answer any more; check cable and power") != std::string::npos;
}

/// The guardian that a process, by default this one, has started; 0 when there is none.
inline pid_t guardian_process(pid_t of = getpid()) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    std::string number, name, state;
    pid_t parent = 0;
    if (file >> number >> name >> state >> parent && parent == of && name == "(spidar-guardian)")
      return std::stoi(number);
  }
  return 0;
}

/// Its parent may not have taken note of its end yet.
inline bool has_ended(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  return !(status >> number >> name >> state) || state == "Z";
}

}  // namespace spidar::test
