// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// load_profile() reads back exactly what save_profile() has written.
#include <atomic>
#include <thread>
#include <vector>

#include "spidar/devices/device_registry.h"
#include "spidar/part_file.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/whole_file.h"
#include "tests/spidar/calibration_samples.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace fs = std::filesystem;
namespace spidar::test::profile_writer_test {

namespace {

class Folder {
 public:
  std::string file(const std::string& name) const { return (folder_.path / name).string(); }
  bool is_empty() const { return fs::is_empty(folder_.path); }

 private:
  TemporaryFolder folder_;
};

void expect_same(const Profile& a, const Profile& b) {
  EXPECT_EQ(a.description, b.description);
  EXPECT_EQ(a.board, b.board);
  EXPECT_EQ(a.dac_bits, b.dac_bits);
  EXPECT_EQ(a.dac_max_V, b.dac_max_V);
  EXPECT_EQ(a.drive_lag_s, b.drive_lag_s);
  EXPECT_EQ(a.drive_lag_known, b.drive_lag_known);
  EXPECT_EQ(a.moment_of_inertia_kg_m2, b.moment_of_inertia_kg_m2);
  ASSERT_EQ(a.geometry.count, b.geometry.count);
  for (size_t i = 0; i < static_cast<size_t>(a.geometry.count); ++i) {
    EXPECT_EQ(a.geometry.exit_m[i], b.geometry.exit_m[i]);
    EXPECT_EQ(a.geometry.grip_m[i], b.geometry.grip_m[i]);
    EXPECT_EQ(a.drives[i].min_tension_N, b.drives[i].min_tension_N);
    EXPECT_EQ(a.drives[i].max_tension_N, b.drives[i].max_tension_N);
    EXPECT_EQ(a.drives[i].newtons_per_volt, b.drives[i].newtons_per_volt);
    EXPECT_EQ(a.drives[i].metres_per_count, b.drives[i].metres_per_count);
    EXPECT_EQ(a.drives[i].continuous_tension_N, b.drives[i].continuous_tension_N);
    EXPECT_EQ(a.drives[i].heating_time_s, b.drives[i].heating_time_s);
    EXPECT_EQ(a.drives[i].motor_sign, b.drives[i].motor_sign);
    EXPECT_EQ(a.drives[i].encoder_sign, b.drives[i].encoder_sign);
    EXPECT_EQ(a.drives[i].home_offset_m, b.drives[i].home_offset_m);
  }
  ASSERT_EQ(a.provenance.size(), b.provenance.size());
  for (size_t i = 0; i < a.provenance.size(); ++i) {
    EXPECT_EQ(a.provenance[i].field, b.provenance[i].field);
    EXPECT_EQ(a.provenance[i].source, b.provenance[i].source);
    EXPECT_EQ(a.provenance[i].evidence, b.provenance[i].evidence);
    EXPECT_EQ(a.provenance[i].note, b.provenance[i].note);
  }
  ASSERT_EQ(a.calibration.has_value(), b.calibration.has_value());
  if (!a.calibration) return;
  EXPECT_EQ(a.calibration->samples, b.calibration->samples);
  EXPECT_EQ(a.calibration->residual_m, b.calibration->residual_m);
}

std::string load_error(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return message_of<ProfileError>([&] { load_profile(path); });
}

}  // namespace

TEST(ProfileWriter, EveryShippedProfileComesBack) {
  const Folder folder;
  const std::string path = folder.file("copy.toml");
  for (const std::string& name : list_profiles()) {
    SCOPED_TRACE(name);
    const Profile profile = load_profile(name);
    save_profile(profile, path);
    expect_same(profile, load_profile(path));
  }
}

TEST(ProfileWriter, AnyBoardWithStringsMayBeNamed) {
  Profile profile = load_profile("spidar-gcc");
  for (const DeviceKind& kind : devices()) {
    if (!kind.has_strings()) continue;
    profile.board = kind.profile_board;
    EXPECT_EQ(parse_profile(profile_text(profile), "", "").board, kind.profile_board);
  }
}

/// Calibration must not make a measured lag of one that nobody has measured.
TEST(ProfileWriter, ALagIsWrittenWhenItIsKnown) {
  const Folder folder;
  const std::string path = folder.file("copy.toml");
  Profile profile = load_profile("spidar-gcc");
  EXPECT_FALSE(profile.drive_lag_known);
  EXPECT_EQ(profile_text(profile).find("drive_lag_s"), std::string::npos);
  profile.drive_lag_known = true;
  save_profile(profile, path);
  expect_same(profile, load_profile(path));
}

/// What is not stated is inferred, and does not become stated by being written.
TEST(ProfileWriter, AMomentOfInertiaIsWrittenWhenItIsStated) {
  const Folder folder;
  const std::string path = folder.file("copy.toml");
  Profile profile = load_profile("spidar-gcc");
  EXPECT_EQ(profile_text(profile).find("moment_of_inertia_kg_m2 ="), std::string::npos);
  // A solid sphere of 34 g and 32 mm, and 300 g at the 32.5 mm at which the strings end.
  EXPECT_NEAR(profile.body().least_kg_m2, 0.4 * 0.034 * 0.032 * 0.032, 1e-12);
  EXPECT_NEAR(profile.body().most_kg_m2, 0.3 * 0.0325 * 0.0325, 1e-12);
  profile.moment_of_inertia_kg_m2 = {3e-5, 2e-5, 4e-5};
  save_profile(profile, path);
  expect_same(profile, load_profile(path));
  EXPECT_EQ(load_profile(path).body().least_kg_m2, 2e-5);
  EXPECT_EQ(load_profile(path).body().most_kg_m2, 4e-5);
}

TEST(ProfileWriter, CalibrationComesBack) {
  const Folder folder;
  const Profile profile = load_profile("spidar-gcc");
  Random random(1);
  calibration::Result result;
  result.status = calibration::Status::kSolved;
  result.samples = 1234;
  result.residual_m = 1.0 / 3e5;
  result.scale = 1 + uniform(random, 0.01);
  result.estimated = {true, true};
  for (size_t i = 0; i < 8; ++i) {
    result.exit_m[i] = profile.geometry.exit_m[i] + uniform_vector(random, 1e-3);
    result.home_offset_m[static_cast<Eigen::Index>(i)] = uniform(random, 0.02);
  }
  Profile once =
      calibration::calibrated_profile(profile, result, "first \"try\"\twith\nodd characters");
  const Profile twice = calibration::calibrated_profile(once, result, "second try");
  // Scale and offsets replace those of before; so does what is said about them.
  EXPECT_EQ(twice.provenance.size(), profile.provenance.size() + 3);
  EXPECT_EQ(twice.provenance.back().source, "second try");
  EXPECT_EQ(twice.provenance.back().evidence, Evidence::kMeasured);
  for (const Profile& calibrated : {once, twice}) {
    save_profile(calibrated, folder.file("mine.toml"));
    const Profile loaded = load_profile(folder.file("mine.toml"));
    EXPECT_EQ(loaded.name, "mine");
    ASSERT_TRUE(loaded.calibration);
    EXPECT_EQ(loaded.drives[5].home_offset_m, result.home_offset_m[5]);
    expect_same(calibrated, loaded);
  }
}

TEST(ProfileWriter, FailureLeavesNothingBehind) {
  const Folder folder;
  const Profile profile = load_profile("spidar-gcc");
  for (const std::string& path : {folder.file("no/such/folder.toml"), folder.file("")}) {
    const auto save = [&] { save_profile(profile, path); };
    expect_contains(message_of<std::runtime_error>(save), path + ": cannot be written: ");
  }
  EXPECT_TRUE(folder.is_empty());
}

/// Of profiles, of those that were chosen for boards, and of reports: of all that is written so.
TEST(ReplaceFile, ALinkStaysOneAndLeadsToTheNewFile) {
  const Folder folder;
  const std::string kept = folder.file("kept"), named = folder.file("mine.toml");
  const auto text_of = [](const std::string& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  };
  replace_file(kept, "as it was");
  constexpr auto kOnlyOwner = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(kept, kOnlyOwner);
  fs::create_symlink(kept, named);
  replace_file(named, "new");
  EXPECT_EQ(text_of(kept), "new");
  EXPECT_EQ(fs::status(kept).permissions(), kOnlyOwner);
  EXPECT_TRUE(fs::is_symlink(named));
  const std::string dangling = folder.file("dangling.toml");
  fs::create_symlink(folder.file("gone"), dangling);
  EXPECT_THROW(replace_file(dangling, "new"), std::runtime_error);
  EXPECT_THROW(replace_file("/dev/null", "no device"), std::runtime_error);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(ReplaceFile, WhatAKilledProcessLeftDoesNotBlockIt) {
  const Folder folder;
  const std::string file = folder.file("file"), other = folder.file("other");
  const std::string part = PartFile(file, {true, {}}).path();
  std::ofstream(part) << "a part";
  EXPECT_NO_THROW(replace_file(file, "text"));
  EXPECT_TRUE(fs::is_regular_file(file));
  EXPECT_FALSE(fs::exists(part));
  fs::create_symlink(other, part);
  EXPECT_THROW(replace_file(file, "text"), std::runtime_error);
  EXPECT_FALSE(fs::exists(other));
}

TEST(ReplaceFile, AFileThatThisProgramReadsIsReplaced) {
  const Folder folder;
  const std::string file = folder.file("file");
  replace_file(file, "old");
  note_read(file);
  EXPECT_THROW(PartFile(file, {true, {}}), std::runtime_error);
  EXPECT_NO_THROW(replace_file(file, "new"));
}

TEST(ReplaceFile, ThreadsThatSaveInOneFolderDoNotMeet) {
  const Folder folder;
  std::atomic<int> failed{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      for (int times = 0; times < 100; ++times) {
        try {
          replace_file(folder.file(std::to_string(i)), "text");
        } catch (const std::runtime_error&) {
          ++failed;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failed, 0);
}

TEST(ProfileWriter, BadCalibrationIsRefusedByName) {
  const Folder folder;
  Profile profile = load_profile("spidar-gcc");
  profile.drives[2].home_offset_m = -1.0;
  expect_contains(load_error(folder.file("a.toml"), profile_text(profile)), "home_offset_m[2]");
  profile.drives[2].home_offset_m = 0;
  profile.calibration = CalibrationRecord{10, -1e-6};
  expect_contains(load_error(folder.file("c.toml"), profile_text(profile)), "residual_m");
}

}  // namespace spidar::test::profile_writer_test
