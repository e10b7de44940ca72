// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/coded_film.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture.h"

namespace spidar::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

/// The grey of noise that is blurred by a Gaussian of σ = `blur_px`, with a standard deviation of
/// `sigma_grey`. Both figures are those of cubic B-splines over values that are uniform from −120
/// to 120.
double soft(uint32_t seed, double blur_px, double sigma_grey, double x, double y) {
  const double spread_grey = 120 / std::sqrt(3.0) * 151 / 315;
  return sigma_grey / spread_grey * (Texture(seed, std::sqrt(3.0) * blur_px).at(x, y) - 128);
}

double wall_grey(const CodedFilm& film, double x, double y) {
  switch (film.wall) {
    case CodedFilm::Wall::kPlain:
      return 112;
    case CodedFilm::Wall::kSlope:
      return 60 + 100 * x / film.width_px + 40 * y / film.height_px;
    case CodedFilm::Wall::kShade:
      return 128 + 30 * std::sin(x / 90) * std::cos(y / 70 + x / 300);
    case CodedFilm::Wall::kFaint:
      return 128 + 10 * std::sin(x / 150) + soft(1, 3, 2, x, y);
    case CodedFilm::Wall::kIce:
      return 215 + soft(1, 40, 5, x, y) + soft(2, 8, 2, x, y) + soft(3, 2, 1, x, y);
    case CodedFilm::Wall::kBlur:
      return 120 + soft(1, 12, 20, x, y);
    case CodedFilm::Wall::kDark:
      return 24 + soft(1, 25, 5, x, y) + soft(2, 5, 2.5, x, y);
    case CodedFilm::Wall::kMeadow: {  // out of focus, below a plain sky
      const double depth = std::clamp(y / film.height_px * 4 - 2.5, 0.0, 1.0);
      return 180 + depth * (soft(1, 12, 20, x, y) - 60);
    }
  }
  return 0;
}

/// Cells of 6 px.
std::vector<double> square_grey(int side_px) {
  constexpr int kCell = 6;
  const int cells = side_px / kCell + 1;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> level(32, 224);
  std::vector<double> of_cells(static_cast<size_t>(cells * cells));
  for (double& grey : of_cells) grey = level(random);
  std::vector<double> grey;
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      grey.push_back(of_cells[static_cast<size_t>(y / kCell * cells + x / kCell)]);
    }
  }
  return grey;
}

}  // namespace

const Coding kX264{"x264", "-c:v libx264 -preset veryfast -g 12 -crf 18"};
const Coding kX265{"x265",
                   "-c:v libx265 -preset ultrafast -g 12 -crf 18 -x265-params log-level=error"};
const Coding kSvtAv1{"svt-av1", "-c:v libsvtav1 -preset 12 -g 12 -crf 20"};
const Coding kX265Medium{"x265, medium",
                         "-c:v libx265 -preset medium -crf 26 -x265-params log-level=error"};
const Coding kSvtAv1Medium{"svt-av1, 8", "-c:v libsvtav1 -preset 8 -crf 35"};

Vector2d CodedFilm::wall_moved_px(int n) const {
  return n < kRests ? Vector2d(0, 0) : Vector2d(pan_px.cast<double>());
}

Vector2d CodedFilm::square_moved_px(int n) const {
  return (square_px(n) - square_px(n - 1)).cast<double>();
}

/// The upper left corner of the square.
Vector2i CodedFilm::square_px(int n) const {
  const int moved = std::max(0, n - kRests + 1);
  Vector2d at_px(width_px / 5.0, (height_px - side_px) / 2.0);
  if (step_px.isZero()) {
    const double angle_rad = speed_px / radius_px * moved;
    at_px << (width_px - side_px) / 2.0 - radius_px * std::cos(angle_rad),
        (height_px - side_px) / 2.0 + radius_px * std::sin(angle_rad);
  } else {
    at_px += moved * step_px;
  }
  return at_px.array().round().cast<int>();
}

std::vector<Picture> CodedFilm::drawn() const {
  // The wall is drawn once, as large as the film shows it.
  const Vector2i margin_px = (kPictures - kRests) * pan_px.cwiseAbs();
  const int whole_width = width_px + 2 * margin_px.x();
  std::vector<double> whole;
  for (int y = -margin_px.y(); y < height_px + margin_px.y(); ++y) {
    for (int x = -margin_px.x(); x < width_px + margin_px.x(); ++x) {
      whole.push_back(wall_grey(*this, x, y));
    }
  }
  const std::vector<double> square = square_grey(side_px);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, noise_grey);
  std::vector<Picture> pictures;
  for (int n = 0; n < kPictures; ++n) {
    const Vector2i from_px = margin_px - std::max(0, n - kRests + 1) * pan_px;
    const Vector2i corner_px = square_px(n);
    pictures.emplace_back(width_px, height_px);
    pictures.back().fill([&](double x, double y) {
      const Vector2i at_px(static_cast<int>(x), static_cast<int>(y));
      const Vector2i on_px = at_px - corner_px;
      const bool on_square = on_px.minCoeff() >= 0 && on_px.maxCoeff() < side_px;
      const double grey = on_square
                              ? square[static_cast<size_t>(on_px.y() * side_px + on_px.x())]
                              : whole[static_cast<size_t>((from_px + at_px).y() * whole_width +
                                                          (from_px + at_px).x())];
      return std::clamp(grey + noise(random), 0.0, 255.0);
    });
  }
  return pictures;
}

std::vector<Picture> CodedFilm::pictures() const {
  const TemporaryFolder folder;
  const std::string raw = folder.path / "raw", coded = folder.path / "coded.mkv";
  const std::streamsize luma = width_px * height_px;
  const std::string no_colour(luma / 2, '\x80');
  {
    std::ofstream to(raw, std::ios::binary);
    for (const Picture& picture : drawn()) {
      to.write(reinterpret_cast<const char*>(picture.pixels.data()), luma);
      to.write(no_colour.data(), luma / 2);
    }
  }
  const std::string as_raw = " -f rawvideo -pix_fmt yuv420p -s " + std::to_string(width_px) + "x" +
                             std::to_string(height_px) + " ";
  const std::string ffmpeg = "ffmpeg -nostdin -v error -y ";
  const CommandResult result =
      run(ffmpeg + as_raw + "-r 25 -i " + raw + " -threads 1 " + coding + " " + coded +
          " 2>/dev/null && " + ffmpeg + "-i " + coded + as_raw + raw);
  if (result.status != 0) return {};
  std::vector<Picture> pictures;
  std::ifstream from(raw, std::ios::binary);
  for (int n = 0; n < kPictures; ++n) {
    pictures.emplace_back(width_px, height_px);
    from.read(reinterpret_cast<char*>(pictures.back().pixels.data()), luma);
    from.ignore(luma / 2);
  }
  return pictures;
}

}  // namespace spidar::test
