// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/track/csv_track.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <vector>

#include "core/number_text.h"

namespace spidar {
namespace {

constexpr const char* kNames[kTrackChannels] = {"fx", "fy", "fz", "tx", "ty", "tz"};
constexpr double kUnits[kTrackChannels] = {kTrackForceScale_N,   kTrackForceScale_N,
                                           kTrackForceScale_N,   kTrackTorqueScale_Nm,
                                           kTrackTorqueScale_Nm, kTrackTorqueScale_Nm};
/// Times that were rounded to a microsecond may be as much before their sample.
constexpr double kRounding_ms = 1e-3;
/// A longer rest at the begin is a time of the day, or of a machine; later, a mistake.
constexpr double kMaxRest_ms = 24.0 * 3600 * 1000;

std::string_view trimmed(std::string_view text) {
  const auto is_edge = [](char c) { return c == ' ' || c == '\r' || c == '"'; };
  while (!text.empty() && is_edge(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_edge(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

char separator_of(std::string_view line) {
  for (const char separator : {'\t', ';'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ',';
}

std::optional<double> value_of(std::string_view field, char separator) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  if (separator != ';' || field.find(',') == std::string_view::npos) return number_of(field);
  std::string with_point(field);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return number_of(with_point);
}

/// In small letters, "fx" of "Fx (N)" and "fx_N"; the rest is the unit.
std::string name_of(std::string_view field, std::string& unit) {
  std::string name;
  size_t i = 0;
  for (; i < field.size() && std::isalpha(static_cast<unsigned char>(field[i])) != 0; ++i) {
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(field[i])));
  }
  unit.clear();
  for (; i < field.size(); ++i) {
    if (std::isalpha(static_cast<unsigned char>(field[i])) != 0) unit += field[i];
  }
  return name;
}

}  // namespace

void CsvTrackReader::fail(const std::string& what) const {
  throw TrackFileError("line " + std::to_string(line_) + ": " + what);
}

bool CsvTrackReader::read_names(std::string_view line) {
  separator_ = separator_of(line);
  const auto fields = fields_of(line, separator_);
  columns_ = fields.size();
  if (value_of(fields[0], separator_)) {
    if (columns_ != 1 + kTrackChannels) {
      fail("has " + std::to_string(columns_) +
           " columns without names; without them, there are seven: time, fx, fy, fz, tx, ty, tz");
    }
    time_ = 0;
    for (size_t i = 0; i < kTrackChannels; ++i) channels_[i] = i + 1;
    return false;
  }
  for (size_t column = 0; column < columns_; ++column) {
    std::string unit;
    const std::string name = name_of(fields[column], unit);
    if (!time_ && (name == "time" || name == "t")) {
      time_ = column;
      second_ = unit == "ms" ? 1e3 : unit == "us" ? 1e6 : unit == "ns" ? 1e9 : 1;
    }
    const auto* const channel = std::find(std::begin(kNames), std::end(kNames), name);
    if (channel != std::end(kNames)) channels_[static_cast<size_t>(channel - kNames)] = column;
  }
  const bool has_any = std::any_of(channels_.begin(), channels_.end(),
                                   [](const auto& column) { return column.has_value(); });
  if (!time_ || !has_any) {
    fail(
        "names no column time and none of fx, fy, fz, tx, ty, tz, such as "
        "time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm");
  }
  return true;
}

void CsvTrackReader::add(std::string_view line) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (++line_ == 1 && line.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    line.remove_prefix(kByteOrderMark.size());
  }
  if (trimmed(line).empty() || line.front() == '#') return;
  if (columns_ == 0 && read_names(line)) return;
  const auto fields = fields_of(line, separator_);
  if (fields.size() != columns_) {
    fail("has " + std::to_string(fields.size()) + " columns, and not " + std::to_string(columns_));
  }
  const auto number = [&](size_t column) {
    const auto value = value_of(fields[column], separator_);
    if (!value) fail("\"" + std::string(fields[column]) + "\" is not a number");
    return *value;
  };
  const double now_ms = 1000 * number(*time_) / second_;
  if (last_ms_ && !(now_ms > *last_ms_)) fail("its time is not after that of the line before");
  if (!last_ms_ && (now_ms < 0 || now_ms > kMaxRest_ms)) {
    fail("its time is not within a day from 0, where the film begins: subtract where it began");
  }
  if (last_ms_ && now_ms - *last_ms_ > kMaxRest_ms) {
    fail("its time is more than a day after that of the line before");
  }
  std::array<double, kTrackChannels> now{};
  for (size_t i = 0; i < kTrackChannels; ++i) {
    if (channels_[i]) now[i] = number(*channels_[i]) / kUnits[i];
  }
  for (; static_cast<double>(next_ms_) <= now_ms + kRounding_ms; ++next_ms_) {
    TrackSample sample{};
    const double ms = static_cast<double>(next_ms_);
    const bool is_before = !last_ms_ && ms < now_ms - kRounding_ms;
    const double share =
        last_ms_ ? std::clamp((ms - *last_ms_) / (now_ms - *last_ms_), 0.0, 1.0) : 1;
    for (size_t i = 0; i < kTrackChannels && !is_before; ++i) {
      sample[i] = static_cast<float>(last_[i] + share * (now[i] - last_[i]));
    }
    take_(sample);
  }
  last_ms_ = now_ms;
  last_ = now;
}

void CsvTrackReader::finish() {
  if (!last_ms_) fail("the table has no rows");
}

void write_csv(const SampleSource& samples, const WriteText& write) {
  write("time_s");
  for (size_t i = 0; i < kTrackChannels; ++i) {
    write(std::string(",") + kNames[i] + (i < kTrackChannels / 2 ? "_N" : "_Nm"));
  }
  write("\n");
  size_t count = 0;
  samples.each([&](const TrackSample& sample) {
    char time[32];
    std::snprintf(time, sizeof time, "%zu.%03zu", count / kTrackRate_Hz, count % kTrackRate_Hz);
    ++count;
    std::string line = time;
    for (size_t i = 0; i < kTrackChannels; ++i) {
      line += ',';
      line += std::string_view(NumberText(static_cast<float>(kUnits[i]) * sample[i]));
    }
    write(line + '\n');
  });
}

}  // namespace spidar
