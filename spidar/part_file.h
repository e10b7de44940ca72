// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace spidar {

/// Records in an extended attribute of the open and complete file that `maker` has written it, with
/// its size and the time of its last change. Records nothing where the file system has no
/// attributes (FAT, NFS before 4.2).
void mark_written(int file, const std::string& maker);

/// Whether `maker` has written the file at `path`, and nobody has changed its content since.
bool is_as_written(const std::string& path, const std::string& maker);

/// An output file that appears under its name, the target, only when it is complete. Until then it
/// is a part file in the folder of the target. The name of the part file is `.part-`, a number that
/// follows from the name of the target, and the target's extension, so that it is never too long.
/// The part file has one owner at a time, among all threads and processes, because it is locked for
/// as long as this object exists. The leftover of a killed process is removed and never written
/// into, and a link with the name of the part file is not followed, so that nobody else has the
/// file open. The destructor removes the part file. If the target is a link, publish() replaces the
/// file to which the link leads, and keeps the permissions of that file.
class PartFile {
 public:
  /// Which existing files are replaced.
  struct Replaces {
    bool any = false;      ///< every regular file; unless `is_named`, only files by `maker`
    std::string maker;     ///< command whose files are replaced if unchanged; empty: none
    bool is_named = true;  ///< whether the user has given the name of the target
    bool is_read =
        false;  ///< also a file that this program reads (note_read()), otherwise an error
  };

  /// Makes an empty part file. Throws std::runtime_error when that is not possible, when another
  /// thread or process is writing the same file, or when the target exists and is not replaced.
  PartFile(const std::filesystem::path& target, const Replaces& replaces);
  /// The part file of `target` of another process, which has passed the descriptor to this one.
  PartFile(const std::filesystem::path& target, int descriptor);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Returns null when another thread or process is writing the same file. Only publish() checks
  /// whether there is a file that must not be replaced.
  static std::unique_ptr<PartFile> claim(const std::filesystem::path& target,
                                         const Replaces& replaces);

  const std::string& path() const { return path_; }
  /// The final name of the file, for messages.
  const std::string& target() const { return target_; }
  int descriptor() const { return descriptor_; }

  /// Appends to what earlier calls have written. Throws std::runtime_error when that fails.
  void write(const std::string& content);

  /// Throws std::runtime_error when path() has become another file, or its folder has gone.
  void check_in_place() const;

  /// Renames the part file to the target. Throws std::runtime_error if there is now a file that
  /// must not be replaced. Returns a remark for the user; usually empty.
  std::string publish();

 private:
  PartFile() = default;
  bool try_claim(const std::filesystem::path& target, const Replaces& replaces);
  bool may_replace() const;

  std::string path_, target_;
  std::string place_;  ///< the target, or the file that it links to
  Replaces replaces_;
  int descriptor_ = -1;
  uint64_t written_ = 0;  ///< bytes
};

/// Writes `text` to a part file of `file`, once no other thread or process does, and publishes it.
/// Throws std::runtime_error with the reason; the old file is then unchanged.
void replace_file(const std::filesystem::path& file, const std::string& text);

/// From now on, SIGINT, SIGTERM, SIGHUP and SIGXCPU remove all part files before they end the
/// program, and a failed write is an error instead of a signal. Call this before other threads
/// start, because they inherit the blocked signals.
void remove_part_files_on_signals();

}  // namespace spidar
