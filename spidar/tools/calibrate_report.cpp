// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/calibrate_report.h"

#include <cmath>
#include <ostream>

#include "spidar/simulation/grip_model.h"

namespace spidar {
namespace {

constexpr double kDegrees = 180 / M_PI;

std::string micrometres(double value_m) {
  return std::isfinite(value_m) ? formatted("%.2f", 1e6 * value_m) : "unknown";
}

std::string triple(const Eigen::Vector3d& value, const char* pattern) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    std::string number = formatted(pattern, value[axis]);
    if (std::stod(number) == 0) number = formatted(pattern, 0.0);  // and not -0.00
    text += (axis ? " " : "") + number;
  }
  return text;
}

const char* status_name(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::kSolved:
      return "solved";
    case CalibrationStatus::kUndetermined:
      return "undetermined";
    case CalibrationStatus::kContradiction:
      return "contradiction";
  }
  return "";
}

const char* advice(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::kSolved:
      return "";
    case CalibrationStatus::kUndetermined:
      return "This motion does not determine everything that was asked for. Move further, turn the "
             "grip about every axis as well, take longer, or ask for less with --free.\n";
    case CalibrationStatus::kContradiction:
      return "The lengths contradict each other or the profile. Check that no string slips or is "
             "off its pulley and that the profile is correct, try --free exits,scale, or start "
             "closer to the centre.\n";
  }
  return "";
}

void print_strings(std::ostream& out, int strings, const CalibrationResult& result) {
  out << "\n  string  offset mm  sd um    residual um  uncertainty um\n";
  for (int i = 0; i < strings; ++i)
    out << formatted("  %6d  %9.4f  %-7s  %11.2f  %s\n", i, 1e3 * result.home_offset_m[i],
                     micrometres(result.home_offset_sd_m[i]).c_str(),
                     1e6 * result.string_residual_m[i],
                     micrometres(result.home_offset_uncertainty_m[i]).c_str());
  out << "  sd: from noise alone, if all other numbers of the profile are exact; uncertainty: if "
         "exits\n"
         "  and points on the grip may be wrong by 1 mm, and each string's scale or stretch by 0.5 "
         "%\n";
}

void print_exits(std::ostream& out, int strings, const CalibrationResult& result) {
  out << "\n  exit    x y z mm                    sd um\n";
  for (int i = 0; i < strings; ++i)
    out << formatted("  %4d    %s  %s\n", i,
                     triple(1e3 * result.exit_m[static_cast<size_t>(i)], "%8.3f").c_str(),
                     triple(1e6 * result.exit_sd_m.col(i), "%6.1f").c_str());
}

}  // namespace

void print_result(std::ostream& out, const Profile& profile, const CalibrationResult& result,
                  const std::string& how) {
  const int strings = profile.geometry.count;
  out << profile.name << ": " << how << ", " << result.samples
      << " samples: " << status_name(result.status) << '\n'
      << "  counters zero at  " << triple(1e3 * result.cleared_at.position_m, "%.2f")
      << " mm, turned by "
      << triple(kDegrees * rotation_vector(result.cleared_at.orientation), "%.2f") << " deg\n"
      << "  residual          " << formatted("%.2f um rms", 1e6 * result.residual_m)
      << formatted(", noise of a length %.2f um", 1e6 * result.length_noise_m)
      << formatted(", outliers %.1f %%\n", 100 * result.outlier_share) << "  grip moved        "
      << triple(1e3 * result.moved_m, "%.1f") << " mm each way, turned "
      << triple(kDegrees * result.turned_rad, "%.1f") << " deg\n";
  print_strings(out, strings, result);
  if (result.estimated.free_scale)
    out << formatted("\n  scale   %.6f, sd %.6f\n", result.scale, result.scale_sd);
  if (result.estimated.free_exits) print_exits(out, strings, result);
  if (!result.undetermined.empty()) {
    out << "\n  not determined to " << micrometres(kMaxCalibrationSd_m) << " um:\n";
    for (const UndeterminedCombination& one : result.undetermined)
      out << "    sd " << micrometres(one.sd_m) << " um: " << one.text << '\n';
  }
  if (result.status != CalibrationStatus::kSolved) out << '\n' << advice(result.status);
}

Json result_json(const Profile& profile, const CalibrationResult& result, const std::string& how) {
  const int strings = profile.geometry.count;
  Json json{
      {"profile", profile.name},
      {"how", how},
      {"status", status_name(result.status)},
      {"samples", result.samples},
      {"residual_m", result.residual_m},
      {"length_noise_m", result.length_noise_m},
      {"outlier_share", result.outlier_share},
      {"home_offset_m", to_json(result.home_offset_m.head(strings))},
      {"home_offset_sd_m", to_json(result.home_offset_sd_m.head(strings))},
      {"home_offset_uncertainty_m", to_json(result.home_offset_uncertainty_m.head(strings))},
      {"string_residual_m", to_json(result.string_residual_m.head(strings))},
      {"cleared_at_m", to_json(result.cleared_at.position_m)},
      {"cleared_at_rad", to_json(rotation_vector(result.cleared_at.orientation))},
      {"moved_m", to_json(result.moved_m)},
      {"turned_rad", to_json(result.turned_rad)},
  };
  if (result.estimated.free_scale)
    json.update({{"scale", result.scale}, {"scale_sd", result.scale_sd}});
  if (result.estimated.free_exits) {
    for (int i = 0; i < strings; ++i) {
      json["exit_m"].push_back(to_json(result.exit_m[static_cast<size_t>(i)]));
      json["exit_sd_m"].push_back(to_json(result.exit_sd_m.col(i)));
    }
  }
  json["undetermined"] = Json::array();
  for (const UndeterminedCombination& one : result.undetermined)
    json["undetermined"].push_back(Json{{"sd_m", one.sd_m}, {"combination", one.text}});
  return json;
}

}  // namespace spidar
