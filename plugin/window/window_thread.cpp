// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/window_thread.h"

#include <algorithm>
#include <sys/resource.h>
#include <unistd.h>

#include <GLFW/glfw3.h>

#include "plugin/window/glfw/private_glfw.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFallbackRate_Hz = 60;

Clock::duration screen_period() {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  const int rate_Hz = mode && mode->refreshRate > 0 ? mode->refreshRate : kFallbackRate_Hz;
  return std::chrono::nanoseconds(1'000'000'000 / rate_Hz);
}

std::string glfw_error() {
  const char* why = nullptr;
  glfwGetError(&why);
  return why ? why : "unknown reason";
}

}  // namespace

WindowThread& WindowThread::instance() {
  static WindowThread* const thread = new WindowThread;
  return *thread;
}

std::shared_ptr<Window::Entry> WindowThread::open(std::shared_ptr<WindowSource> source,
                                                  std::shared_ptr<FrameFeed> feed) {
  auto entry = std::make_shared<Window::Entry>();
  entry->source = std::move(source);
  entry->feed = std::move(feed);
  const std::lock_guard<std::mutex> lock(mutex_);
  entries_.push_back(entry);
  if (running_) {
    wake_.notify_one();
  } else {
    start();
  }
  return entry;
}

/// With the mutex held.
void WindowThread::start() {
  if (thread_.joinable()) thread_.join();  // it has left run() for good
  running_ = true;
  thread_ = start_thread("spidar-window", [this] { run(); });
}

void WindowThread::close(const std::shared_ptr<Window::Entry>& entry) {
  std::unique_lock<std::mutex> lock(mutex_);
  entry->closing = true;
  wake_.notify_one();
  if (thread_.get_id() == std::this_thread::get_id()) return;  // closed by its own user
  // The last window takes its thread along.
  const auto settled = [&] { return entry->gone && (!entries_.empty() || !running_); };
  if (!changed_.wait_for(lock, Window::kPatience, settled)) return;
  if (!running_ && thread_.joinable()) thread_.join();
}

std::optional<Screenshot> WindowThread::screenshot(const std::shared_ptr<Window::Entry>& entry,
                                                   std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!entry->screenshot) entry->screenshot = std::make_shared<std::optional<Screenshot>>();
  const auto shot = entry->screenshot;
  changed_.wait_for(lock, timeout, [&] { return *shot || entry->gone; });
  return *shot;
}

void WindowThread::request(const std::shared_ptr<Window::Entry>& entry,
                           std::function<void(DebugWindow&)> what) {
  const std::lock_guard<std::mutex> lock(mutex_);
  entry->requests.push_back(std::move(what));
}

// --- window thread -----------------------------------------------------------------------------

void WindowThread::run() {
  // Drawing yields to decoding; of a thread on Linux, whatever POSIX says of processes.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
  const std::string problem = load_glfw();
  if (!problem.empty()) {
    fail_all("The debug window needs GLFW, which cannot be loaded: " + problem + ".",
             "Is the package libglfw3 installed?");
  } else if (!glfwInit()) {
    fail_all("The debug window cannot be opened: " + glfw_error() +
                 ". Is DISPLAY or WAYLAND_DISPLAY right?",
             "It needs an X11 or Wayland display.");
  } else {
    serve();  // GLFW stays initialised afterwards: the next glfwInit() does nothing
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  running_ = false;
  changed_.notify_all();
  // What was opened in the meantime.
  if (!entries_.empty()) {
    thread_.detach();
    start();
  }
}

void WindowThread::fail_all(const std::string& what, const std::string& advice) {
  Entries failed;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    failed.swap(entries_);
  }
  for (const auto& entry : failed) {
    entry->source->warn(what, advice);
    finish(*entry);
  }
}

void WindowThread::serve() {
  const Clock::duration period = screen_period();
  Clock::time_point next = Clock::now();
  for (;;) {
    Entries now;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      const auto is_closing = [](const auto& entry) { return entry->closing; };
      wake_.wait_until(lock, next,
                       [&] { return std::any_of(entries_.begin(), entries_.end(), is_closing); });
      if (entries_.empty()) return;
      now = entries_;
    }
    const Clock::time_point begin = Clock::now();
    glfwPollEvents();
    for (const auto& entry : now) draw(*entry);
    // Where the processor draws, half of its time stays with others.
    const Clock::time_point end = Clock::now();
    next = std::max(begin + period, end + (end - begin));
  }
}

bool WindowThread::create(Window::Entry& entry) {
  try {
    entry.window = std::make_unique<DebugWindow>(entry.source, entry.feed);
    return true;
  } catch (const std::exception& e) {
    entry.source->warn(
        std::string("The debug window cannot be opened with OpenGL 3.3: ") + e.what() + ".",
        "Is there a driver for it, or Mesa's software renderer (libgl1-mesa-dri)?");
    return false;
  }
}

void WindowThread::draw(Window::Entry& entry) {
  std::vector<std::function<void(DebugWindow&)>> requests;
  std::shared_ptr<std::optional<Screenshot>> wanted;
  bool closing;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    requests.swap(entry.requests);
    wanted.swap(entry.screenshot);
    closing = entry.closing;
  }
  if (closing || (!entry.window && !create(entry))) {
    finish(entry);
    return;
  }
  for (const auto& request : requests) request(*entry.window);
  if (entry.window->is_done()) {
    entry.window.reset();
    finish(entry);
    entry.source->closed();
    return;
  }
  entry.window->draw();
  if (wanted) {
    Screenshot shot = entry.window->screenshot();
    const std::lock_guard<std::mutex> lock(mutex_);
    *wanted = std::move(shot);
    changed_.notify_all();
  }
  entry.window->present();
}

void WindowThread::finish(Window::Entry& entry) {
  entry.window.reset();
  const std::lock_guard<std::mutex> lock(mutex_);
  entry.gone = true;
  const auto is_it = [&](const auto& other) { return other.get() == &entry; };
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(), is_it), entries_.end());
  changed_.notify_all();
}

// --- Window ------------------------------------------------------------------------------------

bool windows_are_built_in() {
  return true;
}

Window::Window(std::shared_ptr<WindowSource> source, std::shared_ptr<FrameFeed> feed)
    : entry_(WindowThread::instance().open(std::move(source), std::move(feed))) {}

Window::~Window() {
  WindowThread::instance().close(entry_);
}

std::optional<Screenshot> Window::screenshot(std::chrono::milliseconds timeout) {
  return WindowThread::instance().screenshot(entry_, timeout);
}

void Window::resize(int width, int height) {
  WindowThread::instance().request(entry_, [=](DebugWindow& w) { w.resize(width, height); });
}

void Window::set_mouse(const Mouse& mouse) {
  WindowThread::instance().request(entry_, [=](DebugWindow& w) { w.set_mouse(mouse); });
}

void Window::press(int key) {
  WindowThread::instance().request(entry_, [=](DebugWindow& w) { w.on_key(key); });
}

}  // namespace spidar
