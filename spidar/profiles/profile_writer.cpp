// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <locale>
#include <sstream>

#include "core/number_text.h"
#include "spidar/part_file.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/profiles/toml.h"

namespace spidar {
namespace {

std::string number(double value) {
  return std::string(NumberText(value + 0.0));  // the sum turns −0 into 0
}

/// Writes `value(i)` for each of `count` strings, on one line.
template <typename Value>
std::string listed(size_t count, Value value) {
  std::string text = "[";
  for (size_t i = 0; i < count; ++i) text += (i ? ", " : "") + number(value(i));
  return text + "]";
}

template <typename Points>
void write_points(std::ostream& out, const char* key, const Points& points, size_t count) {
  out << key << " = [\n";
  for (size_t i = 0; i < count; ++i) {
    out << "  "
        << listed(3, [&](size_t axis) { return points[i][static_cast<Eigen::Index>(axis)]; })
        << ",\n";
  }
  out << "]\n";
}

void write_text(std::ostream& out, const char* key, const std::string& text) {
  out << key << " = " << toml::value<std::string>(text) << '\n';
}

const char* evidence_name(Evidence evidence) {
  switch (evidence) {
    case Evidence::kPublished:
      return "published";
    case Evidence::kInferred:
      return "inferred";
    case Evidence::kContradicted:
      return "contradicted";
    case Evidence::kMeasured:
      return "measured";
  }
  return "inferred";
}

void write_strings(std::ostream& out, const Profile& profile) {
  out << "\n[strings]\n";
  const auto write = [&](const char* key, auto member) {
    out << key << " = " << listed(static_cast<size_t>(profile.geometry.count), [&](size_t i) {
      return profile.drives[i].*member;
    }) << '\n';
  };
  write("min_tension_N", &StringDrive::min_tension_N);
  write("max_tension_N", &StringDrive::max_tension_N);
  write("newtons_per_volt", &StringDrive::newtons_per_volt);
  write("metres_per_count", &StringDrive::metres_per_count);
  write("continuous_tension_N", &StringDrive::continuous_tension_N);
  write("heating_time_s", &StringDrive::heating_time_s);
  write("motor_sign", &StringDrive::motor_sign);
  write("encoder_sign", &StringDrive::encoder_sign);
  write("home_offset_m", &StringDrive::home_offset_m);
}

}  // namespace

std::string profile_text(const Profile& profile) {
  const StringGeometry& geometry = profile.geometry;
  std::ostringstream out;
  out.imbue(std::locale::classic());
  write_text(out, "description", profile.description);
  write_text(out, "board", profile.board);
  out << "dac_bits = " << profile.dac_bits << "\ndac_max_V = " << number(profile.dac_max_V) << "\n";
  if (profile.drive_lag_known) out << "drive_lag_s = " << number(profile.drive_lag_s) << "\n";
  out << "\n[geometry]\nframe = \"right-handed\"  # x right, y up, z towards the user\n"
      << "unit = \"m\"\n";
  write_points(out, "exit", geometry.exit_m, static_cast<size_t>(geometry.count));
  write_points(out, "grip", geometry.grip_m, static_cast<size_t>(geometry.count));
  write_strings(out, profile);
  if (const Eigen::Vector3d& moments = profile.moment_of_inertia_kg_m2; !moments.isZero(0)) {
    out << "\n[grip]\nmoment_of_inertia_kg_m2 = "
        << listed(3, [&](size_t i) { return moments[static_cast<Eigen::Index>(i)]; }) << '\n';
  }
  if (profile.calibration) {
    out << "\n[calibration]\nsamples = " << profile.calibration->samples
        << "\nresidual_m = " << number(profile.calibration->residual_m) << '\n';
  }
  for (const Provenance& row : profile.provenance) {
    out << "\n[[source]]\nfields = [\"" << row.field << "\"]\n";
    write_text(out, "source", row.source);
    write_text(out, "evidence", evidence_name(row.evidence));
    if (!row.note.empty()) write_text(out, "note", row.note);
  }
  return out.str();
}

void save_profile(const Profile& profile, const std::string& path) {
  replace_file(path, profile_text(profile));
}

}  // namespace spidar
