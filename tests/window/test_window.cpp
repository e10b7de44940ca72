// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Debug windows on an X server of the test: opened, used, closed, and everything that can go wrong.
#include <cerrno>
#include <csignal>
#include <mutex>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <GLFW/glfw3.h>

#include "plugin/window/view/channel.h"
#include "spidar/profiles/profile.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/window/fake_source.h"
#include "tests/window/window_fixture.h"

namespace spidar::test::window_test {
namespace {

TEST_F(WindowTest, KeysChangeSettingsAndQClosesTheWindow) {
  window::ElementState state;
  state.settings = {
      {"mute", "", window::Setting::Kind::kSwitch, 0, 0, 1, {}},
      {"max-force", "", window::Setting::Kind::kNumber, 2, 0, 20, {}},
      {"arrow-scale", "", window::Setting::Kind::kNumber, 4, 0.1, 100, {}},
      {"controller", "", window::Setting::Kind::kChoice, 1, 0, 0, {{0, "a"}, {1, "b"}}},
      {"budget", "", window::Setting::Kind::kWhole, 0, 0, 1000000, {}},
      {"ts-offset", "", window::Setting::Kind::kWhole, 0, -1e10, 1e10, {}}};
  auto source = std::make_shared<FakeSource>(state);
  window::Window window(source);
  look(window);  // the keys act on what it has read
  for (const int key :
       {GLFW_KEY_SPACE, GLFW_KEY_UP, GLFW_KEY_DOWN, GLFW_KEY_RIGHT, GLFW_KEY_LEFT, GLFW_KEY_F12}) {
    press(window, key);
  }
  const FakeSource::Sets sets = source->wait_for_sets(5);
  const FakeSource::Sets expected{{"mute", 1},
                                  {"max-force", 2.1},
                                  {"max-force", 1.9},
                                  {"arrow-scale", 5},
                                  {"arrow-scale", 3.2}};
  ASSERT_EQ(sets.size(), expected.size());
  for (size_t i = 0; i < sets.size(); ++i) {
    EXPECT_EQ(sets[i].first, expected[i].first);
    EXPECT_NEAR(sets[i].second, expected[i].second, 1e-9);
  }
  press(window, GLFW_KEY_Q);
  source->wait_until_closed();
  EXPECT_NE(window.take_picture("/dev/null", kLong), "");
  EXPECT_TRUE(source->warnings().empty());
}

/// A window manager may choose any size, and a film may be as narrow as one line of the window.
TEST_F(WindowTest, AnySizeIsDrawn) {
  window::ElementState state;
  DeviceView& device = state.device.emplace();
  device.name = "sim";
  device.geometry = load_profile("spidar-g").geometry;
  device.last.device = DeviceState::kRunning;
  device.last.delivered.force_N = {1, 1, 0};
  const auto source = std::make_shared<FakeSource>(state);
  window::Window window(source);
  DrawnFrame report;
  report.controller.max_force_N = 3;
  report.frame.wrench.force_N = {1, 1, 0};
  give(window, report);
  constexpr std::array<double, 8> kSides{1, 2, 10, 47, 99, 100, 130, 700};
  for (const double width : kSides) {
    for (const double height : kSides) {
      SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
      window::UserInput input;
      input.size_px = Eigen::Vector2d(width, height);
      window.input(input);
      ASSERT_EQ(window.take_picture("/dev/null", kLong), "");
      ASSERT_TRUE(source->warnings().empty());
    }
  }
}

TEST_F(WindowTest, SSavesAPicture) {
  const std::filesystem::path before = std::filesystem::current_path();
  const TemporaryFolder folder;
  std::filesystem::current_path(folder.path);
  {
    window::Window window(std::make_shared<FakeSource>());
    press(window, GLFW_KEY_S);
    look(window);
    look(window);
  }
  std::filesystem::current_path(before);
  int pictures = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path)) {
    EXPECT_EQ(file.path().extension(), ".png");
    EXPECT_GT(file.file_size(), 1000u);
    ++pictures;
  }
  EXPECT_EQ(pictures, 1);
}

TEST_F(WindowTest, APictureThatCannotBeWrittenSaysWhy) {
  window::Window window(std::make_shared<FakeSource>());
  EXPECT_NE(window.take_picture("/nowhere/picture.png", kLong).find("No such file"),
            std::string::npos);
}

TEST_F(WindowTest, FramesOfAnotherSizeFollow) {
  window::Window window(std::make_shared<FakeSource>());
  give(window, {}, 60);
  EXPECT_NEAR(level_in(window), 60, 1);
  GstVideoInfo info;
  gst_video_info_set_format(&info, GST_VIDEO_FORMAT_GRAY8, 64, 48);
  GstBuffer* const buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
  gst_buffer_memset(buffer, 0, 160, GST_VIDEO_INFO_SIZE(&info));
  GstVideoFrame frame;
  ASSERT_TRUE(gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ));
  DrawnFrame report;
  report.visible = visible_part(frame);
  while (!window.queue_frame(frame, report))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  gst_video_frame_unmap(&frame);
  gst_buffer_unref(buffer);
  EXPECT_NEAR(level_in(window), 160, 1);
}

/// The processes that this one has started and not waited for.
int children() {
  int count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "children");
    for (pid_t process; file >> process;) ++count;
  }
  return count;
}

/// A window may have left its process to a thread that still waits for its end.
void wait_until_no_more_children_than(int before) {
  while (children() > before) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(WindowTest, MayBeOpenedAndClosedAtOnceAndLeavesNothing) {
  const int before = children();
  for (int n = 0; n < 5; ++n) const window::Window window(std::make_shared<FakeSource>());
  wait_until_no_more_children_than(before);
}

/// A program in place of the window.
class OtherProgram {
 public:
  explicit OtherProgram(const std::string& script) {
    const std::string path = folder_.path / "window";
    std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    name(path);
  }
  ~OtherProgram() { name(before_); }
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;

 private:
  static void name(const std::string& path) { setenv("SPIDAR_WINDOW", path.c_str(), 1); }

  const TemporaryFolder folder_;
  const std::string before_ = getenv("SPIDAR_WINDOW");
};

TEST_F(WindowTest, OneThatCannotBeStartedOrCrashesIsOneWarning) {
  for (const auto& [script, said] : {std::pair{"kill -SEGV $$", "signal 11"},
                                     {"exit 3", "status 3"},
                                     {"printf 'I am no window at all' >&0", "another version"}}) {
    SCOPED_TRACE(script);
    const OtherProgram other(script);
    auto source = std::make_shared<FakeSource>();
    const window::Window window(source);
    source->wait_until_closed();
    ASSERT_EQ(source->warnings().size(), 1u);
    EXPECT_NE(source->warnings()[0].find(said), std::string::npos) << source->warnings()[0];
  }
  const OtherProgram none("");
  setenv("SPIDAR_WINDOW", "/nowhere/spidar-window", 1);
  auto source = std::make_shared<FakeSource>();
  const window::Window window(source);
  source->wait_until_closed();
  ASSERT_EQ(source->warnings().size(), 1u);
  EXPECT_NE(source->warnings()[0].find("No such file"), std::string::npos);
}

TEST_F(WindowTest, OneThatDoesNotAnswerIsKilledWhenItIsToClose) {
  const int before = children();
  {
    const OtherProgram deaf("exec sleep 1000");
    const window::Window window(std::make_shared<FakeSource>());
    EXPECT_FALSE(window.wants_frame());
  }
  wait_until_no_more_children_than(before);
}

/// What a window sends for these messages.
std::string sent(const std::vector<window::FromWindow>& messages) {
  std::array<int, 2> ends{};
  EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
  window::Channel channel(ends[0], window::Channel::kFromPlayer);
  for (const window::FromWindow& message : messages) channel.send(window::to_bytes(message));
  std::string bytes(1 << 20, '\0');
  bytes.resize(static_cast<size_t>(read(ends[1], bytes.data(), bytes.size())));
  ::close(ends[1]);
  return bytes;
}

/// A window that sends these messages, and then neither reads nor ends.
class LyingWindow {
 public:
  explicit LyingWindow(const std::vector<window::FromWindow>& messages) {
    std::ofstream(folder_.path / "messages", std::ios::binary) << sent(messages);
  }
  void await_sent() const {
    while (!std::filesystem::exists(folder_.path / "sent")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  const TemporaryFolder folder_;
  const OtherProgram program_{"cat " + (folder_.path / "messages").string() + " >&0; touch " +
                              (folder_.path / "sent").string() + "; exec sleep 1000"};
};

TEST_F(WindowTest, OneThatAsksAndDoesNotReadIsNotAnswered) {
  // The first answer is larger than the socket; each further one would wait in the memory.
  window::ElementState state;
  state.no_force = std::string(1'000'000, 'x');
  const auto source = std::make_shared<FakeSource>(state);
  const LyingWindow lying(std::vector<window::FromWindow>(500, window::RequestFrames()));
  {
    const window::Window window(source);
    lying.await_sent();
  }
  EXPECT_LE(source->reads(), 1);
}

TEST_F(WindowTest, OneThatSaysManyThingsIsWarnedOfOnce) {
  const auto source = std::make_shared<FakeSource>();
  const LyingWindow lying(std::vector<window::FromWindow>(
      500, window::CannotOpen{"it cannot be opened", "nothing helps"}));
  {
    const window::Window window(source);
    lying.await_sent();
  }
  EXPECT_LE(source->warnings().size(), 1u);
}

/// The player's own code, in which the thread of the window is, may wait for a lock of whoever
/// closes the window: a change of the state, an application.
TEST_F(WindowTest, IsClosedByWhomItWaitsFor) {
  struct Waiting final : FakeSource {
    void seek(int64_t to_ns) override {
      FakeSource::seek(to_ns);
      const std::lock_guard<std::mutex> lock(of_closer);
    }
    std::mutex of_closer;
  };
  const int before = children();
  const auto source = std::make_shared<Waiting>();
  const LyingWindow lying({window::SeekFilm{5}});
  std::unique_lock<std::mutex> lock(source->of_closer);
  {
    const window::Window window(source);
    source->wait_for_seeks(1);
  }
  lock.unlock();
  wait_until_no_more_children_than(before);
}

TEST_F(WindowTest, WithoutOpenGl33IsAWarning) {
  setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1);
  auto source = std::make_shared<FakeSource>();
  const window::Window window(source);
  source->wait_until_closed();
  unsetenv("MESA_GL_VERSION_OVERRIDE");
  ASSERT_EQ(source->warnings().size(), 1u);
  EXPECT_NE(source->warnings()[0].find("cannot be opened with OpenGL 3.3: "), std::string::npos);
}

/// The group of the players' terminal and the end of the player.
TEST_F(WindowTest, EndsWithItsPlayer) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t player = fork();
  if (player == 0) {
    // The window inherits the end of the pipe, and so it is closed when the window has ended.
    ::close(ends[0]);
    auto* const window = new window::Window(std::make_shared<FakeSource>());
    const bool is_open = window->take_picture("/dev/null", kLong).empty();
    _exit(is_open ? 0 : 1);
  }
  ::close(ends[1]);
  int status = 0;
  ASSERT_EQ(waitpid(player, &status, 0), player);
  EXPECT_EQ(status, 0) << "it was open";
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 0) << "the window has ended";
  ::close(ends[0]);
}

}  // namespace
}  // namespace spidar::test::window_test
