// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The file of rules that the debug window changes.
#include "plugin/filter/choice/feel_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::feel_file_test {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kSecond = 1'000'000'000;
const FeelEdit kChoice{kSecond, 2 * kSecond, Eigen::Vector2d(0.25, 0.5)};
const std::string kChosen = "0:01-0:02 object at 0.25,0.5\n";

class FeelFile : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& what) const {
    std::ofstream(path(name)) << what;
  }
  std::string error(const std::string& feel, const std::string& of) const {
    try {
      filter::save_feel(feel, of, {kChoice});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  size_t files() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder.path), {}));
  }

  TemporaryFolder folder;
  const std::string film = (folder.path / "film.avi").string();
};

TEST_F(FeelFile, IsBesideTheFilmWhereItIsFoundAgain) {
  EXPECT_EQ(filter::save_feel("", film, {kChoice}), "film.avi.feel has 1 rule.");
  EXPECT_EQ(text("film.avi.feel"), kChosen);
  const filter::NamedRules read = filter::read_feel("auto", film);
  ASSERT_TRUE(read.rules);
  EXPECT_EQ(read.rules->text() + "\n", kChosen);
  EXPECT_EQ(files(), 1u) << "nothing else is left";
}

TEST_F(FeelFile, IsTheOneThatIsThereOrThatTheElementReads) {
  write("film.feel", "0:05- largest\n");
  EXPECT_EQ(filter::save_feel("auto", film, {kChoice}), "film.feel has 2 rules.");
  EXPECT_EQ(text("film.feel"), kChosen + "0:05- largest\n");
  EXPECT_EQ(filter::save_feel(path("mine.feel"), film, {kChoice}), "mine.feel has 1 rule.");
  EXPECT_EQ(text("mine.feel"), kChosen);
}

/// Whoever writes it meanwhile.
TEST_F(FeelFile, KeepsTheRulesThatItHas) {
  filter::save_feel("", film, {kChoice});
  write("film.avi.feel", kChosen + "0:05- camera\n");
  filter::save_feel("", film, {{3 * kSecond, 4 * kSecond, Eigen::Vector2d(1, 1)}});
  EXPECT_EQ(text("film.avi.feel"), kChosen + "0:03-0:04 object at 1,1\n0:05- camera\n");
  EXPECT_EQ(files(), 1u);
}

/// Who may read it, and write it.
TEST_F(FeelFile, KeepsItsPermissions) {
  write("film.avi.feel", kChosen);
  const fs::perms only_owner = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(path("film.avi.feel"), only_owner);
  filter::save_feel("", film, {{3 * kSecond, 4 * kSecond, Eigen::Vector2d(1, 1)}});
  EXPECT_EQ(fs::status(path("film.avi.feel")).permissions(), only_owner);
}

TEST_F(FeelFile, WithRemarksOrMistakesIsKeptUnderAnotherName) {
  const std::string remark = "0:05- largest  # the dog\n", mistake = "biggest\n";
  write("film.avi.feel", remark);
  EXPECT_EQ(filter::save_feel("", film, {kChoice}),
            "film.avi.feel has 2 rules; what it was before is in film.avi.feel~.");
  EXPECT_EQ(text("film.avi.feel"), kChosen + "0:05- largest\n");
  EXPECT_EQ(text("film.avi.feel~"), remark);
  write("film.avi.feel", mistake);
  EXPECT_EQ(filter::save_feel("", film, {kChoice}),
            "film.avi.feel has 1 rule; what it was before is in film.avi.feel~~.");
  EXPECT_EQ(text("film.avi.feel"), kChosen);
  EXPECT_EQ(text("film.avi.feel~"), remark);
  EXPECT_EQ(text("film.avi.feel~~"), mistake);
}

TEST_F(FeelFile, GoesWithItsLastRule) {
  filter::save_feel("", film, {kChoice});
  EXPECT_EQ(filter::save_feel("", film, {{0, 9 * kSecond, std::nullopt}}),
            "film.avi.feel has no rules left and is removed.");
  EXPECT_EQ(files(), 0u);
  EXPECT_EQ(filter::save_feel("", film, {{0, 9 * kSecond, std::nullopt}}),
            "film.avi.feel has no rules left and is removed.");
}

TEST_F(FeelFile, SaysWhyItCannotBeWritten) {
  EXPECT_EQ(error("", ""), "what is played comes from no file, beside which rules could be kept");
  EXPECT_EQ(error("", path("none/film.avi")),
            path("none/film.avi.feel") + ": cannot be written: there is no folder " + path("none"));
  fs::create_directory(path("film.avi.feel"));
  EXPECT_EQ(error("", film), path("film.avi.feel") + ": it is not a regular file");
}

}  // namespace
}  // namespace spidar::test::feel_file_test
