// The tension solver beside others: nanoseconds against error, on what a device meets and on hard
// cases. The optional argument is the number of hard cases of each family (default 10000).
//
// KKT is the largest violation of the optimality conditions in long double, relative to |Q||t| +
// |c|; a case fails when it is above 1e-9 or a bound is exceeded by more than 1e-9 of the largest
// tension. Times of one run compare with each other; absolute ones drift from machine to machine.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <ceres/ceres.h>

#include "call_timer.h"
#include "core/tension_solver.h"
#include "tests/core/tension_cases.h"
#include "tests/core/tension_reference.h"

namespace {

using namespace spidar;
using namespace spidar::bench;
using test::TensionCase;

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
  std::printf("\n%s, %zu problems\n%-28s %9s %9s %9s %9s %9s %9s\n", title, problems.size(), "",
              "median ns", "99 % ns", "max ns", "KKT med", "KKT max", "failures");
  for (const auto& peer : peers) {
    std::vector<StringVector> t(problems.size());
    const std::vector<double> ns = time_calls(
        problems.size(), peer->passes(), [&] { peer->forget(); },
        [&](size_t i) { t[i] = peer->solve(problems[i]); });
    Quality quality;
    for (size_t i = 0; i < problems.size(); ++i) quality.add(problems[i], t[i]);
    std::printf("%-28s %9.0f %9.0f %9.0f %9.1e %9.1e %9d\n", peer->name(), quantile(ns, 0.5),
                quantile(ns, 0.99), quantile(ns, 1), quantile(quality.kkt, 0.5),
                quantile(quality.kkt, 1), quality.failures);
  }
}

std::vector<TensionProblem> easy_problems() {
  test::Random random(1);
  std::vector<TensionProblem> problems;
  for (int i = 0; i < 1000; ++i)
    problems.push_back(
        test::random_problem(random, i % 2 ? TensionCase::kNearCentre : TensionCase::kReachable));
  return problems;
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

void hard_cases(int count) {
  std::printf("\nours on hard cases, %d each, cold\n%-20s %9s %9s %9s %9s %9s %7s\n", count, "",
              "median ns", "99 % ns", "KKT max", "rounds", "max", "failed");
  for (int c = 0; c < test::kTensionCases; ++c) {
    test::Random random(2);
    int failed = 0, most = 0;
    double worst = 0, sum = 0;
    std::vector<double> ns;
    for (int i = 0; i < count; ++i) {
      const TensionProblem p = test::random_problem(random, static_cast<TensionCase>(c));
      TensionSolver solver;
      TensionResult result;
      if (i < 2000) {
        ns.push_back(time_calls(
            1, 5, [&] { solver.reset(); }, [&](size_t) { result = solver.solve(p); })[0]);
      } else {
        result = solver.solve(p);
      }
      const double kkt = test::optimality(p, result.tension_N).relative;
      bool within = true;
      for (int k = 0; k < p.count; ++k)
        within &= result.tension_N[k] >= p.t_min_N[k] && result.tension_N[k] <= p.t_max_N[k];
      failed += !(kkt <= 1e-12) || !within || result.status != TensionStatus::kSolved ||
                result.iterations > 24;
      worst = std::max(worst, kkt);
      most = std::max(most, result.iterations);
      sum += result.iterations;
    }
    std::printf("%-20s %9.0f %9.0f %9.1e %9.2f %9d %7d\n", test::name(static_cast<TensionCase>(c)),
                quantile(ns, 0.5), quantile(ns, 0.99), worst, sum / count, most, failed);
  }
}

/// What the weights that Springhead's HISpidarG sets by default deliver: smoothing 0.3 on the
/// tensions, 6 on the squared torque error in N·m, solved exactly.
void published_weights() {
  test::Random random(3);
  TensionSolver ours, theirs;
  std::vector<double> our_force, their_force, our_torque, their_torque;
  for (int i = 0; i < 2000; ++i) {
    TensionProblem p = test::g6x3_problem(test::random_pose(random, 0.02, 0.35),
                                          {3 * test::random_direction(random), {0, 0, 0}});
    const auto add = [&p](const TensionResult& r, std::vector<double>& f, std::vector<double>& t) {
      f.push_back(r.delivered.force_N.dot(p.wrench.force_N) / 3);
      t.push_back(1e3 * r.delivered.torque_Nm.norm());
    };
    add(ours.solve(p), our_force, our_torque);
    p.epsilon = 0.3;
    p.t_ref_N.setZero();
    p.torque_length_m = 1 / std::sqrt(6.0);
    add(theirs.solve(p), their_force, their_torque);
  }
  std::printf(
      "\n3 N wanted within 2 cm and 20 deg, delivered: median (least) N, median (most) N·mm\n");
  std::printf("%-28s %6.2f (%4.2f) %6.1f (%4.1f)\n", "ours", quantile(our_force, 0.5),
              quantile(our_force, 0), quantile(our_torque, 0.5), quantile(our_torque, 1));
  std::printf("%-28s %6.2f (%4.2f) %6.1f (%4.1f)\n", "published weights 0.3 and 6",
              quantile(their_force, 0.5), quantile(their_force, 0), quantile(their_torque, 0.5),
              quantile(their_torque, 1));
}

}  // namespace

int main(int argc, char** argv) {
  const int hard = argc > 1 ? std::atoi(argv[1]) : 10000;
  pin_to_one_core();
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(std::make_unique<Ours>(false));
  peers.push_back(std::make_unique<Ours>(true));
  peers.push_back(std::make_unique<EigenLdlt>());
  peers.push_back(std::make_unique<EigenCod>());
  peers.push_back(std::make_unique<GaussSeidel>());
  peers.push_back(std::make_unique<CeresBounded>());
  compare("1 kHz trajectory", trajectory(), peers);
  peers.erase(peers.begin() + 1);
  compare("unrelated easy problems", easy_problems(), peers);
  for (int c = 2; c < test::kTensionCases - 1; ++c) {
    test::Random random(4);
    std::vector<TensionProblem> problems;
    for (int i = 0; i < 400; ++i)
      problems.push_back(test::random_problem(random, static_cast<TensionCase>(c)));
    compare(test::name(static_cast<TensionCase>(c)), problems, peers);
  }
  hard_cases(hard);
  published_weights();
}
