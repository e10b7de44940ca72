#include "spidar/profile_writer.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include <toml++/toml.h>

namespace spidar {
namespace {

namespace fs = std::filesystem;

toml::array to_array(const Eigen::Vector3d& point) {
  return toml::array{point.x(), point.y(), point.z()};
}

/// One line for each string.
template <typename Points>
void write_points(std::ostream& out, const char* key, const Points& points, int count) {
  out << key << " = [\n";
  for (size_t i = 0; i < static_cast<size_t>(count); ++i)
    out << "  " << to_array(points[i]) << ",\n";
  out << "]\n";
}

template <typename Value>
void write(std::ostream& out, const char* key, const Value& value) {
  out << key << " = " << toml::value<Value>(value) << '\n';
}

template <typename Value>
void write_drives(std::ostream& out, const Profile& profile, Value StringDrive::*member) {
  toml::array values;
  for (size_t i = 0; i < static_cast<size_t>(profile.geometry.count); ++i)
    values.push_back(profile.drives[i].*member);
  out << values << '\n';
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
  const auto numbers = [&](const char* key, auto member) {
    out << key << " = ";
    write_drives(out, profile, member);
  };
  numbers("min_tension_N", &StringDrive::min_tension_N);
  numbers("max_tension_N", &StringDrive::max_tension_N);
  numbers("newtons_per_volt", &StringDrive::newtons_per_volt);
  numbers("metres_per_count", &StringDrive::metres_per_count);
  numbers("motor_sign", &StringDrive::motor_sign);
  numbers("encoder_sign", &StringDrive::encoder_sign);
  numbers("home_offset_m", &StringDrive::home_offset_m);
}

void write_calibration(std::ostream& out, const CalibrationRecord& record) {
  out << "\n[calibration]  # standard deviations\n";
  write<int64_t>(out, "samples", record.samples);
  write(out, "residual_m", record.residual_m);
  toml::array offsets;
  for (const double sd : record.home_offset_sd_m) offsets.push_back(sd);
  out << "home_offset_sd_m = " << offsets << '\n';
  if (record.scale_sd) write(out, "scale_sd", *record.scale_sd);
  if (!record.exit_sd_m.empty())
    write_points(out, "exit_sd_m", record.exit_sd_m, static_cast<int>(record.exit_sd_m.size()));
}

}  // namespace

std::string profile_text(const Profile& profile) {
  std::ostringstream out;
  write(out, "description", profile.description);
  write(out, "board", profile.board);
  write<int64_t>(out, "dac_bits", profile.dac_bits);
  write(out, "dac_max_V", profile.dac_max_V);
  out << "\n[geometry]\nframe = \"right-handed\"  # x right, y up, z towards the user\nunit = "
         "\"m\"\n";
  write_points(out, "exit", profile.geometry.exit_m, profile.geometry.count);
  write_points(out, "grip", profile.geometry.grip_m, profile.geometry.count);
  write_strings(out, profile);
  if (profile.calibration) write_calibration(out, *profile.calibration);
  for (const Provenance& row : profile.provenance) {
    out << "\n[[source]]\nfields = " << toml::array{row.field} << '\n';
    write(out, "source", row.source);
    write<std::string>(out, "evidence", evidence_name(row.evidence));
    if (!row.note.empty()) write(out, "note", row.note);
  }
  return out.str();
}

void save_profile(const Profile& profile, const std::string& path) {
  const std::string part = path + ".part" + std::to_string(getpid());
  const auto fail = [&](const std::string& why) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw ProfileError(path + ": cannot be written: " + why);
  };
  errno = 0;
  std::ofstream out(part, std::ios::binary);
  out << profile_text(profile) << std::flush;
  out.close();
  if (!out) fail(errno ? std::strerror(errno) : "unknown error");
  std::error_code error;
  fs::rename(part, path, error);
  if (error) fail(error.message());
}

}  // namespace spidar
