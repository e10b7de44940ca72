// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/profiles/profile_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>

#include "spidar/profiles/profile.h"
#include "spidar/profiles/toml_field.h"

namespace spidar {
namespace {

using Values = std::array<double, kMaxStrings>;
using Signs = std::array<int, kMaxStrings>;

constexpr int kMinStrings = 6;  // fewer cannot hold six degrees of freedom
// Larger values are a mistaken unit: the largest SPIDAR fills a room, and a count is some
// micrometres.
constexpr double kMaxCoordinate_m = 5.0;
constexpr double kMinLength_m = 1e-3;
constexpr double kMin_m_per_count = 1e-8;
constexpr double kMax_m_per_count = 1e-3;
constexpr double kMaxDriveLag_s = 0.1;

void check_length(const TomlField& field, int count) {
  if (field.size() != static_cast<size_t>(count))
    field.fail("has " + shown(field.size()) + " entries, must have " + shown(count) +
               ", one for each string of geometry.exit");
}

Eigen::Vector3d point(const TomlField& field, const Eigen::Array3d& scale) {
  if (field.size() != 3)
    field.fail("has " + shown(field.size()) + " coordinates, must have three: [x, y, z]");
  const Eigen::Vector3d point_m =
      Eigen::Array3d(field[0].number(), field[1].number(), field[2].number()) * scale;
  if (!(point_m.cwiseAbs().maxCoeff() <= kMaxCoordinate_m))
    field.fail("is more than " + shown(kMaxCoordinate_m) +
               " m from the centre; check it and geometry.unit");
  return point_m;
}

StringGeometry read_geometry(const TomlField& in) {
  in.allow_only({"frame", "unit", "exit", "grip"});
  const double scale = in["unit"].one_of({"m", "mm"}) == "mm" ? 1e-3 : 1.0;
  const bool left_handed = in["frame"].one_of({"left-handed", "right-handed"}) == "left-handed";
  const Eigen::Array3d to_D(scale, scale, left_handed ? -scale : scale);

  const TomlField exits = in["exit"];
  if (exits.size() < kMinStrings || exits.size() > kMaxStrings)
    exits.fail("has " + shown(exits.size()) + " strings, must have " + shown(kMinStrings) + " to " +
               shown(kMaxStrings));
  StringGeometry geometry;
  geometry.count = static_cast<int>(exits.size());
  const TomlField grips = in["grip"];
  check_length(grips, geometry.count);
  for (size_t i = 0; i < exits.size(); ++i) {
    geometry.exit_m[i] = point(exits[i], to_D);
    geometry.grip_m[i] = point(grips[i], to_D);
    if ((geometry.exit_m[i] - geometry.grip_m[i]).norm() < kMinLength_m)
      exits[i].fail("is less than " + shown(kMinLength_m) +
                    " m from its grip point: the string would have no direction; check both and "
                    "geometry.unit");
  }
  return geometry;
}

/// One number for all strings, or an array with one for each; all above zero.
Values per_string(const TomlField& field, int count) {
  Values values{};
  if (!field.is_array()) {
    values.fill(field.positive());
    return values;
  }
  check_length(field, count);
  for (size_t i = 0; i < field.size(); ++i) values[i] = field[i].positive();
  return values;
}

Signs signs(const TomlField& field, int count) {
  check_length(field, count);
  Signs values{};
  for (size_t i = 0; i < field.size(); ++i) {
    values[i] = field[i].integer(-1, 1);
    if (values[i] == 0) field[i].fail("is 0, must be 1 or -1");
  }
  return values;
}

/// Zero when it is missing.
Values home_offsets(const TomlField& strings, const StringGeometry& geometry) {
  Values values{};
  if (!strings.has("home_offset_m")) return values;
  const TomlField field = strings["home_offset_m"];
  check_length(field, geometry.count);
  const StringVector home_m = string_lengths_m(geometry, {});
  for (size_t i = 0; i < field.size(); ++i) {
    values[i] = field[i].number();
    const double length_m = home_m[static_cast<Eigen::Index>(i)] + values[i];
    if (!(length_m > 0 && length_m <= 2 * kMaxCoordinate_m))
      field[i].fail("is " + shown(values[i]) + ": with the length at the centre the string has " +
                    shown(length_m) + " m at zero count, must be above zero and at most " +
                    shown(2 * kMaxCoordinate_m) + " m; the unit is metres");
  }
  return values;
}

void check_drive(const TomlField& in, size_t i, const StringDrive& drive, double dac_max_V) {
  const std::string string = "string " + shown(i) + ": ";
  if (!(drive.min_tension_N < drive.max_tension_N))
    in["max_tension_N"].fail(string + shown(drive.max_tension_N) +
                             " N must be above min_tension_N, which is " +
                             shown(drive.min_tension_N) + " N");
  const double needed_V = drive.max_tension_N / drive.newtons_per_volt;
  if (!(needed_V <= dac_max_V))
    in["max_tension_N"].fail(string + shown(drive.max_tension_N) + " N needs " + shown(needed_V) +
                             " V, but dac_max_V is " + shown(dac_max_V) +
                             "; lower it, or correct newtons_per_volt or dac_max_V");
  if (!(drive.min_tension_N <= drive.continuous_tension_N &&
        drive.continuous_tension_N <= drive.max_tension_N))
    in["continuous_tension_N"].fail(string + shown(drive.continuous_tension_N) +
                                    " N must be from min_tension_N, which is " +
                                    shown(drive.min_tension_N) + " N, to max_tension_N, which is " +
                                    shown(drive.max_tension_N) + " N");
  if (drive.metres_per_count < kMin_m_per_count || drive.metres_per_count > kMax_m_per_count)
    in["metres_per_count"].fail(string + shown(drive.metres_per_count) + " must be from " +
                                shown(kMin_m_per_count) + " to " + shown(kMax_m_per_count) +
                                "; the unit is metres");
}

void read_strings(const TomlField& in, Profile& profile) {
  in.allow_only({"min_tension_N", "max_tension_N", "newtons_per_volt", "metres_per_count",
                 "continuous_tension_N", "heating_time_s", "motor_sign", "encoder_sign",
                 "home_offset_m"});
  const int count = profile.geometry.count;
  const auto read = [&](const char* key, double StringDrive::*member) {
    const Values values = per_string(in[key], count);
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) profile.drives[i].*member = values[i];
  };
  read("min_tension_N", &StringDrive::min_tension_N);
  read("max_tension_N", &StringDrive::max_tension_N);
  read("newtons_per_volt", &StringDrive::newtons_per_volt);
  read("metres_per_count", &StringDrive::metres_per_count);
  if (in.has("heating_time_s")) read("heating_time_s", &StringDrive::heating_time_s);
  for (StringDrive& drive : profile.drives)
    drive.continuous_tension_N = std::max(drive.min_tension_N, drive.max_tension_N / 2);
  if (in.has("continuous_tension_N"))
    read("continuous_tension_N", &StringDrive::continuous_tension_N);
  const Signs motor_sign = signs(in["motor_sign"], count);
  const Signs encoder_sign = signs(in["encoder_sign"], count);
  const Values home_offset_m = home_offsets(in, profile.geometry);
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    StringDrive& drive = profile.drives[i];
    drive.motor_sign = motor_sign[i];
    drive.encoder_sign = encoder_sign[i];
    drive.home_offset_m = home_offset_m[i];
    check_drive(in, i, drive, profile.dac_max_V);
  }
}

Evidence read_evidence(const TomlField& field) {
  const std::string evidence = field.one_of({"published", "inferred", "contradicted", "measured"});
  return evidence == "published"      ? Evidence::kPublished
         : evidence == "inferred"     ? Evidence::kInferred
         : evidence == "contradicted" ? Evidence::kContradicted
                                      : Evidence::kMeasured;
}

std::vector<Provenance> read_sources(const TomlField& sources) {
  std::vector<Provenance> provenance;
  for (size_t i = 0; i < sources.size(); ++i) {
    const TomlField in = sources[i];
    in.allow_only({"fields", "source", "evidence", "note"});
    Provenance row;
    row.source = in["source"].string();
    row.evidence = read_evidence(in["evidence"]);
    if (in.has("note")) row.note = in["note"].string();
    const TomlField fields = in["fields"];
    for (size_t k = 0; k < fields.size(); ++k) {
      row.field = fields[k].one_of({"geometry", "frame", "min_tension_N", "max_tension_N",
                                    "newtons_per_volt", "metres_per_count", "continuous_tension_N",
                                    "heating_time_s", "motor_sign", "encoder_sign", "home_offset_m",
                                    "board", "dac_bits", "dac_max_V", "drive_lag_s"});
      provenance.push_back(row);
    }
  }
  return provenance;
}

double not_negative(const TomlField& field) {
  const double value = field.number();
  if (value < 0) field.fail("is " + shown(value) + ", must not be negative");
  return value;
}

double drive_lag_s(const TomlField& field) {
  const double lag_s = not_negative(field);
  if (!(lag_s <= kMaxDriveLag_s))
    field.fail("is " + shown(lag_s) + ", must be at most " + shown(kMaxDriveLag_s) +
               "; the unit is seconds");
  return lag_s;
}

CalibrationRecord read_calibration(const TomlField& in) {
  in.allow_only({"samples", "residual_m"});
  return {in["samples"].integer(1, std::numeric_limits<int>::max()),
          not_negative(in["residual_m"])};
}

}  // namespace

Profile parse_profile(const std::string& text, const std::string& path, const std::string& name) {
  toml::table document;
  try {
    document = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    TomlField::fail(path, error.source().begin.line, "",
                    "not TOML: " + std::string(error.description()));
  }
  const TomlField root(path, document);
  root.allow_only({"description", "board", "dac_bits", "dac_max_V", "drive_lag_s", "geometry",
                   "strings", "calibration", "source"});
  Profile profile;
  profile.name = name;
  profile.description = root["description"].string();
  profile.board = root["board"].one_of({"usb-sh4", "usb-simple", "uart", "ahs", "unknown"});
  profile.dac_bits = root["dac_bits"].integer(8, 24);
  profile.dac_max_V = root["dac_max_V"].positive();
  profile.drive_lag_known = root.has("drive_lag_s");
  if (profile.drive_lag_known) profile.drive_lag_s = drive_lag_s(root["drive_lag_s"]);
  profile.geometry = read_geometry(root["geometry"]);
  read_strings(root["strings"], profile);
  if (root.has("calibration")) profile.calibration = read_calibration(root["calibration"]);
  if (root.has("source")) profile.provenance = read_sources(root["source"]);
  return profile;
}

namespace {

bool write_all(int file, const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<size_t>(written);
  }
  return fsync(file) == 0;
}

}  // namespace

void replace_file(const std::filesystem::path& file, const std::string& text) {
  // Its name does not depend on that of the file, which may be as long as the system allows.
  const std::string part = file.parent_path() / (".spidar-" + std::to_string(getpid()) + ".part");
  const auto fail = [&] {
    throw ProfileError(file.string() + ": cannot be written: " + std::strerror(errno));
  };
  struct stat named {};
  if (lstat(file.c_str(), &named) == 0 && !S_ISREG(named.st_mode) && !S_ISLNK(named.st_mode))
    throw ProfileError(file.string() + ": cannot be written: it is no regular file");
  const int opened = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (opened < 0) fail();
  const bool written = write_all(opened, text);
  int error = written ? 0 : errno;
  if (close(opened) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(part.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return;
  unlink(part.c_str());
  errno = error;
  fail();
}

}  // namespace spidar
