// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/limits/vibration_memory.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

#include "spidar/folders.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/realtime/uninterrupted.h"
#include "spidar/transports/transport.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// How often the vibration is stored. In this time the vibration takes at most 1/kEmptied_s of what
/// is left in the store.
constexpr std::chrono::seconds kEvery{1};
/// Smaller amounts, below a thousandth of the store, are stored later: a film that hardly vibrates
/// must not keep a disk awake.
constexpr auto kWorthKeeping_ns = static_cast<int64_t>(1e9 / 1000 * VibrationBudget::kStore_m2_s3 /
                                                       VibrationBudget::kRefill_m2_s4);
/// The longest time until the store is full again: the time that refilling twice the store takes.
constexpr int64_t kMax_ns = 4 * VibrationMemory::kUnknown_ns;

constexpr size_t kMaxText = 200;

/// For root, no file counts as another user's: root may write all files, and sudo may keep a user's
/// home.
bool is_of_another(const struct stat& status) {
  return status.st_uid != geteuid() && geteuid() != 0;
}

/// The owner that a user namespace, as in a container, shows for the host's root (overflowuid).
constexpr uid_t kUnmapped = 65534;

/// The first folder above the file in which others may remove or rename a part of the path, or
/// whose permissions are unknown; empty if there is none. In a sticky folder, users may remove and
/// rename only their own files. This user's default group counts as the user.
std::string folder_of_others(const fs::path& file) {
  std::error_code error;
  fs::path folder = fs::canonical(file, error);
  if (error) return file.parent_path().string();
  while (folder.has_relative_path()) {
    folder = folder.parent_path();
    struct stat status {};
    if (stat(folder.c_str(), &status) != 0) return folder;
    const mode_t others = S_IWOTH | (status.st_gid == getegid() ? 0 : S_IWGRP);
    const bool is_open = (status.st_mode & others) != 0 && (status.st_mode & S_ISVTX) == 0;
    const bool is_of_system = status.st_uid == 0 || status.st_uid == kUnmapped;
    if (is_open || (!is_of_system && is_of_another(status))) return folder;
  }
  return {};
}

/// A file that this process has opened and locked, or the errno of the failure.
class LockedFile {
 public:
  explicit LockedFile(const std::string& path) {
    std::error_code not_made;
    fs::create_directories(fs::path(path).parent_path(), not_made);
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0600);
    struct stat status {};
    if (file_ < 0 || fstat(file_, &status) != 0) {
      error = errno == ENOENT && not_made ? not_made.value() : errno;
    } else if (!S_ISREG(status.st_mode)) {
      error = EINVAL;
    } else if (!lock_device(file_)) {
      error = errno;
    }
    if (error != 0) return;
    const std::string folder = folder_of_others(path);
    if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0 || is_of_another(status)) {
      untrusted = "others may write it: chmod go-w and chown it to yourself, or remove it";
    } else if (!folder.empty()) {
      untrusted = "others may remove it: chmod go-w " + folder + ", which you or root must own";
    }
  }
  ~LockedFile() {
    if (file_ >= 0) close(file_);
  }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  /// Returns an empty text after an error.
  std::string read() {
    if (error != 0) return {};
    std::array<char, kMaxText> text{};
    const ssize_t length = uninterrupted([&] { return pread(file_, text.data(), text.size(), 0); });
    if (length < 0) error = errno;
    return {text.data(), static_cast<size_t>(std::max<ssize_t>(length, 0))};
  }
  /// Writes the text at once, always with the same length, so that no reader finds a part of it.
  void write(const std::string& text) {
    if (error != 0) return;
    const ssize_t length =
        uninterrupted([&] { return pwrite(file_, text.data(), text.size(), 0); });
    if (length != static_cast<ssize_t>(text.size())) error = length < 0 ? errno : ENOSPC;
    if (ftruncate(file_, static_cast<off_t>(text.size())) != 0) error = errno;
  }

  int error = 0;
  std::string untrusted;  ///< why another user may have written the content; empty: none may

 private:
  int file_ = -1;
};

}  // namespace

Moment Moment::now() {
  Moment now;
  now.since_boot_ns = clock_ns(CLOCK_BOOTTIME);
  now.utc_ns = clock_ns(CLOCK_REALTIME);
  std::ifstream("/proc/sys/kernel/random/boot_id") >> now.boot;
  return now;
}

int64_t passed_ns(const Moment& then, const Moment& now) noexcept {
  if (then.boot == now.boot) return std::max<int64_t>(0, now.since_boot_ns - then.since_boot_ns);
  return std::max(now.since_boot_ns, now.utc_ns - then.utc_ns);
}

int64_t VibrationMemory::Entry::left_ns(const Moment& now) const noexcept {
  return std::max<int64_t>(0, empty_ns - passed_ns(at, now));
}

VibrationMemory& VibrationMemory::of_user() {
  // Never destroyed: when a player exits, a session may still be open.
  static auto& memory = *[] {
    if (const char* const folder = secure_getenv("SPIDAR_STATE")) {
      return new VibrationMemory(*folder ? fs::path(folder) / "vibration" : fs::path());
    }
    const fs::path folder = user_folder("XDG_STATE_HOME", ".local/state");
    if (folder.empty()) return new VibrationMemory("", "this user has no home");
    return new VibrationMemory(folder / "gst-spidar/vibration");
  }();
  return memory;
}

std::string VibrationMemory::text_of(const Entry& entry) {
  std::array<char, kMaxText> text{};
  const int length =
      std::snprintf(text.data(), text.size(),
                    "gst-spidar: the vibration of this hand is refilled in %020" PRId64
                    " ns; at %020" PRId64 " ns UTC, %020" PRId64 " ns since start %.36s\n",
                    entry.empty_ns, entry.at.utc_ns, entry.at.since_boot_ns, entry.at.boot.c_str());
  return {text.data(), static_cast<size_t>(length)};
}

std::optional<VibrationMemory::Entry> VibrationMemory::parse(const std::string& text) {
  Entry entry;
  std::array<char, 37> boot{};
  std::sscanf(text.c_str(),
              "gst-spidar: the vibration of this hand is refilled in %20" SCNd64
              " ns; at %20" SCNd64 " ns UTC, %20" SCNd64 " ns since start %36s",
              &entry.empty_ns, &entry.at.utc_ns, &entry.at.since_boot_ns, boot.data());
  entry.at.boot = boot.data();
  const bool is_possible = entry.empty_ns >= 0 && entry.empty_ns <= kMax_ns &&
                           entry.at.utc_ns >= 0 && entry.at.since_boot_ns >= 0;
  return is_possible && text_of(entry) == text ? std::optional(entry) : std::nullopt;
}

int64_t VibrationMemory::add(int64_t taken_ns, const Moment& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Entry entry{now, last_ ? last_->left_ns(now) : 0};
  std::string wrong;
  const auto distrust = [&](const std::string& why) {
    wrong = why;
    if (!last_) entry.empty_ns = std::max(entry.empty_ns, kUnknown_ns);
  };
  std::optional<LockedFile> file;
  bool is_known = false;
  if (!why_no_file_.empty()) distrust(why_no_file_);
  if (!file_.empty()) {
    file.emplace(file_);
    const std::string text = file->read();
    if (!file->untrusted.empty()) distrust(file->untrusted);
    if (const std::optional<Entry> kept = parse(text)) {
      is_known = true;
      entry.empty_ns = std::max(entry.empty_ns, kept->left_ns(now));
    } else if (!text.empty()) {
      distrust("its text is not what this program writes");
    }
  }
  entry.empty_ns = std::min(entry.empty_ns + std::max<int64_t>(taken_ns, 0), kMax_ns);
  if (file) {
    if (taken_ns > 0 || !is_known) file->write(text_of(entry));
    if (file->error != 0) distrust(std::strerror(file->error));
  }
  if (!wrong.empty() && error_.empty()) {
    error_ = (file_.empty() ? "The file" : file_) +
             ", which keeps how much a hand was shaken within a day, cannot be used: " + wrong +
             ". Half of what is allowed in a day counts as used.";
  }
  last_ = entry;
  return entry.empty_ns;
}

std::string VibrationMemory::error() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}

VibrationKeeper::VibrationKeeper(VibrationBudget& budget, VibrationMemory& memory)
    : budget_(budget), memory_(memory), kept_ns_(budget.taken_ns()) {
  budget_.restore(monotonic_now_ns() + memory_.add(0));
  thread_ = start_thread("spidar-budget", [this] { keep(); });
}

VibrationKeeper::~VibrationKeeper() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void VibrationKeeper::keep() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (bool ends = false; !ends;) {
    ends = ended_.wait_for(lock, kEvery, [this] { return ends_; });
    int64_t taken_ns = budget_.taken_ns() - kept_ns_;
    if (taken_ns < kWorthKeeping_ns && !ends) taken_ns = 0;
    kept_ns_ += taken_ns;
    budget_.restore(monotonic_now_ns() + memory_.add(taken_ns));
  }
}

}  // namespace spidar
