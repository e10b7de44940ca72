// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Accuracy of the calibration as a function of the time for which the grip is moved. Uses the
// simulated device, whose counters are cleared anywhere within ±4 cm and 1 rad of the centre and
// whose strings are off by up to 3 mm, with encoders of 15 µm and noise added to the counts. The
// optional argument is the number of repetitions of each case.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "spidar/calibration/count_recorder.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/simulation/simulated_device.h"
#include "tests/spidar/calibration_samples.h"

namespace {

using namespace spidar;
using namespace spidar::test;

constexpr double kMetresPerCount = 1.5e-5;

Profile encoders_of_15_um(Profile profile) {
  for (StringDrive& drive : profile.drives) drive.metres_per_count = kMetresPerCount;
  return profile;
}

Profile unknown_device(const Profile& profile, const CalibrationSettings& settings,
                       Random& random) {
  Profile device = profile;
  const double scale = settings.free_scale ? 1 + uniform(random, 0.005) : 1;
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    if (settings.free_exits) device.geometry.exit_m[k] += uniform_vector(random, 1e-3);
    device.drives[k].metres_per_count *= scale;
  }
  clear_counters_at(wrong_start(random, 0.04, 1.0), device);
  add_to_offsets(random, 3e-3, device);
  return device;
}

CountSamples record(const Profile& device_profile, double seconds, double noise, Random& random) {
  SimulatedDevice device(device_profile, SimulatedDevice::Time::kFixedStep);
  const double phase_rad = uniform(random, M_PI);
  CountSamples counts = record_counts(device, device_profile, {seconds, 0.002}, [&](double time_s) {
    device.set_hand(hand_in_motion(device_profile.geometry, time_s, phase_rad));
    return true;
  });
  std::normal_distribution<double> normal;
  return counts.unaryExpr([&](double count) { return std::round(count + noise * normal(random)); });
}

void run_case(const Profile& profile, const CalibrationSettings& settings, double seconds,
              double noise, int repetitions) {
  double error_um2 = 0, predicted_um2 = 0, scale_error2 = 0, scale_predicted2 = 0, cpu_s = 0;
  int solved = 0;
  for (int n = 0; n < repetitions; ++n) {
    Random random(static_cast<unsigned>(n + 1));
    const Profile device = unknown_device(profile, settings, random);
    const CountSamples counts = record(device, seconds, noise, random);
    const int64_t begin_ns = monotonic_now_ns();
    const CalibrationResult result = calibrate(profile, counts, settings);
    cpu_s += 1e-9 * static_cast<double>(monotonic_now_ns() - begin_ns);
    solved += result.status == CalibrationStatus::kSolved;
    const double strings = profile.geometry.count;
    error_um2 += 1e12 * zero_length_errors_m(profile, device, result).squaredNorm() / strings;
    predicted_um2 += 1e12 * result.home_offset_sd_m.squaredNorm() / strings;
    const double scale = device.drives[0].metres_per_count / profile.drives[0].metres_per_count;
    scale_error2 += std::pow(result.scale - scale, 2);
    scale_predicted2 += std::pow(result.scale_sd, 2);
  }
  std::printf("| %4.0f | %4.0f | %8.2f | %8.2f |", seconds, noise,
              std::sqrt(error_um2 / repetitions), std::sqrt(predicted_um2 / repetitions));
  if (settings.free_scale)
    std::printf(" %7.0f | %7.0f |", 1e6 * std::sqrt(scale_error2 / repetitions),
                1e6 * std::sqrt(scale_predicted2 / repetitions));
  std::printf(" %2d/%d | %.2f |\n", solved, repetitions, cpu_s / repetitions);
  std::fflush(stdout);
}

/// Counters cleared off the centre by up to `share` of the strings' mean length an axis, turned by
/// up to 80 degrees; ten seconds of motion.
void run_wrong_starts(const char* name, double share, int repetitions) {
  const Profile profile = load_profile(name);
  const int strings = profile.geometry.count;
  const double reach_m = share * string_lengths_m(profile.geometry, {}).head(strings).mean();
  int recovered = 0, wrong = 0;
  for (int n = 0; n < repetitions; ++n) {
    Random random(static_cast<unsigned>(n + 1));
    Profile device = profile;
    clear_counters_at(wrong_start(random, reach_m, 80 * M_PI / 180), device);
    const CalibrationResult result =
        calibrate(profile, moved_counts(device, 1000, 0.01, random, 0));
    const double error_m = zero_length_errors_m(profile, device, result).norm();
    const bool solved = result.status == CalibrationStatus::kSolved;
    const bool right = error_m < 10 * result.home_offset_sd_m.norm();
    recovered += solved && right;
    wrong += solved && !right;
  }
  std::printf("| %-16s | %2.0f | %d/%d | %d |\n", name, 1e3 * reach_m, recovered, repetitions,
              wrong);
  std::fflush(stdout);
}

struct Motion {
  const char* name;
  Eigen::Array3d move_m, turn_rad;
};

/// How many combinations ten seconds of a motion leave undetermined.
void run_motion(const Profile& profile, const Motion& motion) {
  const Eigen::Array3d move_Hz(0.437, 0.361, 0.281), turn_Hz(0.251, 0.319, 0.397);
  Random random(1);
  const CountSamples counts = counts_of(profile, 1000, 0.01, random, 0, [&](double time_s) {
    Pose pose;
    pose.position_m = motion.move_m * (2 * M_PI * move_Hz * time_s).sin();
    const Eigen::Vector3d turn = motion.turn_rad * (2 * M_PI * turn_Hz * time_s).sin();
    if (turn.norm() > 0) pose.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
    return pose;
  });
  std::printf("| %-22s |", motion.name);
  for (const CalibrationSettings settings :
       {CalibrationSettings{}, {false, true}, {true, false}, {true, true}}) {
    const CalibrationResult result = calibrate(profile, counts, settings);
    std::printf(" %2zu |", result.undetermined.size());
    std::fflush(stdout);
  }
  std::printf("\n");
}

void run_motions() {
  const double m = 0.03, r = 0.5;
  std::printf(
      "\nCombinations that a motion leaves undetermined (sd above 50 um), %s, 10 s, rounding "
      "only:\n\n| motion | offsets (8) | and scale (9) | and exits (26) | and both (27) |\n"
      "|---|---|---|---|---|\n",
      kDefaultProfile);
  for (const Motion& motion : {Motion{"held still", {0, 0, 0}, {0, 0, 0}},
                               {"along x", {m, 0, 0}, {0, 0, 0}},
                               {"along y", {0, m, 0}, {0, 0, 0}},
                               {"along z", {0, 0, m}, {0, 0, 0}},
                               {"along x, y, z", {m, m, m}, {0, 0, 0}},
                               {"about x", {0, 0, 0}, {r, 0, 0}},
                               {"about y", {0, 0, 0}, {0, r, 0}},
                               {"about z", {0, 0, 0}, {0, 0, r}},
                               {"about x, y, z", {0, 0, 0}, {r, r, r}},
                               {"along and about all", {m, m, m}, {r, r, r}}})
    run_motion(load_profile(kDefaultProfile), motion);
}

void run_accuracy(int repetitions) {
  const Profile profile = encoders_of_15_um(load_profile(kDefaultProfile));
  std::printf(
      "%s, offsets:\n\n| s | noise, counts | error, um | predicted, um | solved | s to "
      "solve |\n|---|---|---|---|---|---|\n",
      profile.name.c_str());
  for (const double noise : {0.0, 1.0, 3.0})
    for (const double seconds : {1.0, 2.0, 5.0, 10.0, 20.0, 40.0})
      run_case(profile, {}, seconds, noise, repetitions);
  std::printf(
      "\n%s, offsets, exits and scale:\n\n| s | noise, counts | error, um | predicted, um | "
      "scale error, ppm | predicted, ppm | solved | s to solve |\n"
      "|---|---|---|---|---|---|---|---|\n",
      profile.name.c_str());
  for (const double noise : {0.0, 1.0, 3.0})
    for (const double seconds : {10.0, 20.0, 40.0, 80.0})
      run_case(profile, {true, true}, seconds, noise, repetitions);
}

}  // namespace

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 4;
  if (repetitions < 1) {
    std::fprintf(stderr, "bench_calibration: \"%s\" is not a number of repetitions above 0\n",
                 argv[1]);
    return 2;
  }
  try {
    run_accuracy(repetitions);
    std::printf(
        "\nWrong starts, turned by up to 80 degrees:\n\n| profile | off by up to, mm an axis | "
        "recovered | solved but wrong |\n|---|---|---|---|\n");
    for (const char* name :
         {"spidar-gcc", "spidar-g", "spidar-g6x3-v2-r", "spidar-g6c", "spidar-isotropic"})
      run_wrong_starts(name, 0.45, 25 * repetitions);
    run_motions();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_calibration: %s\n", error.what());
    return 1;
  }
}
