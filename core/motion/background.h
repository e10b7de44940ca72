/// What moves with the camera.
#pragma once

#include <vector>

#include "core/api.h"
#include "core/motion/motion_models.h"
#include "core/motion/robust_fit.h"

namespace spidar {

/// Which model the background has in one frame, and how well.
struct Background {
  MotionModel model;
  double sigma_px = 0;  ///< noise of a track's displacement, each coordinate
  double coverage = 1;  ///< share of the frame that speaks for the model; 1 while still
};

/// The lowest rung of the ladder that explains the tracks, from frame to frame.
///
/// Each track counts by its share of the frame: a cell of a grid has one vote, at the border two,
/// that the tracks in it share. An object in front of a plain background may hold all the tracks,
/// but hardly the frame: a model other than 'still' needs kLeastCoverage of all votes, those of the
/// empty cells included.
///
/// Rungs compete by the GRIC (Torr: Geometric motion segmentation and model selection, Phil. Trans.
/// R. Soc. A 356, 1998): Σ w ρ(e²) + λ₁ d n + λ₂ k, ρ(e²) = min(e²/σ², λ₃ (r − d)), with r = 4
/// coordinates of a track, d = 2 for all rungs, k parameters, λ₁ = ln r, λ₂ = ln(r n), λ₃ = 2. The
/// smallest wins, with hysteresis: a higher rung must be better by kMargin parameters' worth, a
/// lower one must be better in kPatience frames in succession. Higher rungs are only fitted when
/// the one in use stops explaining the tracks, and not in every frame when that does not help.
class SPIDAR_API BackgroundEstimator {
 public:
  BackgroundEstimator();

  /// Displacements between two frames of `width` × `height` pixels, as displacements() makes them.
  const Background& estimate(const std::vector<Displacement>& points, int width, int height);

  /// For the tests and the benchmark: models that were fitted for the last frame.
  int fitted() const { return fitted_; }

  /// A cut, a seek: nothing is known.
  void reset();

 private:
  struct Scored {
    MotionModel model;
    double coverage = 1;
    double cost = 0;  ///< Σ w ρ
    double gric = 0;
  };

  void weigh(int width, int height);
  double coverage_of(const MotionModel& model) const;
  bool score(ModelKind kind, Scored& scored);
  bool climb(Scored& current);
  void descend(Scored& current);
  void learn_noise(const MotionModel& model, bool nothing_better);

  WeightedTracks evidence_;
  RobustFitter fitter_;
  std::vector<double> residuals_px_;
  std::vector<int> cell_of_;    ///< of each point
  std::vector<int> cell_size_;  ///< points in it
  double effective_points_ = 0;
  double covered_ = 0;   ///< coverage if all points agreed
  double scale_ = 1;     ///< frame px for a px of a picture of kNoiseLength_px
  double noise_px_ = 0;  ///< at that scale
  int patience_ = 0;     ///< frames in which a lower rung was better
  int frames_since_climb_ = 0;
  double refused_cost_ = 0;  ///< mean cost when climbing did not help
  int fitted_ = 0;
  Background background_;
};

}  // namespace spidar
