// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds out whether strings, which can only pull, can balance a wrench at a pose.
#pragma once

#include "core/grip/string_geometry.h"

/// A pose has force closure, that is, lies in the wrench-closure workspace, when tensions ≥ 0 can
/// balance any wrench. This is so exactly when W has rank 6 and some t with all tᵢ > 0 has W t = 0
/// (Gouttefarde, Characterizations of fully constrained poses of parallel cable-driven robots: a
/// review, ASME DETC 2008). It does not limit the size of the tensions.
struct ForceClosure {
  /// Largest min tᵢ / max tᵢ of all t with W t = 0, 0 … 1: the tension factor of Pham, Yeo, Yang
  /// and Chen (Workspace analysis of fully restrained cable-driven manipulators, Robotics and
  /// Autonomous Systems 57, 2009). The pose has force closure where it is above 0.
  double tension_factor = 0;
  /// Whether W has rank 6 and some t with t_min ≤ t ≤ t_max has W t = 0: the pose has force
  /// closure, and the grip can be held still within the range of the motors.
  bool balanced_within_bounds = false;
};

/// `W` has `count` ≤ kMaxStrings columns in use; `torque_length_m` > 0 makes torques comparable
/// with forces when the rank is determined; bounds are in newtons.
ForceClosure force_closure(const spidar::StructureMatrix& W, int count, double torque_length_m,
                           const spidar::StringVector& t_min_N,
                           const spidar::StringVector& t_max_N);
