#include "tests/support/motion_cases.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "tests/support/photo_sheet.h"

namespace spidar::test {
namespace {

using Eigen::Affine2d;
using Eigen::Matrix2d;
using Eigen::Rotation2Dd;
using Eigen::Translation2d;
using Eigen::Vector2d;
using SheetPtr = std::shared_ptr<const SplineSheet>;

/// σ of what a good camera adds, grey levels.
constexpr double kSensorNoise = 1.5;
constexpr double kDegree = 3.14159265358979323846 / 180;
const Vector2d kDirection = Vector2d(3, 1).normalized();

Pose still() {
  return [](double) { return Affine2d::Identity(); };
}

/// From `start_px` by `step_px` a frame.
Pose straight(const Vector2d& start_px, const Vector2d& step_px) {
  return [=](double t) { return Affine2d(Translation2d(start_px + t * step_px)); };
}

/// About the middle: the t-th power of a linear map near 1.
Pose growing(const Matrix2d& generator) {
  return [=](double t) {
    // exp(t G) of a 2×2 matrix by its series: |t G| < 1 here.
    Matrix2d term = Matrix2d::Identity();
    Matrix2d sum = term;
    for (int k = 1; k <= 20; ++k) {
      term = term * generator * (t / k);
      sum += term;
    }
    return Affine2d(sum);
  };
}

Matrix2d matrix(double xx, double xy, double yx, double yy) {
  Matrix2d m;
  m << xx, xy, yx, yy;
  return m;
}

/// Builds films of one size and seed. Sheets are drawn when a film first needs them and kept for
/// the next ones: they take longer than a film does.
class Studio {
 public:
  Studio(int width, int height, uint32_t seed)
      : width_(width), height_(height), seed_(seed), unit_(width / 640.0) {}

  double unit() const { return unit_; }
  Film still_film() {
    return behind(sheet("background", kMargin * width_, kMargin * height_), still());
  }
  Film behind(SheetPtr sheet, Pose pose) const {
    Film film(width_, height_);
    film.background = {std::move(sheet), std::move(pose)};
    film.noise_seed = seed_ * 1000;
    return film;
  }
  Film camera(Pose pose) {
    Film film = still_film();
    film.background.pose = std::move(pose);
    return film;
  }
  Film pan(double x_px, double y_px) {
    return camera(straight({0, 0}, unit_ * Vector2d(x_px, y_px)));
  }
  SheetPtr sheet(const std::string& name, double width_px, double height_px) {
    SheetPtr& found = sheets_[name];
    if (!found) {
      const auto seed = seed_ * 100 + static_cast<uint32_t>(sheets_.size()) * 10;
      found = std::make_shared<SplineSheet>(photo_sheet(seed, width_px, height_px));
    }
    return found;
  }
  SheetPtr other_background() { return sheet("other", kMargin * width_, kMargin * height_); }
  SheetPtr plain() const { return std::make_shared<SplineSheet>(plain_sheet(120)); }

  /// A disc that covers `share` of the frame.
  FilmObject object(double share, Pose pose, const std::string& name = "object") {
    const double radius_px = std::sqrt(share * width_ * height_ / 3.14159265358979323846);
    return {sheet(name, 0.6 * width_, 0.6 * height_), {radius_px, radius_px}, std::move(pose)};
  }
  /// Crosses the middle of the frame at half time.
  Pose crossing(const Vector2d& step_px, const Vector2d& middle_px = {0, 0}) const {
    return straight(unit_ * (middle_px - (kFilmFrames - 1) / 2.0 * step_px), unit_ * step_px);
  }
  Film usual_object(double speed_px) {
    Film film = still_film();
    film.objects = {object(kShare, crossing(speed_px * kDirection))};
    return film;
  }
  Film pan_with_object() {
    Film film = pan(-4, 1.5);
    film.objects = {object(kShare, crossing({9, 2.5}))};
    return film;
  }

  static constexpr double kShare = 0.08;

 private:
  static constexpr double kMargin = 1.5;
  int width_;
  int height_;
  uint32_t seed_;
  double unit_;
  std::map<std::string, SheetPtr> sheets_;
};

Film rotating_object(Studio& s) {
  Film film = s.still_film();
  const Pose path = s.crossing({7, -2});
  film.objects = {s.object(Studio::kShare, [path](double t) {
    return Affine2d(path(t) * Rotation2Dd(3 * kDegree * t));
  })};
  return film;
}

Film several_objects(Studio& s) {
  Film film = s.still_film();
  film.objects = {s.object(0.06, s.crossing({8, 0}, {-150, -80}), "object"),
                  s.object(0.05, s.crossing({-6, 4}, {160, -30}), "second"),
                  s.object(0.04, s.crossing({-2, -9}, {0, 90}), "third")};
  return film;
}

Film entering(Studio& s) {
  Film film = s.still_film();
  const double u = s.unit();
  film.objects = {s.object(Studio::kShare, straight(u * Vector2d(-400, 20), u * Vector2d(24, -2)))};
  return film;
}

Film with_noise(Studio& s) {
  Film film = s.pan_with_object();
  film.noise = 6;
  return film;
}

Film blurred(Studio& s) {
  Film film = s.pan_with_object();
  film.blur_px = 2 * s.unit();
  return film;
}

/// A 180° shutter.
Film motion_blurred(Studio& s) {
  Film film = s.usual_object(16);
  film.shutter = 0.5;
  return film;
}

Film brightness(Studio& s) {
  Film film = s.pan_with_object();
  film.light = [](int n) { return Light{1 - 0.03 * n, 2.0 * n}; };
  return film;
}

Film coded_object(Studio& s) {
  return s.usual_object(kNormal_px);
}
Film coded_pan(Studio& s) {
  return s.pan_with_object();
}

Film heavy_motion_blur(Studio& s) {
  Film film = s.usual_object(30);
  film.shutter = 1;
  return film;
}

/// There and back: turns between two frames' exposures, so every displacement is 80 px.
Film object_at_80(Studio& s) {
  Film film = s.still_film();
  const double u = s.unit();
  film.objects = {s.object(Studio::kShare, [u](double t) {
    const double phase = std::fmod(t, 10);
    const double steps = phase < 5 ? phase : 10 - phase;
    return Affine2d(Translation2d(u * Vector2d(-200 + 80 * steps, 10)));
  })};
  return film;
}

Film tiny_object(Studio& s) {
  Film film = s.still_film();
  film.objects = {s.object(0.01, s.crossing(kNormal_px * kDirection), "tiny")};
  return film;
}

Film on_plain(Studio& s) {
  Film film = s.behind(s.plain(), still());
  film.objects = {s.object(Studio::kShare, s.crossing(kNormal_px * kDirection))};
  return film;
}

Film periodic(Studio& s) {
  Film film = s.still_film();
  const double u = s.unit();
  film.background = {std::make_shared<SplineSheet>(periodic_sheet(1000 * u, 600 * u, 16 * u)),
                     straight({0, 0}, u * Vector2d(3, 1))};
  film.objects = {s.object(Studio::kShare, s.crossing({10, -2}))};
  return film;
}

Film textureless(Studio& s) {
  Film film = s.usual_object(kNormal_px);
  film.objects[0].sheet = s.plain();
  return film;
}

Film strobe(Studio& s) {
  Film film = s.pan_with_object();
  film.light = [](int n) { return n % 2 == 0 ? Light() : Light{0.4, 5}; };
  return film;
}

Film noise_only(Studio& s) {
  Film film = s.behind(s.plain(), still());
  film.noise = 6;
  return film;
}

/// One slanted edge that moves: how far along itself nobody can see.
Film single_edge(Studio& s) {
  Film film = s.still_film();
  const double u = s.unit();
  film.background = {
      std::make_shared<SplineSheet>(edge_sheet(1000 * u, 600 * u, {10 * u, 5 * u}, {2, 1})),
      straight({0, 0}, u * Vector2d(3, -1))};
  return film;
}

Film light_step(Studio& s) {
  Film film = s.still_film();
  film.light = [](int n) { return n < 6 ? Light() : Light{0.5, 30}; };
  return film;
}

Film cut(Studio& s) {
  Film film = s.still_film();
  film.cut_at = 6;
  film.after_cut = {s.other_background(), still()};
  return film;
}

using Build = std::function<Film(Studio&)>;

/// Sheets of the size and seed that were asked for last are kept.
MotionCase make(std::string name, CaseGroup group, Build build, bool coded = false) {
  return {std::move(name), group, coded, [group, build](int width, int height, uint32_t seed) {
            static std::tuple<int, int, uint32_t> key;
            static std::unique_ptr<Studio> studio;
            if (!studio || key != std::make_tuple(width, height, seed)) {
              studio.reset();
              studio = std::make_unique<Studio>(width, height, seed);
              key = {width, height, seed};
            }
            Film film = build(*studio);
            if (group != CaseGroup::kSilent) film.noise = std::max(film.noise, kSensorNoise);
            return film;
          }};
}

std::vector<MotionCase> all_cases() {
  const CaseGroup usual = CaseGroup::kUsual;
  const CaseGroup hard = CaseGroup::kHard;
  const CaseGroup silent = CaseGroup::kSilent;
  const double roll = 1.2 * kDegree;
  return {
      make("translation", usual, [](Studio& s) { return s.pan(5.3, 2.1); }),
      make("rotation", usual,
           [=](Studio& s) { return s.camera(growing(matrix(0, -roll, roll, 0))); }),
      make("zoom", usual, [](Studio& s) { return s.camera(growing(matrix(0.012, 0, 0, 0.012))); }),
      make("affine", usual,
           [](Studio& s) { return s.camera(growing(matrix(0.008, 0.012, -0.004, -0.003))); }),
      make("slow-object", usual, [](Studio& s) { return s.usual_object(kSlow_px); }),
      make("object", usual, [](Studio& s) { return s.usual_object(kNormal_px); }),
      make("fast-object", usual, [](Studio& s) { return s.usual_object(kFast_px); }),
      make("pan-object", usual, [](Studio& s) { return s.pan_with_object(); }),
      make("rotating-object", usual, rotating_object),
      make("several-objects", usual, several_objects),
      make("noise", usual, with_noise),
      make("blur", usual, blurred),
      make("motion-blur", usual, motion_blurred),
      make("brightness", usual, brightness),
      make("entering-object", usual, entering),
      make("x264-object", usual, coded_object, true),
      make("x264-pan-object", usual, coded_pan, true),
      make("camera-80px", hard, [](Studio& s) { return s.pan(80, 0); }),
      make("object-80px", hard, object_at_80),
      make("tiny-object", hard, tiny_object),
      make("heavy-motion-blur", hard, heavy_motion_blur),
      make("strobe", hard, strobe),
      make("plain-background", hard, on_plain),
      make("periodic-background", hard, periodic),
      make("textureless-object", hard, textureless),
      make("still", silent, [](Studio& s) { return s.still_film(); }),
      make("flat", silent, [](Studio& s) { return s.behind(s.plain(), still()); }),
      make("noise-only", silent, noise_only),
      make("single-edge", silent, single_edge),
      make("light-step", silent, light_step),
      make("cut", silent, cut),
  };
}

}  // namespace

const std::vector<MotionCase>& motion_cases() {
  static const std::vector<MotionCase> cases = all_cases();
  return cases;
}

const MotionCase& motion_case(const std::string& name) {
  std::string names;
  for (const MotionCase& known : motion_cases()) {
    if (known.name == name) return known;
    names += (names.empty() ? "" : ", ") + known.name;
  }
  throw std::invalid_argument("no case '" + name + "'; there are " + names);
}

}  // namespace spidar::test
