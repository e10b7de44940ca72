// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// One object of libgst-spidar that several threads use, and what a callback must not call.
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gst-spidar/c-api.h>
#include <gst-spidar/device.h>
#include <gst-spidar/motion.h>
#include <gtest/gtest.h>

namespace gst_spidar {
namespace {

using namespace std::chrono_literals;

/// Each of these in a thread of its own, over and over, until all have been called that often.
void beside_each_other(const std::vector<std::function<void()>>& calls, int times) {
  std::atomic<size_t> busy{calls.size()};
  std::vector<std::thread> threads;
  for (const auto& call : calls)
    threads.emplace_back([&] {
      for (int n = 0; n < times; ++n) call();
      --busy;
      while (busy > 0) call();
    });
  for (std::thread& thread : threads) thread.join();
}

struct Picture {
  Picture() {
    for (size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = static_cast<uint8_t>((i % kSide / 4 * 73 + i / kSide / 4 * 151) * 37 >> 3);
    grey = {pixels.data(), kSide, kSide, kSide};
  }
  static constexpr int kSide = 64;
  std::vector<uint8_t> pixels = std::vector<uint8_t>(size_t{kSide} * kSide);
  GreyPicture grey;
};

/// What a callback has captured is there as long as it may be called, and one that was replaced is
/// not called any more.
TEST(Threads, ShareADevice) {
  Device device("sim");
  ASSERT_TRUE(device.wait_until_running(60s));
  std::atomic<bool> used_after_its_end{false};
  const auto set_callback = [&] {
    struct Captured {
      std::atomic<bool> ended{false};
      ~Captured() { ended = true; }
    };
    device.set_callback([&, captured = std::make_shared<Captured>()](const GripState&) {
      if (captured->ended) used_after_its_end = true;
      return Wrench{};
    });
  };
  const Picture picture;
  Surface surface;
  surface.picture = picture.grey;
  Wrench wrench;
  wrench.force_N.x = 0.5;
  beside_each_other({set_callback, set_callback, [&] { device.set_surface(surface); },
                     [&] { device.set_surface(surface); }, [&] { device.clear_surface(); },
                     [&] { device.push(wrench); }, [&] { device.push(wrench); },
                     [&] { device.set_limits(1, 0.05); }, [&] { device.set_limits(2, 0.1); },
                     [&] {
                       device.rest();
                       device.callback_error();
                       device.felt();
                     }},
                    100);
  EXPECT_FALSE(used_after_its_end);
  // And it still does what it is told.
  device.clear_surface();
  device.set_callback({});
  device.set_limits(3, 0.1);
  const auto until = std::chrono::steady_clock::now() + 60s;
  bool felt = false;
  while (!felt && std::chrono::steady_clock::now() < until) {
    device.push(wrench);
    felt = device.felt().force_N.x > 0.4;
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_TRUE(felt);
}

TEST(Threads, ShareAMotion) {
  MotionToWrench motion;
  const Picture picture;
  std::atomic<int64_t> time_ns{0};
  const auto analyze = [&] {
    motion.analyze(picture.grey, std::chrono::nanoseconds(time_ns += 40'000'000));
  };
  MotionSettings settings;
  settings.max_force_N = 1;
  beside_each_other({analyze, analyze, [&] { motion.reset(); }, [&] { motion.configure(settings); },
                     [&] { motion.configure({}); }},
                    50);
  motion.reset();
  motion.analyze(picture.grey, 0s);
  EXPECT_TRUE(motion.analyze(picture.grey, 40ms).has_picture_before);
}

/// Whether `call` returns true in a copy of this process, soon.
bool in_a_copy(const std::function<bool()>& call) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    _exit(call() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool throws_of_fork(const std::function<void()>& call) {
  try {
    call();
    return false;
  } catch (const std::runtime_error& error) {
    return std::string(error.what()).find("fork") != std::string::npos;
  }
}

/// Whatever was locked, or was being written, in the moment of the copy.
TEST(Threads, ACopyOfTheProcessHasNoDevice) {
  Device device("sim");
  ASSERT_TRUE(device.wait_until_running(60s));
  // The callback does not end before `ends`, and set_callback() waits for that, with the lock.
  std::atomic<bool> called{false}, ends{false};
  device.set_callback([&](const GripState&) {
    called = true;
    while (called && !ends) std::this_thread::sleep_for(1ms);
    return Wrench{};
  });
  while (!called) std::this_thread::sleep_for(1ms);
  std::thread sets([&] { device.set_callback({}); });
  const Picture picture;
  Surface surface;
  surface.picture = picture.grey;
  for (int times = 0; times < 20; ++times) {
    EXPECT_TRUE(in_a_copy([&] {
      device.rest();
      device.clear_surface();
      const bool refuses = throws_of_fork([&] { device.push({}); }) &&
                           throws_of_fork([&] { device.set_callback({}); }) &&
                           throws_of_fork([&] { device.set_limits(1, 0.1); }) &&
                           throws_of_fork([&] { device.set_surface(surface); });
      const bool knows_nothing = !device.pose() && !device.velocity() && !device.held() &&
                                 device.buttons() == 0 && device.felt().force_N.x == 0 &&
                                 device.vibration_fraction() == 1 &&
                                 device.callback_error().empty() && device.warning().empty();
      return refuses && knows_nothing && device.state() == DeviceState::kLost &&
             !device.wait_until_running(1ms) && device.name() == "sim" &&
             device.capabilities().torque && device.last_fault().find("fork") != std::string::npos;
    }));
  }
  ends = true;
  sets.join();
}

TEST(Threads, ACopyOfTheProcessHasNoMotion) {
  MotionToWrench motion;
  const Picture picture;
  std::atomic<bool> ends{false};
  std::thread analyzes([&] {
    for (auto time = 0ms; !ends; time += 40ms) motion.analyze(picture.grey, time);
  });
  for (int times = 0; times < 20; ++times) {
    EXPECT_TRUE(in_a_copy([&] {
      motion.reset();
      return throws_of_fork([&] { motion.analyze(picture.grey, 0ms); }) &&
             throws_of_fork([&] { motion.configure({}); });
    }));
  }
  ends = true;
  analyzes.join();
}

/// What the call throws within a callback of `device`.
std::string refused(Device& device, const std::function<void()>& call) {
  auto done = std::make_shared<std::promise<std::string>>();
  std::future<std::string> message = done->get_future();
  device.set_callback([&call, done, asked = false](const GripState&) mutable {
    if (asked) return Wrench{};
    asked = true;
    try {
      call();
      done->set_value("");
    } catch (const std::logic_error& error) {
      done->set_value(error.what());
    }
    return Wrench{};
  });
  const bool answered = message.wait_for(60s) == std::future_status::ready;
  EXPECT_TRUE(answered);
  device.set_callback({});
  return answered ? message.get() : "";
}

/// Each of them might wait for the callback's end, or for a thread that does.
TEST(Threads, ACallbackMayNotCallWhatWaits) {
  Device device("sim"), other("sim");
  ASSERT_TRUE(device.wait_until_running(60s));
  const Picture picture;
  Surface surface;
  surface.picture = picture.grey;
  for (Device* const called : {&device, &other}) {
    const std::vector<std::function<void()>> calls{
        [&] { called->push({}); }, [&] { called->set_callback({}); },
        [&] { called->set_limits(1, 0.1); }, [&] { called->set_surface(surface); },
        [&] { called->wait_until_running(1h); }};
    for (const auto& call : calls) {
      const std::string message = refused(device, call);
      EXPECT_EQ(message.find("not within a callback"), 0u) << message;
    }
    EXPECT_EQ(refused(device,
                      [&] {
                        called->rest();
                        called->clear_surface();
                        called->callback_error();
                        called->pose();
                      }),
              "")
        << "these never wait";
  }
}

}  // namespace
}  // namespace gst_spidar
