// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Spectrum of the force between two frames at 24 and 60 frames/s, as the timeline gives it to the 1
// kHz loop, compared with holding each frame's force and with straight lines.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <vector>

#include "core/force/wrench_timeline.h"

namespace {

using spidar::WrenchTimeline;

constexpr int kTicks = 8000;  // of 1 ms; the bins of the spectrum are 1/8 Hz apart
constexpr double kTick_s = 1e-3;
constexpr double kFelt_Hz = 30;

using Force = std::function<double(double time_s)>;

/// One of the ways from frames to ticks. `ahead_s`: how long before it is shown a frame is known.
struct Way {
  const char* name;
  std::function<double(const Force&, double frame_s, int tick)> at;
};

double held(const Force& force, double frame_s, int tick) {
  return force(frame_s * std::floor(tick * kTick_s / frame_s));
}

double straight(const Force& force, double frame_s, int tick) {
  const double frame = std::floor(tick * kTick_s / frame_s);
  const double s = tick * kTick_s / frame_s - frame;
  return (1 - s) * force(frame_s * frame) + s * force(frame_s * (frame + 1));
}

/// The timeline in use: every tick takes the frames that are known by then.
class Timeline {
 public:
  explicit Timeline(double ahead_s) : ahead_s_(ahead_s) {}

  double at(const Force& force, double frame_s, int tick) {
    if (tick == 0) {
      timeline_.clear();
      frames_ = 0;
    }
    for (; frames_ * frame_s <= tick * kTick_s + ahead_s_; ++frames_) {
      const int64_t time_ns = std::llround(1e9 * frame_s * frames_);
      timeline_.push({time_ns, 100'000'000, {{force(frame_s * frames_), 0, 0}, {0, 0, 0}}});
    }
    return timeline_.at(1'000'000 * int64_t{tick}).wrench.force_N.x();
  }

 private:
  double ahead_s_;
  WrenchTimeline timeline_;
  int frames_ = 0;
};

/// Mean square above kFelt_Hz, N². Hann window (mean square 3/8), so that what does not fit into
/// the window does not leak there.
double power_above(const std::vector<double>& force_N) {
  static const std::vector<double> wave = [] {
    std::vector<double> cosine(kTicks);
    for (size_t i = 0; i < kTicks; ++i) {
      cosine[i] = std::cos(2 * M_PI * static_cast<double>(i) / kTicks);
    }
    return cosine;
  }();
  double power = 0;
  constexpr auto kFirst = static_cast<size_t>(kFelt_Hz * kTicks * kTick_s) + 1;
  for (size_t bin = kFirst; bin < kTicks / 2; ++bin) {
    double re = 0, im = 0;
    for (size_t i = 0; i < kTicks; ++i) {
      const double windowed_N = (0.5 - 0.5 * wave[i]) * force_N[i];
      re += windowed_N * wave[bin * i % kTicks];
      im += windowed_N * wave[(bin * i + kTicks / 4) % kTicks];
    }
    power += 2 * (re * re + im * im) / (double{kTicks} * kTicks) / 0.375;
  }
  return power;
}

/// From one tick to the next, but for the first frames, which come out of nothing.
double largest_step(const std::vector<double>& force_N) {
  double largest = 0;
  for (size_t i = 100; i < force_N.size(); ++i) {
    largest = std::max(largest, std::fabs(force_N[i] - force_N[i - 1]));
  }
  return largest;
}

double rms(const std::vector<double>& force_N) {
  double sum = 0;
  for (const double f : force_N) sum += f * f;
  return std::sqrt(sum / static_cast<double>(force_N.size()));
}

}  // namespace

int main() {
  const struct {
    const char* name;
    Force force;
  } motions[] = {
      {"sway, 1 N at 1.3 Hz", [](double t) { return std::sin(2 * M_PI * 1.3 * t); }},
      {"shake, 1 N at 4.7 Hz", [](double t) { return std::sin(2 * M_PI * 4.7 * t); }},
      // Twice a second the velocity turns round within 50 ms.
      {"bounce, 1 N", [](double t) { return std::tanh(60 * std::sin(2 * M_PI * t) / (2 * M_PI)); }},
  };
  Timeline player(0.1);
  Timeline due(1e-9);
  Timeline live(0.02);
  const Way ways[] = {
      {"held", held},
      {"straight lines", straight},
      {"timeline, player",
       [&](const Force& f, double frame_s, int tick) { return player.at(f, frame_s, tick); }},
      {"timeline, live, known 20 ms ahead",
       [&](const Force& f, double frame_s, int tick) { return live.at(f, frame_s, tick); }},
      {"timeline, live, known when due",
       [&](const Force& f, double frame_s, int tick) { return due.at(f, frame_s, tick); }},
      {"the motion itself", [](const Force& f, double, int tick) { return f(tick * kTick_s); }},
  };
  std::printf(
      "| motion | frames/s | way | above 30 Hz, mN rms | of all, dB | largest step, mN |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const auto& motion : motions) {
    for (const int rate : {24, 60}) {
      for (const Way& way : ways) {
        std::vector<double> force_N(kTicks);
        for (int tick = 0; tick < kTicks; ++tick) {
          force_N[static_cast<size_t>(tick)] = way.at(motion.force, 1.0 / rate, tick);
        }
        const double above_N = std::sqrt(power_above(force_N));
        std::printf("| %s | %d | %s | %.2f | %.0f | %.1f |\n", motion.name, rate, way.name,
                    1e3 * above_N, 20 * std::log10(above_N / rms(force_N)),
                    1e3 * largest_step(force_N));
      }
    }
  }
}
