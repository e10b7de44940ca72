// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/depth_clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "tests/support/texture.h"

namespace spidar::test {
namespace {

using Eigen::Vector3d;

/// Draws the same numbers with every standard library.
class Draws {
 public:
  explicit Draws(uint32_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) * 0x1p-32);
  }
  /// Draws a ratio, uniform in its logarithm.
  double of_ratios(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  double sign() { return between(-1, 1) < 0 ? -1 : 1; }

 private:
  std::mt19937 engine_;
};

/// Grey levels −1 … 1 with details of all sizes, of which every octave has the same contrast. The
/// pattern repeats after kSide_px, mirrored, and is drawn once.
class Grain {
 public:
  Grain() {
    for (int y = 0; y < kSide_px; ++y) {
      for (int x = 0; x < kSide_px; ++x) {
        double sum = 0;
        for (const uint32_t octave : {1U, 2U, 3U, 4U, 5U}) {
          sum += Texture(octave, 1U << octave).at(x, y) - 128;
        }
        greys_.push_back(static_cast<float>(sum / 250));
      }
    }
  }
  double at(int x, int y) const {
    const auto mirrored = [](int at) {
      const int in_two = at & (2 * kSide_px - 1);
      return static_cast<size_t>(std::min(in_two, 2 * kSide_px - 1 - in_two));
    };
    return static_cast<double>(greys_[mirrored(y) * kSide_px + mirrored(x)]);
  }

 private:
  static constexpr int kSide_px = 512;
  std::vector<float> greys_;
};

const Grain& grain() {
  static const Grain grain;
  return grain;
}

/// 1 in `share` of each period, 0 elsewhere, with edges of a texel.
double bars(double at, double period, double share) {
  const double from_middle = std::abs(at / period - std::round(at / period)) * period;
  return std::clamp(share * period / 2 - from_middle + 0.5, 0.0, 1.0);
}

double opaque(int, int) {
  return 1;
}

}  // namespace

const char* DepthClip::to_string(Kind kind) {
  constexpr std::array names{"relief", "orbit", "facade", "roof", "railing", "sleepers", "bricks"};
  return names[static_cast<size_t>(kind)];
}

template <typename Grey, typename Opacity>
void DepthClip::add_plane(int width, int height, const Vector3d& centre, double yaw_rad,
                          double pitch_rad, Grey&& grey, Opacity&& opacity) {
  Plane plane;
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(yaw_rad, Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(pitch_rad, Vector3d::UnitX()))
                                     .toRotationMatrix();
  plane.centre = centre;
  plane.right = turned.col(0);
  plane.down = turned.col(1);
  Skin skin;
  skin.width = width;
  skin.height = height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      skin.grey.push_back(static_cast<float>(grey(x, y)));
      skin.opacity.push_back(static_cast<float>(opacity(x, y)));
    }
  }
  while (std::min(skin.width, skin.height) >= 4) {
    plane.skins.push_back(skin);
    const Skin& larger = plane.skins.back();
    skin = Skin();
    skin.width = larger.width / 2;
    skin.height = larger.height / 2;
    for (int y = 0; y < skin.height; ++y) {
      for (int x = 0; x < skin.width; ++x) {
        const auto i = static_cast<size_t>(2 * y * larger.width + 2 * x);
        const auto below = i + static_cast<size_t>(larger.width);
        const auto mean = [&](const std::vector<float>& of) {
          return (of[i] + of[i + 1] + of[below] + of[below + 1]) / 4;
        };
        skin.grey.push_back(mean(larger.grey));
        skin.opacity.push_back(mean(larger.opacity));
      }
    }
  }
  planes_.push_back(std::move(plane));
}

DepthClip::DepthClip(Kind kind, uint32_t seed) : seed_(seed) {
  Draws draws(seed);
  const auto photo = [&draws](double contrast) {
    const int right = static_cast<int>(draws.between(0, 1024));
    const int down = static_cast<int>(draws.between(0, 1024));
    const double mean = draws.between(90, 160);
    return [=](int x, int y) { return mean + contrast * grain().at(x + right, y + down); };
  };
  const double period = draws.of_ratios(6, 40);
  const double contrast = draws.between(20, 100);
  const double speed_px = draws.of_ratios(1, 10) * draws.sign();
  const double yaw_rad = draws.between(0.3, 0.9) * draws.sign();
  const double heading_rad = draws.between(-0.4, 0.4);
  const double detail = draws.between(4, 20);
  const auto surface = photo(detail);

  add_plane(1200, 900, {0, 0, 1.3 * kFocus_px}, 0, 0, photo(draws.between(30, 90)), opaque);
  const bool is_of_cards = kind == Kind::kRelief || kind == Kind::kOrbit;
  for (int card = 0; is_of_cards && card < 5; ++card) {
    const double nearer = kind == Kind::kOrbit ? 0.5 : 0.7;
    const double depth = kFocus_px * (1.2 - (1.2 - nearer) * (card + draws.between(0, 1)) / 5);
    const double right = draws.between(-200, 200), down = draws.between(-80, 120);
    const int width = static_cast<int>(draws.between(60, 200));
    const int height = static_cast<int>(draws.between(60, 200));
    add_plane(width, height, {right, down, depth}, draws.between(-0.5, 0.5), 0, photo(60), opaque);
  }
  const Vector3d middle(draws.between(-60, 60), draws.between(-30, 30), kFocus_px);
  switch (kind) {
    case Kind::kRelief:
    case Kind::kOrbit:
      break;
    case Kind::kFacade:
      add_plane(
          700, 500, middle, yaw_rad, 0,
          [&](int x, int y) {
            return surface(x, y) - contrast * bars(x, period, 0.5) * bars(y, 1.4 * period, 0.6);
          },
          opaque);
      break;
    case Kind::kRoof:
      add_plane(
          700, 500, middle, yaw_rad / 2, -0.8,
          [&](int x, int y) {
            const double row = std::floor(y / period);
            return surface(x, y) - contrast * std::max(bars(y, period, 0.25),
                                                       bars(x + row * period / 2, period, 0.1));
          },
          opaque);
      break;
    case Kind::kRailing:
      add_plane(
          900, 160, {middle.x(), 40, 0.7 * kFocus_px}, yaw_rad / 3, 0,
          [&](int x, int y) { return surface(x, y) - contrast / 2; },
          [&](int x, int y) { return std::max(bars(x, period, 0.35), bars(y, 70, 0.12)); });
      break;
    case Kind::kSleepers:
      add_plane(
          500, 1600, {0, 90, 2.2 * kFocus_px}, 0, M_PI / 2,
          [&](int x, int y) {
            const double rails = std::max(bars(x - 190, 1000, 0.012), bars(x - 310, 1000, 0.012));
            const double sleeper = std::abs(x - 250) < 90 ? bars(y, 3 * period, 0.45) : 0;
            return surface(x, y) - contrast * (sleeper - rails);
          },
          opaque);
      break;
    case Kind::kBricks:
      add_plane(
          1200, 900, middle, 0, 0,
          [&](int x, int y) {
            const double row = std::floor(y / (period / 2));
            return surface(x, y) + contrast * std::max(bars(y, period / 2, 0.2),
                                                       bars(x + row * period / 2, period, 0.1));
          },
          opaque);
      break;
  }

  Vector3d shake(0, 0, 0);
  for (int n = 0; n < kPictures; ++n) {
    const double step = n - kPictures / 2.0;
    const double way = speed_px * step;
    View view{Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    const Vector3d aside(way * std::cos(heading_rad), way * std::sin(heading_rad), 0);
    switch (kind) {
      case Kind::kOrbit: {
        const double turned_rad = way / kFocus_px;
        view.turned = Eigen::AngleAxisd(turned_rad, Vector3d::UnitY()).toRotationMatrix();
        const Vector3d centre(0, 0, kFocus_px);
        view.from = centre - view.turned.transpose() * centre;
        break;
      }
      case Kind::kSleepers:
        view.from = {0, 0, way};
        break;
      case Kind::kBricks:
        for (int axis = 0; axis < 3; ++axis) {
          shake[axis] = 0.5 * shake[axis] + draws.between(-1, 1) * speed_px / kFocus_px;
        }
        view.turned = (seed % 2 == 0 ? Eigen::AngleAxisd(way / kFocus_px, Vector3d::UnitY())
                                     : Eigen::AngleAxisd(shake.x(), Vector3d::UnitY()))
                          .toRotationMatrix();
        view.turned = Eigen::AngleAxisd(shake.y() / 2, Vector3d::UnitX()) * view.turned;
        break;
      default:
        view.from = aside;
    }
    views_.push_back(view);
  }
}

/// A pixel is at M (x, y, 1)ᵀ of the plane, seen with M's last row as 1 / depth.
void DepthClip::draw(const Plane& plane, const View& view, std::vector<float>& greys) const {
  Eigen::Matrix3d to_picture;
  to_picture << plane.right, plane.down, plane.centre - view.from;
  const Eigen::Matrix3d to_plane = (view.turned * to_picture).inverse();
  const Eigen::RowVector2d along = to_plane.bottomLeftCorner<1, 2>();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Vector3d at = to_plane * Vector3d(x - kWidth / 2, y - kHeight / 2, kFocus_px);
      if (!(at.z() > 0)) continue;
      const Eigen::Vector2d on = at.head<2>() / at.z();
      const Eigen::Matrix2d texels = (to_plane.topLeftCorner<2, 2>() - on * along) / at.z();
      // Half of the logarithm of the number of texels that a pixel covers.
      const double size = std::log2(std::abs(texels.determinant())) / 2;
      const double level = std::clamp(size, 0.0, static_cast<double>(plane.skins.size() - 1));
      const Skin& skin = plane.skins[static_cast<size_t>(level)];
      const double smaller = std::exp2(std::floor(level));
      const Skin& whole = plane.skins.front();
      const double u = (on.x() + whole.width / 2.0) / smaller - 0.5;
      const double v = (on.y() + whole.height / 2.0) / smaller - 0.5;
      if (!(u >= 0 && v >= 0 && u < skin.width - 1 && v < skin.height - 1)) continue;
      const auto left = static_cast<size_t>(u), top = static_cast<size_t>(v);
      const auto right = static_cast<float>(u - std::floor(u));
      const auto down = static_cast<float>(v - std::floor(v));
      const size_t i = top * static_cast<size_t>(skin.width) + left;
      const size_t below = i + static_cast<size_t>(skin.width);
      const auto read = [&](const std::vector<float>& of) {
        const float upper = of[i] + right * (of[i + 1] - of[i]);
        const float lower = of[below] + right * (of[below + 1] - of[below]);
        return upper + down * (lower - upper);
      };
      float& grey = greys[static_cast<size_t>(y * kWidth + x)];
      grey += read(skin.opacity) * (read(skin.grey) - grey);
    }
  }
}

Picture DepthClip::picture(int n) const {
  std::vector<float> greys(static_cast<size_t>(kWidth * kHeight), 128.0F);
  for (const Plane& plane : planes_) draw(plane, views_[static_cast<size_t>(n)], greys);
  Draws draws(1000 * seed_ + static_cast<uint32_t>(n));
  // Uniform from −2.6 to 2.6.
  constexpr double kNoise_grey = 1.5 * 1.7321;
  Picture picture(kWidth, kHeight);
  picture.fill([&](double x, double y) {
    const float grey = greys[static_cast<size_t>(y) * kWidth + static_cast<size_t>(x)];
    const double noise_grey = draws.between(-kNoise_grey, kNoise_grey);
    return std::clamp(static_cast<double>(grey) + noise_grey, 0.0, 255.0);
  });
  return picture;
}

}  // namespace spidar::test
