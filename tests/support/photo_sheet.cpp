// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/photo_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "tests/support/bspline.h"

namespace spidar::test {
namespace {

/// 0 … 1, one after the other.
class Uniform {
 public:
  explicit Uniform(uint32_t seed) : seed_(seed) {}
  double operator()() { return (lattice_value(seed_, ++count_, -1) + 1) / 2; }

 private:
  uint32_t seed_;
  int64_t count_ = 0;
};

/// The same spline over a grid twice as fine (knot insertion: 1/8 (1 4 6 4 1) in each direction).
SplineSheet refined(const SplineSheet& coarse, const SplineSheet& size) {
  SplineSheet fine = size;
  const auto between = [](float a, float b) { return (a + b) / 2; };
  const auto on = [](float a, float b, float c) { return (a + 6 * b + c) / 8; };
  for (int j = 0; j < fine.rows(); ++j) {
    const auto column = [&](int i) {
      const int row = j / 2;
      if (j % 2 != 0) return between(coarse.control(i, row), coarse.control(i, row + 1));
      return on(coarse.control(i, row - 1), coarse.control(i, row), coarse.control(i, row + 1));
    };
    for (int i = 0; i < fine.columns(); ++i) {
      const int k = i / 2;
      fine.control(i, j) = i % 2 != 0 ? between(column(k), column(k + 1))
                                      : on(column(k - 1), column(k), column(k + 1));
    }
  }
  return fine;
}

/// Noise, uniform in −1 … 1 at the control values of each octave.
SplineSheet octaves(uint32_t seed, const SplineSheet& size) {
  int halvings = 0;
  while (std::min(size.columns(), size.rows()) >> halvings > 8) ++halvings;
  SplineSheet sum(1, 1);
  for (int octave = 0; octave <= halvings; ++octave) {
    const double scale = SplineSheet::kSpacing_px / (1 << (halvings - octave));
    const SplineSheet finer(size.columns() * scale, size.rows() * scale);
    sum = octave == 0 ? finer : refined(sum, finer);
    for (int j = 0; j < sum.rows(); ++j) {
      for (int i = 0; i < sum.columns(); ++i) {
        sum.control(i, j) +=
            static_cast<float>(lattice_value(seed + static_cast<uint32_t>(octave), i, j));
      }
    }
  }
  return sum;
}

/// An ellipse or a rectangle; lengths in control values.
struct Leaf {
  Eigen::Vector2d middle;
  Eigen::Matrix2d to_unit;  ///< its own axes, in which it reaches from −1 to 1
  double reach;             ///< bounds the distance of its parts from the middle
  bool round;
  float grey;
  float grain;  ///< grey levels of an octave's noise

  bool covers(const Eigen::Vector2d& position) const {
    const Eigen::Vector2d unit = to_unit * (position - middle);
    return round ? unit.squaredNorm() <= 1 : unit.cwiseAbs().maxCoeff() <= 1;
  }
};

Leaf fall(Uniform& uniform, const SplineSheet& sheet) {
  // The smallest leaves are 6 px across: a lens and a sensor show less contrast in smaller things.
  const double smallest = 1.5;
  const double largest = std::min(sheet.columns(), sheet.rows()) / 6.0;
  Leaf leaf{};
  leaf.middle.x() = uniform() * sheet.columns();
  leaf.middle.y() = uniform() * sheet.rows();
  // Number ~ r⁻³: r⁻² is uniform.
  const double inverse_square =
      std::pow(smallest, -2) + uniform() * (std::pow(largest, -2) - std::pow(smallest, -2));
  const double radius = 1 / std::sqrt(inverse_square);
  const double slenderness = 1 + uniform();  // of the same area
  leaf.to_unit = Eigen::Vector2d(1 / slenderness, slenderness).asDiagonal() *
                 Eigen::Rotation2Dd(M_PI * uniform()).toRotationMatrix() / radius;
  leaf.round = uniform() < 0.5;
  leaf.reach = std::sqrt(2.0) * radius * slenderness;
  leaf.grey = static_cast<float>(40 + 170 * uniform());
  leaf.grain = static_cast<float>(std::max(0.0, 14 * uniform() - 4));
  return leaf;
}

/// The number of control values that the leaf covers.
template <typename Cover>
double lay(const Leaf& leaf, Cover&& cover) {
  double covered = 0;
  const Eigen::Array2i first = (leaf.middle.array() - leaf.reach).ceil().cast<int>();
  const Eigen::Array2i last = (leaf.middle.array() + leaf.reach).floor().cast<int>();
  for (int j = first.y(); j <= last.y(); ++j) {
    for (int i = first.x(); i <= last.x(); ++i) {
      if (!leaf.covers(Eigen::Vector2d(i, j))) continue;
      cover(i, j);
      ++covered;
    }
  }
  return covered;
}

/// The blur of a lens, 1/4 (1 2 1) in each direction: without it the slanted edge of a leaf is a
/// staircase of control values.
SplineSheet softened(const SplineSheet& sheet) {
  SplineSheet soft = sheet;
  for (int j = 0; j < sheet.rows(); ++j) {
    for (int i = 0; i < sheet.columns(); ++i) {
      float sum = 0;
      for (int b = -1; b <= 1; ++b) {
        for (int a = -1; a <= 1; ++a) {
          sum += static_cast<float>((2 - std::abs(a)) * (2 - std::abs(b))) *
                 sheet.control(i + a, j + b);
        }
      }
      soft.control(i, j) = sum / 16;
    }
  }
  return soft;
}

}  // namespace

SplineSheet photo_sheet(uint32_t seed, double width_px, double height_px) {
  constexpr double kLayers = 5;  // leaves on top of each other: e⁻⁵ of the ground remains
  SplineSheet sheet(width_px, height_px);
  const SplineSheet noise = octaves(seed, sheet);
  Uniform uniform(seed);
  const auto cover = [&](const Leaf& leaf) {
    return lay(leaf, [&](int i, int j) {
      sheet.control(i, j) = std::clamp(leaf.grey + leaf.grain * noise.control(i, j), 0.0f, 255.0f);
    });
  };
  sheet.fill([](double, double) { return 128; });
  const double area = static_cast<double>(sheet.columns()) * sheet.rows();
  for (double covered = 0; covered < kLayers * area;) covered += cover(fall(uniform, sheet));
  return softened(sheet);
}

SplineSheet plain_sheet(double grey) {
  SplineSheet sheet(1, 1);
  sheet.fill([grey](double, double) { return grey; });
  return sheet;
}

SplineSheet edge_sheet(double width_px, double height_px, const Eigen::Vector2d& through_px,
                       const Eigen::Vector2d& normal) {
  SplineSheet sheet(width_px, height_px);
  sheet.fill([&](double x, double y) {
    // Without a soft control value, the edge of a slanted line would be a row of steps: corners.
    const double side_px = normal.normalized().dot(Eigen::Vector2d(x, y) - through_px);
    return 128 + 60 * std::clamp(side_px / SplineSheet::kSpacing_px, -1.0, 1.0);
  });
  return sheet;
}

}  // namespace spidar::test
