// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The debug window in an application that uses GLFW itself, with the plugin as GStreamer loads it.
// Each test has a process of its own, for GLFW keeps its display.
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <string>
#include <thread>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace spidar::test::window_application_test {
namespace {

/// Ends the process with a message.
void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "%s\n", what);
  std::_Exit(1);
}

/// A window of the application, which handles its events on the main thread.
class ApplicationWindow {
 public:
  /// With RTLD_GLOBAL, every library that is loaded later finds this GLFW, as if the application
  /// were linked with it.
  ApplicationWindow() : library_(dlopen("libglfw.so.3", RTLD_NOW | RTLD_GLOBAL)) {
    require(library_ != nullptr, "no GLFW");
    require(call<decltype(glfwInit)>("glfwInit")() == GLFW_TRUE, "glfwInit() fails");
    window_ = call<decltype(glfwCreateWindow)>("glfwCreateWindow")(200, 100, "application", nullptr,
                                                                   nullptr);
    require(window_ != nullptr, "no window of the application");
    call<decltype(glfwMakeContextCurrent)>("glfwMakeContextCurrent")(window_);
    call<decltype(glfwSetWindowSizeCallback)>("glfwSetWindowSizeCallback")(
        window_, [](GLFWwindow*, int width, int) {
          require(std::this_thread::get_id() == main_thread, "called in another thread");
          width_seen = width;
        });
  }

  /// The size of a window changes when the X server says so, which is an event of this window.
  void handle_events() {
    const int width = ++width_;
    call<decltype(glfwSetWindowSize)>("glfwSetWindowSize")(window_, width, 100);
    while (width_seen != width) {
      call<decltype(glfwPollEvents)>("glfwPollEvents")();
      call<decltype(glfwSwapBuffers)>("glfwSwapBuffers")(window_);
    }
  }

  void terminate() { call<decltype(glfwTerminate)>("glfwTerminate")(); }

 private:
  template <typename Function>
  Function* call(const char* name) {
    return reinterpret_cast<Function*>(dlsym(library_, name));
  }

  inline static const std::thread::id main_thread = std::this_thread::get_id();
  inline static int width_seen = 0;
  void* const library_;
  GLFWwindow* window_ = nullptr;
  int width_ = 200;
};

class Player {
 public:
  Player() {
    gst_init(nullptr, nullptr);
    pipeline_ = gst_parse_launch(
        "videotestsrc pattern=ball ! video/x-raw,width=320,height=240 ! spidarmotion name=motion "
        "debug-window=true ! fakesink sync=true",
        nullptr);
    require(pipeline_ != nullptr, "no pipeline");
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
    gst_element_get_state(pipeline_, nullptr, nullptr, GST_CLOCK_TIME_NONE);
    motion_ = gst_bin_get_by_name(GST_BIN(pipeline_), "motion");
  }

  void expect_window() {
    // The element waits five seconds for the window, which draws at low priority.
    constexpr int kTries = 20;
    const TemporaryFolder folder;
    gboolean saved = FALSE;
    for (int i = 0; i < kTries && !saved; ++i) {
      g_signal_emit_by_name(motion_, "save-window", (folder.path / "window.png").c_str(), &saved);
    }
    require(saved, "no debug window");
  }

  void stop() {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(motion_);
    gst_object_unref(pipeline_);
  }

 private:
  GstElement* pipeline_;
  GstElement* motion_;
};

[[noreturn]] void application_first() {
  ApplicationWindow window;
  window.handle_events();
  Player player;
  for (int i = 0; i < 2; ++i) {
    player.expect_window();
    window.handle_events();
  }
  window.terminate();
  player.expect_window();
  player.stop();
  Player().expect_window();
  std::_Exit(0);
}

[[noreturn]] void debug_window_first() {
  Player player;
  player.expect_window();
  ApplicationWindow window;
  for (int i = 0; i < 2; ++i) {
    window.handle_events();
    player.expect_window();
  }
  player.stop();
  window.handle_events();
  Player next;
  next.expect_window();
  window.terminate();
  next.expect_window();
  next.stop();
  std::_Exit(0);
}

class WindowApplication : public testing::Test {
 protected:
  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "under the address sanitizer, threads of Mesa and of the window wait for each "
                    "other in the unwinder; the test runs in the other builds";
#endif
    if (!VirtualDisplay::shared().runs()) GTEST_SKIP() << VirtualDisplay::kWhyNot;
  }
};

TEST_F(WindowApplication, MayBeginToUseGlfwBeforeTheDebugWindow) {
  EXPECT_EXIT(application_first(), testing::ExitedWithCode(0), "");
}

TEST_F(WindowApplication, MayBeginToUseGlfwAfterTheDebugWindow) {
  EXPECT_EXIT(debug_window_first(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace spidar::test::window_application_test
