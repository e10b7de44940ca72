// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// For tests of sound cards.
#pragma once

#include "spidar/devices/sound/packets.h"
#include "spidar/session/device_factory.h"
#include "tests/support/emulated_card.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test {

inline constexpr int64_t kMs = 1'000'000;
inline constexpr int64_t kLatency_ms = 40;  // of the emulated card
inline constexpr double kFull = 32767;
inline constexpr double kFrame_ns = 1e9 / sound::kRate_Hz;

struct Sample {
  double at_ns;
  std::array<int16_t, 4> value;
};

/// Sound cards that are emulated behind ALSA's library, and keep what is heard and when.
class Sound : public testing::Test {
 protected:
  Sound() {
    // ALSA reads its configuration once in a process.
    static const TemporaryFolder folder;
    file_ = folder.path / "heard";
    gone_ = folder.path / "gone";
    fails_ = folder.path / "fails";
    recorded_ = folder.path / "recorded";
    const std::string files = " file \"" + file_.string() + "\" gone \"" + gone_.string() +
                              "\" fails \"" + fails_.string() + "\" ";
    std::ofstream(folder.path / "asound.conf")
        << "pcm_type.emulated { lib \"" << EMULATED_CARD << "\" }\n"
        << "pcm.shaker { type emulated channels 4 latency_ms " << kLatency_ms << " file \""
        << file_.string() << "\" gone \"" << gone_.string()
        << "\" hint { show on description \"Emulated shaker\" } }\n"
        << "pcm.stereo { type emulated channels 2 file \"" << file_.string() << "\" gone \""
        << gone_.string() << "\" hint { show on description \"Two channels\" } }\n"
        << "pcm.coarse { type emulated channels 2 period_ms 40" << files << "hint { show on } }\n"
        << "pcm.deep { type emulated channels 2 period_ms 85" << files << "hint { show on } }\n"
        << "pcm.large { type emulated channels 2 buffer_ms 310" << files << "hint { show on } }\n"
        << "pcm.recorder { type file format raw file \"" << recorded_.string()
        << "\" slave.pcm { type null } hint { show on } }\n"
        << "pcm.default { type null hint { show on description \"Speakers\" } }\n";
    setenv("ALSA_CONFIG_PATH", (folder.path / "asound.conf").c_str(), 1);
    for (const auto& path : {gone_, fails_, file_, recorded_}) std::filesystem::remove(path);
  }
  ~Sound() override {
    std::filesystem::remove(gone_);
    std::filesystem::remove(fails_);
  }

  void plug(bool in) {
    if (in)
      std::filesystem::remove(gone_);
    else
      std::ofstream(gone_) << "gone";
  }

  std::vector<Heard> events() const {
    std::vector<Heard> found;
    each([&](const Heard& record, const std::vector<int16_t>&) { found.push_back(record); });
    return found;
  }
  size_t count(Heard::Kind kind) const {
    const std::vector<Heard> found = events();
    return static_cast<size_t>(std::count_if(
        found.begin(), found.end(), [kind](const Heard& one) { return one.kind == kind; }));
  }
  template <typename Take>
  void each(const Take& take) const {
    std::ifstream file(file_, std::ios::binary);
    Heard record{};
    while (file.read(reinterpret_cast<char*>(&record), sizeof record)) {
      std::vector<int16_t> values(size_t{record.frames} * record.channels);
      file.read(reinterpret_cast<char*>(values.data()),
                static_cast<std::streamsize>(2 * values.size()));
      take(record, values);
    }
  }
  /// In the order of time.
  std::vector<Sample> heard() const {
    std::vector<Sample> samples;
    each([&](const Heard& record, const std::vector<int16_t>& values) {
      for (size_t i = 0; record.at_ns != 0 && i < record.frames; ++i) {
        Sample sample{static_cast<double>(record.at_ns) + kFrame_ns * static_cast<double>(i), {}};
        for (size_t channel = 0; channel < std::min(record.channels, 4u); ++channel)
          sample.value[channel] = values[i * record.channels + channel];
        samples.push_back(sample);
      }
    });
    return samples;
  }

  static std::unique_ptr<Grip> grip(const std::string& spec) {
    return make_grip(spec, load_profile(kDefaultProfile));
  }
  /// The message of open(), and what kind of error it is.
  static std::pair<std::string, DeviceErrorCode> error(const std::string& spec) {
    try {
      grip(spec)->open();
    } catch (const DeviceError& error) {
      return {error.what(), error.code()};
    }
    return {"", DeviceErrorCode::kFailed};
  }
  /// As the loop does, a force each millisecond.
  static void push(Grip& grip, const Eigen::Vector3d& force_N, int ms) {
    GripCommand command = told(force_N.x(), force_N.y());
    for (int i = 0; i < ms; ++i) {
      grip.exchange(command);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::filesystem::path file_, gone_, fails_, recorded_;
};

}  // namespace spidar::test
