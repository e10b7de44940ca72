#include "spidar/profile_file.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace spidar {
namespace {

using Values = std::array<double, kMaxStrings>;
using Names = std::vector<std::string_view>;

constexpr int kMinStrings = 6;  // fewer cannot hold six degrees of freedom
// Beyond these a unit was mistaken: the largest SPIDAR fills a room, a count is some micrometres.
constexpr double kMaxCoordinate_m = 5.0;
constexpr double kMinLength_m = 1e-3;
constexpr double kMin_m_per_count = 1e-8;
constexpr double kMax_m_per_count = 1e-3;

const Names kRootKeys = {"description", "board",   "dac_bits", "dac_max_V",
                         "geometry",    "strings", "source"};
const Names kGeometryKeys = {"frame", "unit", "exit", "grip"};
const Names kStringKeys = {"min_tension_N",    "max_tension_N", "newtons_per_volt",
                           "metres_per_count", "motor_sign",    "encoder_sign"};
const Names kSourceKeys = {"fields", "source", "evidence", "note"};
const Names kSourceFields = {
    "geometry",         "frame",      "min_tension_N", "max_tension_N", "newtons_per_volt",
    "metres_per_count", "motor_sign", "encoder_sign",  "board",         "dac_bits",
    "dac_max_V"};
const Names kBoards = {"usb-sh4", "usb-simple", "uart", "ahs", "unknown"};
const Names kFrames = {"left-handed", "right-handed"};
const Names kUnits = {"m", "mm"};
const Names kEvidence = {"published", "inferred", "contradicted"};

std::string listed(const Names& names) {
  std::string text;
  for (const std::string_view name : names) {
    if (!text.empty()) text += ", ";
    text += name;
  }
  return text;
}

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string type_of(const toml::node& node) {
  std::ostringstream out;
  out << node.type();
  return out.str();
}

class Reader {
 public:
  explicit Reader(std::string path) : path_(std::move(path)) {}

  Profile read(const toml::table& root, const std::string& name) const {
    allow_keys(root, "", kRootKeys);
    Profile profile;
    profile.name = name;
    profile.description = string(root, "", "description");
    profile.board = one_of(root, "", "board", kBoards);
    profile.dac_bits = static_cast<int>(integer(root, "", "dac_bits", 8, 24));
    profile.dac_max_V = positive(need(root, "", "dac_max_V"), "dac_max_V");
    profile.geometry = read_geometry(table(root, "geometry"));
    read_strings(table(root, "strings"), profile);
    profile.provenance = read_sources(root);
    return profile;
  }

  [[noreturn]] void fail(toml::source_index line, const std::string& field,
                         const std::string& what) const {
    throw ProfileError(path_ + ":" + std::to_string(line) + ": " +
                       (field.empty() ? "" : field + ": ") + what);
  }

 private:
  [[noreturn]] void fail(const toml::node& at, const std::string& field,
                         const std::string& what) const {
    fail(at.source().begin.line, field, what);
  }

  void allow_keys(const toml::table& in, const std::string& prefix, const Names& known) const {
    for (const auto& [key, node] : in)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        fail(key.source().begin.line, prefix + std::string(key.str()),
             "unknown key; known here are " + listed(known));
  }

  const toml::node& need(const toml::table& in, const std::string& prefix,
                         std::string_view key) const {
    const toml::node* node = in.get(key);
    if (!node) fail(in, prefix + std::string(key), "missing");
    return *node;
  }

  const toml::table& table(const toml::table& in, std::string_view key) const {
    const toml::node& node = need(in, "", key);
    if (!node.is_table()) fail(node, std::string(key), "is " + type_of(node) + ", must be a table");
    return *node.as_table();
  }

  std::string string(const toml::node& node, const std::string& field) const {
    if (!node.is_string()) fail(node, field, "is " + type_of(node) + ", must be a string");
    return node.as_string()->get();
  }

  std::string string(const toml::table& in, const std::string& prefix, std::string_view key) const {
    return string(need(in, prefix, key), prefix + std::string(key));
  }

  std::string one_of(const toml::node& node, const std::string& field, const Names& allowed) const {
    const std::string value = string(node, field);
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
      fail(node, field, "is \"" + value + "\", must be one of " + listed(allowed));
    return value;
  }

  std::string one_of(const toml::table& in, const std::string& prefix, std::string_view key,
                     const Names& allowed) const {
    return one_of(need(in, prefix, key), prefix + std::string(key), allowed);
  }

  int64_t integer(const toml::table& in, const std::string& prefix, std::string_view key,
                  int64_t low, int64_t high) const {
    const toml::node& node = need(in, prefix, key);
    const std::string range =
        "an integer from " + std::to_string(low) + " to " + std::to_string(high);
    if (!node.is_integer())
      fail(node, prefix + std::string(key), "is " + type_of(node) + ", must be " + range);
    const int64_t value = node.as_integer()->get();
    if (value < low || value > high)
      fail(node, prefix + std::string(key), "is " + std::to_string(value) + ", must be " + range);
    return value;
  }

  double number(const toml::node& node, const std::string& field) const {
    if (!node.is_number()) fail(node, field, "is " + type_of(node) + ", must be a number");
    const double value = node.value<double>().value_or(std::nan(""));
    if (!std::isfinite(value)) fail(node, field, "is " + shown(value) + ", must be finite");
    return value;
  }

  double positive(const toml::node& node, const std::string& field) const {
    const double value = number(node, field);
    if (!(value > 0)) fail(node, field, "is " + shown(value) + ", must be above zero");
    return value;
  }

  const toml::array& array(const toml::node& node, const std::string& field) const {
    if (!node.is_array()) fail(node, field, "is " + type_of(node) + ", must be an array");
    return *node.as_array();
  }

  void check_length(const toml::array& values, const std::string& field, int count) const {
    if (values.size() != static_cast<size_t>(count))
      fail(values, field,
           "has " + std::to_string(values.size()) + " entries, must have " + std::to_string(count) +
               ", one for each string of geometry.exit");
  }

  static std::string entry(const std::string& field, size_t i) {
    return field + "[" + std::to_string(i) + "]";
  }

  Eigen::Vector3d point(const toml::node& node, const std::string& field) const {
    const toml::array& xyz = array(node, field);
    if (xyz.size() != 3)
      fail(node, field,
           "has " + std::to_string(xyz.size()) + " coordinates, must have three: [x, y, z]");
    return {number(xyz[0], field + ".x"), number(xyz[1], field + ".y"),
            number(xyz[2], field + ".z")};
  }

  StringGeometry read_geometry(const toml::table& in) const {
    const std::string prefix = "geometry.";
    allow_keys(in, prefix, kGeometryKeys);
    const double scale_m = one_of(in, prefix, "unit", kUnits) == "mm" ? 1e-3 : 1.0;
    const double z_sign = one_of(in, prefix, "frame", kFrames) == "left-handed" ? -1.0 : 1.0;
    const Eigen::Array3d to_D(scale_m, scale_m, z_sign * scale_m);

    const toml::array& exits = array(need(in, prefix, "exit"), "geometry.exit");
    if (exits.size() < kMinStrings || exits.size() > kMaxStrings)
      fail(exits, "geometry.exit",
           "has " + std::to_string(exits.size()) + " strings, must have " +
               std::to_string(kMinStrings) + " to " + std::to_string(kMaxStrings));
    StringGeometry geometry;
    geometry.count = static_cast<int>(exits.size());
    const toml::array& grips = array(need(in, prefix, "grip"), "geometry.grip");
    check_length(grips, "geometry.grip", geometry.count);

    for (size_t i = 0; i < exits.size(); ++i) {
      const Eigen::Vector3d exit_m = point(exits[i], entry("geometry.exit", i)).array() * to_D;
      const Eigen::Vector3d grip_m = point(grips[i], entry("geometry.grip", i)).array() * to_D;
      if (exit_m.cwiseAbs().maxCoeff() > kMaxCoordinate_m)
        fail(exits[i], entry("geometry.exit", i),
             "is more than " + shown(kMaxCoordinate_m) + " m from the centre; check geometry.unit");
      if (grip_m.cwiseAbs().maxCoeff() > kMaxCoordinate_m)
        fail(grips[i], entry("geometry.grip", i),
             "is more than " + shown(kMaxCoordinate_m) + " m from the centre; check geometry.unit");
      if ((exit_m - grip_m).norm() < kMinLength_m)
        fail(exits[i], entry("geometry.exit", i),
             "is less than 1 mm from its grip point: the string would have no direction; check the "
             "tables and geometry.unit");
      geometry.exit_m[i] = exit_m;
      geometry.grip_m[i] = grip_m;
    }
    return geometry;
  }

  /// One number for all strings or an array with one for each; all above zero.
  Values per_string(const toml::table& in, std::string_view key, int count) const {
    const std::string field = "strings." + std::string(key);
    const toml::node& node = need(in, "strings.", key);
    Values values{};
    if (node.is_array()) {
      const toml::array& entries = *node.as_array();
      check_length(entries, field, count);
      for (size_t i = 0; i < entries.size(); ++i) values[i] = positive(entries[i], entry(field, i));
    } else {
      values.fill(positive(node, field));
    }
    return values;
  }

  std::array<int, kMaxStrings> signs(const toml::table& in, std::string_view key, int count) const {
    const std::string field = "strings." + std::string(key);
    const toml::array& entries = array(need(in, "strings.", key), field);
    check_length(entries, field, count);
    std::array<int, kMaxStrings> values{};
    for (size_t i = 0; i < entries.size(); ++i) {
      const auto* value = entries[i].as_integer();
      if (!value || (value->get() != 1 && value->get() != -1))
        fail(entries[i], entry(field, i), "must be 1 or -1");
      values[i] = static_cast<int>(value->get());
    }
    return values;
  }

  void read_strings(const toml::table& in, Profile& profile) const {
    allow_keys(in, "strings.", kStringKeys);
    const int count = profile.geometry.count;
    const Values min_N = per_string(in, "min_tension_N", count);
    const Values max_N = per_string(in, "max_tension_N", count);
    const Values N_per_V = per_string(in, "newtons_per_volt", count);
    const Values m_per_count = per_string(in, "metres_per_count", count);
    const auto motor_sign = signs(in, "motor_sign", count);
    const auto encoder_sign = signs(in, "encoder_sign", count);
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
      if (!(min_N[i] < max_N[i]))
        fail(*in.get("max_tension_N"), entry("strings.max_tension_N", i),
             "is " + shown(max_N[i]) + " N, must be above min_tension_N, which is " +
                 shown(min_N[i]) + " N");
      if (max_N[i] > N_per_V[i] * profile.dac_max_V)
        fail(*in.get("max_tension_N"), entry("strings.max_tension_N", i),
             "is " + shown(max_N[i]) + " N and needs " + shown(max_N[i] / N_per_V[i]) +
                 " V, but dac_max_V is " + shown(profile.dac_max_V) +
                 "; lower it, or correct newtons_per_volt or dac_max_V");
      if (m_per_count[i] < kMin_m_per_count || m_per_count[i] > kMax_m_per_count)
        fail(*in.get("metres_per_count"), entry("strings.metres_per_count", i),
             "is " + shown(m_per_count[i]) + ", must be from " + shown(kMin_m_per_count) + " to " +
                 shown(kMax_m_per_count) + "; the unit is metres");
      profile.drives[i] = {min_N[i],       max_N[i],      N_per_V[i],
                           m_per_count[i], motor_sign[i], encoder_sign[i]};
    }
  }

  std::vector<Provenance> read_sources(const toml::table& root) const {
    std::vector<Provenance> provenance;
    if (!root.contains("source")) return provenance;
    const toml::array& sources = array(need(root, "", "source"), "source");
    for (size_t i = 0; i < sources.size(); ++i) {
      const std::string prefix = entry("source", i) + ".";
      if (!sources[i].is_table())
        fail(sources[i], entry("source", i), "is " + type_of(sources[i]) + ", must be a table");
      const toml::table& in = *sources[i].as_table();
      allow_keys(in, prefix, kSourceKeys);
      Provenance row;
      row.source = string(in, prefix, "source");
      const std::string evidence = one_of(in, prefix, "evidence", kEvidence);
      row.evidence = evidence == "published"  ? Evidence::kPublished
                     : evidence == "inferred" ? Evidence::kInferred
                                              : Evidence::kContradicted;
      if (in.contains("note")) row.note = string(in, prefix, "note");
      const toml::array& fields = array(need(in, prefix, "fields"), prefix + "fields");
      for (size_t k = 0; k < fields.size(); ++k) {
        row.field = one_of(fields[k], entry(prefix + "fields", k), kSourceFields);
        provenance.push_back(row);
      }
    }
    return provenance;
  }

  std::string path_;
};

}  // namespace

Profile parse_profile(const std::string& text, const std::string& path, const std::string& name) {
  const Reader reader(path);
  toml::table root;
  try {
    root = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    reader.fail(error.source().begin.line, "", "not TOML: " + std::string(error.description()));
  }
  return reader.read(root, name);
}

}  // namespace spidar
