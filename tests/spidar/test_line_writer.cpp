// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "spidar/realtime/line_writer.h"
#include "spidar/realtime/standard_descriptors.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::line_writer_test {
namespace {

namespace fs = std::filesystem;

const std::string kLine = std::string(99, 'x') + "\n";

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

uint64_t lines_in(const std::string& text) {
  return static_cast<uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

/// All that comes out of the pipe until nobody writes into it.
std::string read_all(int pipe) {
  std::string text;
  char part[4096];
  for (ssize_t n = 1; n > 0;) {
    n = read(pipe, part, sizeof part);
    if (n > 0) text.append(part, static_cast<size_t>(n));
  }
  return text;
}

class LineWriterPipe : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(mkfifo(path.c_str(), 0600), 0); }

  const TemporaryFolder folder;
  const std::string path = folder.path / "pipe";
  LineWriter writer;
};

TEST_F(LineWriterPipe, WithoutAReaderIsRefusedAtOnce) {
  expect_contains(writer.open(path, kLine), "a pipe that nobody reads");
  EXPECT_FALSE(writer.is_open());
  EXPECT_EQ(open_output(path.c_str(), 0), -1) << "would wait for ever";
}

TEST_F(LineWriterPipe, WhatAReaderThatStandsStillDoesNotTakeIsDroppedAndCounted) {
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_EQ(writer.open(path, kLine), "");
  // Twice what may wait, and what a pipe holds is little beside it. It takes no longer than the
  // standstill: with a wait for each line this would take hours.
  const uint64_t lines = 2 * LineWriter::kMaxWaiting_bytes / kLine.size();
  for (uint64_t i = 0; i < lines; ++i) writer.add(kLine);
  const LineWriter::Status status = writer.close();
  EXPECT_EQ(status.error, 0);
  EXPECT_GT(status.dropped, lines / 2);
  EXPECT_EQ(status.lines + status.dropped, lines);
  const std::string text = read_all(reader);
  EXPECT_EQ(lines_in(text), status.lines);
  EXPECT_EQ(text.size(), status.lines * kLine.size()) << "whole lines";
  close(reader);
}

/// A line that is added when the one before has come would wait for the whole period of a file.
TEST_F(LineWriterPipe, ALineComesAtOnce) {
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_EQ(writer.open(path, kLine), "");
  fcntl(reader, F_SETFL, 0);
  auto least = std::chrono::steady_clock::duration::max();
  // How late a busy machine is at worst says nothing.
  for (int i = 0; i < 200 && least > LineWriter::kPeriod / 4; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    writer.add(kLine);
    std::string line(kLine.size(), 0);
    ASSERT_EQ(read(reader, line.data(), line.size()), static_cast<ssize_t>(line.size()));
    least = std::min(least, std::chrono::steady_clock::now() - begin);
  }
  EXPECT_LE(least, LineWriter::kPeriod / 4);
  close(reader);
}

TEST_F(LineWriterPipe, ASlowReaderGetsEveryLine) {
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_EQ(writer.open(path, kLine), "");
  fcntl(reader, F_SETFL, 0);
  std::string text;
  std::thread reading([&] {
    std::this_thread::sleep_for(LineWriter::kPeriod);
    text = read_all(reader);
  });
  const uint64_t lines = 2 * LineWriter::kMaxWaiting_bytes / kLine.size();
  for (uint64_t i = 0; i < lines; ++i) writer.add(kLine);
  const LineWriter::Status status = writer.close();
  reading.join();
  EXPECT_EQ(status.dropped, 0u);
  EXPECT_EQ(lines_in(text), lines);
  close(reader);
}

TEST(LineWriter, AKilledProcessLeavesWholeLines) {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "lines.csv";
  const pid_t child = fork();
  if (child == 0) {
    LineWriter writer;
    if (!writer.open(path, kLine).empty()) _exit(1);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // also when this test is ended
    while (true) {
      writer.add(kLine);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  while (!fs::exists(path) || fs::file_size(path) < kLine.size())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGTERM);
  waitpid(child, nullptr, 0);
  const std::string text = content(path);
  EXPECT_EQ(text.back(), '\n');
}

/// Runs `write` in a process whose standard output is `file`.
template <typename Write>
void with_output_into(const fs::path& file, Write write) {
  const pid_t child = fork();
  if (child == 0) {
    const int output = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    dup2(output, STDOUT_FILENO);
    _exit(write() ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(LineWriter, TheStandardOutputIsContinuedWhereItIs) {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "output";
  for (const char* name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    SCOPED_TRACE(name);
    fs::remove(path);
    with_output_into(path, [name] {
      bool good = write(STDOUT_FILENO, "printed\n", 8) == 8;
      LineWriter writer;
      good = good && writer.open(name, kLine).empty();
      writer.add("a line\n");
      good = good && writer.close().lines == 1;
      return good && write(STDOUT_FILENO, "printed\n", 8) == 8;
    });
    EXPECT_EQ(content(path), "printed\na line\nprinted\n");
  }
}

TEST(LineWriter, OnlyAFileThatBeginsInTheSameWayIsReplaced) {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "trace.csv";
  const auto reason_with = [&](const std::string& text) {
    std::ofstream(path) << text;
    LineWriter writer;
    const std::string reason = writer.open(path, "tick,");
    EXPECT_EQ(content(path), reason.empty() ? "" : text);
    return reason;
  };
  for (const char* text : {"", "tick,", "tick,of an older version\n1,2\n"})
    EXPECT_EQ(reason_with(text), "") << text;
  for (const char* text : {"the only copy of a film", "t", "tock,1\n"}) {
    EXPECT_EQ(reason_with(text),
              "there is a file with something else in it, which is not replaced; name another file")
        << text;
  }
}

}  // namespace
}  // namespace spidar::test::line_writer_test
