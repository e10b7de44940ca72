// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Time and error of the tension solver: beside others while a hand moves, and on hard problems,
// among them problems of every shipped profile. The optional argument is the number of hard
// problems of each family (default 30000).
//
// KKT is the largest violation of the optimality conditions in long double, relative to |Q||t| +
// |c|. Beside others, a case fails when it is above 1e-9, or a bound is exceeded by more than 1e-9
// of the largest tension; a hard case when it is above 1e-12, a bound is exceeded at all, or more
// than 24 rounds are needed. max* is the slowest case, each case being timed by its fastest pass,
// which excludes interruptions. Compare times within one run only; absolute times depend on the
// machine.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <ceres/ceres.h>

#include "core/grip/tension_solver.h"
#include "spidar/profiles/profile.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/core/tension_reference.h"
#include "tests/spidar/profile_tension_cases.h"
#include "tests/support/tension_cases.h"

namespace {

using namespace spidar;
using namespace spidar::bench;
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

struct Quality {
  std::vector<double> kkt;
  int failures = 0;

  void add(const TensionProblem& p, const StringVector& t) {
    const double k = t.allFinite() ? test::optimality(p, clipped(p, t)).relative : INFINITY;
    double outside = 0;
    for (int i = 0; i < p.count; ++i)
      outside = std::max({outside, p.t_min_N[i] - t[i], t[i] - p.t_max_N[i]});
    kkt.push_back(k);
    failures += !(k <= 1e-9) || outside > 1e-9 * t.cwiseAbs().maxCoeff();
  }
};

void compare(const char* title, const std::vector<TensionProblem>& problems,
             const std::vector<std::unique_ptr<Peer>>& peers) {
  std::printf("\n%s, %zu problems\n%-28s %9s %9s %9s %9s %9s %9s %9s\n", title, problems.size(), "",
              "median ns", "99 % ns", "max ns", "max*", "KKT med", "KKT max", "failures");
  for (const auto& peer : peers) {
    std::vector<StringVector> t(problems.size());
    const CallTimes ns = time_calls(
        problems.size(), peer->passes(), [&] { peer->forget(); },
        [&](size_t i) { t[i] = peer->solve(problems[i]); });
    Quality quality;
    for (size_t i = 0; i < problems.size(); ++i) quality.add(problems[i], t[i]);
    std::printf("%-28s %9.0f %9.0f %9.0f %9.0f %9.1e %9.1e %9d\n", peer->name(),
                quantile(ns.median, 0.5), quantile(ns.median, 0.99), quantile(ns.median, 1),
                quantile(ns.least, 1), quantile(quality.kkt, 0.5), quantile(quality.kkt, 1),
                quality.failures);
  }
}

/// 4 s of a hand that moves with up to 0.4 m/s and 2 rad/s while force and torque go round.
std::vector<TensionProblem> trajectory() {
  std::vector<TensionProblem> problems;
  for (int tick = 0; tick < 4000; ++tick) {
    const double t = tick * 1e-3;
    Pose pose;
    pose.position_m =
        0.02 * Eigen::Vector3d(std::sin(9 * t), std::sin(7 * t + 1), std::sin(11 * t + 2));
    pose.orientation =
        Eigen::AngleAxisd(0.6 * std::sin(3 * t), Eigen::Vector3d(1, 2, -1).normalized());
    problems.push_back(test::g6x3_problem(
        pose, {3 * Eigen::Vector3d(std::sin(13 * t), std::sin(17 * t), std::cos(5 * t)),
               0.03 * Eigen::Vector3d(std::sin(8 * t), std::cos(6 * t), std::sin(4 * t))}));
  }
  return problems;
}

constexpr int kTimed = 2000;  // cases of a family
constexpr int kPasses = 7;

struct Totals {
  long cases = 0;
  long failed = 0;
};

bool is_right(const TensionProblem& p, const TensionResult& result, double kkt) {
  bool within = true;
  for (int k = 0; k < p.count; ++k)
    within = within && result.tension_N[k] >= p.t_min_N[k] && result.tension_N[k] <= p.t_max_N[k];
  return kkt <= 1e-12 && within && result.status == TensionStatus::kSolved &&
         result.iterations <= 24;
}

template <typename Draw>
void run_family(const std::string& name, int count, Totals& totals, Draw draw) {
  test::Random random(2);
  std::vector<TensionProblem> timed;
  TensionSolver warm;
  int failed = 0, most = 0;
  double worst = 0, sum = 0;
  for (int i = 0; i < count; ++i) {
    const TensionProblem p = draw(random);
    if (i < kTimed) timed.push_back(p);
    TensionSolver cold;
    for (TensionSolver* solver : {&cold, &warm}) {  // warm: from the solution of something else
      const TensionResult result = solver->solve(p);
      const double kkt = test::optimality(p, result.tension_N).relative;
      failed += !is_right(p, result, kkt);
      worst = std::max(worst, kkt);
      most = std::max(most, result.iterations);
      sum += result.iterations;
    }
  }
  TensionSolver solver;
  const CallTimes ns = time_calls(
      timed.size(), kPasses, [] {},
      [&](size_t i) {
        solver.reset();
        solver.solve(timed[i]);
      });
  std::printf("%-26s %7.0f %7.0f %7.0f %7.0f %9.1e %7.2f %5d %7d\n", name.c_str(),
              quantile(ns.median, 0.5), quantile(ns.median, 0.99), quantile(ns.median, 1),
              quantile(ns.least, 1), worst, sum / (2.0 * count), most, failed);
  totals.cases += 2L * count;
  totals.failed += failed;
}

}  // namespace

int spidar::bench::tension(int argc, char** argv) {
  const int count = std::max(argc > 1 ? std::atoi(argv[1]) : 30000, 1);
  pin_to_one_core();
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(std::make_unique<Ours>(true));
  peers.push_back(std::make_unique<Ours>(false));
  peers.push_back(std::make_unique<EigenLdlt>());
  peers.push_back(std::make_unique<CeresBounded>());
  compare("1 kHz trajectory", trajectory(), peers);
  std::printf(
      "\nhard problems, cold starts timed by %d passes\n%-26s %7s %7s %7s %7s %9s %7s %5s %7s\n",
      kPasses, "", "med ns", "99 %", "max", "max*", "KKT max", "rounds", "most", "failed");
  Totals totals;
  for (int c = 0; c < test::kTensionCases; ++c) {
    const auto family = static_cast<test::TensionCase>(c);
    run_family(test::name(family), count, totals,
               [family](test::Random& random) { return test::random_problem(random, family); });
  }
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    run_family(name, count, totals,
               [&profile](test::Random& random) { return test::random_problem(random, profile); });
  }
  std::printf("%ld solutions, cold and warm, %ld failed\n", totals.cases, totals.failed);
  return totals.failed > 0;
}
