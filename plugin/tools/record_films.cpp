// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "plugin/tools/film_recorder.h"
#include "plugin/tools/record_options.h"
#include "plugin/tools/record_report.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/part_file.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_file.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// How often it is looked whether another process has finished a track.
constexpr std::chrono::milliseconds kLook{200};

/// Throws std::runtime_error when the file that is there is not what would be made. One that says
/// nothing of itself was made by hand, or by an older version, and may be.
void check_file(const std::string& film, const fs::path& file, const RecordOptions& options) {
  const std::string again = "; --force records it again";
  if (fs::is_empty(file)) throw std::runtime_error(file.string() + " is empty" + again);
  const TrackNotes notes = read_track_notes(file.string());
  const std::string settings = with_rules(options.properties, film).settings;
  if (notes.settings && *notes.settings != settings) {
    const auto shown = [](const std::string& text) { return text.empty() ? "the defaults" : text; };
    throw std::runtime_error(file.string() + " was recorded with " + shown(*notes.settings) +
                             ", and not with " + shown(settings) + again);
  }
  if (notes.film.empty()) return;
  if (!find_picture(notes.film, read_film(film).packets)) {
    throw std::runtime_error(file.string() + " is the track of another film: " + kOtherPictures +
                             again);
  }
}

/// Records a list of films with several threads.
class FilmBatch {
 public:
  explicit FilmBatch(const RecordOptions& options)
      : options_(options), report_(paths(options.films)) {}

  /// Returns whether no film failed.
  bool run() {
    claim_names();
    std::vector<std::thread> workers;
    try {
      for (unsigned i = 1; i < options_.jobs && i < options_.films.size(); ++i)
        workers.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
      // The system gives no more threads: those that there are take longer.
    }
    work();
    for (std::thread& worker : workers) worker.join();
    return report_.finish();
  }

 private:
  using Result = RecordReport::Result;

  struct Film {
    size_t index;
    bool is_elsewhere = false;  ///< another process is recording it
  };

  static std::vector<std::string> paths(const std::vector<ListedFilm>& films) {
    std::vector<std::string> paths;
    for (const ListedFilm& film : films) paths.push_back(film.path);
    return paths;
  }

  /// Queues the films, but for those whose track has the same name as that of an earlier one.
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
        report_.done(i, Result::kTwice, "is given twice");
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
        if (film->is_elsewhere) std::this_thread::sleep_for(kLook);
        if (finish(film->index)) continue;
        if (!film->is_elsewhere) report_.note(film->index, "another process is recording it");
        // All others come first.
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
    const std::unique_ptr<PartFile> part = PartFile::claim(track);
    if (!part) return false;
    if (is_done(index, track)) return true;  // in the meantime
    report_.progress(index, 0);
    const RecordProperties properties = with_rules(options_.properties, film);
    const auto tell = [&](int percent) { report_.progress(index, percent); };
    const FilmOutcome outcome = record_film(film, *part, properties, tell);
    part->publish(options_.force ? PartFile::Existing::kReplace : PartFile::Existing::kKeep);
    const std::string remark = with_warning(outcome.remark, film, track);
    report_.done(index, Result::kRecorded,
                 track.string() + "; " + outcome.felt + (remark.empty() ? "" : "; " + remark));
    return true;
  }

  /// The folder itself has to be there: it may be a share that is not mounted.
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

  void fail(size_t index, const std::string& cause) { report_.done(index, Result::kError, cause); }

  bool is_done(size_t index, const fs::path& track) {
    if (options_.force || !fs::exists(track)) return false;
    const std::string& film = options_.films[index].path;
    check_file(film, track, options_);
    report_.done(index, Result::kThere, with_warning(track.string() + " is there", film, track));
    return true;
  }

  const RecordOptions& options_;
  RecordReport report_;
  std::mutex mutex_;
  std::deque<Film> waiting_;
};

}  // namespace

int record_films(const RecordOptions& options) {
  return FilmBatch(options).run() ? kDone : kFailed;
}

}  // namespace spidar
