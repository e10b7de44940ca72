// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/csv_track.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <csv.h>
#include <map>
#include <optional>
#include <regex>
#include <stdexcept>
#include <vector>

#include "core/number_text.h"
#include "plugin/films/text_lines.h"
#include "spidar/text.h"

namespace spidar::tools {
namespace {

/// The time, and the channels of a track.
constexpr size_t kColumns = 1 + kTrackChannels;
constexpr const char* kColumnNames[kColumns] = {"time", "fx", "fy", "fz", "tx", "ty", "tz"};
/// The units of a column.
struct Quantity {
  double scale;                         ///< of the stored value: ms, or the full scale of a track
  std::map<std::string, double> units;  ///< by name
};
const Quantity kTime = {
    1e-3,
    {{"s", 1}, {"sec", 1}, {"seconds", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"min", 60}}};
const Quantity kForce = {kTrackForceScale_N,
                         {{"N", 1}, {"cN", 1e-2}, {"mN", 1e-3}, {"uN", 1e-6}, {"kN", 1e3}}};
const Quantity kTorque = {kTrackTorqueScale_Nm,
                          {{"Nm", 1}, {"Ncm", 1e-2}, {"Nmm", 1e-3}, {"mNm", 1e-3}, {"uNm", 1e-6}}};
const Quantity& quantity_of(size_t column) {
  return column == 0 ? kTime : column <= kTrackChannels / 2 ? kForce : kTorque;
}
/// A time that was rounded to a microsecond may precede its sample by this much.
constexpr double kRounding_ms = 1e-3;
/// No film is longer: a later time is a time of day, the uptime of a machine, or in another unit.
constexpr double kLongest_ms = 24.0 * 3600 * 1000;
/// Larger values fit into no format with a range of its own (kMinGain).
constexpr double kLargest = 1 / kMinGain;

using Fields = std::vector<std::string>;
using Places = std::array<std::optional<size_t>, kColumns>;

/// Returns nothing if the quotation marks are not those of RFC 4180.
Fields split(const std::string& record, char separator) {
  Fields fields;
  csv_parser parser;
  csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI);
  csv_set_delim(&parser, static_cast<unsigned char>(separator));
  const auto take = [](void* text, size_t size, void* user) {
    static_cast<Fields*>(user)->emplace_back(static_cast<char*>(text), size);
  };
  const bool is_whole =
      csv_parse(&parser, record.data(), record.size(), take, nullptr, &fields) == record.size() &&
      csv_fini(&parser, take, nullptr, &fields) == 0;
  csv_free(&parser);
  if (!is_whole) fields.clear();
  if (separator == ' ') {  // columns of numbers
    fields.erase(std::remove(fields.begin(), fields.end(), ""), fields.end());
  }
  return fields;
}

std::optional<double> value_of(std::string field) {
  std::replace(field.begin(), field.end(), ',', '.');
  return number_of(std::string_view(field).substr(!field.empty() && field[0] == '+' ? 1 : 0));
}

class CsvReader {
 public:
  CsvReader(const std::string& path, const SampleSource::Take& take)
      : path_(path), lines_(path), take_(take) {}

  void read() {
    while (next_record()) {
      if (width_ > 0 || !detect_format()) add_row(split(record_, separator_));
    }
    if (!has_row_) fail("the table has no rows");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(path_ + ", line " + std::to_string(line_) + ": " + what);
  }

  bool add_line() {
    const auto line = lines_.next();
    line_ += line ? 1 : 0;
    if (line && !g_utf8_validate_len(line->data(), line->size(), nullptr)) {
      fail(TextLines::kOtherText);
    }
    record_ += line.value_or("");
    return line.has_value();
  }

  /// Reads the next line with values or names; a name may contain line breaks.
  bool next_record() {
    for (record_.clear(); add_line(); record_.clear()) {
      const size_t begin = record_.find_first_not_of(" \t,;\"");
      if (begin == std::string::npos) continue;
      if (line_ == 1 && record_.rfind("sep=", 0) == 0 && record_.size() == 5) {
        separators_ = record_.substr(4);
      } else if (record_[begin] == '#' || record_[begin] == '%') {
        if (width_ == 0) comments_.insert(comments_.begin(), record_.substr(begin + 1));
      } else {
        const auto is_open = [&] {
          return std::count(record_.begin(), record_.end(), '"') % 2 != 0;
        };
        while (width_ == 0 && is_open() && add_line()) continue;
        return true;
      }
    }
    return false;
  }

  /// Detects the format of the table from its first line. Returns whether this line has names.
  bool detect_format() {
    for (const char separator : separators_) {
      separator_ = separator;
      const Fields fields = split(record_, separator);
      if (parse_names(fields)) return true;
      if (!std::any_of(fields.begin(), fields.end(), value_of)) continue;
      for (const std::string& comment : comments_) {
        const Fields names = split(comment, separator);
        if (names.size() == fields.size() && parse_names(names)) return false;
      }
      if (fields.size() == kColumns && std::all_of(fields.begin(), fields.end(), value_of)) {
        return !parse_names(Fields(std::begin(kColumnNames), std::end(kColumnNames)));
      }
    }
    fail(
        "names no column time and none of fx, fy, fz, tx, ty, tz, such as time_s,fx_N,tz_Nm; "
        "without names, there are all seven, in this order");
  }

  /// Returns false when these are not the names of columns.
  bool parse_names(const Fields& fields) {
    std::array<std::string, kColumns> units;
    at_ = {};
    for (size_t i = 0; i < fields.size(); ++i) {
      const auto end = std::find_if_not(fields[i].begin(), fields[i].end(),
                                        [](char c) { return g_ascii_isalpha(c); });
      std::string name(fields[i].begin(), end), unit(end, fields[i].end());
      std::transform(name.begin(), name.end(), name.begin(), g_ascii_tolower);
      const auto* const known =
          std::find(std::begin(kColumnNames), std::end(kColumnNames), name == "t" ? "time" : name);
      if (known == std::end(kColumnNames)) continue;
      const auto column = static_cast<size_t>(known - std::begin(kColumnNames));
      if (at_[column]) fail("names " + name + " twice");
      at_[column] = i;
      unit.erase(0, unit.find_first_not_of(" _,:/([{"));
      unit.erase(unit.find_last_not_of(" )]}") + 1);
      units[column] = unit;
    }
    if (!at_[0] || at_ == Places{at_[0]}) return false;
    for (size_t column = 0; column < kColumns; ++column) {
      factors_[column] = size_of(units[column], column) / quantity_of(column).scale;
    }
    width_ = fields.size();
    return true;
  }

  double size_of(const std::string& text, size_t column) const {
    static const std::regex product("[ _.*-]|·|⋅|\u00A0|\u202F"), micro("µ|μ");
    const std::string unit = std::regex_replace(std::regex_replace(text, product, ""), micro, "u");
    if (unit.empty()) return 1;
    std::string known;
    for (const auto& [name, size] : quantity_of(column).units) {
      // Ignore case, as in FX_N and TZ_NM, but do not take MN for mN.
      const bool is_mega = column > 0 && unit[0] == 'M';
      if (g_ascii_strcasecmp(name.c_str(), unit.c_str()) == 0 && !is_mega) return size;
      known += (known.empty() ? "" : ", ") + name;
    }
    fail(std::string(kColumnNames[column]) + ": the unit \"" + text + "\" is not one of " + known);
  }

  double number(const std::string& field) {
    const auto value = value_of(field);
    const size_t mark = field.find_first_of(",.");
    if (mark != std::string::npos && decimal_mark_ == '\0') decimal_mark_ = field[mark];
    if (!value || (mark != std::string::npos && field[mark] != decimal_mark_)) {
      fail("\"" + field + "\" is not a number" +
           (value ? std::string(", as decimals are behind a '") + decimal_mark_ + "' before" : ""));
    }
    return *value;
  }

  void add_row(const Fields& fields) {
    if (fields.empty()) fail("a quotation mark is not closed, or not doubled");
    if (fields.size() != width_) {
      fail("has " + std::to_string(fields.size()) + " columns, and not " + std::to_string(width_));
    }
    std::array<double, kColumns> now{};
    for (size_t i = 0; i < kColumns; ++i) {
      if (!at_[i]) continue;
      now[i] = number(fields[*at_[i]]) * factors_[i];
      if (i > 0 && std::abs(now[i]) > kLargest) {
        fail("\"" + fields[*at_[i]] + "\" is too large for a track");
      }
    }
    const double now_ms = now[0];
    if (now_ms < -kRounding_ms || now_ms > kLongest_ms) {
      fail("its time is not within a day from 0, where the film begins: subtract where it began");
    }
    if (has_row_ && now_ms < last_[0]) fail("its time is before that of the line before");
    for (; static_cast<double>(next_ms_) <= now_ms + kRounding_ms; ++next_ms_) {
      TrackSample sample{};
      const double ms = static_cast<double>(next_ms_);
      const bool is_before = !has_row_ && ms < now_ms - kRounding_ms;
      const double share =
          has_row_ ? std::clamp((ms - last_[0]) / (now_ms - last_[0]), 0.0, 1.0) : 1;
      for (size_t i = 0; i < kTrackChannels && !is_before; ++i) {
        sample[i] = static_cast<float>(last_[i + 1] + share * (now[i + 1] - last_[i + 1]));
      }
      take_(sample);
    }
    has_row_ = true;
    last_ = now;
  }

  const std::string path_;
  TextLines lines_;
  const SampleSource::Take& take_;
  size_t line_ = 0;
  std::string record_;
  Fields comments_;  ///< the last one first
  std::string separators_ = "\t;, ";
  char separator_ = '\0';
  char decimal_mark_ = '\0';
  size_t width_ = 0;  ///< of a row; 0: unknown
  Places at_;
  std::array<double, kColumns> factors_{};
  // The last row, in ms and fractions of the full scale.
  bool has_row_ = false;
  std::array<double, kColumns> last_{};
  size_t next_ms_ = 0;
};

}  // namespace

void read_csv(const std::string& path, const SampleSource::Take& take) {
  CsvReader(path, take).read();
}

void write_csv(const SampleSource& samples, const WriteText& write) {
  write("time_s");
  for (size_t i = 1; i < kColumns; ++i) {
    write(std::string(",") + kColumnNames[i] + (i <= kTrackChannels / 2 ? "_N" : "_Nm"));
  }
  write("\n");
  size_t count = 0;
  samples.each([&](const TrackSample& sample) {
    std::string line = formatted("%zu.%03zu", count / kTrackRate_Hz, count % kTrackRate_Hz);
    ++count;
    for (size_t i = 0; i < kTrackChannels; ++i) {
      line += ',';
      line +=
          std::string_view(NumberText(static_cast<float>(quantity_of(i + 1).scale) * sample[i]));
    }
    write(line + '\n');
  });
}

}  // namespace spidar::tools
