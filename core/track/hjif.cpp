// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/json_text.h"
#include "core/number_text.h"
#include "core/track/exchange_formats.h"
#include "core/track/keyframes.h"

namespace spidar {
namespace {

constexpr std::array<const char*, kTrackChannels> kChannelNames = {
    "Force x, to the right: 1 is 10 N",
    "Force y, up: 1 is 10 N",
    "Force z, towards the viewer: 1 is 10 N",
    "Torque about x: 1 is 1 N m",
    "Torque about y: 1 is 1 N m",
    "Torque about z: 1 is 1 N m"};
/// The largest timescale of the format's main profile, ticks a second.
constexpr int64_t kMaxTicks_Hz = 48000;
/// The highest frequency that the haptic loop can render.
constexpr int kUpperLimit_Hz = kTrackRate_Hz / 2;

double to_steps(double value) {
  constexpr double kSteps = 1e5;
  return std::round(value * kSteps) / kSteps;
}

double amplitude_of(float sample) {
  if (std::isnan(sample)) return 0;
  return to_steps(std::clamp(static_cast<double>(sample), -1.0, 1.0));
}

void write_keyframe(const WriteText& write, size_t index, double value) {
  std::string text = index == 0 ? R"({"relative_position":)" : R"(,{"relative_position":)";
  text.append(NumberText(index));
  text += R"(,"amplitude_modulation":)";
  text.append(NumberText(value + 0.0));  // the sum turns −0 into 0
  write(text + '}');
}

/// Writes the keyframes of a curve. A curve needs more than two, because the Synthesizer of MPEG's
/// reference software turns two into silence.
class HjifCurveWriter {
 public:
  explicit HjifCurveWriter(const WriteText& write) : write_(write) {}

  void add(size_t index, double value) {
    if (count_ > 1) flush();
    last_index_ = index;
    last_value_ = value;
    if (count_++ == 0) {
      flush();
      first_value_ = value;
    }
  }
  void finish() {
    if (count_ == 2 && last_index_ > 1) {
      const size_t middle = last_index_ / 2;
      const double fraction = static_cast<double>(middle) / static_cast<double>(last_index_);
      write_keyframe(write_, middle,
                     to_steps(first_value_ + fraction * (last_value_ - first_value_)));
    }
    if (count_ > 1) flush();
  }

 private:
  void flush() { write_keyframe(write_, last_index_, last_value_); }

  const WriteText& write_;
  size_t count_ = 0, last_index_ = 0;
  double first_value_ = 0, last_value_ = 0;
};

void write_channel(const SampleSource& samples, const WriteText& write, size_t channel,
                   double tolerance) {
  std::string text = R"({"id":)";
  text.append(NumberText(channel));
  text += R"(,"description":")";
  text += kChannelNames[channel];
  text += R"(","gain":1.0,"mixing_coefficient":1.0,"body_part_mask":0,"frequency_sampling":)";
  text.append(NumberText(kTrackRate_Hz));
  text += R"(,"sample_count":)";
  text.append(NumberText(samples.count));
  text += R"(,"bands":[{"band_type":"Curve","curve_type":"Linear","lower_frequency_limit":0,)"
          R"("upper_frequency_limit":)";
  text.append(NumberText(kUpperLimit_Hz));
  text += R"(,"effects":[{"effect_type":"Basis","position":0,"phase":0.0,"base_signal":"Sine",)"
          R"("keyframes":[)";
  write(text);
  HjifCurveWriter curve(write);
  KeyframeChooser keyframes(tolerance,
                            [&curve](size_t index, double value) { curve.add(index, value); });
  samples.each([&](const TrackSample& sample) { keyframes.add(amplitude_of(sample[channel])); });
  keyframes.finish();
  curve.finish();
  write("]}]}]}");
}

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw TrackFileError(where + " " + what);
}

const ReadJson& member(const ReadJson& object, const char* name, const std::string& where) {
  if (!object.is_object()) fail(where, "is not an object");
  const auto found = object.find(name);
  if (found == object.end()) fail(where, std::string("has no ") + name);
  return *found;
}

const ReadJson& array(const ReadJson& object, const char* name, const std::string& where) {
  const ReadJson& value = member(object, name, where);
  if (!value.is_array()) fail(where + "." + name, "is not an array");
  return value;
}

std::string text_of(const ReadJson& object, const char* name, const std::string& where) {
  const ReadJson& value = member(object, name, where);
  if (!value.is_string()) fail(where + "." + name, "is not a string");
  return value.get<std::string>();
}

/// Reads a finite number of at most ±`most`.
double number(const ReadJson& object, const char* name, const std::string& where, double most) {
  const ReadJson& value = member(object, name, where);
  if (!value.is_number()) fail(where + "." + name, "is not a number");
  const double result = value.get<double>();
  if (!(std::fabs(result) <= most)) {
    std::string what = "is ";
    what.append(NumberText(result)).append(", must be from -").append(NumberText(most));
    fail(where + "." + name, what.append(" to ").append(NumberText(most)));
  }
  return result;
}

/// Reads a time in ticks, from 0 to 2^31 − 1 as in the format.
int64_t ticks(const ReadJson& object, const char* name, const std::string& where) {
  const double value = number(object, name, where, INT32_MAX);
  if (value < 0 || value != std::floor(value)) fail(where + "." + name, "is not a number of ticks");
  return static_cast<int64_t>(value);
}

struct Keyframe {
  int64_t tick;
  double amplitude;
};

/// Adds curves to samples, whose number grows as needed.
class Curves {
 public:
  Curves(int64_t ticks_Hz, size_t most_samples) : ticks_Hz_(ticks_Hz), most_(most_samples) {}

  void add(const std::vector<Keyframe>& curve, size_t channel, double gain,
           const std::string& where) {
    if (curve.empty()) return;
    reach(index_before(curve.back().tick) + 1, where);
    add_keyframe(curve.front(), channel, gain);
    for (size_t k = 1; k < curve.size(); ++k) {
      const Keyframe &a = curve[k - 1], &b = curve[k];
      const double length = static_cast<double>(b.tick - a.tick);
      for (size_t i = index_before(a.tick) + 1; i <= index_before(b.tick); ++i) {
        const double after =
            static_cast<double>(i) * static_cast<double>(ticks_Hz_) / kTrackRate_Hz -
            static_cast<double>(a.tick);
        const double value = a.amplitude + (b.amplitude - a.amplitude) * after / length;
        samples_[i][channel] += static_cast<float>(gain * value);
      }
    }
  }

  void reach(size_t count, const std::string& where) {
    if (count > most_) fail(where, "is longer than a track may be");
    if (samples_.size() < count) samples_.resize(count);
  }

  std::vector<TrackSample> take() { return std::move(samples_); }

 private:
  /// The last sample at or before the tick.
  size_t index_before(int64_t tick) const {
    return static_cast<size_t>(tick * kTrackRate_Hz / ticks_Hz_);
  }
  /// Sets the sample at a keyframe.
  void add_keyframe(const Keyframe& keyframe, size_t channel, double gain) {
    const size_t i = index_before(keyframe.tick);
    if (static_cast<int64_t>(i) * ticks_Hz_ == keyframe.tick * kTrackRate_Hz) {
      samples_[i][channel] += static_cast<float>(gain * keyframe.amplitude);
    }
  }

  const int64_t ticks_Hz_;
  const size_t most_;
  std::vector<TrackSample> samples_;
};

std::vector<Keyframe> read_keyframes(const ReadJson& effect, const std::string& where) {
  const int64_t begin = ticks(effect, "position", where);
  std::vector<Keyframe> curve;
  const ReadJson& keyframes = array(effect, "keyframes", where);
  for (size_t k = 0; k < keyframes.size(); ++k) {
    const std::string at = where + ".keyframes[" + std::to_string(k) + "]";
    const int64_t tick = begin + ticks(keyframes[k], "relative_position", at);
    if (!curve.empty() && tick <= curve.back().tick) fail(at, "is not after the one before");
    curve.push_back({tick, number(keyframes[k], "amplitude_modulation", at, 1)});
  }
  return curve;
}

void read_channel(const ReadJson& channel, size_t number_of_channel, Curves& curves,
                  const std::string& where) {
  const double gain = number(channel, "gain", where, 1e3);
  if (channel.contains("sample_count") && channel.contains("frequency_sampling")) {
    const auto count = static_cast<size_t>(ticks(channel, "sample_count", where));
    if (ticks(channel, "frequency_sampling", where) == kTrackRate_Hz) {
      curves.reach(count, where + ".sample_count");
    }
  }
  const ReadJson& bands = array(channel, "bands", where);
  for (size_t b = 0; b < bands.size(); ++b) {
    const std::string band = where + ".bands[" + std::to_string(b) + "]";
    const std::string type = text_of(bands[b], "band_type", band);
    if (type != "Curve") fail(band, "is of type " + type + ": only curves are forces");
    const std::string curve = text_of(bands[b], "curve_type", band);
    if (curve != "Linear") fail(band, "is a curve of type " + curve + ", not Linear");
    const ReadJson& effects = array(bands[b], "effects", band);
    for (size_t e = 0; e < effects.size(); ++e) {
      const std::string effect = band + ".effects[" + std::to_string(e) + "]";
      curves.add(read_keyframes(effects[e], effect), number_of_channel, gain, effect);
    }
  }
}

int64_t timescale_of(const ReadJson& root) {
  if (!root.contains("timescale")) return kTrackRate_Hz;
  const int64_t ticks_Hz = ticks(root, "timescale", "the file");
  if (ticks_Hz < 1 || ticks_Hz > kMaxTicks_Hz) fail("timescale", "must be from 1 to 48000");
  return ticks_Hz;
}

}  // namespace

void write_hjif(const SampleSource& samples, const WriteText& write, double tolerance) {
  std::string text =
      R"({"version":"2023","profile":"Main","level":1,"date":"2023-01-01","description":)"
      R"("Wanted wrench on a grip","timescale":)";
  text.append(NumberText(kTrackRate_Hz));
  text += R"(,"avatars":[],"perceptions":[{"id":0,"avatar_id":0,"description":)"
          R"("Force and torque on the grip","perception_modality":"Force","effect_library":[],)"
          R"("reference_devices":[],"channels":[)";
  write(text);
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    if (channel > 0) write(",");
    write_channel(samples, write, channel, tolerance);
  }
  write(R"(]}],"syncs":[]})"
        "\n");
}

std::vector<TrackSample> read_hjif(const std::string& text, size_t most_samples,
                                   std::vector<std::string>* others) {
  std::string why;
  const ReadJson root = parse_json(text, why);
  if (root.is_discarded()) throw TrackFileError(why);
  Curves curves(timescale_of(root), most_samples);
  // A variable, because with a temporary GCC 14 warns of a dangling reference.
  const std::string whole = "the file";
  const ReadJson& perceptions = array(root, "perceptions", whole);
  bool is_read = false;
  std::vector<std::string> unread;
  for (size_t p = 0; p < perceptions.size(); ++p) {
    const std::string where = "perceptions[" + std::to_string(p) + "]";
    const std::string modality = text_of(perceptions[p], "perception_modality", where);
    if (is_read || modality != "Force") {
      unread.push_back(where + " (" + modality + ")");
      continue;
    }
    const ReadJson& channels = array(perceptions[p], "channels", where);
    if (channels.size() != kTrackChannels) {
      fail(where, "has " + std::to_string(channels.size()) +
                      " channels; a haptic track has 6, force x, y, z and torque x, y, z");
    }
    for (size_t c = 0; c < channels.size(); ++c) {
      read_channel(channels[c], c, curves, where + ".channels[" + std::to_string(c) + "]");
    }
    is_read = true;
  }
  if (!is_read) {
    std::string only;
    for (const std::string& other : unread) only += (only.empty() ? ", only " : ", ") + other;
    fail(whole, "has no perception of modality Force" + only);
  }
  if (others) *others = std::move(unread);
  return curves.take();
}

}  // namespace spidar
