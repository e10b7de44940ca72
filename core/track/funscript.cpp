// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>

#include "core/json_text.h"
#include "core/number_text.h"
#include "core/track/exchange_formats.h"
#include "core/track/keyframes.h"

namespace spidar {
namespace {

constexpr double kMiddle = 50;
constexpr const char *kNotesKey = "gst-spidar", *kChannelKey = "channel", *kGainKey = "gain";

struct Action {
  size_t at_ms;
  double fraction;  ///< of the full scale
};

struct Range {
  double least, most;
};

double number(const ReadJson& object, const char* name, Range range, const std::string& where) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  if (!object.is_object() || found == object.end() || !found->is_number()) {
    throw FunscriptError(where + " has no number " + name);
  }
  const double value = found->get<double>();
  if (!(value >= range.least && value <= range.most)) {
    std::string text = where + "." + name + " is ";
    text.append(NumberText(value)).append(", not from ").append(NumberText(range.least));
    throw FunscriptError(text.append(" to ").append(NumberText(range.most)));
  }
  return value;
}

/// Throws FunscriptError.
ReadJson parse(const std::string& text) {
  std::string why;
  ReadJson root = parse_json(text, why);
  if (root.is_discarded()) throw FunscriptError(why);
  return root;
}

std::vector<Action> read_actions(const ReadJson& root, size_t most_samples) {
  const ReadJson* const actions =
      root.is_object() && root.contains("actions") ? &root["actions"] : nullptr;
  if (!actions || !actions->is_array() || actions->empty()) {
    throw FunscriptError("it has no actions");
  }
  const bool inverted = root.value("inverted", ReadJson(false)) == ReadJson(true);
  constexpr double kPercent = 100;
  const double range =
      root.contains("range") ? number(root, "range", {0, kPercent}, "the script") : kPercent;
  const double used = range > 0 ? range / kPercent : 1;
  std::vector<Action> found;
  for (size_t i = 0; i < actions->size(); ++i) {
    const std::string where = "actions[" + std::to_string(i) + "]";
    const double at_ms =
        number((*actions)[i], "at", {0, static_cast<double>(most_samples) - 1}, where);
    const double fraction =
        used * (number((*actions)[i], "pos", {0, 2 * kMiddle}, where) / kMiddle - 1);
    found.push_back({static_cast<size_t>(std::lround(at_ms)), inverted ? -fraction : fraction});
    if (i > 0 && found[i].at_ms <= found[i - 1].at_ms) {
      throw FunscriptError(where + " is not after the one before");
    }
  }
  return found;
}

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

std::optional<FunscriptNotes> read_funscript_notes(const std::string& text) {
  const ReadJson root = parse(text);
  if (!root.is_object() || !root.contains(kNotesKey)) return std::nullopt;
  const ReadJson& notes = root[kNotesKey];
  const double channel = number(notes, kChannelKey, {0, kTrackChannels - 1}, kNotesKey);
  const double gain = number(notes, kGainKey, {kLeastGain, kMostGain}, kNotesKey);
  return FunscriptNotes{static_cast<size_t>(channel), gain};
}

std::vector<TrackSample> read_funscript(const std::string& text, size_t channel,
                                        size_t most_samples) {
  const ReadJson root = parse(text);
  const std::vector<Action> actions = read_actions(root, most_samples);
  std::vector<TrackSample> samples(actions.back().at_ms + 1);
  samples[actions.front().at_ms][channel] = static_cast<float>(actions.front().fraction);
  for (size_t k = 1; k < actions.size(); ++k) {
    const Action &a = actions[k - 1], &b = actions[k];
    const auto length_ms = static_cast<double>(b.at_ms - a.at_ms);
    for (size_t i = a.at_ms + 1; i <= b.at_ms; ++i) {
      const double part = static_cast<double>(i - a.at_ms) / length_ms;
      samples[i][channel] = static_cast<float>(a.fraction + part * (b.fraction - a.fraction));
    }
  }
  return samples;
}

}  // namespace spidar
