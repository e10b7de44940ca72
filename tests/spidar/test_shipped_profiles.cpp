// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Compares the profiles in spidar/profiles/shipped with the published numbers.

#include <Eigen/LU>

#include "core/grip/pose_solver.h"
#include "spidar/profiles/profile.h"
#include "tests/support/random_motion.h"
#include "tests/support/test.h"

namespace spidar::test::shipped_profiles_test {

namespace {

// Numbers as published, string by string; see the [[source]] tables of the profiles. `tolerance_mm`
// is half of the last digit that was published.
struct Published {
  std::string name;
  std::vector<double> home_length_mm;
  double tolerance_mm;
  std::string encoder_signs;
  std::string motor_signs;
  double volts_per_newton, metres_per_count, min_N, max_N;
};

std::vector<double> all(double length_mm) {
  return std::vector<double>(8, length_mm);
}
/// The frame is symmetric: the strings of four corners are longer than the others.
std::vector<double> corners(double a_mm, double b_mm) {
  return {a_mm, b_mm, b_mm, a_mm, a_mm, b_mm, b_mm, a_mm};
}

const std::vector<double> kGcc = corners(89.187, 90.990);
const std::vector<double> kG = {103.5, 103.5, 99.3, 99.3, 103.5, 103.5, 99.3, 99.3};
const std::vector<double> kG6x3 = {103.84, 103.84, 100.31, 100.31, 103.84, 103.84, 100.31, 100.31};

const std::vector<Published> kPublished = {
    {"spidar-g6c", all(156.70), 0.005, "--------", "++++++++", 0.3, 2.03086921e-5, 1, 20},
    {"spidar-g6jun", corners(185.79, 186.53), 0.005, "++++----", "++++++++", 0.3, 2.924062107079e-5,
     1, 20},
    {"spidar-g6o", corners(155.30, 155.40), 0.005, "--+++---", "++++++++", 0.15, 2.03086921e-5, 1,
     20},
    {"spidar-g6x", all(104.08), 0.005, "-+-++-+-", "++++++++", 0.12, 2.924062107079e-5, 1, 20},
    {"spidar-g6x2", all(104.08), 0.005, "++++++++", "++++++++", 4 / 35.1, 1.705029838e-5, 0.7, 20},
    {"spidar-g6x3-v1-r", all(92.17), 0.005, "++----++", "++++++++", 4 / 35.1, 1.705029838e-5, 1,
     20},
    {"spidar-g6x3-v1-l", all(92.17), 0.005, "++----++", "++++++++", 4 / 35.1, 1.705029838e-5, 1,
     20},
    {"spidar-g6x3-v2-r", kG6x3, 0.005, "++----++", "++++++++", 0.365296803653, 1.66555e-5, 0.3, 20},
    {"spidar-g6x3-v2-l", kG6x3, 0.005, "++----++", "++++++++", 0.365296803653, 1.66555e-5, 0.3, 20},
    {"spidar-g645", corners(326.22, 325.97), 0.005, "++++++++", "++++++++", 0.3, 2.924062107079e-5,
     1, 20},
    {"spidar-g6x4", corners(121.57, 126.29), 0.005, "--++++--", "++----++", 0.08, 3.485e-5, 0.2,
     20},
    {"spidar-g6x5-r",
     {123.75, 123.75, 124.24, 124.24, 123.75, 123.75, 124.24, 124.24},
     0.005,
     "-+-+-+-+",
     "+-+-+-+-",
     0.091,
     2.25e-5,
     0.3,
     6},
    {"spidar-g6x5-l",
     {123.75, 123.75, 124.24, 124.24, 123.75, 123.75, 124.24, 124.24},
     0.005,
     "++++++++",
     "++++++++",
     0.091,
     2.25e-5,
     0.3,
     6},
    {"spidar-i7",
     {26.75, 26.75, 26.75, 30.87, 30.87, 30.87, 30.87},
     0.005,
     "+++++++",
     "+++++++",
     0.2279,
     0.008 * M_PI / 500 / 4,
     0.4,
     3},
    // Rotation direction a is written +, b −. A GCC's log has volt and force per A/D digit, and the
    // length per pulse.
    {"spidar-gcc", kGcc, 0.0005, "-+-++-+-", "-+-++-+-", 6.105006e-4 / 2.600732e-3, 1.533981e-5,
     0.05, 4.2},
    {"spidar-gcc-l", kGcc, 0.0005, "-+-++-+-", "-+-++-+-", 5.0 / 21.3, 2 * M_PI * 5.0e-3 / 2048,
     0.02, 4.2},
    {"spidar-gcc-sh", kGcc, 0.0005, "-+-++-+-", "-+-++-+-", 5.0 / 21.3, 2 * M_PI * 5.0e-3 / 2048,
     0.02, 4.2},
    {"spidar-g", kG, 0.05, "++----++", "++----++", 5.0 / 21.3, 2 * M_PI * 5.0e-3 / 2048, 0.01, 6},
    {"spidar-g-sh", kG, 0.05, "++----++", "++----++", 5.0 / 21.3, 2 * M_PI * 5.0e-3 / 2048, 0.002,
     6},
    {"spidar-i05", all(25.9), 0.05, "++--++--", "++--++--", 3.0 / 21.3, 2 * M_PI * 3.0e-3 / 2048,
     0.05, 5},
    {"spidar-igarashi001", all(30.0), 0.05, "+-+-+-+-", "+-+-+-+-", 4.5 / 10,
     2 * M_PI * 4.5e-3 / 2048, 0.02, 4.2},
    {"spidar-igarashi002", all(39.7), 0.05, "+-+-+-+-", "+-+-+-+-", 4.5 / 10.1,
     2 * M_PI * 4.5e-3 / 2048, 0.025, 1.2},
    {"spidar-koyama003", all(38.3), 0.05, "+-+-+-+-", "+-+-+-+-", 4.5 / 10.1,
     2 * M_PI * 4.5e-3 / 2048, 0.0018, 1.2},
    {"spidar-isotropic", all(21.6), 0.05, "--++--++", "--++--++", 2.55 / 10.1,
     2 * M_PI * 2.55e-3 / 2048, 0.0018, 1.2},
};

std::string sign(int value) {
  return value > 0 ? "+" : "-";
}

class ShippedProfile : public testing::TestWithParam<Published> {};

}  // namespace

TEST_P(ShippedProfile, HomeLengthsAreAsPublished) {
  const Profile profile = load_profile(GetParam().name);
  ASSERT_EQ(static_cast<size_t>(profile.geometry.count), GetParam().home_length_mm.size());
  const StringVector length_m = string_lengths_m(profile.geometry, {});
  for (int i = 0; i < profile.geometry.count; ++i)
    EXPECT_NEAR(1e3 * length_m[i], GetParam().home_length_mm[static_cast<size_t>(i)],
                GetParam().tolerance_mm)
        << "string " << i;
}

TEST_P(ShippedProfile, DrivesAreAsPublished) {
  const Profile profile = load_profile(GetParam().name);
  const StringDrive& drive = profile.drives[0];
  // The files have at least seven digits.
  EXPECT_NEAR(drive.newtons_per_volt * GetParam().volts_per_newton, 1, 5e-7);
  EXPECT_NEAR(drive.metres_per_count / GetParam().metres_per_count, 1, 5e-7);
  EXPECT_EQ(drive.min_tension_N, GetParam().min_N);
  EXPECT_EQ(drive.max_tension_N, GetParam().max_N);
  std::string encoder, motor;
  for (size_t i = 0; i < static_cast<size_t>(profile.geometry.count); ++i) {
    encoder += sign(profile.drives[i].encoder_sign);
    motor += sign(profile.drives[i].motor_sign);
  }
  EXPECT_EQ(encoder, GetParam().encoder_signs);
  EXPECT_EQ(motor, GetParam().motor_signs);
}

// A grip is held against any wrench exactly when W has rank 6 and a strictly positive t with W t =
// 0 exists (Murray, Li, Sastry: A Mathematical Introduction to Robotic Manipulation, 1994,
// prop. 5.3). The null space of 7 or 8 strings has one or two dimensions: its directions are tried
// all round.
TEST_P(ShippedProfile, StringsHoldTheGripAgainstAnyWrench) {
  const Profile profile = load_profile(GetParam().name);
  const int count = profile.geometry.count;
  Eigen::MatrixXd W = structure_matrix(profile.geometry, {}).leftCols(count);
  W.bottomRows(3) /= profile.geometry.grip_radius_m();
  // Now without unit: entries are of order 1, and rank 6 is far above rounding.
  Eigen::FullPivLU<Eigen::MatrixXd> lu(W);
  lu.setThreshold(1e-2);
  ASSERT_EQ(lu.rank(), 6);
  const Eigen::MatrixXd null_space = lu.kernel();
  ASSERT_LE(null_space.cols(), 2);

  bool in_range = false;
  for (int degree = 0; degree < 360 && !in_range; ++degree) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(null_space.cols());
    direction[0] = std::cos(degree * M_PI / 180);
    if (direction.size() == 2) direction[1] = std::sin(degree * M_PI / 180);
    const Eigen::VectorXd tension = null_space * direction;
    if (tension.minCoeff() <= 1e-3) continue;
    // Scales that lift every string above its minimum and leave each below its maximum.
    const double low = profile.min_tension_N().head(count).cwiseQuotient(tension).maxCoeff();
    const double high = profile.max_tension_N().head(count).cwiseQuotient(tension).minCoeff();
    in_range = low < high;
  }
  EXPECT_TRUE(in_range);
}

TEST_P(ShippedProfile, EveryNumberSaysWhereItIsFrom) {
  const Profile profile = load_profile(GetParam().name);
  std::multiset<std::string> fields;
  for (const Provenance& row : profile.provenance) {
    fields.insert(row.field);
    EXPECT_FALSE(row.source.empty()) << row.field;
    EXPECT_TRUE(row.evidence == Evidence::kPublished || !row.note.empty())
        << row.field << " does not say how it was inferred or by what it is contradicted";
  }
  for (const std::string field :
       {"geometry", "frame", "min_tension_N", "max_tension_N", "newtons_per_volt",
        "metres_per_count", "motor_sign", "encoder_sign", "board", "dac_bits", "dac_max_V",
        "moment_of_inertia_kg_m2"})
    EXPECT_EQ(fields.count(field), 1u) << field;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedProfile, testing::ValuesIn(kPublished),
                         [](const testing::TestParamInfo<Published>& row) {
                           std::string name = row.param.name;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(ShippedProfiles, NoneIsUntestedAndTheDefaultIsAmongThem) {
  std::set<std::string> tested;
  for (const Published& published : kPublished) tested.insert(published.name);
  EXPECT_EQ(tested.count(kDefaultProfile), 1u);
  std::set<std::string> shipped;
  const char* folder = std::getenv("SPIDAR_PROFILE_PATH");
  ASSERT_NE(folder, nullptr) << "run through `meson test`, or set it to spidar/profiles/shipped";
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    shipped.insert(entry.path().stem().string());
  EXPECT_EQ(shipped, tested);
}

}  // namespace spidar::test::shipped_profiles_test
