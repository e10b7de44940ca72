// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <string>
#include <utility>

#include "core/force/motion_rendering.h"
#include "core/json_text.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tracks/track_summary.h"
#include "spidar/text.h"
#include "spidar/tools/command_line.h"

namespace spidar::tools {

namespace fs = std::filesystem;

namespace {

std::pair<TrackCondition, tracks::Summary> summarise(const std::string& path) {
  tracks::Summariser summariser;
  TrackCondition found =
      read_track(path, [&summariser](const TrackSample& sample) { summariser.add(sample); });
  return {std::move(found), summariser.summary()};
}

constexpr double kMaxSlew_N_s = 300;

void print_json(const TrackCondition& found, const tracks::Summary& summary) {
  Json info;
  if (!found.film.empty()) info = {{"film", found.film}, {"belongs", found.other.empty()}};
  info["track"] = found.track;
  info["samples"] = summary.samples;
  info["rate_Hz"] = kTrackRate_Hz;
  info["felt"] = summary.felt;
  info["largest_force_N"] = summary.largest_force_N;
  info["largest_torque_Nm"] = summary.largest_torque_Nm;
  info["steepest_N_s"] = summary.steepest_N_s;
  info["not_finite"] = found.faults.not_finite;
  info["beyond_full_scale"] = found.faults.beyond_full;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const tracks::ChannelSummary& channel = summary.channels[i];
    info["channels"][tracks::channel_name(i)] = {{"peak", channel.peak},
                                                 {"rms", channel.rms},
                                                 {"above_30_Hz", channel.above_30_Hz},
                                                 {"full_scale", tracks::full_scale(i)}};
  }
  std::cout << json_text(info) << '\n';
}

}  // namespace

int print_info(const std::string& track_or_film, bool as_json) {
  const auto [found, summary] = summarise(track_or_film);
  if (as_json) {
    print_json(found, summary);
    return kDone;
  }
  if (!found.film.empty()) {
    const fs::path at = fs::path(found.track).parent_path();
    std::cout << found.film << ": the haptic track is "
              << (found.film == found.track                  ? "inside the film"
                  : at == fs::path(found.film).parent_path() ? "beside the film"
                                                             : "in " + at.string())
              << (found.other.empty() ? "" : ", but is that of another film: " + found.other)
              << '\n';
  }
  std::cout << found.track << ": " << summary.samples << " samples, "
            << static_cast<double>(summary.samples) / kTrackRate_Hz << " s\n"
            << (found.missing.empty() ? "" : found.missing + "\n");
  for (const std::string& line : found.about) std::cout << line << '\n';
  std::cout << "largest force " << summary.largest_force_N << " N, torque "
            << summary.largest_torque_Nm << " N m, steepest " << summary.steepest_N_s << " N/s\n"
            << "channel        peak         rms       above 30 Hz\n";
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const tracks::ChannelSummary& channel = summary.channels[i];
    std::cout << tracks::channel_name(i) << std::fixed << std::setprecision(4) << std::setw(17)
              << tracks::full_scale(i) * channel.peak << std::setw(12)
              << tracks::full_scale(i) * channel.rms << std::left << std::setw(4)
              << tracks::channel_unit(i) << std::right << std::setw(12) << 100 * channel.above_30_Hz
              << " %\n";
  }
  return kDone;
}

int check_track(const std::string& track, double max_force_N, double max_torque_Nm) {
  const auto [found, summary] = summarise(track);
  const std::string& path = found.track;
  const tracks::Faults& faults = found.faults;
  int count = 0;
  const auto fault = [&count, &path]() -> std::ostream& {
    ++count;
    return std::cout << path << ": ";
  };
  if (!found.other.empty()) fault() << "is that of another film: " << found.other << '\n';
  if (!found.missing.empty()) fault() << found.missing << '\n';
  if (faults.not_finite > 0) fault() << faults.not_finite << " samples are not numbers\n";
  if (faults.beyond_full > 0) fault() << faults.beyond_full << " samples are beyond full scale\n";
  if (summary.largest_force_N > max_force_N) {
    fault() << "the largest force is " << summary.largest_force_N << " N, more than " << max_force_N
            << " N\n";
  }
  if (summary.largest_torque_Nm > max_torque_Nm) {
    fault() << "the largest torque is " << summary.largest_torque_Nm << " N m, more than "
            << max_torque_Nm << " N m\n";
  }
  if (summary.steepest_N_s > kMaxSlew_N_s) {
    fault() << "the force changes by " << summary.steepest_N_s << " N/s, more than " << kMaxSlew_N_s
            << " N/s\n";
  }
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const double fraction = summary.channels[i].above_30_Hz;
    if (fraction > tracks::kMaxFast) {
      fault() << 100 * fraction << " % of the energy of " << tracks::channel_name(i)
              << " is above 30 Hz: is it sound for ears?\n";
    }
  }
  const bool is_silent = summary.felt == 0;
  if (count == 0 && !is_silent) std::cout << path << ": ok\n";
  const std::string least =
      as_text(kFeltForce_N) + " N and " + as_text(kFeltForce_N * kTorqueArm_m) + " N m";
  std::cout << path << ": " << std::lround(100 * summary.felt) << " % of it is felt"
            << (is_silent          ? ": force and torque are below " + least
                : summary.felt < 1 ? "; in the rest force and torque are below " + least
                                   : "")
            << '\n';
  return count == 0 && !is_silent ? kDone : kFailed;
}

}  // namespace spidar::tools
