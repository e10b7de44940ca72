// How long a grip must be moved for how exact a calibration: the simulated device, its counters
// cleared anywhere within ±4 cm and 1 rad of the centre and its strings off by up to 3 mm, with
// encoders of 15 µm and noise added to the counts. The optional argument is how often each case is
// repeated.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "spidar/count_recorder.h"
#include "spidar/monotonic.h"
#include "spidar/simulated_device.h"
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

void run(int repetitions) {
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
    run(repetitions);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_calibration: %s\n", error.what());
    return 1;
  }
}
