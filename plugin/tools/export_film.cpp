// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <glib.h>

#include "plugin/films/file_bytes.h"
#include "plugin/films/film_reader.h"
#include "plugin/gobject/ref.h"
#include "plugin/tools/film_encoder.h"
#include "plugin/tools/film_page.h"
#include "plugin/tools/film_process.h"
#include "plugin/tools/record_options.h"
#include "plugin/tools/record_report.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace spidar::tools {
namespace {

namespace fs = std::filesystem;

/// Does not resolve links in the two paths, because a browser does not resolve them either.
std::string relative_url(const fs::path& film, const fs::path& page) {
  const fs::path folder = fs::absolute(page).lexically_normal().parent_path();
  const fs::path path = fs::absolute(film).lexically_normal().lexically_relative(folder);
  return taken(g_uri_escape_string(path.c_str(), "/", FALSE));
}

constexpr const char* kMaker = "spidartrack export";

/// Searches as players do: film.srt or film.en.srt for film.mp4.
bool has_subtitles_beside(const fs::path& film) {
  const std::string begin = film.stem().string() + ".";
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(fs::absolute(film).parent_path(), none)) {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, begin.size(), begin) != 0) continue;
    for (const char* end : {".srt", ".vtt", ".ass", ".ssa", ".sub"}) {
      if (ends_with(name, end)) return true;
    }
  }
  return false;
}

/// Passes the bytes of a file to `take` in pieces, from its beginning.
void read_file(const std::string& path, size_t at_once,
               const std::function<void(const std::string&)>& take) {
  FileBytes file(path);
  for (uint64_t at = 0; at < file.size();) {
    const std::string bytes = file.read(at, at_once);
    if (bytes.empty()) throw std::runtime_error(path + ": cannot be read");
    take(bytes);
    at += bytes.size();
  }
}

/// The largest film in a page: base64 takes a third more, and neither Chromium's longest string
/// (2^29 - 24 characters) nor the memory of telephones holds much more.
constexpr uint64_t kMaxEmbedded_bytes = uint64_t{1} << 28;

void expect_embeddable(const std::string& name, const std::string& file) {
  const uint64_t bytes = FileBytes(file).size();
  if (bytes <= kMaxEmbedded_bytes) return;
  constexpr uint64_t kMega = 1'000'000;
  throw std::runtime_error(name + ": has " + std::to_string(bytes / kMega) +
                           " MB, which is too large for a page: browsers do not hold more than " +
                           std::to_string(kMaxEmbedded_bytes / kMega) +
                           " MB with --embed; export it to a folder, FOLDER/");
}

class ExportedFilm {
 public:
  /// `folder` receives the film and the page; else empty.
  ExportedFilm(const ExportOptions& options, const fs::path& page, const fs::path& folder)
      : film_(options.film) {
    const bool is_recorded = options.properties || (options.track.empty() && !has_track(film_));
    unplayed_ = why_no_browser(film_);
    if (!folder.empty()) open_copy(folder, options.force);
    const bool is_converted = !unplayed_.empty() && (copy_ || options.embed);
    if (options.embed && unplayed_.empty()) expect_embeddable(film_, film_);
    parts_of_work_ = 1 + (is_recorded ? 1 : 0) + (is_converted ? 1 : 0);
    std::unique_ptr<PartFile> recorded;  // never published
    if (is_recorded) {
      recorded = std::make_unique<PartFile>(fs::path(page) += ".haptic.flac",
                                            PartFile::Replaces{true, {}});
      record(options.properties.value_or(parse_record_properties({}, 1)), *recorded);
    }
    read_forces(recorded ? recorded->path() : options.track);
    has_subtitles_ = read_film(film_).has_subtitles || has_subtitles_beside(film_);
    place_arrow();
  }

  /// Writes a page that plays the film where it is stored.
  void write_page(PartFile& page) {
    const std::string html = this->html(relative_url(film_, page.target()), film_, 0, unplayed_);
    page.write(html);
    publish(page);
    std::string unplayed;
    if (!unplayed_.empty()) {
      unplayed = (ends_with(unplayed_, kNotEveryBrowser) ? "; not every browser plays it, because "
                                                         : "; browsers do not play it, because ") +
                 unplayed_ + "; spidartrack export " + film_ +
                 " FOLDER/ converts it for them, as --embed does";
    }
    print_result(page.target(), html, unplayed);
  }

  /// Writes a page that contains the film.
  void write_all_in_one(PartFile& page) {
    std::unique_ptr<PartFile> converted;
    std::string missing;
    if (!unplayed_.empty()) {  // never published
      converted = std::make_unique<PartFile>(page.target() + ".mp4", PartFile::Replaces{true, {}});
      missing = convert(*converted);
    }
    const std::string path = converted ? converted->path() : film_;
    if (converted) expect_embeddable(film_, path);
    const std::string html = this->html("", path, later_s(path), "");
    constexpr const char* kTrack = "<script type=\"application/json\" id=\"track\">";
    const size_t at = html.find(kTrack);
    page.write(html.substr(0, at) + "<script type=\"text/plain\" id=\"bytes\">");
    constexpr size_t kAtOnce = 3 << 20;  // a multiple of 3 avoids padding between the pieces
    read_file(path, kAtOnce, [&page](const std::string& bytes) { page.write(base64(bytes)); });
    page.write("</script>\n" + html.substr(at));
    publish(page);
    print_result(page.target(), html, "; with the film in it" + missing);
  }

  /// Writes a self-contained folder with the page and the film.
  void write_folder(PartFile& page) {
    PartFile& film = *copy_;
    std::string missing;
    if (unplayed_.empty()) {
      constexpr size_t kAtOnce = 1 << 20;
      read_file(film_, kAtOnce, [&film](const std::string& bytes) { film.write(bytes); });
    } else {
      missing = convert(film);
    }
    const std::string html = this->html(relative_url(film.target(), page.target()), film.path(),
                                        later_s(film.path()), "");
    page.write(html);
    publish(film);
    publish(page);
    print_result(page.target(), html, missing);
  }

 private:
  void open_copy(const fs::path& folder, bool force) {
    const fs::path film(film_);
    const fs::path name = unplayed_.empty() ? film.filename() : film.stem().concat(".mp4");
    copy_ = std::make_unique<PartFile>(folder / name, PartFile::Replaces{force, kMaker, false});
  }

  /// `track` is the file of the track; empty if the film contains it.
  void read_forces(const std::string& track) {
    condition_ = read_track(
        film_, [this](const TrackSample& sample) { page_.add(sample); }, {}, track);
    if (condition_.film.empty()) {
      throw UsageError(film_ + ": is a track; give the film that it is for");
    }
    expect_own_track(condition_);
  }

  void record(const RecordProperties& properties, const PartFile& track) {
    try {
      const FilmResult result = record_in_process(
          {film_, track.target(), with_rules(properties, film_), false}, track, next_part());
      remark_ = "; " + result.felt + (result.remark.empty() ? "" : "; " + result.remark);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(film_ + ": " + error.what());
    }
  }

  /// Returns a function that reports the progress of the next part of the work.
  std::function<void(int percent)> next_part() {
    const int done = parts_done_++;
    return [this, done](int percent) {
      constexpr int kWhole = 100;
      report_->progress(0, (kWhole * done + percent) / parts_of_work_);
    };
  }

  /// Places the arrow on the felt object, if the track states how it was measured.
  void place_arrow() {
    const auto report = next_part();
    if (!condition_.notes.settings) return;
    try {
      std::vector<FeltBox> boxes = find_felt_boxes(film_, *condition_.notes.settings, report);
      for (FeltBox& box : boxes) box.stream_ns -= condition_.later_ns;
      page_.set_boxes(boxes);
    } catch (const std::runtime_error& error) {
      in_the_middle_ = std::string("; the arrow stays in the middle: ") + error.what();
    }
  }

  /// `file` is what the page plays, and `unplayed` why some browser does not.
  std::string html(const std::string& url, const std::string& file, double more_s,
                   const std::string& unplayed) {
    const FilmPage::Html html =
        page_.html(url, fs::path(film_).filename(), is_webm(file) ? "video/webm" : "video/mp4",
                   1e-9 * static_cast<double>(condition_.later_ns) + more_s, unplayed);
    tolerance_N_ = html.tolerance_N;
    return html.text;
  }

  /// Converts the film. Returns why, and what is missing, for the end of the line.
  std::string convert(const PartFile& part) {
    try {
      const std::string missing = encode_film(film_, "", "flip", {}, part, next_part()).missing;
      return "; converted, because " + unplayed_ + (missing.empty() ? "" : "; " + missing);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(film_ + ": browsers do not play it, because " + unplayed_ +
                               ", and it cannot be converted: " + error.what());
    }
  }

  /// How much later the pictures of a copy come than those of the film.
  double later_s(const std::string& copy) const {
    if (unplayed_.empty()) return 0;
    return 1e-9 * static_cast<double>(read_film(copy).begin_ns - read_film(film_).begin_ns);
  }

  void print_result(const std::string& to, const std::string& html, const std::string& more) {
    report_ = nullptr;  // this erases its line
    const char* const lost =
        has_subtitles_ ? "; without its subtitles, which browsers do not show" : "";
    std::printf("%s: %s; %zu KB, exact to %.2f N%s%s%s%s\n", film_.c_str(), to.c_str(),
                html.size() / 1000, tolerance_N_, more.c_str(), lost, in_the_middle_.c_str(),
                remark_.c_str());
  }

  const std::string film_;
  std::unique_ptr<PartFile> copy_;  ///< of the film
  std::unique_ptr<RecordReport> report_ =
      std::make_unique<RecordReport>(std::vector<std::string>{film_});
  int parts_of_work_ = 1, parts_done_ = 0;
  std::string remark_;  ///< about the recording
  FilmPage page_;
  double tolerance_N_ = 0;  ///< of the shown force
  TrackCondition condition_;
  bool has_subtitles_ = false;
  std::string unplayed_;       ///< why browsers do not play the film
  std::string in_the_middle_;  ///< why the place of the felt object is unknown
};

}  // namespace

int export_film(const ExportOptions& options) {
  const std::string& to = options.to;
  note_read(options.film);
  std::error_code none;
  const bool is_folder = !to.empty() && (to.back() == '/' || fs::is_directory(to, none));
  if (!is_folder && !ends_with(to, ".html")) {
    throw UsageError(to + ": is to end in .html, or in / as a folder does");
  }
  if (is_folder && options.embed) throw UsageError("--embed is for a page, not for a folder");
  if (is_folder) {
    fs::create_directories(to);
    PartFile page(fs::path(to) / "index.html", {options.force, kMaker, false});
    ExportedFilm(options, page.target(), to).write_folder(page);
    return kDone;
  }
  PartFile page(to, {options.force, kMaker});
  ExportedFilm film(options, to, {});
  if (options.embed) {
    film.write_all_in_one(page);
  } else {
    film.write_page(page);
  }
  return kDone;
}

}  // namespace spidar::tools
