// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/profiles/profile_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <utility>

#include "core/grip/pose_solver.h"
#include "spidar/profiles/toml.h"
#include "spidar/text.h"

namespace spidar {
namespace {

/// A field of the parsed document; the document and `file` must outlive this object. Every accessor
/// throws ProfileError when the value does not have the requested type.
class TomlField {
 public:
  TomlField(const std::string& file, const toml::node& node, std::string name = "")
      : file_(&file), node_(&node), name_(std::move(name)) {}

  /// "file:line: name: what"
  [[noreturn]] void fail(const std::string& what) const {
    fail(*file_, node_->source().begin.line, name_, what);
  }

  [[noreturn]] static void fail(const std::string& file, toml::source_index line,
                                const std::string& name, const std::string& what) {
    throw ProfileError(file + ":" + std::to_string(line) + ": " +
                       (name.empty() ? "" : name + ": ") + what);
  }

  // --- tables

  bool has(std::string_view key) const { return table().contains(key); }

  TomlField operator[](std::string_view key) const {
    const toml::node* node = table().get(key);
    if (!node) TomlField(*file_, *node_, member(key)).fail("missing");
    return {*file_, *node, member(key)};
  }

  void allow_only(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, node] : table()) {
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
        fail(*file_, key.source().begin.line, member(key.str()),
             "unknown key; known here are " + listed(keys));
      }
    }
  }

  // --- arrays

  bool is_array() const { return node_->is_array(); }

  size_t size() const { return array().size(); }

  TomlField operator[](size_t i) const {
    return {*file_, array()[i], name_ + "[" + std::to_string(i) + "]"};
  }

  // --- values

  std::string string() const {
    if (!node_->is_string()) wrong_type("a string");
    return node_->as_string()->get();
  }

  std::string one_of(std::initializer_list<std::string_view> allowed) const {
    const std::string value = string();
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
      fail("is \"" + value + "\", must be one of " + listed(allowed));
    }
    return value;
  }

  int integer(int low, int high) const {
    const std::string range = "an integer from " + as_text(low) + " to " + as_text(high);
    if (!node_->is_integer()) wrong_type(range);
    const int64_t value = node_->as_integer()->get();
    if (value < low || value > high) fail("is " + as_text(value) + ", must be " + range);
    return static_cast<int>(value);
  }

  /// Returns a finite number; integers count as numbers.
  double number() const {
    if (!node_->is_number()) wrong_type("a number");
    const double value = node_->is_integer() ? static_cast<double>(node_->as_integer()->get())
                                             : node_->as_floating_point()->get();
    if (!std::isfinite(value)) fail("is " + as_text(value) + ", must be finite");
    return value;
  }

  double positive() const {
    const double value = number();
    if (!(value > 0)) fail("is " + as_text(value) + ", must be above zero");
    return value;
  }

 private:
  [[noreturn]] void wrong_type(const std::string& right) const {
    fail("is " + as_text(node_->type()) + ", must be " + right);
  }

  const toml::table& table() const {
    if (!node_->is_table()) wrong_type("a table");
    return *node_->as_table();
  }

  const toml::array& array() const {
    if (!node_->is_array()) wrong_type("an array");
    return *node_->as_array();
  }

  std::string member(std::string_view key) const {
    return (name_.empty() ? "" : name_ + ".") + std::string(key);
  }

  static std::string listed(std::initializer_list<std::string_view> names) {
    std::string text;
    for (const std::string_view name : names) text.append(text.empty() ? "" : ", ").append(name);
    return text;
  }

  const std::string* file_;
  const toml::node* node_;
  std::string name_;
};

}  // namespace

namespace {

constexpr int kMinStrings = 6;  // fewer cannot hold six degrees of freedom
// A larger value has a mistaken unit: the largest SPIDAR fills a room.
constexpr double kMaxCoordinate_m = 5.0;
constexpr double kMinLength_m = 1e-3;
// The finest encoder of a SPIDAR has 8 µm, the coarsest 35 µm.
constexpr double kMin_m_per_count = 1e-6;
constexpr double kMax_m_per_count = 1e-4;
constexpr double kMaxDriveLag_s = 0.1;
// No grip of 300 g within 8 cm has more, and no ball of 1 g and 16 mm less: the unit is wrong.
constexpr double kMinInertia_kg_m2 = 1e-7;
constexpr double kMaxInertia_kg_m2 = 2e-3;
// No D/A converter exceeds safety extra-low voltage (IEC 61140, 60 V of direct current).
constexpr double kMaxDac_V = 60;
// No motor amplifier works with less; the shipped profiles have 3.3 V or more.
constexpr double kMinDac_V = 0.1;
constexpr int kMinDacBits = 8;
constexpr int kMaxDacBits = 16;
// The fewest steps of the D/A converter in the range of a string. Shipped profiles: 280 or more.
constexpr double kMinSteps = 16;
// No string of a hand-held device pulls more; the strongest of the shipped profiles have 20 N.
constexpr double kMaxTension_N = 100;
constexpr double kMinTension_N = 0.1;  // a weaker string moves no grip
// No limit bounds the force of the strings at rest: off the centre, about the tension of one.
constexpr double kMaxRest_N = kDefaultForce_N;
// The windings of small motors have 2 to 60 s in data sheets; a longer time would be no protection.
constexpr double kMinHeating_s = 1;
constexpr double kMaxHeating_s = 120;
// The force in the weakest direction for one newton of each string. Shipped profiles: 1.2 or more.
constexpr double kMinReach = 0.1;
constexpr double kMaxResidual_m = 0.05;

void check_length(const TomlField& field, int count) {
  if (field.size() != static_cast<size_t>(count)) {
    field.fail("has " + as_text(field.size()) + " entries, must have " + as_text(count) +
               ", one for each string of geometry.exit");
  }
}

Eigen::Vector3d point(const TomlField& field, const Eigen::Array3d& scale) {
  if (field.size() != 3) {
    field.fail("has " + as_text(field.size()) + " coordinates, must have three: [x, y, z]");
  }
  const Eigen::Vector3d point_m =
      Eigen::Array3d(field[0].number(), field[1].number(), field[2].number()) * scale;
  if (!(point_m.cwiseAbs().maxCoeff() <= kMaxCoordinate_m)) {
    field.fail("is more than " + as_text(kMaxCoordinate_m) +
               " m from the centre; check it and geometry.unit");
  }
  return point_m;
}

/// The strings must hold the grip: pull in every direction, and change length in all six motions.
void check_hold(const TomlField& in, const StringGeometry& geometry) {
  const TomlField exits = in["exit"];
  for (size_t i = 0; i < exits.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if ((geometry.exit_m[i] - geometry.exit_m[k]).norm() < kMinLength_m &&
          (geometry.grip_m[i] - geometry.grip_m[k]).norm() < kMinLength_m) {
        exits[i].fail("is that of string " + as_text(k) +
                      ", with the same grip point: two strings cannot be in one position");
      }
    }
  }
  const double radius_m = geometry.grip_radius_m();
  if (radius_m < kMinLength_m) {
    in["grip"].fail("has all points within " + as_text(kMinLength_m) +
                    " m of the grip's origin: the strings could not turn the grip; check it and "
                    "geometry.unit");
  }
  const StructureMatrix W = structure_matrix(geometry, {});
  const double reach = least_reach(W.topRows<3>(), geometry.count);
  if (!(reach >= kMinReach)) {
    exits.fail("has no string that pulls to one side: with 1 N each, the strings give " +
               as_text(std::max(0.0, reach)) + " N there, must give " + as_text(kMinReach) +
               " N or more; the exits enclose the grip");
  }
  const double weakest = PoseSolver::least_stiffness(geometry);
  if (!(weakest >= PoseSolver::kMinStiffness)) {
    in["grip"].fail("leaves a motion of the grip with which no string's length changes (" +
                    as_text(weakest) + ", must be " + as_text(PoseSolver::kMinStiffness) +
                    " or more): no pose could be found");
  }
}

StringGeometry read_geometry(const TomlField& in) {
  in.allow_only({"frame", "unit", "exit", "grip"});
  const double scale = in["unit"].one_of({"m", "mm"}) == "mm" ? 1e-3 : 1.0;
  const bool left_handed = in["frame"].one_of({"left-handed", "right-handed"}) == "left-handed";
  const Eigen::Array3d to_D(scale, scale, left_handed ? -scale : scale);

  const TomlField exits = in["exit"];
  if (exits.size() < kMinStrings || exits.size() > kMaxStrings) {
    exits.fail("has " + as_text(exits.size()) + " strings, must have " + as_text(kMinStrings) +
               " to " + as_text(kMaxStrings));
  }
  StringGeometry geometry;
  geometry.count = static_cast<int>(exits.size());
  const TomlField grips = in["grip"];
  check_length(grips, geometry.count);
  for (size_t i = 0; i < exits.size(); ++i) {
    geometry.exit_m[i] = point(exits[i], to_D);
    geometry.grip_m[i] = point(grips[i], to_D);
    if ((geometry.exit_m[i] - geometry.grip_m[i]).norm() < kMinLength_m) {
      exits[i].fail("is less than " + as_text(kMinLength_m) +
                    " m from its grip point: the string would have no direction; check both and "
                    "geometry.unit");
    }
  }
  check_hold(in, geometry);
  return geometry;
}

/// Reads one number for all strings, or an array with one for each; all must be above zero.
std::array<double, kMaxStrings> per_string(const TomlField& field, int count) {
  std::array<double, kMaxStrings> values{};
  if (!field.is_array()) {
    values.fill(field.positive());
    return values;
  }
  check_length(field, count);
  for (size_t i = 0; i < field.size(); ++i) values[i] = field[i].positive();
  return values;
}

std::array<int, kMaxStrings> signs(const TomlField& field, int count) {
  check_length(field, count);
  std::array<int, kMaxStrings> values{};
  for (size_t i = 0; i < field.size(); ++i) {
    values[i] = field[i].integer(-1, 1);
    if (values[i] == 0) field[i].fail("is 0, must be 1 or -1");
  }
  return values;
}

/// Returns zeros when the field is missing.
std::array<double, kMaxStrings> home_offsets(const TomlField& strings,
                                             const StringGeometry& geometry) {
  std::array<double, kMaxStrings> values{};
  if (!strings.has("home_offset_m")) return values;
  const TomlField field = strings["home_offset_m"];
  check_length(field, geometry.count);
  const StringVector home_m = string_lengths_m(geometry, {});
  for (size_t i = 0; i < field.size(); ++i) {
    values[i] = field[i].number();
    const double length_m = home_m[static_cast<Eigen::Index>(i)] + values[i];
    if (!(length_m > 0 && length_m <= 2 * kMaxCoordinate_m)) {
      field[i].fail("is " + as_text(values[i]) + ": with the length at the centre the string has " +
                    as_text(length_m) + " m at zero count, must be above zero and at most " +
                    as_text(2 * kMaxCoordinate_m) + " m; the unit is metres");
    }
  }
  return values;
}

void check_drive(const TomlField& in, size_t i, const Profile& profile) {
  const StringDrive& drive = profile.drives[i];
  const double dac_max_V = profile.dac_max_V;
  const std::string string = "string " + as_text(i) + ": ";
  if (!(drive.min_tension_N < drive.max_tension_N)) {
    in["max_tension_N"].fail(string + as_text(drive.max_tension_N) +
                             " N must be above min_tension_N, which is " +
                             as_text(drive.min_tension_N) + " N");
  }
  if (drive.min_tension_N > kMaxRest_N) {
    in["min_tension_N"].fail(string + as_text(drive.min_tension_N) + " N must be at most " +
                             as_text(kMaxRest_N) +
                             " N: at rest the strings pull with it, and no limit bounds that");
  }
  if (drive.max_tension_N > kMaxTension_N || drive.max_tension_N < kMinTension_N) {
    in["max_tension_N"].fail(string + as_text(drive.max_tension_N) + " N must be at least " +
                             as_text(kMinTension_N) + " N and at most " + as_text(kMaxTension_N) +
                             " N; the unit is newtons");
  }
  const double needed_V = drive.max_tension_N / drive.newtons_per_volt;
  if (!(needed_V <= dac_max_V)) {
    in["max_tension_N"].fail(string + as_text(drive.max_tension_N) + " N needs " +
                             as_text(needed_V) + " V, but dac_max_V is " + as_text(dac_max_V) +
                             "; lower it, or correct newtons_per_volt or dac_max_V");
  }
  const double steps = needed_V / dac_max_V * ((1 << profile.dac_bits) - 1);
  if (!(steps >= kMinSteps)) {
    in["newtons_per_volt"].fail(string + as_text(drive.newtons_per_volt) + " N/V leaves " +
                                as_text(steps) +
                                " steps of the D/A for max_tension_N, must leave " +
                                as_text(kMinSteps) + " or more; check it, dac_max_V and dac_bits");
  }
  if (!(drive.min_tension_N <= drive.continuous_tension_N &&
        drive.continuous_tension_N <= drive.max_tension_N)) {
    in["continuous_tension_N"].fail(
        string + as_text(drive.continuous_tension_N) + " N must be from min_tension_N, which is " +
        as_text(drive.min_tension_N) + " N, to max_tension_N, which is " +
        as_text(drive.max_tension_N) + " N");
  }
  if (drive.metres_per_count < kMin_m_per_count || drive.metres_per_count > kMax_m_per_count) {
    in["metres_per_count"].fail(string + as_text(drive.metres_per_count) + " must be from " +
                                as_text(kMin_m_per_count) + " to " + as_text(kMax_m_per_count) +
                                "; the unit is metres");
  }
  if (drive.heating_time_s < kMinHeating_s || drive.heating_time_s > kMaxHeating_s) {
    in["heating_time_s"].fail(string + as_text(drive.heating_time_s) + " must be from " +
                              as_text(kMinHeating_s) + " to " + as_text(kMaxHeating_s) +
                              "; the unit is seconds, of the winding");
  }
}

void read_strings(const TomlField& in, Profile& profile) {
  in.allow_only({"min_tension_N", "max_tension_N", "newtons_per_volt", "metres_per_count",
                 "continuous_tension_N", "heating_time_s", "motor_sign", "encoder_sign",
                 "home_offset_m"});
  const int count = profile.geometry.count;
  const auto read = [&](const char* key, double StringDrive::*member) {
    const std::array<double, kMaxStrings> values = per_string(in[key], count);
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) profile.drives[i].*member = values[i];
  };
  read("min_tension_N", &StringDrive::min_tension_N);
  read("max_tension_N", &StringDrive::max_tension_N);
  read("newtons_per_volt", &StringDrive::newtons_per_volt);
  read("metres_per_count", &StringDrive::metres_per_count);
  if (in.has("heating_time_s")) read("heating_time_s", &StringDrive::heating_time_s);
  for (StringDrive& drive : profile.drives) {
    drive.continuous_tension_N = std::max(drive.min_tension_N, drive.max_tension_N / 2);
  }
  if (in.has("continuous_tension_N")) {
    read("continuous_tension_N", &StringDrive::continuous_tension_N);
  }
  const std::array<int, kMaxStrings> motor_sign = signs(in["motor_sign"], count);
  const std::array<int, kMaxStrings> encoder_sign = signs(in["encoder_sign"], count);
  const std::array<double, kMaxStrings> home_offset_m = home_offsets(in, profile.geometry);
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    StringDrive& drive = profile.drives[i];
    drive.motor_sign = motor_sign[i];
    drive.encoder_sign = encoder_sign[i];
    drive.home_offset_m = home_offset_m[i];
    check_drive(in, i, profile);
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
                                    "board", "dac_bits", "dac_max_V", "drive_lag_s",
                                    "moment_of_inertia_kg_m2"});
      provenance.push_back(row);
    }
  }
  return provenance;
}

double not_negative(const TomlField& field) {
  const double value = field.number();
  if (value < 0) field.fail("is " + as_text(value) + ", must not be negative");
  return value;
}

double at_most(const TomlField& field, double value, double most, const std::string& unit) {
  if (!(value <= most)) {
    field.fail("is " + as_text(value) + ", must be at most " + as_text(most) + "; the unit is " +
               unit);
  }
  return value;
}

/// Reads one number for all axes, or the three principal moments.
Eigen::Vector3d moments_of_inertia(const TomlField& field) {
  if (field.is_array() && field.size() != 3) {
    field.fail("has " + as_text(field.size()) +
               " entries, must be one number, or the three principal moments of inertia");
  }
  Eigen::Vector3d moments;
  for (int i = 0; i < 3; ++i) {
    const TomlField entry = field.is_array() ? field[static_cast<size_t>(i)] : field;
    moments[i] = at_most(entry, entry.positive(), kMaxInertia_kg_m2, "kg m²");
    if (moments[i] < kMinInertia_kg_m2) {
      entry.fail("is " + as_text(moments[i]) + ", must be at least " + as_text(kMinInertia_kg_m2) +
                 "; the unit is kg m²");
    }
  }
  // A sphere has equal moments; the margin accepts a thin disc in spite of rounding.
  if (moments.maxCoeff() > 0.5 * moments.sum() * (1 + 1e-9)) {
    field.fail("has a moment above the sum of the other two, which no body has");
  }
  return moments;
}

CalibrationRecord read_calibration(const TomlField& in) {
  in.allow_only({"samples", "residual_m"});
  const TomlField residual = in["residual_m"];
  return {in["samples"].integer(1, std::numeric_limits<int>::max()),
          at_most(residual, not_negative(residual), kMaxResidual_m, "metres")};
}

}  // namespace

Profile parse_profile(const std::string& text, const std::string& path, const std::string& name) {
  const toml::table document = parse_toml(text, path);
  const TomlField root(path, document);
  root.allow_only({"description", "board", "dac_bits", "dac_max_V", "drive_lag_s", "geometry",
                   "grip", "strings", "calibration", "source"});
  Profile profile;
  profile.name = name;
  const TomlField description = root["description"];
  profile.description = description.string();
  if (std::any_of(profile.description.begin(), profile.description.end(),
                  [](unsigned char c) { return c < ' '; })) {
    description.fail("has a control character, must be one line");
  }
  const TomlField board = root["board"];
  profile.board = board.string();
  if (profile.board.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") !=
          std::string::npos ||
      profile.board.empty()) {
    board.fail(
        "is \"" + profile.board +
        "\", must be a kind of board in small letters, digits and hyphens, such as \"uart\"");
  }
  profile.dac_bits = root["dac_bits"].integer(kMinDacBits, kMaxDacBits);
  const TomlField dac_max = root["dac_max_V"];
  profile.dac_max_V = at_most(dac_max, dac_max.positive(), kMaxDac_V, "volts");
  if (profile.dac_max_V < kMinDac_V) {
    dac_max.fail("is " + as_text(profile.dac_max_V) + ", must be at least " + as_text(kMinDac_V) +
                 "; the unit is volts");
  }
  profile.drive_lag_known = root.has("drive_lag_s");
  if (profile.drive_lag_known) {
    const TomlField lag = root["drive_lag_s"];
    profile.drive_lag_s = at_most(lag, not_negative(lag), kMaxDriveLag_s, "seconds");
  }
  profile.geometry = read_geometry(root["geometry"]);
  read_strings(root["strings"], profile);
  if (root.has("grip")) {
    const TomlField grip = root["grip"];
    grip.allow_only({"moment_of_inertia_kg_m2"});
    profile.moment_of_inertia_kg_m2 = moments_of_inertia(grip["moment_of_inertia_kg_m2"]);
  }
  if (root.has("calibration")) profile.calibration = read_calibration(root["calibration"]);
  if (root.has("source")) profile.provenance = read_sources(root["source"]);
  return profile;
}

}  // namespace spidar
