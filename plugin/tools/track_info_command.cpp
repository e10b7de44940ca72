// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tools/track_summary.h"
#include "plugin/track/film_reader.h"
#include "plugin/track/sidecar.h"
#include "plugin/track/track_file.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

constexpr const char* kInfoHelp = R"(usage: spidartrack info TRACK|FILM [--json]

Of a film: whether a haptic track is inside it or beside it, and belongs to it; then as of the track.
How long a track is, and how large: largest force and torque, steepest change, peak and mean square
of each channel in shares of the full scale (10 N, 1 N m), and how much of its energy is above 30 Hz.
)";

constexpr const char* kCheckHelp =
    R"(usage: spidartrack check TRACK [--max-force N] [--max-torque NM]

Whether a track can be felt as it is: nothing is missing at its end, all samples are numbers, none is beyond full scale, and force
and torque stay below the limits of spidarsink (3 N and 0.1 N m, unless others are given) and change
no faster than its 300 N/s. What is felt is within the limits in any case. A tenth of the energy of a
channel above 30 Hz is no motion of a film. Exit status 1, and a line for each thing that is wrong.
)";

constexpr double kMaxSlew_N_s = 300;
constexpr double kMostFast = 0.1;

std::string only_operand(const std::vector<std::string>& operands) {
  if (operands.empty()) throw UsageError("no TRACK given");
  if (operands.size() > 1) throw UsageError(operands[1] + ": one TRACK only");
  return operands[0];
}

/// A JSON string; bytes that are not UTF-8 become U+FFFD.
std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A film that was given instead of a track.
struct FilmOfTrack {
  std::string film;   ///< empty: a track was given
  std::string track;  ///< the film itself when the track is inside it
  std::string other;  ///< why the track is that of another film; empty when it is not
};

/// Throws std::runtime_error when `path` is a film without a track.
FilmOfTrack find_track(const std::string& path) {
  for (const char* end : {".flac", ".wav", ".mka", ".hjif", ".csv", ".jsonl", ".funscript"}) {
    if (ends_with(path, end)) return {{}, path, {}};
  }
  Film film;
  try {
    film = read_film(path);
  } catch (const std::runtime_error&) {
    return {{}, path, {}};  // reading the track will tell why
  }
  if (film.has_track) return {path, path, {}};
  const std::string sidecar = find_sidecar(path);
  if (sidecar.empty()) {
    throw std::runtime_error(path + ": is a film without a haptic track, inside it or beside it; " +
                             "spidartrack record makes one");
  }
  const TrackFile track = read_track_file(sidecar);
  return {path, sidecar, match_film(film, track.duration_ns, track.notes).problem};
}

void print_json(const FilmOfTrack& found, size_t count, const TrackFaults& faults,
                const TrackSummary& summary) {
  std::cout << "{";
  if (!found.film.empty()) {
    std::cout << "\"film\":" << json_string(found.film)
              << ",\"belongs\":" << (found.other.empty() ? "true" : "false") << ",";
  }
  std::cout << "\"track\":" << json_string(found.track) << ",\"samples\":" << count
            << ",\"rate_Hz\":" << kTrackRate_Hz
            << ",\"largest_force_N\":" << summary.largest_force_N
            << ",\"largest_torque_Nm\":" << summary.largest_torque_Nm
            << ",\"steepest_N_s\":" << summary.steepest_N_s
            << ",\"not_finite\":" << faults.not_finite
            << ",\"beyond_full_scale\":" << faults.beyond_full << ",\"channels\":{";
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const ChannelSummary& channel = summary.channels[i];
    std::cout << (i > 0 ? "," : "") << '"' << channel_name(i) << "\":{\"peak\":" << channel.peak
              << ",\"rms\":" << channel.rms << ",\"above_30_Hz\":" << channel.above_30_Hz << '}';
  }
  std::cout << "}}\n";
}

}  // namespace

int track_info_command(int argc, char** argv) {
  bool help = false, json = false;
  const std::vector<std::string> operands = parse_options(
      argc, argv, {json_option(json), {"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << kInfoHelp;
    return kDone;
  }
  const FilmOfTrack found = find_track(only_operand(operands));
  const std::string& path = found.track;
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(path, &condition);
  const TrackFaults& faults = condition.faults;
  const TrackSummary summary = summarise(samples);
  if (json) {
    print_json(found, samples.size(), faults, summary);
    return kDone;
  }
  if (!found.film.empty()) {
    std::cout << found.film << ": the haptic track is "
              << (found.film == path ? "inside the film" : "beside the film")
              << (found.other.empty() ? "" : ", but is that of another film: " + found.other)
              << '\n';
  }
  std::cout << path << ": " << samples.size() << " samples, "
            << static_cast<double>(samples.size()) / kTrackRate_Hz << " s\n"
            << (condition.missing.empty() ? "" : condition.missing + "\n") << "largest force "
            << summary.largest_force_N << " N, torque " << summary.largest_torque_Nm
            << " N m, steepest " << summary.steepest_N_s << " N/s\n"
            << "channel       peak        rms   above 30 Hz\n";
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const ChannelSummary& channel = summary.channels[i];
    std::cout << channel_name(i) << std::fixed << std::setprecision(4) << std::setw(16)
              << channel.peak << std::setw(11) << channel.rms << std::setw(12)
              << 100 * channel.above_30_Hz << " %\n";
  }
  return kDone;
}

int check_track_command(int argc, char** argv) {
  bool help = false;
  double max_force_N = 3, max_torque_Nm = 0.1;
  const std::vector<std::string> operands =
      parse_options(argc, argv,
                    {{"max-force", true,
                      [&](const std::string& text) {
                        max_force_N = parse_number("--max-force", text, 0, 20, "N");
                      }},
                     {"max-torque", true,
                      [&](const std::string& text) {
                        max_torque_Nm = parse_number("--max-torque", text, 0, 1, "N m");
                      }},
                     {"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << kCheckHelp;
    return kDone;
  }
  const std::string path = only_operand(operands);
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(path, &condition);
  const TrackFaults& faults = condition.faults;
  const TrackSummary summary = summarise(samples);
  int problems = 0;
  const auto problem = [&problems, &path]() -> std::ostream& {
    ++problems;
    return std::cout << path << ": ";
  };
  if (!condition.missing.empty()) problem() << condition.missing << '\n';
  if (faults.not_finite > 0) problem() << faults.not_finite << " samples are not numbers\n";
  if (faults.beyond_full > 0) problem() << faults.beyond_full << " samples are beyond full scale\n";
  if (summary.largest_force_N > max_force_N) {
    problem() << "the largest force is " << summary.largest_force_N << " N, more than "
              << max_force_N << " N\n";
  }
  if (summary.largest_torque_Nm > max_torque_Nm) {
    problem() << "the largest torque is " << summary.largest_torque_Nm << " N m, more than "
              << max_torque_Nm << " N m\n";
  }
  if (summary.steepest_N_s > kMaxSlew_N_s) {
    problem() << "the force changes by " << summary.steepest_N_s << " N/s, more than "
              << kMaxSlew_N_s << " N/s\n";
  }
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const double share = summary.channels[i].above_30_Hz;
    if (share > kMostFast) {
      problem() << 100 * share << " % of the energy of " << channel_name(i)
                << " is above 30 Hz: is it sound for ears?\n";
    }
  }
  if (problems == 0) std::cout << path << ": well\n";
  return problems == 0 ? kDone : kFailed;
}

}  // namespace spidar
