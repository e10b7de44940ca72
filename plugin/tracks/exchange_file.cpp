// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/exchange_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include <glib.h>

#include "core/track/exchange_formats.h"
#include "plugin/tracks/script_set.h"
#include "plugin/tracks/sidecar.h"
#include "spidar/whole_file.h"

namespace spidar::tracks {
namespace {

constexpr size_t kMaxText_bytes = size_t{1} << 30;  ///< for HJIF: a track of 24 hours has less

/// A track that is in memory as a whole.
class ExchangeTrack : public OpenTrack {
 public:
  /// `at` takes a time in ms.
  ExchangeTrack(const char* origin, int64_t length_ms, std::function<TrackSample(int64_t)> at,
                std::vector<std::string> about, std::vector<std::string> unfelt)
      : length_ms_(length_ms),
        at_(std::move(at)),
        about_(std::move(about)),
        unfelt_(std::move(unfelt)) {
    notes_.origin = origin;
  }
  ~ExchangeTrack() override { blocks_->stop(); }
  ExchangeTrack(const ExchangeTrack&) = delete;
  ExchangeTrack& operator=(const ExchangeTrack&) = delete;

  const Notes& notes() const override { return notes_; }
  std::optional<int64_t> duration_ns() const override { return length_ms_ * kTrackPeriod_ns; }
  std::string missing(int64_t) const override { return {}; }
  const std::shared_ptr<ReadAhead>& blocks() const override { return blocks_; }
  std::vector<std::string> about() const override { return about_; }
  std::vector<std::string> unfelt() const override { return unfelt_; }

  bool next(TrackBlock& block) override {
    if (next_ms_ >= length_ms_) return false;
    block.begin_ns = next_ms_ * kTrackPeriod_ns;
    block.count =
        static_cast<size_t>(std::min<int64_t>(TrackBlock::kCapacity, length_ms_ - next_ms_));
    block.duration_ns = static_cast<int64_t>(block.count) * kTrackPeriod_ns;
    for (size_t i = 0; i < block.count; ++i) block.samples[i] = at_(next_ms_++);
    return true;
  }
  void seek(int64_t time_ns) override {
    next_ms_ = std::clamp<int64_t>(time_ns / kTrackPeriod_ns, 0, length_ms_);
    blocks_->begin_pass();
  }
  void read_pass() override {
    TrackBlock block;
    while (next(block)) {
      if (!blocks_->push(block, {})) return;
    }
    blocks_->end_pass({});
  }

 private:
  const int64_t length_ms_;
  const std::function<TrackSample(int64_t)> at_;
  const std::vector<std::string> about_, unfelt_;
  int64_t next_ms_ = 0;
  Notes notes_;
  const std::shared_ptr<ReadAhead> blocks_ = std::make_shared<ReadAhead>();
};

bool is_hjif(const std::string& path) {
  return g_ascii_strcasecmp(std::filesystem::path(path).extension().c_str(), ".hjif") == 0;
}

}  // namespace

bool is_exchange_file(const std::string& path) {
  return is_script(path) || is_hjif(path);
}

std::string find_exchange_file(const std::string& film) {
  const std::string script = find_script(film);
  return script.empty() ? find_beside(film, {".hjif"}) : script;
}

std::unique_ptr<OpenTrack> open_exchange_file(const std::string& path, const std::string& film) {
  if (is_hjif(path)) {
    std::vector<std::string> unfelt;
    std::vector<TrackSample> samples = read_hjif_file(path, unfelt);
    const auto length_ms = static_cast<int64_t>(samples.size());
    auto at = [samples = std::move(samples)](int64_t time_ms) {
      return samples[static_cast<size_t>(time_ms)];
    };
    return std::make_unique<ExchangeTrack>("hjif", length_ms, std::move(at),
                                           std::vector<std::string>{path + ": force and torque"},
                                           std::move(unfelt));
  }
  ScriptChoice choice;
  choice.film = film;
  ScriptSet set = read_scripts(path, choice);
  const int64_t length_ms = set.length_ms();
  const std::vector<std::string> about = set.about, unfelt = set.unfelt;
  return std::make_unique<ExchangeTrack>(
      "funscript", length_ms, [set = std::move(set)](int64_t time_ms) { return set.at(time_ms); },
      about, unfelt);
}

std::vector<TrackSample> read_hjif_file(const std::string& path, std::vector<std::string>& unfelt) {
  try {
    std::vector<std::string> others;
    std::vector<TrackSample> samples =
        read_hjif(read_regular_file(path, kMaxText_bytes), kMaxHjifSamples, &others);
    for (const std::string& other : others) unfelt.push_back(other + " of " + path);
    return samples;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace spidar::tracks
