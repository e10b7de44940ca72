// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/track/funscript.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/json_text.h"
#include "core/number_text.h"
#include "core/track/keyframes.h"

namespace spidar {
namespace {

constexpr double kMiddle = 50;
constexpr const char *kNotesKey = "gst-spidar", *kChannelKey = "channel", *kGainKey = "gain";

/// Returns a member, or null.
const ReadJson* member(const ReadJson& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() ? &*found : nullptr;
}

double number(const ReadJson& object, const char* name, double least, double most,
              const std::string& where) {
  const ReadJson* const found = member(object, name);
  if (!found || !found->is_number()) throw TrackFileError(where + " has no number " + name);
  const double value = found->get<double>();
  if (!(value >= least && value <= most)) {
    std::string text = where + "." + name + " is ";
    text.append(NumberText(value)).append(", not from ").append(NumberText(least));
    throw TrackFileError(text.append(" to ").append(NumberText(most)));
  }
  return value;
}

/// The fraction of the full scale that a script uses, negative for an inverted script. Without an
/// entry, the result is `scale`.
double read_scale(const ReadJson& script, const std::string& where, double scale) {
  constexpr double kPercent = 100;
  if (const ReadJson* const inverted = member(script, "inverted")) {
    scale = std::copysign(scale, *inverted == ReadJson(true) ? -1 : 1);
  }
  if (!member(script, "range")) return scale;
  const double range = number(script, "range", 0, kPercent, where);
  return std::copysign(range > 0 ? range / kPercent : 1, scale);
}

std::vector<ScriptAxis::Point> read_points(const ReadJson& actions, const std::string& where,
                                           double scale) {
  if (!actions.is_array()) throw TrackFileError(where + " is no list");
  constexpr auto kLatest_ms = static_cast<double>(kLatestPosition_ms);
  std::vector<ScriptAxis::Point> points;
  for (size_t i = 0; i < actions.size(); ++i) {
    const std::string at = where + "[" + std::to_string(i) + "]";
    const double at_ms = number(actions[i], "at", -kLatest_ms, kLatest_ms, at);
    const double position = number(actions[i], "pos", 0, 2 * kMiddle, at);
    points.push_back({std::llround(at_ms), scale * (position / kMiddle - 1)});
  }
  const auto is_before = [](const auto& a, const auto& b) { return a.at_ms < b.at_ms; };
  std::stable_sort(points.begin(), points.end(), is_before);
  // The last of several positions at one time counts: the first in reverse order.
  const auto is_same = [](const auto& a, const auto& b) { return a.at_ms == b.at_ms; };
  points.erase(points.begin(), std::unique(points.rbegin(), points.rend(), is_same).base());
  return points;
}

double usual_gain(size_t channel) {
  return channel < kTrackChannels / 2 ? kTrackForceScale_N / kScriptForce_N
                                      : kTrackTorqueScale_Nm / kScriptTorque_Nm;
}

/// Replaces an axis of the same channel: players use the last of several.
void set_axis(ScriptAxis axis, Funscript& script) {
  const auto same = std::find_if(script.axes.begin(), script.axes.end(),
                                 [&](const auto& other) { return other.channel == axis.channel; });
  if (same == script.axes.end()) {
    script.axes.push_back(std::move(axis));
  } else {
    *same = std::move(axis);
  }
}

void read_axis(const ReadJson& from, const std::string& name, const std::string& where,
               double scale, Funscript& script) {
  const std::optional<size_t> channel = channel_of_axis(name);
  if (!channel) {
    script.others.push_back(name);
    return;
  }
  const ReadJson* const actions = member(from, "actions");
  if (!actions) throw TrackFileError(where + " has no actions");
  set_axis({name, *channel, usual_gain(*channel), false,
            read_points(*actions, where + ".actions", read_scale(from, where, scale))},
           script);
}

/// Reads the axes of version 1.1.
void read_axes(const ReadJson& axes, double scale, Funscript& script) {
  if (!axes.is_array()) throw TrackFileError("axes is no list");
  for (size_t i = 0; i < axes.size(); ++i) {
    const std::string where = "axes[" + std::to_string(i) + "]";
    const ReadJson* const id = member(axes[i], "id");
    if (!id || !id->is_string()) throw TrackFileError(where + " has no id such as \"R1\"");
    read_axis(axes[i], id->get<std::string>(), where, scale, script);
  }
}

/// Reads the channels of version 2.0.
void read_channels(const ReadJson& channels, double scale, Funscript& script) {
  if (!channels.is_object()) throw TrackFileError("channels is no object");
  for (const auto& [name, channel] : channels.items()) {
    read_axis(channel, name, "channels." + name, scale, script);
  }
}

/// Reads the notes of write_funscript(), if there are any.
void read_notes(const ReadJson& root, ScriptAxis& axis) {
  const ReadJson* const notes = member(root, kNotesKey);
  if (!notes) return;
  axis.channel = static_cast<size_t>(number(*notes, kChannelKey, 0, kTrackChannels - 1, kNotesKey));
  axis.gain = number(*notes, kGainKey, kMinGain, kMaxGain, kNotesKey);
  axis.is_noted = true;
}

bool equals_ignoring_case(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return small(x) == small(y); });
}

constexpr std::pair<const char*, size_t> kAxisNames[] = {
    {"stroke", 1}, {"L0", 1}, {"up", 1},    {"surge", 2}, {"L1", 2}, {"forward", 2},
    {"sway", 0},   {"L2", 0}, {"left", 0},  {"twist", 4}, {"R0", 4}, {"yaw", 4},
    {"roll", 5},   {"R1", 5}, {"pitch", 3}, {"R2", 3}};
constexpr const char* kOtherNames[] = {"vib", "vib0", "vib1", "vib2", "V0", "V1",   "V2",   "pump",
                                       "L3",  "suck", "A0",   "A1",   "A2", "lube", "valve"};

}  // namespace

void write_funscript(const SampleSource& samples, size_t channel, const WriteText& write,
                     double tolerance, double gain) {
  const Json notes = {{kChannelKey, channel}, {kGainKey, gain}};
  write(R"({"version":"1.0","inverted":false,"range":100,")" + std::string(kNotesKey) +
        "\":" + json_text(notes) + R"(,"actions":[)");
  KeyframeChooser keyframes(tolerance, [&write](size_t index, double fraction) {
    write((index == 0 ? R"({"at":)" : R"(,{"at":)") + std::to_string(index) + R"(,"pos":)" +
          std::to_string(std::lround(kMiddle + kMiddle * fraction)) + "}");
  });
  samples.each([&](const TrackSample& sample) {
    const double fraction = sample[channel];
    keyframes.add(std::isnan(fraction) ? 0 : std::clamp(fraction, -1.0, 1.0));
  });
  keyframes.finish();
  write("]}\n");
}

float ScriptAxis::at(int64_t time_ms) const {
  const auto after =
      std::upper_bound(points.begin(), points.end(), time_ms,
                       [](int64_t time, const Point& point) { return time < point.at_ms; });
  if (after == points.begin()) return 0;
  const Point& a = *(after - 1);
  if (after == points.end()) {
    return a.at_ms == time_ms ? static_cast<float>(a.fraction / gain) : 0;
  }
  const double part =
      static_cast<double>(time_ms - a.at_ms) / static_cast<double>(after->at_ms - a.at_ms);
  return static_cast<float>((a.fraction + part * (after->fraction - a.fraction)) / gain);
}

std::optional<size_t> channel_of_axis(std::string_view name) {
  for (const auto& [known, channel] : kAxisNames) {
    if (equals_ignoring_case(name, known)) return channel;
  }
  return std::nullopt;
}

bool is_other_axis(std::string_view name) {
  return std::any_of(std::begin(kOtherNames), std::end(kOtherNames),
                     [&](const char* other) { return equals_ignoring_case(name, other); });
}

Funscript parse_funscript(const std::string& text, size_t channel) {
  std::string why;
  const ReadJson root = parse_json(text, why);
  if (root.is_discarded()) throw TrackFileError(why);
  const ReadJson* const actions = member(root, "actions");
  const ReadJson* const axes = member(root, "axes");
  const ReadJson* const channels = member(root, "channels");
  if (!actions && !axes && !channels) throw TrackFileError("it has no actions");
  const double scale = read_scale(root, "the script", 1);
  ScriptAxis own{"", channel, usual_gain(channel), false, {}};
  read_notes(root, own);
  if (actions) own.points = read_points(*actions, "actions", scale);
  Funscript script;
  if (actions) set_axis(std::move(own), script);
  if (axes) read_axes(*axes, scale, script);
  if (channels) read_channels(*channels, scale, script);
  return script;
}

}  // namespace spidar
