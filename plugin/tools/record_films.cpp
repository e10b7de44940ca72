// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cerrno>
#include <chrono>
#include <deque>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

#include "core/json_text.h"
#include "plugin/films/file_bytes.h"
#include "plugin/tools/film_process.h"
#include "plugin/tools/record_options.h"
#include "plugin/tools/record_report.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tracks/sidecar.h"
#include "spidar/part_file.h"
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace spidar::tools {
namespace {

struct RecordedFilm {
  std::string film;
  std::filesystem::path track;
  std::string result;  ///< "recorded", "there" or "failed"
  std::string remark;  ///< a warning or, if it failed, the cause; may be empty
  double seconds = 0;  ///< of work
  Json summary;        ///< FilmResult::summary
};

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error("the manifest " + path + " cannot be written: " + output_reason(errno));
}

/// Returns a line of JSON for the manifest, without a newline. Unless the film failed, the line
/// contains the summary of the track.
std::string manifest_line(const RecordedFilm& film) {
  Json line = {{"film", film.film},
               {"result", film.result},
               {"seconds", film.seconds},
               {"version", SPIDAR_VERSION}};
  if (!film.remark.empty()) line[film.result == "failed" ? "error" : "warning"] = film.remark;
  if (film.result != "failed") line["track"] = film.track.string();
  if (!film.summary.empty()) line.update(film.summary);
  return json_text(line);
}

/// Whether the file is new, or its first line is one of manifest_line(). Also accepts a pipe or a
/// device, which has no lines, and a link, which open_output() checks.
bool is_new_or_manifest(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_symlink(path, none) || !std::filesystem::is_regular_file(path, none) ||
      std::filesystem::is_empty(path, none)) {
    return true;
  }
  constexpr size_t kMaxLine_bytes = size_t{1} << 20;
  const std::string begin = FileBytes(path).read(0, kMaxLine_bytes);
  std::string why;
  const ReadJson first = parse_json(begin.substr(0, begin.find('\n')), why);
  return first.is_object() && first.contains("film") && first.contains("result");
}

/// Appends lines to a file, also from several threads and processes.
class ManifestFile {
 public:
  /// Empty: nothing is written. Throws std::runtime_error when the file cannot be opened.
  explicit ManifestFile(const std::string& path) : path_(path) {
    if (path.empty()) return;
    expect_not_read(path);
    if (!is_new_or_manifest(path)) {
      throw std::runtime_error(path + ": is no manifest, so nothing is appended to it; name " +
                               "another file after --manifest");
    }
    descriptor_ = open_output(path.c_str(), O_APPEND);
    if (descriptor_ < 0) fail(path);
  }
  ~ManifestFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  ManifestFile(const ManifestFile&) = delete;
  ManifestFile& operator=(const ManifestFile&) = delete;

  void add(const RecordedFilm& film) const {
    if (descriptor_ < 0) return;
    const std::string line = manifest_line(film) + "\n";
    // A single call keeps lines of several writers apart.
    const ssize_t written = write(descriptor_, line.data(), line.size());
    if (written >= 0 && static_cast<size_t>(written) < line.size()) errno = ENOSPC;
    if (written < 0 || static_cast<size_t>(written) < line.size()) fail(path_);
  }

 private:
  const std::string path_;
  int descriptor_ = -1;
};

namespace fs = std::filesystem;

/// The period of checks whether another process has finished a track.
constexpr std::chrono::milliseconds kCheckPeriod{200};

/// Records a list of films with several processes, for each of which a thread waits.
class FilmBatch {
 public:
  explicit FilmBatch(const RecordOptions& options)
      : options_(options), report_(note_films(options.films)), manifest_(options.manifest) {}

  /// Returns whether no film failed.
  bool run() {
    claim_names();
    if (!options_.left_out.empty()) report_.print("left out: " + options_.left_out);
    std::vector<std::thread> workers;
    try {
      for (unsigned i = 1; i < options_.jobs && i < options_.films.size(); ++i) {
        workers.emplace_back([this] { work(); });
      }
    } catch (const std::system_error&) {
      // The system refuses more threads; continue with those that have started.
    }
    work();
    for (std::thread& worker : workers) worker.join();
    const bool no_film_failed = report_.finish();
    print_track_path();
    return no_film_failed;
  }

 private:
  struct Film {
    size_t index;
    bool is_elsewhere = false;  ///< another process is recording it
  };

  /// Returns the paths of the films. No output may replace one of them.
  static std::vector<std::string> note_films(const std::vector<ListedFilm>& films) {
    std::vector<std::string> paths;
    for (const ListedFilm& film : films) {
      paths.push_back(film.path);
      note_read(film.path);
    }
    return paths;
  }

  /// Prints how players find the tracks in the folder, if they do not search there already.
  void print_track_path() {
    if (options_.folder.empty() || options_.films.empty()) return;
    std::error_code none;
    const ListedFilm& film = options_.films.front();
    const fs::path track = fs::weakly_canonical(options_.file_of(film), none);
    const fs::path found = find_sidecar(film.path);
    if (!fs::exists(track, none) || (!found.empty() && fs::equivalent(found, track, none))) return;
    report_.print(
        std::string(found.empty() ? "" : "warning: " + found.string() + " goes before these; ") +
        "players find these tracks with " + kTrackPathVariable + "=" +
        fs::absolute(options_.folder, none).lexically_normal().string());
  }

  /// Queues the films, except for those whose track has the same name as that of an earlier one.
  void claim_names() {
    std::map<fs::path, size_t> first;
    for (size_t i = 0; i < options_.films.size(); ++i) {
      std::error_code none;
      const ListedFilm& film = options_.films[i];
      const fs::path track = fs::weakly_canonical(options_.file_of(film), none);
      const auto [there, is_new] = first.emplace(track, i);
      const std::string& other = options_.films[there->second].path;
      if (is_new) {
        waiting_.push_back({i});
      } else if (fs::equivalent(film.path, other, none)) {
        report_.done(i, RecordReport::Result::kTwice, "is given twice");
      } else {
        fail(i, options_.file_of(film).string() + " is for " + other +
                    "; give films of the same name different folders");
      }
    }
  }

  std::optional<Film> next() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.empty()) return {};
    const Film film = waiting_.front();
    waiting_.pop_front();
    return film;
  }

  void work() {
    while (const std::optional<Film> film = next()) {
      try {
        if (film->is_elsewhere) std::this_thread::sleep_for(kCheckPeriod);
        if (finish(film->index)) continue;
        if (!film->is_elsewhere) report_.note(film->index, "another process is recording it");
        // Try this film again after all others.
        const std::lock_guard<std::mutex> lock(mutex_);
        waiting_.push_back({film->index, true});
      } catch (const std::exception& error) {
        fail(film->index, error.what());
      }
    }
  }

  /// Returns false if another process is recording the film.
  bool finish(size_t index) {
    const std::string& film = options_.films[index].path;
    const fs::path track = options_.file_of(options_.films[index]);
    if (is_done(index, track)) return true;
    make_subfolder(index);
    const std::unique_ptr<PartFile> part = PartFile::claim(track, {options_.force, {}});
    if (!part) return false;
    if (is_done(index, track)) return true;  // finished in the meantime
    report_.progress(index, 0);
    const std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
    const auto report = [&](int percent) { report_.progress(index, percent); };
    const FilmResult result = record_in_process(job_of(index), *part, report);
    const std::string more = part->publish();
    const std::string remark = with_warning(
        result.remark + (result.remark.empty() || more.empty() ? "" : "; ") + more, film, track);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    manifest_.add({film, track, "recorded", remark, taken.count(), result.summary});
    report_.done(index, RecordReport::Result::kRecorded,
                 track.string() + "; " + result.felt + (remark.empty() ? "" : "; " + remark));
    return true;
  }

  FilmJob job_of(size_t index) const {
    const ListedFilm& film = options_.films[index];
    return {film.path, options_.file_of(film).string(), with_rules(options_.properties, film.path),
            !options_.manifest.empty()};
  }

  /// Makes the subfolder of a film, unless the folder itself has disappeared.
  void make_subfolder(size_t index) const {
    const fs::path& subfolder = options_.films[index].subfolder;
    if (options_.folder.empty() || subfolder.empty() || !fs::is_directory(options_.folder)) return;
    fs::create_directories(fs::path(options_.folder) / subfolder);
  }

  std::string with_warning(const std::string& text, const std::string& film,
                           const fs::path& track) const {
    const std::string why = why_not_played(film, track.string());
    return text + (text.empty() || why.empty() ? "" : "; ") + why;
  }

  void fail(size_t index, std::string cause) {
    const ListedFilm& film = options_.films[index];
    try {
      manifest_.add({film.path, options_.file_of(film), "failed", cause, 0, {}});
    } catch (const std::exception& error) {
      cause += std::string("; ") + error.what();
    }
    report_.done(index, RecordReport::Result::kError, cause);
  }

  bool is_done(size_t index, const fs::path& track) {
    if (!fs::exists(track)) return false;
    const std::string& film = options_.films[index].path;
    const FilmResult result = check_in_process(job_of(index));
    if (options_.force && result.is_by_others) {
      throw std::runtime_error(track.string() + ": spidartrack record has not made it, and does " +
                               "not replace it; rename or remove it");
    }
    if (options_.force) return false;
    if (!result.other.empty()) throw std::runtime_error(result.other);
    manifest_.add({film, track, "there", "", 0, result.summary});
    report_.done(index, RecordReport::Result::kThere,
                 with_warning(track.string() + " is there", film, track));
    return true;
  }

  const RecordOptions& options_;
  RecordReport report_;
  ManifestFile manifest_;
  std::mutex mutex_;
  std::deque<Film> waiting_;
};

/// Makes the folder if its parent exists: a missing parent may be a share that is not mounted.
void make_folder(const fs::path& folder) {
  std::error_code error;
  if (folder.empty() || fs::is_directory(folder, error)) return;
  if (fs::exists(folder, error)) {
    throw UsageError("--folder " + folder.string() + ": is a file, and tracks go into a folder");
  }
  const fs::path above = fs::absolute(folder).lexically_normal();
  const fs::path parent = (above.has_filename() ? above : above.parent_path()).parent_path();
  if (!fs::is_directory(parent, error)) {
    throw std::runtime_error(folder.string() + ": is not made, because there is no folder " +
                             parent.string() + "; make that, or mount it");
  }
  if (!fs::create_directory(folder, error) && error) {
    throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
  }
}

}  // namespace

int record_films(const RecordOptions& options) {
  make_folder(options.folder);
  return FilmBatch(options).run() ? kDone : kFailed;
}

}  // namespace spidar::tools
