// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/force/felt_force.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tools/track_summary.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_file.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

constexpr double kMaxSlew_N_s = 300;
constexpr double kMostFast = 0.1;

/// A film that was given instead of a track.
struct FilmOfTrack {
  std::string film;   ///< empty: a track was given
  std::string track;  ///< the film itself when the track is inside it
  std::string other;  ///< why the track is that of another film; empty when it is not
};

/// Throws std::runtime_error when `path` is a film without a track.
FilmOfTrack find_track(const std::string& path) {
  for (const char* end : {".flac", ".wav", ".mka", ".hjif", ".funscript"}) {
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
  nlohmann::ordered_json info;
  if (!found.film.empty()) info = {{"film", found.film}, {"belongs", found.other.empty()}};
  info["track"] = found.track;
  info["samples"] = count;
  info["rate_Hz"] = kTrackRate_Hz;
  info["felt"] = summary.felt;
  info["largest_force_N"] = summary.largest_force_N;
  info["largest_torque_Nm"] = summary.largest_torque_Nm;
  info["steepest_N_s"] = summary.steepest_N_s;
  info["not_finite"] = faults.not_finite;
  info["beyond_full_scale"] = faults.beyond_full;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const ChannelSummary& channel = summary.channels[i];
    info["channels"][channel_name(i)] = {
        {"peak", channel.peak}, {"rms", channel.rms}, {"above_30_Hz", channel.above_30_Hz}};
  }
  // File names are bytes, and JSON is UTF-8.
  std::cout << info.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

}  // namespace

int print_info(const InfoOptions& options) {
  const FilmOfTrack found = find_track(options.path);
  const std::string& path = found.track;
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(path, &condition);
  const TrackFaults& faults = condition.faults;
  const TrackSummary summary = summarise(samples);
  if (options.json) {
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

int check_track(const CheckOptions& options) {
  const std::string& path = options.track;
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
  if (summary.largest_force_N > options.max_force_N) {
    problem() << "the largest force is " << summary.largest_force_N << " N, more than "
              << options.max_force_N << " N\n";
  }
  if (summary.largest_torque_Nm > options.max_torque_Nm) {
    problem() << "the largest torque is " << summary.largest_torque_Nm << " N m, more than "
              << options.max_torque_Nm << " N m\n";
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
  if (problems == 0) std::cout << path << ": ok\n";
  std::cout << path << ": " << std::lround(100 * summary.felt) << " % of it is felt"
            << (summary.felt < 1 ? "; in the rest the force is below " + shown(kFeltForce_N) + " N"
                                 : "")
            << '\n';
  return problems == 0 ? kDone : kFailed;
}

}  // namespace spidar
