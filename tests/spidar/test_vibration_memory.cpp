// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The vibration that a hand has received limits the force of the next program too.
#include <csignal>
#include <fcntl.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "spidar/folders.h"
#include "spidar/limits/vibration_memory.h"
#include "spidar/realtime/monotonic.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::vibration_memory_test {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kSecond = 1'000'000'000, kHour = 3600 * kSecond;
/// Until an empty store is full.
constexpr int64_t kEmpty_ns = 2 * VibrationMemory::kUnknown_ns;

/// Since 1970, as a computer that is switched on has it.
constexpr int64_t kToday_ns = 1'800'000'000 * kSecond;
Moment at(int64_t since_boot_ns, const std::string& boot = "one", int64_t utc_ns = kToday_ns) {
  return {since_boot_ns, boot, utc_ns};
}

class VibrationMemories : public testing::Test {
 protected:
  TemporaryFolder folder;
  const std::string file = (folder.path / "state/gst-spidar/vibration").string();

  void write(const std::string& text) const {
    fs::create_directories(fs::path(file).parent_path());
    std::ofstream(file, std::ios::trunc) << text;
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  }
};

TEST(PassedTime, CannotBeSet) {
  EXPECT_EQ(passed_ns(at(5 * kHour), at(7 * kHour)), 2 * kHour);
  EXPECT_EQ(passed_ns(at(5 * kHour), at(7 * kHour, "one", 2 * kToday_ns)), 2 * kHour);
  EXPECT_EQ(passed_ns(at(5 * kHour), at(7 * kHour, "one", 0)), 2 * kHour);
  EXPECT_EQ(passed_ns(at(7 * kHour), at(5 * kHour)), 0) << "a snapshot of a virtual machine";
  // After a start of the computer, whatever its clock says, it has run for so long.
  EXPECT_EQ(passed_ns(at(5 * kHour), at(kHour, "two", 0)), kHour);
  EXPECT_EQ(passed_ns(at(5 * kHour), at(kHour, "two", kToday_ns - kHour)), kHour);
  EXPECT_EQ(passed_ns(at(5 * kHour), at(kHour, "two", kToday_ns + 3 * kHour)), 3 * kHour);
}

TEST_F(VibrationMemories, TheNextProgramBeginsWithWhatIsLeft) {
  VibrationMemory first(file);
  EXPECT_EQ(first.add(0, at(kHour)), 0);
  EXPECT_EQ(first.add(6 * kHour, at(kHour)), 6 * kHour);
  EXPECT_EQ(first.add(kHour, at(2 * kHour)), 6 * kHour);
  VibrationMemory second(file);
  EXPECT_EQ(second.add(0, at(3 * kHour)), 5 * kHour);
  EXPECT_EQ(second.add(0, at(20 * kHour)), 0);
  EXPECT_EQ(second.error() + first.error(), "");
  struct stat status {};
  ASSERT_EQ(stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
}

TEST_F(VibrationMemories, ProgramsThatRunTogetherAddUp) {
  VibrationMemory one(file), other(file);
  EXPECT_EQ(one.add(kHour, at(kHour)), kHour);
  EXPECT_EQ(other.add(2 * kHour, at(kHour)), 3 * kHour);
  EXPECT_EQ(one.add(0, at(kHour)), 3 * kHour);
  // Nothing is lost between them.
  constexpr int kThreads = 4, kTimes = 200;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([this] {
      VibrationMemory memory(file);
      for (int n = 0; n < kTimes; ++n) memory.add(kSecond, at(kHour));
      EXPECT_EQ(memory.error(), "");
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(one.add(0, at(kHour)), 3 * kHour + kThreads * kTimes * kSecond);
}

TEST_F(VibrationMemories, WithoutAUsableFileHalfCountsAsUsed) {
  struct Case {
    std::string text, says;
  };
  VibrationMemory whole(file);
  whole.add(kHour, at(kHour));
  std::string good;
  std::getline(std::ifstream(file), good, '\0');
  std::string negative = good, huge = good, cut = good.substr(0, good.size() - 5);
  const size_t digits = good.find("00000");
  negative[digits] = '-';
  huge[digits] = '9';
  for (const std::string& text : {std::string("hello"), std::string("\0\0\0", 3), negative, huge,
                                  cut, good + good, std::string(100'000, 'x')}) {
    write(text);
    VibrationMemory memory(file);
    EXPECT_EQ(memory.add(0, at(kHour)), kEmpty_ns / 2) << text.substr(0, 300);
    expect_contains(memory.error(), file);
    expect_contains(memory.error(), "not what this program writes");
    // It is written anew, and all that counts is in it.
    EXPECT_EQ(memory.add(kHour, at(kHour)), kEmpty_ns / 2 + kHour);
    VibrationMemory next(file);
    EXPECT_EQ(next.add(0, at(kHour)), kEmpty_ns / 2 + kHour);
    EXPECT_EQ(next.error(), "");
  }
}

TEST_F(VibrationMemories, AFileThatCannotBeOpenedIsSaid) {
  fs::create_directories(file);  // a folder
  VibrationMemory folder_there(file);
  EXPECT_EQ(folder_there.add(0, at(kHour)), kEmpty_ns / 2);
  expect_contains(folder_there.error(), "Is a directory");
  // Half once, and then what is known.
  EXPECT_EQ(folder_there.add(kHour, at(2 * kHour)), kEmpty_ns / 2);
  fs::remove(file);
  fs::create_symlink(folder.path / "elsewhere", file);
  VibrationMemory link(file);
  EXPECT_EQ(link.add(0, at(kHour)), kEmpty_ns / 2);
  EXPECT_FALSE(fs::exists(folder.path / "elsewhere"));
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  VibrationMemory pipe(file);
  EXPECT_EQ(pipe.add(0, at(kHour)), kEmpty_ns / 2);
  VibrationMemory nowhere("/proc/none/vibration");
  EXPECT_EQ(nowhere.add(0, at(kHour)), kEmpty_ns / 2);
  EXPECT_NE(nowhere.error(), "");
}

TEST_F(VibrationMemories, AUserWithoutAHomeHasHalf) {
  VibrationMemory memory("", "this user has no home");
  EXPECT_EQ(memory.add(0, at(kHour)), kEmpty_ns / 2);
  EXPECT_EQ(memory.add(kHour, at(kHour)), kEmpty_ns / 2 + kHour);
  EXPECT_EQ(memory.error(),
            "The file, which keeps how much a hand was shaken within a day, cannot be used: this "
            "user has no home. Half of what is allowed in a day counts as used.");
  VibrationMemory wanted("");
  EXPECT_EQ(wanted.add(0, at(kHour)), 0);
  EXPECT_EQ(wanted.error(), "");
}

TEST_F(VibrationMemories, AHomeThatMayNotBeWrittenIsNamedAsThat) {
  const uid_t user = geteuid();
  fs::permissions(folder.path, fs::perms::owner_write, fs::perm_options::remove);
  if (user == 0) {
    ASSERT_EQ(seteuid(65534), 0);
  }
  VibrationMemory memory(file);
  memory.add(0, at(kHour));
  ASSERT_EQ(seteuid(user), 0);
  fs::permissions(folder.path, fs::perms::owner_write, fs::perm_options::add);
  expect_contains(memory.error(), "Permission denied");
}

TEST(UserFolder, IsNeverBelowTheCurrentOne) {
  const char* const before = std::getenv("HOME");
  const std::string home = before ? before : "";
  setenv("HOME", "/home/somebody", 1);
  unsetenv("SPIDAR_TEST_HOME");
  EXPECT_EQ(user_folder("SPIDAR_TEST_HOME", ".local"), "/home/somebody/.local");
  setenv("SPIDAR_TEST_HOME", "/elsewhere", 1);
  EXPECT_EQ(user_folder("SPIDAR_TEST_HOME", ".local"), "/elsewhere");
  setenv("SPIDAR_TEST_HOME", "relative", 1);
  EXPECT_EQ(user_folder("SPIDAR_TEST_HOME", ".local"), "/home/somebody/.local");
  const passwd* const user = getpwuid(geteuid());
  const fs::path of_database = user ? fs::path(user->pw_dir) / ".local" : fs::path();
  for (const char* none : {"", "relative"}) {
    setenv("HOME", none, 1);
    EXPECT_EQ(user_folder("SPIDAR_TEST_HOME", ".local"), of_database);
  }
  unsetenv("HOME");
  EXPECT_EQ(user_folder("SPIDAR_TEST_HOME", ".local"), of_database);
  unsetenv("SPIDAR_TEST_HOME");
  if (before) setenv("HOME", home.c_str(), 1);
}

/// What it says may be too little, or too much.
TEST_F(VibrationMemories, AFileThatOthersMayWriteIsSaidAndNotTrusted) {
  VibrationMemory first(file);
  first.add(kHour, at(kHour));
  const fs::path parent = fs::path(file).parent_path();
  const auto expect_said = [&](const std::string& what) {
    VibrationMemory memory(file);
    EXPECT_EQ(memory.add(0, at(kHour)), kEmpty_ns / 2);
    expect_contains(memory.error(), what);
  };
  fs::permissions(file, fs::perms::group_write, fs::perm_options::add);
  expect_said("others may write it");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_write);
  expect_said("others may write it");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  for (const fs::path& above : {parent, parent.parent_path(), folder.path}) {
    fs::permissions(above, fs::perms::others_write, fs::perm_options::add);
    expect_said("others may remove it: chmod go-w " + fs::canonical(above).string());
    fs::permissions(above, fs::perms::sticky_bit, fs::perm_options::add);
    VibrationMemory sticky(file);
    sticky.add(0, at(kHour));
    EXPECT_EQ(sticky.error(), "") << above;
    fs::permissions(above, fs::perms::owner_all);
  }
  VibrationMemory trusted(file);
  trusted.add(0, at(kHour));
  EXPECT_EQ(trusted.error(), "");
}

TEST_F(VibrationMemories, AFullDiskIsSaid) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit none{0, before.rlim_max};
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &none), 0);
  VibrationMemory memory(file);
  const int64_t empty_ns = memory.add(0, at(kHour));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, ignored);
  EXPECT_EQ(empty_ns, kEmpty_ns / 2);
  expect_contains(memory.error(), "File too large");
}

TEST_F(VibrationMemories, AFileThatSomebodyElseHoldsIsNotWaitedForLong) {
  VibrationMemory memory(file);
  memory.add(kHour, at(kHour));
  const int held = open(file.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  EXPECT_EQ(memory.add(kHour, at(kHour)), 2 * kHour);
  close(held);
  // What could not be written is, later.
  memory.add(kHour, at(kHour));
  EXPECT_EQ(VibrationMemory(file).add(0, at(kHour)), 3 * kHour);
}

/// Also of one that is killed: at most what it has taken within a second is not kept.
TEST_F(VibrationMemories, ALoopKeepsWhatItTakesWhileItRuns) {
  const auto shake = [](VibrationBudget& budget, int64_t ns) {
    Wrench wrench;
    for (int64_t t = 0; t < ns; t += 1'000'000) {
      wrench.force_N.x() = t / 40'000'000 % 2 ? 3 : -3;
      budget.update(wrench, 1e-3, monotonic_now_ns());
    }
  };
  VibrationMemory memory(file);
  VibrationBudget budget(0);
  {
    const VibrationKeeper keeper(budget, memory);
    shake(budget, 10 * kSecond);
    ASSERT_GT(budget.taken_ns(), kEmpty_ns / 100);
    // While it runs.
    for (;;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const int64_t kept_ns = VibrationMemory(file).add(0);
      if (kept_ns > kEmpty_ns / 100) break;
    }
    shake(budget, kSecond);
  }
  VibrationBudget next(0);
  const VibrationKeeper keeper(next, memory);
  next.update({}, 1e-3, monotonic_now_ns());
  // The time between the two is refilled; the test has a limit.
  EXPECT_NEAR(static_cast<double>(next.full_at_ns()), static_cast<double>(budget.full_at_ns()),
              60.0 * kSecond);
  EXPECT_LT(next.state().left, 1);
}

}  // namespace
}  // namespace spidar::test::vibration_memory_test
