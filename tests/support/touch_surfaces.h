// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Surfaces for tests of touching, at about z = −2 mm, over a picture of 60 mm × 34 mm.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/touch/height_field.h"
#include "core/touch/relief.h"

namespace spidar::test {

constexpr double kPictureWidth_m = 0.06;
constexpr double kPictureHeight_m = 0.03375;  // square cells

template <typename Surface>
touch::HeightField sampled_field(Surface&& z_m) {
  touch::HeightField field(kPictureWidth_m, kPictureHeight_m);
  for (int y = 0; y < touch::HeightField::kRows; ++y) {
    for (int x = 0; x < touch::HeightField::kColumns; ++x) {
      field.row(y)[x] = static_cast<float>(z_m(field.x_m(x), field.y_m(y)));
    }
  }
  return field;
}

inline touch::HeightField plane_field(double z_m) {
  return sampled_field([&](double, double) { return z_m; });
}

/// The upper part of a sphere that rises from a plane, its highest point at `top_z_m`.
inline touch::HeightField sphere_field(double x_m, double y_m, double radius_m, double top_z_m) {
  return sampled_field([&](double px_m, double py_m) {
    const double r2 = (px_m - x_m) * (px_m - x_m) + (py_m - y_m) * (py_m - y_m);
    const double most2 = 0.65 * radius_m * radius_m;  // slope 1.36
    return top_z_m - radius_m + std::sqrt(radius_m * radius_m - std::min(r2, most2));
  });
}

/// A picture of discs and stripes of all sizes, with `noise_level` of grey noise.
inline std::vector<uint8_t> busy_picture(unsigned seed, int width, int height, double noise_level) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> noise(0, noise_level);
  std::vector<double> grey(static_cast<size_t>(width * height), 128);
  for (int n = 0; n < 60; ++n) {
    const double x = width * uniform(random);
    const double y = height * uniform(random);
    const double radius = height * 0.25 * uniform(random) * uniform(random) + 3;
    const double level = 255 * uniform(random);
    const double angle = 7 * uniform(random);
    const double stretch = 0.3 + uniform(random);
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        const double u = std::cos(angle) * (i - x) + std::sin(angle) * (j - y);
        const double v = std::cos(angle) * (j - y) - std::sin(angle) * (i - x);
        if (u * u + v * v / (stretch * stretch) < radius * radius) {
          grey[static_cast<size_t>(j * width + i)] = level;
        }
      }
    }
  }
  std::vector<uint8_t> bytes;
  for (const double g : grey) {
    bytes.push_back(static_cast<uint8_t>(std::clamp(std::lround(g + noise(random)), 0L, 255L)));
  }
  return bytes;
}

struct TouchScene {
  std::string name;
  touch::HeightField relief;
  touch::HeightField texture;
};

/// Surfaces for tests of energy. Those of pictures have their fine detail; the others have a
/// texture of waves of 2 mm.
inline std::vector<TouchScene> touch_scenes() {
  const double two_pi = 2 * M_PI;
  const touch::HeightField wave = sampled_field([&](double x_m, double y_m) {
    return 5e-5 * std::sin(two_pi * x_m / 0.002) * std::sin(two_pi * y_m / 0.002);
  });
  std::vector<TouchScene> scenes;
  scenes.push_back({"plane", plane_field(-0.002), wave});
  scenes.push_back({"sphere", sphere_field(0, 0, 0.02, -0.002), wave});
  scenes.push_back({"sine of 1 mm, 6 mm", sampled_field([&](double x_m, double y_m) {
                      return -0.002 + 0.001 * std::sin(two_pi * x_m / 0.006) *
                                          std::sin(two_pi * y_m / 0.006);
                    }),
                    wave});
  touch::ReliefBuilder builder;
  const auto add_picture = [&](const char* name, const std::vector<uint8_t>& bytes) {
    const touch::ReliefSettings settings{-0.006, 0.008, 5e-4};
    touch::HeightField relief(kPictureWidth_m, kPictureHeight_m);
    touch::HeightField detail(kPictureWidth_m, kPictureHeight_m);
    builder.from_brightness({bytes.data(), 427, 240, 427}, settings, relief);
    builder.fine_detail(settings, detail);
    scenes.push_back({name, relief, detail});
  };
  std::vector<uint8_t> step(427 * 240);
  for (size_t i = 0; i < step.size(); ++i) step[i] = i % 427 < 213 ? 64 : 192;
  add_picture("step of 4 mm", step);
  add_picture("picture", busy_picture(1, 427, 240, 3));
  add_picture("noisy picture", busy_picture(2, 427, 240, 20));
  return scenes;
}

}  // namespace spidar::test
