// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/json_text.h"
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

/// A number from 0 to `most`.
double number(const Json& action, const char* name, double most, const std::string& where) {
  const auto found = action.is_object() ? action.find(name) : action.end();
  if (!action.is_object() || found == action.end() || !found->is_number()) {
    throw FunscriptError("funscript: " + where + " has no number " + name);
  }
  const double value = found->get<double>();
  if (!(value >= 0 && value <= most)) {
    std::ostringstream text;
    text << "funscript: " << where << "." << name << " is " << value << ", not from 0 to " << most;
    throw FunscriptError(text.str());
  }
  return value;
}

std::vector<Action> read_actions(const Json& root, size_t most_samples) {
  const Json* const actions =
      root.is_object() && root.contains("actions") ? &root["actions"] : nullptr;
  if (!actions || !actions->is_array() || actions->empty()) {
    throw FunscriptError("funscript: it has no actions");
  }
  const bool inverted = root.value("inverted", Json(false)) == Json(true);
  constexpr double kPercent = 100;
  const double range =
      root.contains("range") ? number(root, "range", kPercent, "the script") : kPercent;
  const double used = range > 0 ? range / kPercent : 1;
  std::vector<Action> found;
  for (size_t i = 0; i < actions->size(); ++i) {
    const std::string where = "actions[" + std::to_string(i) + "]";
    const double at_ms = number((*actions)[i], "at", static_cast<double>(most_samples) - 1, where);
    const double fraction = used * (number((*actions)[i], "pos", 2 * kMiddle, where) / kMiddle - 1);
    found.push_back({static_cast<size_t>(std::lround(at_ms)), inverted ? -fraction : fraction});
    if (i > 0 && found[i].at_ms <= found[i - 1].at_ms) {
      throw FunscriptError("funscript: " + where + " is not after the one before");
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
    keyframes.add(std::isfinite(fraction) ? std::clamp(fraction, -1.0, 1.0) : 0);
  });
  keyframes.finish();
  write("]}\n");
}

std::optional<FunscriptNotes> read_funscript_notes(const std::string& text) {
  const Json root = Json::parse(text, nullptr, false);
  const auto notes = root.is_object() ? root.find(kNotesKey) : root.end();
  if (!root.is_object() || notes == root.end() || !notes->is_object()) return std::nullopt;
  const Json channel = notes->value(kChannelKey, Json()), gain = notes->value(kGainKey, Json());
  if (!channel.is_number_unsigned() || !gain.is_number()) return std::nullopt;
  const FunscriptNotes found{channel.get<size_t>(), gain.get<double>()};
  if (found.channel >= kTrackChannels || !(found.gain > 0)) return std::nullopt;
  return found;
}

std::vector<TrackSample> read_funscript(const std::string& text, size_t channel,
                                        size_t most_samples) {
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::exception& error) {
    throw FunscriptError(std::string("funscript: no JSON: ") + error.what());
  }
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
