// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/window.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <mutex>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <system_error>
#include <time.h>
#include <unistd.h>
#include <utility>

#include "plugin/window/view/channel.h"
#include "plugin/window/view/shared_pictures.h"
#include "spidar/child_process.h"
#include "spidar/folders.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/realtime/uninterrupted.h"

namespace spidar::window {
namespace {

constexpr const char* kNotOpen = "the debug window is not open";
constexpr const char* kSilent = "the debug window does not answer";
/// How long close() waits for the thread, which ends in two thirds of that time, unless its call
/// into the player waits for a lock that the caller of close() holds.
constexpr std::chrono::milliseconds kLongestClose = 3 * Window::kCloseTimeout;
/// The most messages that are sent at once; more wait only for a window that does not read.
constexpr size_t kMaxToSend = 1000;

/// $SPIDAR_WINDOW, or the program that was built or installed with this plugin.
std::string program() {
  const char* const named = secure_getenv("SPIDAR_WINDOW");
  if (named && *named) return named;
  const std::filesystem::path beside = own_file().replace_filename("spidar-window");
  std::error_code error;
  const bool is_built_here =
      prefix_of(own_file()).empty() && std::filesystem::exists(beside, error);
  return is_built_here ? beside.string() : installed(SPIDAR_WINDOW_PATH).string();
}

/// The program spidar-window as a child of this process. One thread at a time.
class Process {
 public:
  Process() = default;
  /// Ends the child if it still runs.
  ~Process() {
    if (process_ >= 0) finish(0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Starts $SPIDAR_WINDOW or the installed program. Returns an empty string, or why it cannot be
  /// started. socket() is then this process's end of its socket, which the caller takes over.
  std::string start() {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      return std::string("no socket: ") + std::strerror(errno);
    }
    const std::string path = program();
    // Because of POSIX_SPAWN_SETSID, Ctrl-C in a terminal reaches only the player.
    process_ = start_child(path, {path}, {{ends[1], STDIN_FILENO}},
                           POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int error = errno;
    ::close(ends[1]);
    if (process_ > 0) {
      socket_ = ends[0];
      return "";
    }
    ::close(ends[0]);
    return path + ": " + std::strerror(error);
  }

  int socket() const { return socket_; }

  /// Waits until the child has ended, and kills it after `timeout_ms`. Returns an empty string if
  /// the child ended by itself with status 0, otherwise how it ended: "was ended by the signal 11
  /// (Segmentation fault)".
  std::string finish(int timeout_ms) {
    if (process_ < 0) return "";
    constexpr int kStep_ms = 5;
    int status = 0;
    pid_t ended = 0;
    for (int waited_ms = 0; ended == 0; waited_ms += kStep_ms) {
      ended = uninterrupted([&] { return waitpid(process_, &status, WNOHANG); });
      if (ended != 0) break;
      if (waited_ms == timeout_ms / kStep_ms * kStep_ms) kill(process_, SIGKILL);
      const timespec step{0, kStep_ms * 1'000'000};
      nanosleep(&step, nullptr);
    }
    process_ = -1;
    // Where the application ignores SIGCHLD, the system keeps no status.
    if (ended < 0 || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) return "";
    if (WIFEXITED(status)) return "ended with status " + std::to_string(WEXITSTATUS(status));
    const int number = WTERMSIG(status);
    return "was ended by the signal " + std::to_string(number) + " (" + strsignal(number) + ")";
  }

 private:
  pid_t process_ = -1;
  int socket_ = -1;
};

}  // namespace

/// The common data of the thread and the owner of a Window; the thread may outlive the owner.
class Window::Session {
 public:
  explicit Session(std::shared_ptr<Source> source) : source_(std::move(source)) {}
  ~Session() {
    if (wake_ >= 0) ::close(wake_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Runs the thread, until the window is closed.
  void run();
  void fail(const std::string& error);

  void close();
  /// Returns false when the thread does not end in kLongestClose.
  bool await_end();
  bool wants_frame() const { return is_ready_ && !is_full_; }
  bool queue_frame(const GstVideoFrame& frame, DrawnFrame report);
  std::string take_picture(const std::string& path, std::chrono::milliseconds timeout);
  void send(ToWindow message);

 private:
  struct Waiting {
    std::shared_ptr<PictureSlots> slots;
    FrameShown frame;
  };

  void watch();
  bool serve(Channel& channel);
  void pass_on(Channel& channel);
  void listen(Channel& channel);
  void handle(Channel& channel, FromWindow&& message);
  void answer(Channel& channel);
  void free_slot(const SlotFree& free);
  void finish(const std::string& how);
  void end_waiting(const std::string& error);
  std::shared_ptr<PictureSlots> slots_for(const GstVideoFrame& frame);
  void wake() const { eventfd_write(wake_, 1); }

  const std::shared_ptr<Source> source_;
  const int wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);  ///< −1: the system refuses it
  std::atomic<bool> is_ready_{false};                        ///< whether the window is there
  std::atomic<bool> is_full_{false};                         ///< whether there is no free slot
  // The thread uses these.
  bool has_failed_ = false;        ///< the window has reported why it cannot be opened
  bool is_requested_ = false;      ///< whether a request waits for its answer
  bool is_compatible_ = true;      ///< whether the window sends valid messages
  uint32_t memory_at_window_ = 0;  ///< the last one that was sent
  // The streaming thread uses these.
  uint32_t memories_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<PictureSlots> slots_;
  std::deque<Waiting> frames_;    ///< frames that the window has not requested yet
  std::deque<ToWindow> to_send_;  ///< messages to send at once
  bool is_closing_ = false;
  bool is_gone_ = false;
  bool has_ended_ = false;  ///< whether the thread has ended
  uint64_t pictures_asked_ = 0, pictures_taken_ = 0;
  std::string picture_error_;
};

// --- streaming thread --------------------------------------------------------------------------

/// Call this with the mutex held. Returns null when there is no memory.
std::shared_ptr<PictureSlots> Window::Session::slots_for(const GstVideoFrame& frame) {
  if (!slots_ || !slots_->fits(frame)) {
    slots_ = std::make_shared<PictureSlots>(++memories_, frame);
    frames_.clear();
  }
  return slots_->is_there() ? slots_ : nullptr;
}

bool Window::Session::queue_frame(const GstVideoFrame& frame, DrawnFrame report) {
  std::shared_ptr<PictureSlots> slots;
  std::optional<uint32_t> slot;
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return false;
    slots = slots_for(frame);
    if (!slots) return false;
    slot = slots->acquire();
    if (!slot) {
      is_full_ = true;
      return false;
    }
  }
  const bool is_copied = slots->copy(frame, *slot);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (is_copied) {
    frames_.push_back({slots, {slots->description().id, *slot, std::move(report)}});
  } else {
    slots->release(*slot);
  }
  return is_copied;
}

// --- any thread --------------------------------------------------------------------------------

void Window::Session::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_closing_ = true;
  to_send_.emplace_back(Close());
  wake();
}

bool Window::Session::await_end() {
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.wait_for(lock, kLongestClose, [&] { return has_ended_; });
}

void Window::Session::send(ToWindow message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (to_send_.size() >= kMaxToSend) return;
  to_send_.push_back(std::move(message));
  wake();
}

std::string Window::Session::take_picture(const std::string& path,
                                          std::chrono::milliseconds timeout) {
  std::error_code error;
  // The window's working folder is the one that was current when it was opened.
  const std::filesystem::path whole = std::filesystem::absolute(path, error);
  std::unique_lock<std::mutex> lock(mutex_);
  if (is_gone_) return kNotOpen;
  if (to_send_.size() >= kMaxToSend) return kSilent;
  const uint64_t number = ++pictures_asked_;
  to_send_.emplace_back(TakePicture{error ? path : whole.string()});
  wake();
  const auto is_taken = [&] { return pictures_taken_ >= number || is_gone_; };
  if (!changed_.wait_for(lock, timeout, is_taken)) return kSilent;
  return pictures_taken_ >= number ? picture_error_ : kNotOpen;
}

// --- the thread --------------------------------------------------------------------------------

void Window::Session::run() {
  watch();
  const std::lock_guard<std::mutex> lock(mutex_);
  has_ended_ = true;
  changed_.notify_all();
}

void Window::Session::watch() {
  Process process;
  const std::string error =
      wake_ < 0 ? std::string("no eventfd: ") + std::strerror(errno) : process.start();
  if (!error.empty()) return fail(error);
  bool is_understood = false, has_left = false;
  {
    Channel channel(process.socket(), Channel::kFromWindow);
    is_understood = serve(channel);
    has_left = channel.is_gone();
  }
  is_ready_ = false;
  // A window that has not closed its end by now is killed at once.
  std::string how = process.finish(has_left ? static_cast<int>(kCloseTimeout.count()) : 0);
  if (!is_understood) how = "is of another version than the plugin";
  finish(how);
}

/// Reports that the window was not even started.
void Window::Session::fail(const std::string& error) {
  has_failed_ = true;
  source_->warn("The debug window cannot be started: " + error + ".",
                "Is spidar-window installed, or named in SPIDAR_WINDOW?");
  finish("");
}

/// Serves the window until it closes its end, or its time for that is over. Returns false when the
/// window sends something other than messages. A window that does not read is not served, so that
/// the queue to it does not grow.
bool Window::Session::serve(Channel& channel) {
  std::optional<std::chrono::steady_clock::time_point> latest;
  while (is_compatible_ && !channel.is_gone()) {
    const short events = channel.has_unsent() ? POLLOUT : POLLIN;
    std::array<pollfd, 2> files{{{channel.socket(), events, 0}, {wake_, POLLIN, 0}}};
    const int wait_ms = latest ? 50 : -1;
    poll(files.data(), files.size(), wait_ms);
    eventfd_t ignored = 0;
    eventfd_read(wake_, &ignored);
    channel.flush();
    if (!channel.has_unsent()) pass_on(channel);
    if (!channel.has_unsent()) listen(channel);
    if (is_requested_ && !channel.has_unsent()) answer(channel);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_closing_ && !latest) latest = std::chrono::steady_clock::now() + kCloseTimeout;
    if (latest && std::chrono::steady_clock::now() > *latest) break;
  }
  return is_compatible_ && !channel.is_incompatible();
}

/// Sends the messages that do not wait for a request.
void Window::Session::pass_on(Channel& channel) {
  std::deque<ToWindow> messages;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages.swap(to_send_);
  }
  for (const ToWindow& message : messages) {
    // A picture shows everything sent before.
    if (std::holds_alternative<TakePicture>(message)) answer(channel);
    channel.send(to_bytes(message));
  }
}

void Window::Session::listen(Channel& channel) {
  channel.fill();
  while (const std::optional<std::vector<uint8_t>> packet = channel.next()) {
    std::optional<FromWindow> message = from_window(*packet);
    is_compatible_ = message.has_value();
    if (!is_compatible_) return;
    if (is_possible(*message)) handle(channel, std::move(*message));
  }
}

/// Sends the frames that have passed, and the state of the element.
void Window::Session::answer(Channel& channel) {
  is_requested_ = false;
  std::deque<Waiting> frames;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    frames.swap(frames_);
  }
  for (Waiting& waiting : frames) {
    const PictureMemory& memory = waiting.slots->description();
    if (memory.id != memory_at_window_) channel.send(to_bytes(memory), waiting.slots->file());
    memory_at_window_ = memory.id;
    channel.send(to_bytes(std::move(waiting.frame)));
  }
  ElementState state;
  source_->read(state);
  channel.send(to_bytes(std::move(state)));
}

void Window::Session::free_slot(const SlotFree& free) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!slots_ || slots_->description().id != free.memory) return;
  slots_->release(free.slot);
  is_full_ = false;
}

void Window::Session::handle(Channel& channel, FromWindow&& message) {
  if (std::holds_alternative<RequestFrames>(message)) {
    is_ready_ = is_requested_ = true;
  } else if (const auto* free = std::get_if<SlotFree>(&message)) {
    free_slot(*free);
  } else if (const auto* change = std::get_if<ChangeSetting>(&message)) {
    source_->set(change->name, change->value);
  } else if (const auto* preset = std::get_if<LoadPreset>(&message)) {
    source_->load_preset(preset->name);
  } else if (const auto* lead = std::get_if<LeadHand>(&message)) {
    source_->lead_hand(lead->to_m);
  } else if (const auto* choose = std::get_if<ChooseObject>(&message)) {
    source_->choose(choose->position);
  } else if (const auto* save = std::get_if<SaveChoices>(&message)) {
    channel.send(to_bytes(source_->save(save->film, save->edits)));
  } else if (const auto* play = std::get_if<PlayFilm>(&message)) {
    source_->play(play->plays);
  } else if (const auto* seek = std::get_if<SeekFilm>(&message)) {
    source_->seek(seek->to_ns);
  } else if (const auto* taken = std::get_if<PictureTaken>(&message)) {
    end_waiting(taken->error);
  } else if (const auto* failed = std::get_if<CannotOpen>(&message)) {
    if (!std::exchange(has_failed_, true)) source_->warn(failed->what, failed->advice);
  }
}

void Window::Session::end_waiting(const std::string& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (pictures_taken_ < pictures_asked_) ++pictures_taken_;
  picture_error_ = error;
  changed_.notify_all();
}

/// `how` describes how the window ended; empty if it ended normally.
void Window::Session::finish(const std::string& how) {
  source_->lead_hand(std::nullopt);
  bool was_wanted = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_gone_ = true;
    was_wanted = !is_closing_;
    slots_.reset();
    frames_.clear();
    changed_.notify_all();
  }
  if (!was_wanted) return;
  if (!how.empty() && !has_failed_) {
    source_->warn("The debug window " + how + ".",
                  "debug-window=true opens it again; a driver of OpenGL may be at fault.");
  }
  source_->closed();
}

// --- Window ------------------------------------------------------------------------------------

Window::Window(std::shared_ptr<Source> source)
    : session_(std::make_shared<Session>(std::move(source))) {
  try {
    thread_ = start_thread("spidar-window", [session = session_] { session->run(); });
  } catch (const std::system_error& error) {
    session_->fail(error.what());
  }
}

void Window::close() {
  session_->close();
  if (!thread_.joinable()) return;
  // When the user closes the window, its thread itself calls this.
  const bool is_own = thread_.get_id() == std::this_thread::get_id();
  if (!is_own && session_->await_end()) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

bool Window::wants_frame() const {
  return session_->wants_frame();
}

bool Window::queue_frame(const GstVideoFrame& frame, DrawnFrame report) {
  return session_->queue_frame(frame, std::move(report));
}

std::string Window::take_picture(const std::string& path, std::chrono::milliseconds timeout) {
  return session_->take_picture(path, timeout);
}

void Window::input(const UserInput& input) {
  session_->send(input);
}

}  // namespace spidar::window
