// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gst/gst.h>

#include "plugin/films/file_end.h"
#include "plugin/films/file_pipeline.h"
#include "plugin/films/film_reader.h"
#include "plugin/gobject/ref.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tracks/open_track.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_summary.h"
#include "plugin/tracks/track_tags.h"
#include "spidar/child_process.h"
#include "spidar/folders.h"
#include "spidar/realtime/uninterrupted.h"
#include "spidar/tools/command_line.h"

namespace spidar::tools {

namespace {

/// The identity of a file, and its last change.
bool is_same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
}

/// Moves a segment so that running time is stream time, the time by which a replay reads the track.
/// The two differ if a film does not begin at 0 (MPEG-TS, MPEG-PS, FLV).
GstPadProbeReturn move_segment(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEGMENT) return GST_PAD_PROBE_OK;
  GstSegment segment;
  gst_event_copy_segment(event, &segment);
  if (segment.format != GST_FORMAT_TIME || segment.time <= segment.base) return GST_PAD_PROBE_OK;
  // The segment begins as early as possible, so that the track begins with the film.
  const GstClockTime earlier = std::min(segment.start, segment.time - segment.base);
  segment.start -= earlier;
  segment.time -= earlier;
  segment.base = segment.time;
  GstEvent* const moved = gst_event_new_segment(&segment);
  gst_event_set_seqnum(moved, gst_event_get_seqnum(event));
  gst_event_unref(event);
  GST_PAD_PROBE_INFO_DATA(info) = moved;
  return GST_PAD_PROBE_OK;
}

/// Analyses `film` as fast as it can be decoded, writes its haptic track into `track`, whose format
/// follows from the end of the name that it will have (`encoder_of()`), and reads it back. `report`
/// is called in another thread with the percentage of the work, whenever it rises. Throws
/// std::runtime_error.
FilmResult record_film(const std::string& film, const PartFile& track,
                       const RecordProperties& properties,
                       const std::function<void(int percent)>& report) {
  struct stat at_first {
  }, at_last{};
  stat(film.c_str(), &at_first);
  FilmProgress progress(report);
  FilmFingerprint fingerprint;
  std::string unread;
  try {
    fingerprint = fingerprint_of(read_film(film).packets);
  } catch (const std::runtime_error& why) {
    unread = why.what();  // decoding it may reveal more
  }
  FilmWatch watch;
  StoredSound stored;
  const FilePipeline file(
      "filesrc name=source ! decodebin name=decode videoconvert name=convert ! "
      "spidarmotion name=motion device=none attach-meta=true ! "
      "spidarextract name=extract extract.wrench ! " +
          encoder_of(track.target()) +
          " ! fdsink sync=false fd=" + std::to_string(track.descriptor()),
      film, nullptr, unread.empty() ? kShareTimeout : FilePipeline::kLongestSilence);
  set_properties(file.find("motion"), properties);
  watch.begin(file.pipeline(), film);
  progress.watch(file.find("motion"));
  stored.watch(file.find("stored"));
  const Ref<GstPad> frames(gst_element_get_static_pad(file.find("extract"), "sink"));
  const Ref<GstPad> wrench(gst_element_get_static_pad(file.find("extract"), "wrench"));
  gst_pad_add_probe(frames.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, move_segment, nullptr,
                    nullptr);
  tracks::tag(wrench.get(), {fingerprint, properties.settings});
  std::string error;
  try {
    file.play_until(GST_MESSAGE_EOS);
  } catch (const std::runtime_error& ended) {
    // decodebin may lose the error of a demuxer, and then waits for ever.
    error = unread.empty() ? ended.what() : unread;
  }
  file.stop();
  if (stat(film.c_str(), &at_last) != 0) {
    throw std::runtime_error("it was removed while it was read, or its share has gone");
  }
  if (!is_same_file(at_first, at_last)) {
    throw std::runtime_error("it was changed while it was read: wait until it is complete");
  }
  const std::string why = watch.why_ended(error);
  if (!why.empty()) throw std::runtime_error(why);
  if (film_end(film) == FilmEnd::kCutOff) throw std::runtime_error(kEndMissing);
  stored.check(track);
  return {watch.felt(), watch.remark(), {}, false, {}};
}

constexpr const char* kMark = "--film-process";
constexpr int kNoPart = -1;

/// The arguments of the process.
enum Argument {
  kProgram,
  kMarkArgument,
  kParent,  // process id
  kSocket,  // descriptors
  kPart,
  kFilm,  // also for people who read a list of processes
  kArguments
};

// A message is its length, a uint32_t, and an object in MessagePack. The first message is the job:
// what FilmJob has besides the film. The process answers {"percent": 40} as often as the percentage
// rises, and last what FilmResult has, or {"error": why}. Texts are bytes, as file names are.

/// Returns false when the other end is closed.
bool send_message(int socket, const Json& message) {
  std::string bytes;
  Json::to_msgpack(message, bytes);
  const auto length = static_cast<uint32_t>(bytes.size());
  bytes.insert(0, reinterpret_cast<const char*>(&length), sizeof length);
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t sent = uninterrupted(
        [&] { return send(socket, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL); });
    if (sent <= 0) return false;
    at += static_cast<size_t>(sent);
  }
  return true;
}

bool read_whole(int socket, char* bytes, size_t size) {
  while (size > 0) {
    const ssize_t got = uninterrupted([&] { return read(socket, bytes, size); });
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<size_t>(got);
  }
  return true;
}

/// Returns nothing when the other end is closed.
std::optional<Json> next_message(int socket) {
  uint32_t length = 0;
  if (!read_whole(socket, reinterpret_cast<char*>(&length), sizeof length)) return std::nullopt;
  std::string bytes(length, '\0');
  if (!read_whole(socket, bytes.data(), length)) return std::nullopt;
  return Json::from_msgpack(bytes);
}

// --- the process that has the list of films

/// The sockets of this process and of the process that reads a film.
struct Sockets {
  Sockets() {
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail(errno);
  }
  ~Sockets() {
    close(ends[0]);
    close_other();
  }
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;

  [[noreturn]] static void fail(int error) {
    throw std::runtime_error(std::string("the system gives no process to read it: ") +
                             std::strerror(error));
  }
  void close_other() {
    if (ends[1] >= 0) close(std::exchange(ends[1], -1));
  }

  int ends[2] = {-1, -1};
};

/// Waits until the process has ended. Throws std::runtime_error if a signal has ended it.
void await_end(pid_t process) {
  int status = 0;
  rusage used{};
  uninterrupted([&] { return wait4(process, &status, 0, &used); });
  if (!WIFSIGNALED(status)) return;
  rlimit limit{};
  const auto s = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  const double used_s = s(used.ru_utime) + s(used.ru_stime);
  if (getrlimit(RLIMIT_CPU, &limit) == 0 && used_s >= static_cast<double>(limit.rlim_cur)) {
    throw std::runtime_error("the limit of CPU time, " + std::to_string(limit.rlim_cur) +
                             " s (ulimit -t), has ended the process that read it; raise it");
  }
  const int signal = WTERMSIG(status);
  throw std::runtime_error(
      signal == SIGKILL
          ? "the process that read it was killed: is there enough memory for it?"
          : std::string("the process that read it crashed (") + strsignal(signal) +
                "): it is damaged, or a plug-in of GStreamer that reads it has a fault");
}

FilmResult run(const FilmJob& job, int part, const std::function<void(int percent)>& report) {
  Sockets sockets;
  const auto [own, other] = sockets.ends;
  std::vector<std::pair<int, int>> files{{other, other}};
  if (part != kNoPart) files.emplace_back(part, part);
  const pid_t process = start_child(own_program(),
                                    {"spidartrack", kMark, std::to_string(getpid()),
                                     std::to_string(other), std::to_string(part), job.film},
                                    files, 0);
  if (process < 0) Sockets::fail(errno);
  sockets.close_other();
  send_message(own, {{"track", job.track},
                     {"is_summarised", job.is_summarised},
                     {"settings", job.properties.settings},
                     {"properties", job.properties.values}});
  Json last = {{"error", "the process that read it ended without a result"}};
  while (const std::optional<Json> answer = next_message(own)) {
    if (answer->contains("percent")) {
      report((*answer)["percent"]);
    } else {
      last = *answer;
    }
  }
  await_end(process);
  if (last.contains("error")) throw std::runtime_error(last["error"].get<std::string>());
  return {last["felt"], last["remark"], last["other"], last["is_by_others"], last["summary"]};
}

// --- the process of a film

void send_answer(int socket, const Json& answer) {
  if (!send_message(socket, answer)) _exit(kFailed);  // the parent is gone
}

/// Summarises a track: duration_s, felt (the fraction of the time with a force that can be felt),
/// largest_force_N, fingerprint and settings.
Json summary_of(const std::string& track) {
  tracks::Summariser summariser;
  const TrackCondition condition =
      read_track(track, [&summariser](const TrackSample& sample) { summariser.add(sample); });
  const tracks::Summary summary = summariser.summary();
  return {{"duration_s", static_cast<double>(summary.samples) / kTrackRate_Hz},
          {"felt", summary.felt},
          {"largest_force_N", summary.largest_force_N},
          {"fingerprint", to_text(condition.notes.film)},
          {"settings", condition.notes.settings.value_or("")}};
}

/// Examines an existing track. Throws std::runtime_error.
FilmResult compare(const std::string& film, const std::string& track, const std::string& settings) {
  const std::string again = "; --force records it again";
  FilmResult result;
  if (std::filesystem::is_empty(track)) {
    result.other = track + " is empty" + again;
    return result;
  }
  const tracks::Notes notes = tracks::notes_of(track);
  result.is_by_others = !notes.settings;
  if (notes.settings && *notes.settings != settings) {
    const auto shown = [](const std::string& text) { return text.empty() ? "the defaults" : text; };
    result.other = track + " was recorded with " + shown(*notes.settings) + ", and not with " +
                   shown(settings) + again;
  } else if (!notes.film.empty() && !find_picture(notes.film, read_film(film).packets)) {
    result.other = track + " is the track of another film: " + kOtherPictures + again;
  }
  return result;
}

/// Parses the number of a descriptor, and prevents children from inheriting the descriptor.
int number_of_descriptor(const char* text) {
  const int descriptor = std::atoi(text);
  if (descriptor >= 0) fcntl(descriptor, F_SETFD, FD_CLOEXEC);
  return descriptor;
}

}  // namespace

FilmResult record_in_process(const FilmJob& job, const PartFile& part,
                             const std::function<void(int percent)>& report) {
  return run(job, part.descriptor(), report);
}

FilmResult check_in_process(const FilmJob& job) {
  return run(job, kNoPart, [](int) {});
}

int run_film_process(int argc, char** argv) {
  if (argc != kArguments || std::strcmp(argv[kMarkArgument], kMark) != 0) return -1;
  // This process ends with its parent, even if the parent is killed. It inherits a mask that blocks
  // the signals that end the parent.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != std::atoi(argv[kParent])) return kFailed;
  const int socket = number_of_descriptor(argv[kSocket]);
  const int descriptor = number_of_descriptor(argv[kPart]);
  try {
    const std::optional<Json> sent = next_message(socket);
    if (!sent) return kFailed;
    const FilmJob job{
        argv[kFilm],
        (*sent)["track"],
        {(*sent)["properties"].get<decltype(RecordProperties::values)>(), (*sent)["settings"]},
        (*sent)["is_summarised"]};
    gst_init(nullptr, nullptr);
    std::string recorded = job.track;
    FilmResult result;
    if (descriptor == kNoPart) {
      result = compare(job.film, job.track, job.properties.settings);
    } else {
      const PartFile part(job.track, descriptor);
      recorded = part.path();
      result = record_film(job.film, part, job.properties, [socket](int percent) {
        send_answer(socket, {{"percent", percent}});
      });
    }
    const bool is_summarised = job.is_summarised && result.other.empty();
    send_answer(socket, {{"felt", result.felt},
                         {"remark", result.remark},
                         {"other", result.other},
                         {"is_by_others", result.is_by_others},
                         {"summary", is_summarised ? summary_of(recorded) : Json::object()}});
    return kDone;
  } catch (const std::exception& error) {
    send_answer(socket, {{"error", error.what()}});
    return kFailed;
  }
}

}  // namespace spidar::tools
