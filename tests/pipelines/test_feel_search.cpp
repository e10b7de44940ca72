// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Where spidar-feel lets the player search for the plugin.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::feel_search_test {
namespace {

namespace fs = std::filesystem;

/// A search path with an empty folder or an old plugin, and a registry of its own.
class FeelSearch : public testing::Test {
 protected:
  /// Prints GST_PLUGIN_PATH and GST_PLUGIN_PATH_1_0 as the player gets them. Between them and
  /// spidar-feel is another one, which would put the folder before them once more if it did not
  /// find the plugin as a player does.
  std::string paths(const std::string& environment) const {
    const CommandResult outcome = run(
        "unset GST_PLUGIN_PATH GST_PLUGIN_PATH_1_0; GST_REGISTRY=" + in("registry") +
        " GST_PLUGIN_SYSTEM_PATH_1_0= " + environment + " " SPIDAR_FEEL " device=none -- " +
        SPIDAR_FEEL " device=none -- sh -c 'echo $GST_PLUGIN_PATH, ${GST_PLUGIN_PATH_1_0-unset}'");
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    return outcome.text;
  }
  std::string in(const std::string& name) const { return (folder_.path / name).string(); }

  const std::string plugin_ = fs::path(SPIDAR_FEEL).parent_path().string();

 private:
  TemporaryFolder folder_;
};

TEST_F(FeelSearch, ThePluginIsFirstInThePathThatGStreamerUses) {
  EXPECT_EQ(paths(""), plugin_ + ", unset\n");
  EXPECT_EQ(paths("GST_PLUGIN_PATH=/other"), plugin_ + ":/other, unset\n");
  EXPECT_EQ(paths("GST_PLUGIN_PATH_1_0=/other"), ", " + plugin_ + ":/other\n");
  EXPECT_EQ(paths("GST_PLUGIN_PATH_1_0="), ", " + plugin_ + "\n");
  EXPECT_EQ(paths("GST_PLUGIN_PATH=/some GST_PLUGIN_PATH_1_0=/other"),
            "/some, " + plugin_ + ":/other\n");
  // GStreamer finds it without further help.
  EXPECT_EQ(paths("GST_PLUGIN_PATH=" + plugin_), plugin_ + ", unset\n");
}

TEST_F(FeelSearch, AnOldVersionOfThePluginIsNotUsed) {
  const std::string old = in("old");
  fs::create_directory(old);
  fs::copy_file(OLD_PLUGIN, old + "/libgstspidar.so");
  EXPECT_EQ(paths("GST_PLUGIN_PATH=" + old), plugin_ + ":" + old + ", unset\n");
  EXPECT_EQ(paths("GST_PLUGIN_PATH_1_0=" + old), ", " + plugin_ + ":" + old + "\n");
}

}  // namespace
}  // namespace spidar::test::feel_search_test
