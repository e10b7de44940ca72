// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Tensions for every shipped profile, from the centre to outside the frame.
#include <cctype>

#include "profile_tension_cases.h"
#include "tests/core/tension_reference.h"
#include "tests/support/test.h"

namespace spidar::test::profile_tensions_test {
namespace {

class ProfileTensions : public testing::TestWithParam<std::string> {};

TEST_P(ProfileTensions, AreOptimalWithinBounds) {
  const Profile profile = load_profile(GetParam());
  Random random(1);
  TensionSolver warm;
  for (int n = 0; n < 4000; ++n) {
    const TensionProblem p = random_problem(random, profile);
    TensionSolver cold;
    for (TensionSolver* solver : {&cold, &warm}) {  // warm: from the solution of something else
      const TensionResult result = solver->solve(p);
      EXPECT_EQ(result.status, TensionStatus::kSolved);
      EXPECT_LE(result.iterations, 24);
      for (int i = 0; i < p.count; ++i) {
        EXPECT_GE(result.tension_N[i], p.t_min_N[i]) << "string " << i;
        EXPECT_LE(result.tension_N[i], p.t_max_N[i]) << "string " << i;
      }
      // What is promised; evaluated in long double from W and f.
      EXPECT_LE(optimality(p, result.tension_N), 1e-12);
    }
    if (HasFailure()) FAIL() << "case " << n << ", " << p.count << " strings:\n" << to_line(p);
  }
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(EveryShippedOne, ProfileTensions, testing::ValuesIn(list_profiles()),
                         test_name);

}  // namespace
}  // namespace spidar::test::profile_tensions_test
