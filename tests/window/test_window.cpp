// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Debug windows on an X server of the test; the frame buffer is read back.
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <unistd.h>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/window/fake_source.h"
#include "tests/window/window_fixture.h"

/// Mesa's drivers are unloaded before the sanitizer looks for leaks, so theirs cannot be told from
/// ours by their names; Mesa and LLVM keep some for good.
extern "C" int __lsan_is_turned_off();
extern "C" int __lsan_is_turned_off() {
  return 1;
}

namespace spidar::test::window_test {
namespace {

TEST_F(WindowTest, KeysChangeSettingsAndQClosesTheWindow) {
  ElementState state;
  state.settings = {{"mute", "", Setting::Kind::kSwitch, 0, 0, 1, {}},
                    {"max-force", "", Setting::Kind::kNumber, 2, 0, 20, {}},
                    {"arrow-scale", "", Setting::Kind::kNumber, 4, 0.1, 100, {}},
                    {"controller", "", Setting::Kind::kChoice, 1, 0, 0, {{0, "a"}, {1, "b"}}},
                    {"max-features", "", Setting::Kind::kWhole, 200, 1, 10000, {}},
                    {"ts-offset", "", Setting::Kind::kWhole, 0, -1e10, 1e10, {}}};
  auto source = std::make_shared<FakeSource>(state);
  Window window(source, std::make_shared<FrameFeed>());
  look(window);  // the keys act on what it has read
  for (const int key : {GLFW_KEY_SPACE, GLFW_KEY_UP, GLFW_KEY_DOWN, GLFW_KEY_RIGHT, GLFW_KEY_LEFT,
                        GLFW_KEY_H, GLFW_KEY_F12}) {
    window.press(key);
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
  look(window);  // with help
  window.press(GLFW_KEY_Q);
  source->wait_until_closed();
  EXPECT_FALSE(window.screenshot(kLong).has_value());
}

TEST_F(WindowTest, SSavesAPicture) {
  const std::filesystem::path before = std::filesystem::current_path();
  const TemporaryFolder folder;
  std::filesystem::current_path(folder.path);
  {
    Window window(std::make_shared<FakeSource>(), std::make_shared<FrameFeed>());
    window.press(GLFW_KEY_S);
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
  EXPECT_NE(write_png({1, 1, {1, 2, 3}}, "/nowhere/picture.png").find("No such file"),
            std::string::npos);
  EXPECT_NE(write_png({}, "/tmp/picture.png"), "");
}

TEST_F(WindowTest, CanBeMadeSmallAndLarge) {
  auto feed = std::make_shared<FrameFeed>();
  Window window(std::make_shared<FakeSource>(), feed);
  give(*feed, {});
  for (const auto& [width, height] : {std::pair{640, 480}, {200, 700}, {1, 1}, {1270, 790}}) {
    window.resize(width, height);
    Screenshot shot;
    do {  // the X server tells of the new size when it likes
      shot = look(window);
    } while ((shot.width != width || shot.height != height) && !HasFailure());
    if (width < 100) continue;
    const PictureMap map = map_of(shot);
    const Eigen::Vector2d middle = map({100, 100});
    EXPECT_TRUE(is_grey(at(shot, middle.x(), middle.y())));
  }
}

TEST_F(WindowTest, SeveralShareTheThread) {
  auto dark = std::make_shared<FrameFeed>(), light = std::make_shared<FrameFeed>();
  auto first = std::make_unique<Window>(std::make_shared<FakeSource>(), dark);
  Window second(std::make_shared<FakeSource>(), light);
  give(*dark, {}, 60);
  give(*light, {}, 160);
  const auto level = [&](Window& window) {
    const Screenshot shot = look(window);
    const Eigen::Vector2d middle = map_of(shot)({100, 100});
    return at(shot, middle.x(), middle.y()).g;
  };
  EXPECT_NEAR(level(*first), 60, 1);
  EXPECT_NEAR(level(second), 160, 1);
  first.reset();
  give(*light, {}, 100);
  EXPECT_NEAR(level(second), 100, 1) << "goes on when the other one is closed";
}

TEST_F(WindowTest, MayBeOpenedAndClosedAtOnce) {
  for (int n = 0; n < 5; ++n) {
    const Window window(std::make_shared<FakeSource>(), std::make_shared<FrameFeed>());
  }
}

/// In a process of its own, where no window was before: GLFW keeps its display.
void open_without_a_display() {
  const std::string name = getenv("DISPLAY");
  unsetenv("DISPLAY");
  auto source = std::make_shared<FakeSource>();
  {
    Window window(source, std::make_shared<FrameFeed>());
    std::fprintf(stderr, "%s", source->wait_for_warning()[0].c_str());
    if (window.screenshot(kLong)) _exit(1);
  }
  setenv("DISPLAY", name.c_str(), 1);
  Window next(std::make_shared<FakeSource>(), std::make_shared<FrameFeed>());
  _exit(next.screenshot(kLong) ? 0 : 2);
}

TEST_F(WindowTest, WithoutADisplayIsAWarningAndTheNextOneIsNotConcerned) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(open_without_a_display(), testing::ExitedWithCode(0), "DISPLAY");
}

/// In a process of its own, for Mesa asks once.
void open_without_opengl_33() {
  setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1);
  auto source = std::make_shared<FakeSource>();
  {
    const Window window(source, std::make_shared<FrameFeed>());
    std::fprintf(stderr, "%s", source->wait_for_warning()[0].c_str());
  }
  std::_Exit(0);
}

using WindowDeathTest = WindowTest;
TEST_F(WindowDeathTest, WithoutOpenGl33IsAWarning) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(open_without_opengl_33(), testing::ExitedWithCode(0),
              "cannot be opened with OpenGL 3.3: ");
}

}  // namespace
}  // namespace spidar::test::window_test
