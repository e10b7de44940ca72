// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cerrno>
#include <clocale>

#include "spidar/loop/tick_trace.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::tick_trace_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) result.push_back(field);
  return result;
}

std::vector<std::string> lines(const fs::path& path) {
  std::vector<std::string> result;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

TickRecord some_record() {
  TickRecord r;
  r.tick = 12;
  r.monotonic_ns = 9'000'000'000'000'001;
  r.lateness_ns = -3;
  r.running_ns = 40'000'000;
  r.frame_ns = 33'366'666;
  r.found = Found::kInterpolated;
  r.playing = true;
  r.device = DeviceState::kRunning;
  r.acknowledged = false;
  r.brakes = true;
  r.wanted = {{0.1, 0.2, 0.3}, {1e-7, 0, -0.5}};
  r.commanded = {{1, 2, 3}, {4, 5, 6}};
  r.delivered = {{7, 8, 9}, {10, 11, 12}};
  for (int i = 0; i < kMaxStrings; ++i) r.tension_N[i] = i + 0.5;
  r.pose = {{0.01, 0.02, 0.03}, Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5)};
  r.pose_residual_m = 5.9e-06;
  r.faulty_string = 3;
  r.max_force_N = 2.5;
  r.max_torque_Nm = 0.1;
  r.contact.depth_m = 0.004;
  r.contact.force_N = {-0.5, 0.25, 2};
  return r;
}

TEST(TickTrace, HeaderAndRow) {
  EXPECT_EQ(trace_header(),
            "tick,monotonic_ns,lateness_ns,running_ns,frame_ns,found,playing,device,"
            "acknowledged,brakes,"
            "wanted_force_x_N,wanted_force_y_N,wanted_force_z_N,"
            "wanted_torque_x_Nm,wanted_torque_y_Nm,wanted_torque_z_Nm,"
            "commanded_force_x_N,commanded_force_y_N,commanded_force_z_N,"
            "commanded_torque_x_Nm,commanded_torque_y_Nm,commanded_torque_z_Nm,"
            "delivered_force_x_N,delivered_force_y_N,delivered_force_z_N,"
            "delivered_torque_x_Nm,delivered_torque_y_Nm,delivered_torque_z_Nm,"
            "tension_0_N,tension_1_N,tension_2_N,tension_3_N,"
            "tension_4_N,tension_5_N,tension_6_N,tension_7_N,"
            "position_x_m,position_y_m,position_z_m,"
            "orientation_w,orientation_x,orientation_y,orientation_z,pose_residual_m,faulty_string,"
            "max_force_N,max_torque_Nm,contact_depth_m,"
            "contact_force_x_N,contact_force_y_N,contact_force_z_N");
  std::string row;
  append_row(some_record(), row);
  EXPECT_EQ(row,
            "12,9000000000000001,-3,40000000,33366666,interpolated,1,running,0,1,"
            "0.1,0.2,0.3,1e-07,0,-0.5,1,2,3,4,5,6,7,8,9,10,11,12,"
            "0.5,1.5,2.5,3.5,4.5,5.5,6.5,7.5,0.01,0.02,0.03,0.5,-0.5,0.5,-0.5,5.9e-06,3,2.5,0.1,"
            "0.004,-0.5,0.25,2\n");
  EXPECT_EQ(fields(row).size(), fields(trace_header()).size());
  row.clear();
  append_row({}, row);
  EXPECT_EQ(fields(row)[4], "-1");
  EXPECT_EQ(fields(row)[5], "nothing");
}

TEST(TickTrace, WritesOnFlushAndAtTheEnd) {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "haptic.csv";
  TickRecord record = some_record();
  {
    TickTrace trace(path);
    record.tick = 1;
    trace.add(record);
    trace.flush();
    EXPECT_EQ(lines(path).size(), 2u);
    EXPECT_EQ(trace.status().lines, 1u);
    record.tick = 5;  // 2, 3 and 4 did not fit into the ring
    trace.add(record);
    EXPECT_EQ(trace.status().dropped, 3u);
  }
  const std::vector<std::string> written = lines(path);
  ASSERT_EQ(written.size(), 3u);
  EXPECT_EQ(written[0], trace_header());
  EXPECT_EQ(fields(written[2])[0], "5");
}

TEST(TickTrace, UnwritablePathIsNamedWithTheReason) {
  const TemporaryFolder folder;
  const auto message = [](const fs::path& path) {
    return message_of<std::runtime_error>([&] { TickTrace trace(path); });
  };
  const fs::path missing = folder.path / "missing" / "haptic.csv";
  expect_contains(message(missing), missing.string());
  expect_contains(message(missing), "No such file or directory");
  expect_contains(message(folder.path), "Is a directory");
  const fs::path shared = folder.path / "shared.csv";
  {
    const TickTrace first(shared);
    expect_contains(message(shared), "each needs its own file");
  }
  EXPECT_EQ(message(shared), "");  // the first one has closed it
}

TEST(TickTrace, AFileBehindALinkIsNotOverwritten) {
  const TemporaryFolder folder;
  const fs::path kept = folder.path / "kept";
  std::ofstream(kept) << "as it was\n";
  fs::create_symlink(kept, folder.path / "haptic.csv");
  EXPECT_THROW(TickTrace trace(folder.path / "haptic.csv"), std::runtime_error);
  EXPECT_EQ(lines(kept), std::vector<std::string>{"as it was"});
  // What is behind it can be no file.
  fs::create_symlink("/dev/null", folder.path / "null.csv");
  EXPECT_NO_THROW(TickTrace trace(folder.path / "null.csv"));
}

}  // namespace
}  // namespace spidar::test::tick_trace_test
