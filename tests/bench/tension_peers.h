// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Other solvers of the tension problem for comparison: Eigen's factorisations, projected
/// Gauss–Seidel, Ceres with bounds, and the published weights.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <ceres/ceres.h>

#include "core/grip/tension_solver.h"

namespace spidar::bench {

using Matrix8 = Eigen::Matrix<double, 8, 8>;

class Peer {
 public:
  virtual ~Peer() = default;
  virtual const char* name() const = 0;
  virtual StringVector solve(const TensionProblem& p) = 0;
  virtual void forget() {}
  virtual int passes() const { return 15; }
};

struct Normal {
  StructureMatrix A;
  Eigen::Matrix<double, 6, 1> b;

  explicit Normal(const TensionProblem& p) : A(p.W), b(p.wrench.stacked()) {
    A.bottomRows<3>() /= p.torque_length_m;
    b.tail<3>() /= p.torque_length_m;
    for (int i = p.count; i < kMaxStrings; ++i) A.col(i).setZero();
  }
  Matrix8 Q(const TensionProblem& p) const {
    return A.transpose() * A + p.epsilon * Matrix8::Identity();
  }
  StringVector c(const TensionProblem& p) const {
    return A.transpose() * b + p.epsilon * p.t_ref_N;
  }
};

StringVector clipped(const TensionProblem& p, const StringVector& t) {
  return t.cwiseMax(p.t_min_N).cwiseMin(p.t_max_N);
}

class Ours : public Peer {
 public:
  explicit Ours(bool warm) : warm_(warm) {}
  const char* name() const override { return warm_ ? "ours, warm" : "ours, cold"; }
  StringVector solve(const TensionProblem& p) override {
    if (!warm_) solver_.reset();
    return solver_.solve(p).tension_N;
  }
  void forget() override { solver_.reset(); }

 private:
  bool warm_;
  TensionSolver solver_;
};

/// No bounds: what an exact method for them starts from.
class EigenLdlt : public Peer {
 public:
  const char* name() const override { return "Eigen LDLT, clipped"; }
  StringVector solve(const TensionProblem& p) override {
    const Normal n(p);
    return clipped(p, n.Q(p).ldlt().solve(n.c(p)));
  }
};

/// The pseudoinverse.
class EigenCod : public Peer {
 public:
  const char* name() const override { return "Eigen COD, clipped"; }
  StringVector solve(const TensionProblem& p) override {
    const Normal n(p);
    const Eigen::CompleteOrthogonalDecomposition<StructureMatrix> cod(n.A);
    return clipped(p, p.t_ref_N + cod.solve(n.b - n.A * p.t_ref_N));
  }
};

/// Projected Gauss–Seidel on the same objective.
class GaussSeidel : public Peer {
 public:
  const char* name() const override { return "projected Gauss-Seidel, 200"; }
  StringVector solve(const TensionProblem& p) override {
    const Normal n(p);
    const Matrix8 Q = n.Q(p);
    const StringVector c = n.c(p);
    StringVector t = clipped(p, p.t_ref_N);
    for (int sweep = 0; sweep < 200; ++sweep)
      for (int i = 0; i < kMaxStrings; ++i) {
        const double newton = t[i] - (Q.row(i).dot(t) - c[i]) / Q(i, i);
        t[i] = std::min(std::max(newton, p.t_min_N[i]), p.t_max_N[i]);
      }
    return t;
  }
};

class CeresBounded : public Peer {
 public:
  const char* name() const override { return "Ceres, bounds"; }
  int passes() const override { return 1; }
  StringVector solve(const TensionProblem& p) override {
    StringVector t = clipped(p, p.t_ref_N);
    ceres::Problem problem;
    problem.AddResidualBlock(new Cost(p), nullptr, t.data());
    for (int i = 0; i < kMaxStrings; ++i) {
      if (p.t_min_N[i] < p.t_max_N[i]) {
        problem.SetParameterLowerBound(t.data(), i, p.t_min_N[i]);
        problem.SetParameterUpperBound(t.data(), i, p.t_max_N[i]);
      }
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return t;
  }

 private:
  struct Cost : ceres::SizedCostFunction<14, 8> {
    const TensionProblem p;
    const Normal n;
    explicit Cost(const TensionProblem& problem) : p(problem), n(p) {}
    bool Evaluate(double const* const* x, double* r, double** jacobians) const override {
      const Eigen::Map<const StringVector, Eigen::Unaligned> t(x[0]);
      Eigen::Map<Eigen::Matrix<double, 14, 1>, Eigen::Unaligned> residual(r);
      const double root = std::sqrt(p.epsilon);
      residual << n.A * t - n.b, root * (t - p.t_ref_N);
      if (jacobians && jacobians[0]) {
        Eigen::Map<Eigen::Matrix<double, 14, 8, Eigen::RowMajor>, Eigen::Unaligned> J(jacobians[0]);
        J << n.A, root * Matrix8::Identity();
      }
      return true;
    }
  };
};

}  // namespace spidar::bench
