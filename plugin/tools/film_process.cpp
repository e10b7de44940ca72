// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_process.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <gst/gst.h>

#include "plugin/tools/film_recorder.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tools/track_summary.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/open_track.h"
#include "plugin/tracks/sidecar.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

constexpr const char* kMark = "--film-process";
constexpr int kNoPart = -1;

/// The arguments of the process, of which properties are pairs of a name and a value. All of them
/// are bytes, as names of files are.
enum Argument {
  kProgram,
  kMarkArgument,
  kParent,   // its process
  kAnswers,  // descriptors
  kPart,
  kFilm,
  kTrack,
  kIsSummarised,
  kSettings,
  kProperties
};

/// Each answer is one of these letters, a text, and a zero byte.
enum Answer : char {
  kPercent = 'p',
  kFelt = 'f',
  kRemark = 'r',
  kSummary = 's',
  kError = 'e',
  kEnd = 'd'
};

// --- the process that has the list of films

/// A pipe of which the other end is the process of a film.
class Answers {
 public:
  Answers() {
    if (pipe2(ends_, O_CLOEXEC) != 0) fail(errno);
  }
  ~Answers() {
    close(ends_[0]);
    close_end();
  }
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  [[noreturn]] static void fail(int error) {
    throw std::runtime_error(std::string("the system gives no process to read it: ") +
                             std::strerror(error));
  }
  int end() const { return ends_[1]; }
  /// Of the process.
  void close_end() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }
  /// Gives all answers until the process has ended.
  void read(const std::function<void(char kind, const std::string& text)>& take) const {
    std::string unread;
    char bytes[4096];
    for (;;) {
      const ssize_t got = ::read(ends_[0], bytes, sizeof bytes);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return;
      unread.append(bytes, static_cast<size_t>(got));
      for (size_t zero; (zero = unread.find('\0')) != std::string::npos; unread.erase(0, zero + 1))
        if (zero > 0) take(unread[0], unread.substr(1, zero - 1));
    }
  }

 private:
  int ends_[2] = {-1, -1};
};

pid_t start_process(const FilmJob& job, int answers, int part) {
  std::vector<std::string> words = {"spidartrack",
                                    kMark,
                                    std::to_string(getpid()),
                                    std::to_string(answers),
                                    std::to_string(part),
                                    job.film,
                                    job.track,
                                    std::to_string(job.is_summarised),
                                    job.properties.settings};
  for (const auto& [name, value] : job.properties.values) {
    words.push_back(name);
    words.push_back(value);
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  // A descriptor that is copied to its own number stays open.
  posix_spawn_file_actions_adddup2(&actions, answers, answers);
  if (part != kNoPart) posix_spawn_file_actions_adddup2(&actions, part, part);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) Answers::fail(error);
  return process;
}

/// Returns when the process has ended. Throws std::runtime_error, unless it ended by itself.
void await_end(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFSIGNALED(status)) return;
  const int signal = WTERMSIG(status);
  throw std::runtime_error(
      signal == SIGKILL
          ? "the process that read it was killed: is there enough memory for it?"
          : std::string("the process that read it crashed (") + strsignal(signal) +
                "): it is damaged, or a plug-in of GStreamer that reads it has a fault");
}

FilmResult run(const FilmJob& job, int part, const std::function<void(int percent)>& tell) {
  Answers answers;
  const pid_t process = start_process(job, answers.end(), part);
  answers.close_end();
  FilmResult result;
  std::string error = "the process that read it ended without a result";
  answers.read([&](char kind, const std::string& text) {
    if (kind == kPercent) tell(std::atoi(text.c_str()));
    if (kind == kFelt) result.felt = text;
    if (kind == kRemark) result.remark = text;
    if (kind == kSummary) result.summary = text;
    if (kind == kError) error = text;
    if (kind == kEnd) error.clear();
  });
  await_end(process);
  if (!error.empty()) throw std::runtime_error(error);
  return result;
}

// --- the process of a film

class Answering {
 public:
  explicit Answering(int descriptor) : descriptor_(descriptor) {}

  void say(Answer kind, const std::string& text) const {
    const std::string answer = static_cast<char>(kind) + text + '\0';
    for (size_t at = 0; at < answer.size();) {
      const ssize_t written = write(descriptor_, answer.data() + at, answer.size() - at);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) _exit(kFailed);  // nobody waits for it
      at += static_cast<size_t>(written);
    }
  }

 private:
  const int descriptor_;
};

/// What the track says of itself: duration_s, felt (the fraction of the time with a force that can
/// be felt), largest_force_N, fingerprint and settings.
std::string summary_of(const std::string& track) {
  Summariser summariser;
  const TrackCondition condition =
      read_track(track, [&summariser](const TrackSample& sample) { summariser.add(sample); });
  const TrackSummary summary = summariser.summary();
  const nlohmann::ordered_json line = {
      {"duration_s", static_cast<double>(summary.samples) / kTrackRate_Hz},
      {"felt", summary.felt},
      {"largest_force_N", summary.largest_force_N},
      {"fingerprint", to_text(condition.notes.film)},
      {"settings", condition.notes.settings.value_or("")}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void inspect(const std::string& film, const std::string& track, const std::string& settings) {
  const std::string again = "; --force records it again";
  if (std::filesystem::is_empty(track)) throw std::runtime_error(track + " is empty" + again);
  const TrackNotes notes = read_track_notes(track);
  if (notes.settings && *notes.settings != settings) {
    const auto shown = [](const std::string& text) { return text.empty() ? "the defaults" : text; };
    throw std::runtime_error(track + " was recorded with " + shown(*notes.settings) +
                             ", and not with " + shown(settings) + again);
  }
  if (notes.film.empty()) return;
  if (!find_picture(notes.film, read_film(film).packets)) {
    throw std::runtime_error(track + " is the track of another film: " + kOtherPictures + again);
  }
}

/// Its descriptors are of this process alone.
int number_of_descriptor(const char* text) {
  const int descriptor = std::atoi(text);
  if (descriptor >= 0) fcntl(descriptor, F_SETFD, FD_CLOEXEC);
  return descriptor;
}

}  // namespace

FilmResult record_in_process(const FilmJob& job, const PartFile& part,
                             const std::function<void(int percent)>& tell) {
  return run(job, part.descriptor(), tell);
}

FilmResult inspect_in_process(const FilmJob& job) {
  return run(job, kNoPart, [](int) {});
}

int run_film_process(int argc, char** argv) {
  if (argc < kProperties || std::strcmp(argv[kMarkArgument], kMark) != 0) return -1;
  // It ends with its parent, also when that is killed; signals that end the parent are blocked.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != std::atoi(argv[kParent])) return kFailed;
  const Answering answers(number_of_descriptor(argv[kAnswers]));
  const int descriptor = number_of_descriptor(argv[kPart]);
  const std::string film = argv[kFilm], track = argv[kTrack];
  RecordProperties properties;
  properties.settings = argv[kSettings];
  for (int i = kProperties; i + 1 < argc; i += 2)
    properties.values.emplace_back(argv[i], argv[i + 1]);
  try {
    gst_init(nullptr, nullptr);
    std::string recorded = track;
    if (descriptor == kNoPart) {
      inspect(film, track, properties.settings);
    } else {
      const PartFile part(track, descriptor);
      recorded = part.path();
      const FilmOutcome outcome = record_film(film, part, properties, [&answers](int percent) {
        answers.say(kPercent, std::to_string(percent));
      });
      answers.say(kFelt, outcome.felt);
      answers.say(kRemark, outcome.remark);
    }
    if (std::atoi(argv[kIsSummarised])) answers.say(kSummary, summary_of(recorded));
    answers.say(kEnd, "");
    return kDone;
  } catch (const std::exception& error) {
    answers.say(kError, error.what());
    return kFailed;
  }
}

}  // namespace spidar
