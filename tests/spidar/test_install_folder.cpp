// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/folders.h"
#include "tests/support/test.h"

namespace spidar::test::install_folder_test {
namespace {

namespace fs = std::filesystem;

const fs::path kMoved = "/home/user/moved";

TEST(InstallFolder, ThePrefixFollowsFromWhereAFileLies) {
  const fs::path libraries = kMoved / SPIDAR_LIBDIR;
  EXPECT_EQ(prefix_of(libraries / "gstreamer-1.0" / "libgstspidar.so"), kMoved);
  EXPECT_EQ(prefix_of(libraries / "libgst-spidar.so.0"), kMoved);
  EXPECT_EQ(prefix_of(kMoved / SPIDAR_BINDIR / "spidarctl"), kMoved);
  EXPECT_EQ(prefix_of(fs::path("/") / SPIDAR_LIBDIR / "libgst-spidar.so.0"), "/");
}

// A program from a folder that belongs to somebody else must not be run as the guardian.
TEST(InstallFolder, AFileThatLiesAnywhereElseSaysNothing) {
  EXPECT_TRUE(prefix_of("/tmp/build/plugin/libgstspidar.so").empty());
  EXPECT_TRUE(prefix_of(kMoved / SPIDAR_LIBDIR / "deeper" / "libgst-spidar.so.0").empty());
  EXPECT_TRUE(prefix_of("/libgst-spidar.so.0").empty());
  EXPECT_TRUE(prefix_of("").empty());
}

TEST(InstallFolder, OfABuildFolderThePrefixIsWhereItWouldBeInstalled) {
  EXPECT_EQ(installed("share/thing"), fs::path(SPIDAR_PREFIX) / "share/thing");
  EXPECT_EQ(installed("/opt/thing"), "/opt/thing");
}

}  // namespace
}  // namespace spidar::test::install_folder_test
