// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The programs that read problems from standard input, run as a user runs them.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <vector>

#include <gtest/gtest.h>

#include "spidar/profiles/profile.h"
#include "tests/core/tension_reference.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tension_cases.h"

namespace spidar::test {
namespace {

struct Output {
  int status = -1;
  std::vector<std::vector<std::string>> lines;  ///< words of standard output
  std::string errors;
};

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class SolvePrograms : public testing::Test {
 protected:
  /// `program` is a path in the build folder's examples/, with arguments.
  Output run(const std::string& program, const std::string& input) const {
    std::ofstream(folder / "in") << input;
    const std::string command = std::string(EXAMPLES_BUILD_DIR) + "/" + program + " < " +
                                (folder / "in").string() + " > " + (folder / "out").string() +
                                " 2> " + (folder / "errors").string();
    Output output;
    const int status = std::system(command.c_str());
    if (WIFEXITED(status)) output.status = WEXITSTATUS(status);
    std::istringstream text(contents(folder / "out"));
    for (std::string line; std::getline(text, line);) {
      std::istringstream words(line);
      output.lines.emplace_back();
      for (std::string word; words >> word;) output.lines.back().push_back(word);
    }
    output.errors = contents(folder / "errors");
    return output;
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder = temporary_.path;
};

TEST_F(SolvePrograms, TensionsOfAKnownProblem) {
  Random random(1);
  std::vector<TensionProblem> problems;
  std::string input = "# W, f, t_min, t_max, t_ref, epsilon, l\n\n";
  for (int n = 0; n < 20; ++n) {
    problems.push_back(random_problem(random, TensionCase::kReachable));
    input += to_line(problems.back()) + "\n";
  }
  const Output output = run("solve_tensions", input);
  EXPECT_EQ(output.status, 0);
  EXPECT_EQ(output.errors, "");
  ASSERT_EQ(output.lines.size(), problems.size());
  for (size_t n = 0; n < problems.size(); ++n) {
    const std::vector<std::string>& words = output.lines[n];
    ASSERT_EQ(words.size(), 11u);
    TensionSolver solver;
    const TensionResult expected = solver.solve(problems[n]);
    // 17 digits bring back the same double.
    for (int i = 0; i < kMaxStrings; ++i)
      EXPECT_EQ(std::stod(words[static_cast<size_t>(i)]), expected.tension_N[i]);
    EXPECT_EQ(words[8], "solved");
    EXPECT_LE(std::stod(words[9]), 1e-12);
    EXPECT_EQ(std::stoi(words[10]), expected.iterations);
  }
}

TEST_F(SolvePrograms, BadProblemsAreRefusedByNumber) {
  const std::string good = to_line(g6x3_problem(Pose(), {{1, 0, 0}, {0, 0, 0}}));
  TensionProblem crossed = g6x3_problem(Pose());
  crossed.t_min_N[2] = 30;
  const std::string input = good + "\n1 2 3\n" + good + "\n" + to_line(crossed) + "\n" + good +
                            " 0\n" + "one " + good + "\n" + good + "\n";
  const Output output = run("solve_tensions", input);
  EXPECT_EQ(output.status, 1);
  EXPECT_EQ(output.lines.size(), 3u) << "the good lines are solved";
  EXPECT_NE(output.errors.find("line 2: 80 numbers expected, 3 found"), std::string::npos);
  EXPECT_NE(output.errors.find("line 4: not a problem"), std::string::npos);
  EXPECT_NE(output.errors.find("line 5: 80 numbers expected, 81 found"), std::string::npos);
  EXPECT_NE(output.errors.find("line 6: 'one' is not a number"), std::string::npos);
}

std::string to_line(const StringVector& lengths_m) {
  std::ostringstream line;
  line << std::setprecision(17);
  for (double l : lengths_m) line << l << ' ';
  return line.str() + "\n";
}

/// Far beyond a search's last step of 1 nm, far below what an encoder tells.
constexpr double kSame_m = 1e-7;

void expect_pose(const std::vector<std::string>& words, const Pose& pose, const char* status) {
  ASSERT_EQ(words.size(), 9u);
  std::array<double, 8> x{};
  for (size_t k = 0; k < x.size(); ++k) x[k] = std::stod(words[k]);
  EXPECT_LE((Eigen::Vector3d(x[0], x[1], x[2]) - pose.position_m).norm(), kSame_m);
  EXPECT_LE(Eigen::Quaterniond(x[3], x[4], x[5], x[6]).angularDistance(pose.orientation),
            kSame_m / 0.0225 + 1e-7);
  EXPECT_LE(x[7], kSame_m);
  EXPECT_EQ(words[8], status);
}

TEST_F(SolvePrograms, PosesOfKnownLengths) {
  const StringGeometry geometry = load_profile(kDefaultProfile).geometry;
  Random random(2);
  std::vector<Pose> poses;
  std::string input;
  for (int n = 0; n < 20; ++n) {
    poses.push_back(random_pose(random, 0.02, 0.5));
    input += to_line(string_lengths_m(geometry, poses.back()));
  }
  const Output output = run(std::string("solve_pose ") + kDefaultProfile, input);
  EXPECT_EQ(output.status, 0) << output.errors;
  ASSERT_EQ(output.lines.size(), poses.size());
  for (size_t n = 0; n < poses.size(); ++n) expect_pose(output.lines[n], poses[n], "solved");
}

// From one line to the next the string that jumps is known; a line on its own with a fault this
// small may fit several explanations.
TEST_F(SolvePrograms, TrackStartsFromTheLineBefore) {
  const StringGeometry geometry = load_profile(kDefaultProfile).geometry;
  std::string input;
  constexpr int kLines = 30;
  Pose pose;
  for (int n = 0; n < kLines; ++n) {
    pose.position_m = {0.0002 * n, 0.0001 * n, -0.0001 * n};
    StringVector lengths_m = string_lengths_m(geometry, pose);
    if (n == kLines - 1) lengths_m[3] += 1e-3;
    input += to_line(lengths_m);
  }
  const Output output = run(std::string("solve_pose ") + kDefaultProfile + " --track", input);
  EXPECT_EQ(output.status, 0) << output.errors;
  ASSERT_EQ(output.lines.size(), static_cast<size_t>(kLines));
  EXPECT_EQ(output.lines[kLines - 2].back(), "solved");
  expect_pose(output.lines[kLines - 1], pose, "solved-without-3");
}

TEST_F(SolvePrograms, BadLengthsAreRefusedByNumber) {
  const StringGeometry geometry = load_profile(kDefaultProfile).geometry;
  const std::string good = to_line(string_lengths_m(geometry, {}));
  const Output output = run(std::string("solve_pose ") + kDefaultProfile,
                            good + "0.1 0.1 0.1\n" + "-1 1 1 1 1 1 1 1\n" + "nan 1 1 1 1 1 1 1\n" +
                                "1 1 1 1 1 1 1 1x\n" + good);
  EXPECT_EQ(output.status, 1);
  EXPECT_EQ(output.lines.size(), 2u);
  for (const char* said : {"line 2: 8 numbers expected, 3 found", "line 3: lengths must be",
                           "line 4: lengths must be", "line 5: '1x' is not a number"})
    EXPECT_NE(output.errors.find(said), std::string::npos) << output.errors;
}

TEST_F(SolvePrograms, SayWhatIsWrongWithTheCommand) {
  EXPECT_EQ(run("solve_pose", "").status, 2);
  const Output unknown = run("solve_pose nothing-like-it", "");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.errors.find("unknown profile"), std::string::npos);
}

}  // namespace
}  // namespace spidar::test
