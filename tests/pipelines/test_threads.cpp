// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The threads that the element starts in an application's process.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>

#include <gst/gst.h>
#include <gtest/gtest.h>

namespace spidar::test {
namespace {

/// Blocked signals of the threads of this process whose name begins with "spidar-": bit n−1 for
/// signal n, as in /proc/PID/status.
std::map<std::string, uint64_t> blocked_signals() {
  std::map<std::string, uint64_t> found;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream status(task.path() / "status");
    std::string key, name;
    while (status >> key) {
      if (key == "Name:") status >> name;
      if (key == "SigBlk:" && name.rfind("spidar-", 0) == 0)
        status >> std::hex >> found[name] >> std::dec;
    }
  }
  return found;
}

// Signals that an application waits for with sigwait(), or handles where it has its data, must not
// end up in a thread that it does not know.
TEST(Threads, OfThisLibraryTakeNoSignals) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      "videotestsrc ! video/x-raw,width=160,height=120 ! spidarmotion haptic-trace=/dev/null ! "
      "fakesink sync=true",
      &error);
  ASSERT_EQ(error, nullptr) << error->message;
  GstDeviceMonitor* monitor = gst_device_monitor_new();
  gst_device_monitor_add_filter(monitor, "Haptic/SPIDAR", nullptr);
  gst_device_monitor_start(monitor);
  ASSERT_NE(gst_element_set_state(pipeline, GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
  gst_element_get_state(pipeline, nullptr, nullptr, GST_CLOCK_TIME_NONE);

  const char* names[] = {"spidar-haptic", "spidar-clock", "spidar-trace", "spidar-boards"};
  std::map<std::string, uint64_t> blocked;
  // A thread gives itself its name; the test's own time limit is the only one.
  const auto all_named = [&] {
    blocked = blocked_signals();
    for (const char* name : names)
      if (blocked.count(name) == 0) return false;
    return true;
  };
  while (!all_named()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (const auto& [name, signals] : blocked)
    for (int signal = 1; signal < 32; ++signal) {
      const bool blockable = signal != SIGKILL && signal != SIGSTOP;
      EXPECT_EQ(signals >> (signal - 1) & 1, blockable) << name << ", signal " << signal;
    }

  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  gst_device_monitor_stop(monitor);
  gst_object_unref(monitor);
}

}  // namespace
}  // namespace spidar::test

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
