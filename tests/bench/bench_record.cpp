// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What `spidartrack record` costs beside only decoding the film, and what a second film at a time
// gains. Whole programs, from their start to their end, in alternating turns.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <sched.h>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gst/gst.h>

#include "tests/bench/call_timer.h"
#include "tests/bench/cost/decoding.h"
#include "tests/bench/tracking/film_frames.h"
#include "tests/support/film_studio.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar::bench;

constexpr int kWidth = 1920, kHeight = 1080;
constexpr int kRate_Hz = 30;
constexpr int kFrames = 600;
constexpr int kTurns = 5;
constexpr int kSkipped = 77;

/// What a film is made of; an empty encoding is H.264 in MP4.
struct Clip {
  const char* name;
  int width, height;
  std::string encoder, rest;
};
const std::vector<Clip> kClips = {
    {"H.264", 432, 240, "", ""},
    {"MPEG-4", 640, 480, "avenc_mpeg4", " bitrate=2000000 ! avimux"},
    {"H.264", 1280, 720, "", ""},
    {"HEVC", 1280, 720, "x265enc", " speed-preset=ultrafast ! h265parse ! matroskamux"},
    {"VP8", 1280, 720, "vp8enc", " deadline=1 cpu-used=8 target-bitrate=3000000 ! webmmux"},
    {"VP9", 1280, 720, "vp9enc", " deadline=1 cpu-used=8 target-bitrate=3000000 ! webmmux"},
    {"MJPEG", 1280, 720, "jpegenc", " ! avimux"},
    {"H.264", 1920, 1080, "", ""},
};
constexpr int kClipFrames = 480;
constexpr int kFewFrames = 3;  // starting, and hardly anything more

struct Cost {
  double cpu_s, wall_s;  // of all its threads; from its start to its end
};

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Throws std::runtime_error when the program fails.
Cost run(const std::vector<std::string>& words, bool on_one_core) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("cannot fork");
  if (process == 0) {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    CPU_SET(sched_getcpu(), &cores);
    if (on_one_core && sched_setaffinity(0, sizeof cores, &cores) != 0) _exit(126);
    dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  if (wait4(process, &status, 0, &usage) != process || !WIFEXITED(status) ||
      WEXITSTATUS(status) != 0) {
    throw std::runtime_error(words.front() + " failed");
  }
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime),
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
}

struct Command {
  const char* name;
  std::vector<std::string> words;
  bool on_one_core;
};

/// Of each command its cost in every turn.
std::vector<std::vector<Cost>> in_turns(const std::vector<Command>& commands) {
  std::vector<std::vector<Cost>> costs(commands.size());
  for (int turn = 0; turn < kTurns; ++turn) {
    for (size_t i = 0; i < commands.size(); ++i) {
      costs[i].push_back(run(commands[i].words, commands[i].on_one_core));
    }
  }
  return costs;
}

double median(const std::vector<Cost>& costs, double Cost::*part) {
  std::vector<double> values;
  for (const Cost& cost : costs) values.push_back(cost.*part);
  return quantile(values, 0.5);
}

/// Median, least and most of the quotients of the same turn.
std::string quotient(const std::vector<Cost>& of, const std::vector<Cost>& by, double Cost::*part) {
  std::vector<double> values;
  for (size_t i = 0; i < of.size(); ++i) values.push_back(of[i].*part / (by[i].*part));
  char text[64];
  std::snprintf(text, sizeof text, "%.2f (%.2f … %.2f)", quantile(values, 0.5), quantile(values, 0),
                quantile(values, 1));
  return text;
}

std::vector<std::string> record(const std::string& jobs, const std::vector<std::string>& films) {
  std::vector<std::string> words = {SPIDARTRACK, "record", "--force", "--jobs", jobs};
  words.insert(words.end(), films.begin(), films.end());
  return words;
}

std::vector<std::string> decode(const std::string& film) {
  return {"gst-launch-1.0", "-q", "filesrc", "location=" + film, "!", "decodebin", "!", "fakesink"};
}

std::vector<spidar::test::Picture> drawn(int width, int height) {
  spidar::test::FilmStudio studio(width, height, 1);
  spidar::test::Film film = studio.pan_with_object();
  return draw_all(film, spidar::test::kFilmFrames);
}

void print_clip(const Clip& clip, const std::filesystem::path& folder) {
  const std::string size = std::to_string(clip.width) + "x" + std::to_string(clip.height);
  if (!clip.encoder.empty() && !is_installed(clip.encoder)) {
    std::printf("| %s %s | %s is not installed | | | | |\n", size.c_str(), clip.name,
                clip.encoder.c_str());
    return;
  }
  const std::string whole = folder / "whole", few = folder / "few";
  const std::vector<spidar::test::Picture> pictures = drawn(clip.width, clip.height);
  const std::string encoding = clip.encoder.empty() ? "" : clip.encoder + clip.rest;
  encode(pictures, kClipFrames, kRate_Hz, whole, encoding);
  encode(pictures, kFewFrames, kRate_Hz, few, encoding);
  const auto costs = in_turns({{"", decode(whole), true},
                               {"", record("1", {whole}), true},
                               {"", decode(few), true},
                               {"", record("1", {few}), true}});
  const auto ms = [&](size_t i) { return 1e3 * median(costs[i], &Cost::cpu_s); };
  const auto frame_ms = [&](size_t i) { return (ms(i) - ms(i + 2)) / (kClipFrames - kFewFrames); };
  std::printf("| %s %s | %.2f | %.2f | %.2f | %.0f | %s |\n", size.c_str(), clip.name, frame_ms(0),
              frame_ms(1) - frame_ms(0), frame_ms(1) / frame_ms(0), ms(3) - ms(2),
              quotient(costs[1], costs[0], &Cost::cpu_s).c_str());
}

/// What a frame costs more is the analysis, which does not depend on the codec: it weighs the more,
/// the less it takes to decode one.
void print_clips(const std::filesystem::path& folder) {
  std::printf(
      "\n### By size and codec\n\nCPU time, one core; %d frames\n\n"
      "| clip | decoding, ms a frame | record, ms a frame more | ÷ decoding, frames | record, ms "
      "more to start | ÷ decoding, whole clip |\n|---|---|---|---|---|---|\n",
      kClipFrames);
  for (const Clip& clip : kClips) print_clip(clip, folder);
}

void print_beside_decoding(const std::string& film) {
  const std::vector<Command> commands = {
      {"decoding, one core", decode(film), true},
      {"record, one core", record("1", {film}), true},
      {"decoding, all cores", decode(film), false},
      {"record, all cores", record("1", {film}), false},
  };
  const auto costs = in_turns(commands);
  std::printf(
      "\n### Beside decoding\n\n"
      "| | CPU time, ms a frame | wall, ms a frame | CPU time ÷ decoding | wall ÷ decoding |\n"
      "|---|---|---|---|---|\n");
  for (size_t i = 0; i < commands.size(); ++i) {
    const bool decodes = i % 2 == 0;
    const auto& decoding = costs[i - i % 2];
    std::printf("| %s | %.2f | %.2f | %s | %s |\n", commands[i].name,
                1e3 * median(costs[i], &Cost::cpu_s) / kFrames,
                1e3 * median(costs[i], &Cost::wall_s) / kFrames,
                decodes ? "1" : quotient(costs[i], decoding, &Cost::cpu_s).c_str(),
                decodes ? "1" : quotient(costs[i], decoding, &Cost::wall_s).c_str());
  }
}

void print_two_films(const std::vector<std::string>& films) {
  const std::vector<Command> commands = {
      {"one core, one after the other", record("1", films), true},
      {"all cores, one after the other", record("1", films), false},
      {"all cores, both at a time (-j2)", record("2", films), false},
  };
  const auto costs = in_turns(commands);
  std::printf(
      "\n### Two films\n\n"
      "| | CPU time, s | wall, s | cores busy | times as fast as on one core | as one after the "
      "other |\n|---|---|---|---|---|---|\n");
  for (size_t i = 0; i < commands.size(); ++i) {
    const double cpu_s = median(costs[i], &Cost::cpu_s), wall_s = median(costs[i], &Cost::wall_s);
    std::printf("| %s | %.2f | %.2f | %.2f | %s | %s |\n", commands[i].name, cpu_s, wall_s,
                cpu_s / wall_s, i < 1 ? "1" : quotient(costs[0], costs[i], &Cost::wall_s).c_str(),
                i < 2 ? "" : quotient(costs[1], costs[i], &Cost::wall_s).c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    const std::string missing = missing_for_decoding();
    if (!missing.empty()) {
      std::printf("skipped: %s\n", missing.c_str());
      return kSkipped;
    }
    const spidar::test::TemporaryFolder folder;
    const std::vector<std::string> films = {folder.path / "a.mp4", folder.path / "b.mp4"};
    encode(drawn(kWidth, kHeight), kFrames, kRate_Hz, films[0]);
    std::filesystem::copy_file(films[0], films[1]);
    std::printf("%d frames of %dx%d, H.264 by %s, %u cores; median of %d turns (least … most)\n",
                kFrames, kWidth, kHeight, h264_encoder().c_str(),
                std::thread::hardware_concurrency(), kTurns);
    print_beside_decoding(films[0]);
    print_two_films(films);
    print_clips(folder.path);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
