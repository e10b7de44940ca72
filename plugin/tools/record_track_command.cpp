// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <atomic>
#include <filesystem>
#include <functional>
#include <iostream>
#include <mutex>
#include <thread>
#include <utility>

#include <gst/gst.h>

#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp =
    R"(usage: spidartrack record FILM... [OPTION]... [-- PROPERTY=VALUE...]

Analyses films as fast as they can be decoded, and writes FILM's haptic track beside it, under its
name with .haptic.flac in place of the extension. Tracks that are there are left alone, so that the
command goes on where it was interrupted. Properties are those of spidarmotion: motion=camera …

  -j, --jobs N   films at a time; as many as there are processors
  --folder DIR   where tracks are written
  --format TYPE  flac (24 bits), mka or wav (both F32); flac
  --force        also those that are there
)";

struct RecordOptions {
  bool help = false;
  bool force = false;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  std::string folder;
  std::string format = "flac";
  std::string properties;
  std::vector<std::string> films;
};

RecordOptions parse(int argc, char** argv) {
  RecordOptions options;
  // getopt must not see the arguments after --.
  int own = 1;
  while (own < argc && std::string(argv[own]) != "--") ++own;
  for (int i = own + 1; i < argc; ++i) {
    const std::string property = argv[i];
    if (property.find('=') == std::string::npos || property.find('!') != std::string::npos) {
      throw UsageError(property + ": is no PROPERTY=VALUE");
    }
    options.properties += " " + property;
  }
  std::vector<std::string> words(argv, argv + own);
  for (size_t i = 1; i < words.size(); ++i) {
    if (words[i].rfind("-j", 0) == 0)
      words[i] = words[i] == "-j" ? "--jobs" : "--jobs=" + words[i].substr(2);
  }
  std::vector<char*> rest;
  for (std::string& word : words) rest.push_back(word.data());
  rest.push_back(nullptr);
  options.films = parse_options(
      own, rest.data(),
      {{"jobs", true,
        [&](const std::string& text) {
          options.jobs = static_cast<unsigned>(parse_number("--jobs", text, 1, 1024, ""));
        }},
       {"folder", true, [&](const std::string& text) { options.folder = text; }},
       {"format", true, [&](const std::string& text) { options.format = text; }},
       {"force", false, [&](const std::string&) { options.force = true; }},
       {"help", false, [&](const std::string&) { options.help = true; }}});
  if (options.help) return options;
  if (options.films.empty()) throw UsageError("no FILM given");
  if (encoder_of("." + options.format).empty()) {
    throw UsageError("--format: \"" + options.format + "\" is none of flac, mka, wav");
  }
  return options;
}

fs::path track_of(const std::string& film, const RecordOptions& options) {
  fs::path track(film);
  track.replace_extension(".haptic." + options.format);
  return options.folder.empty() ? track : fs::path(options.folder) / track.filename();
}

/// Reports `percent` of the film as recorded, in steps of ten.
class Progress {
 public:
  explicit Progress(std::function<void(int percent)> tell) : tell_(std::move(tell)) {}

  /// Counts the buffers that come out of `extract` in `pipeline`.
  void watch(GstElement* pipeline) {
    GstElement* extract = gst_bin_get_by_name(GST_BIN(pipeline), "extract");
    sink_ = gst_element_get_static_pad(extract, "sink");
    GstPad* wrench = gst_element_get_static_pad(extract, "wrench");
    gst_pad_add_probe(wrench, GST_PAD_PROBE_TYPE_BUFFER, passes, this, nullptr);
    gst_object_unref(wrench);
    gst_object_unref(sink_);  // the pipeline has it
    gst_object_unref(extract);
  }

 private:
  static GstPadProbeReturn passes(GstPad*, GstPadProbeInfo* info, gpointer user) {
    auto& self = *static_cast<Progress*>(user);
    if (self.film_ns_ == 0)
      gst_pad_peer_query_duration(self.sink_, GST_FORMAT_TIME, &self.film_ns_);
    if (self.film_ns_ <= 0) {
      self.film_ns_ = -1;  // the container does not tell
      return GST_PAD_PROBE_REMOVE;
    }
    const GstClockTime at = GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info));
    const int percent = static_cast<int>(100 * at / static_cast<GstClockTime>(self.film_ns_));
    if (percent >= self.told_ + 10 && percent < 100) {
      self.told_ = percent / 10 * 10;
      self.tell_(self.told_);
    }
    return GST_PAD_PROBE_OK;
  }

  const std::function<void(int percent)> tell_;
  GstPad* sink_ = nullptr;
  gint64 film_ns_ = 0;
  int told_ = 0;
};

void record(const std::string& film, const fs::path& track, const RecordOptions& options,
            const std::function<void(int percent)>& tell) {
  if (!fs::exists(film)) throw std::runtime_error("there is no such file");
  const std::string part = (track.parent_path() / (".part-" + track.filename().string())).string();
  Progress progress(tell);
  try {
    run_pipeline("filesrc location=" + quoted(film) +
                     " ! decodebin ! video/x-raw ! videoconvert ! spidarmotion device=none "
                     "post-messages=false attach-meta=true" +
                     options.properties + " ! spidarextract name=extract extract.wrench ! " +
                     encoder_of(track.string()) + " ! filesink location=" + quoted(part),
                 [&progress](GstElement* pipeline) { progress.watch(pipeline); });
    fs::rename(part, track);
  } catch (...) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
}

}  // namespace

int record_track_command(int argc, char** argv) {
  const RecordOptions options = parse(argc, argv);
  if (options.help) {
    std::cout << kHelp;
    return kDone;
  }
  std::atomic<size_t> next{0}, failed{0};
  std::mutex output;
  const auto say = [&](size_t film, const std::string& text) {
    const std::lock_guard<std::mutex> lock(output);
    std::cout << '[' << film + 1 << '/' << options.films.size() << "] " << options.films[film]
              << ": " << text << std::endl;
  };
  const auto work = [&] {
    for (size_t i; (i = next++) < options.films.size();) {
      const fs::path track = track_of(options.films[i], options);
      if (!options.force && fs::exists(track)) {
        say(i, track.string() + " is there");
        continue;
      }
      try {
        record(options.films[i], track, options,
               [&](int percent) { say(i, std::to_string(percent) + " %"); });
        say(i, track.string());
      } catch (const std::exception& error) {
        ++failed;
        say(i, std::string("failed: ") + error.what());
      }
    }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < options.jobs && i < options.films.size(); ++i)
    workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  return failed == 0 ? kDone : kFailed;
}

}  // namespace spidar
