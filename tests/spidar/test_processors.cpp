// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// As many films at a time as a control group has time for.
#include "spidar/realtime/processors.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::processors_test {
namespace {

class Processors : public testing::Test {
 protected:
  void write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = root.path / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text << '\n';
  }
  unsigned usable() const { return usable_processors(root.path); }

  const TemporaryFolder root;
  const unsigned all = usable_processors(root.path);  // no file says anything else
};

TEST_F(Processors, ThoseOfAGroupCountAndOfTheGroupsAroundIt) {
  EXPECT_GE(all, 1u);
  write("proc/self/cgroup", "0::/user/jobs/mine");
  EXPECT_EQ(usable(), all) << "no quota";
  write("sys/fs/cgroup/user/jobs/mine/cpu.max", "max 100000");
  EXPECT_EQ(usable(), all);
  write("sys/fs/cgroup/user/jobs/mine/cpu.max", "50000 100000");
  EXPECT_EQ(usable(), 1u);
  write("sys/fs/cgroup/user/jobs/mine/cpu.max", "max 100000");
  write("sys/fs/cgroup/user/cpu.max", "199999 100000");
  EXPECT_EQ(usable(), 1u) << "not two whole ones";
  write("sys/fs/cgroup/user/cpu.max", "200000 100000");
  EXPECT_EQ(usable(), std::min(all, 2u));
}

TEST_F(Processors, InAContainerItsOwnGroupIsMountedWhateverItsPath) {
  write("proc/self/cgroup", "11:memory:/docker/17\n4:cpu,cpuacct:/docker/17\n0::/docker/17");
  write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1");
  write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000");
  EXPECT_EQ(usable(), all);
  write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "150000");
  EXPECT_EQ(usable(), 1u);
}

TEST_F(Processors, WhatIsNoGroupIsNone) {
  for (const char* text : {"", "nonsense", "0::", "0::relative", ":::::", "4:cpu"}) {
    write("proc/self/cgroup", text);
    write("sys/fs/cgroup/cpu.max", "x y");
    EXPECT_EQ(usable(), all) << text;
  }
}

}  // namespace
}  // namespace spidar::test::processors_test
