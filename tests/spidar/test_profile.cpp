// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// load_profile(): where it finds profiles, and its messages for unusable files.
#include <unistd.h>

#include "spidar/profiles/profile.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace fs = std::filesystem;
namespace spidar::test::profile_test {
using spidar::test::TemporaryFolder;

namespace {

const std::string kValid = R"(description = "test"
board = "uart"
dac_bits = 12
dac_max_V = 3.3

[geometry]
frame = "left-handed"
unit = "mm"
exit = [
  [-60, -61, -62],
  [-60, -61, 62],
  [60, -61, 62],
  [60, -61, -62],
  [-60, 61, -62],
  [-60, 61, 62],
]
grip = [[0, -20, 1], [-20, 0, 2], [20, 0, 3], [0, -20, 4], [0, 20, 5], [-20, 0, 6]]

[strings]
min_tension_N = [0.3, 0.3, 0.3, 0.4, 0.3, 0.3]
max_tension_N = 6
newtons_per_volt = 12.5
metres_per_count = 2.25e-5
motor_sign = [1, -1, 1, -1, 1, -1]
encoder_sign = [-1, -1, 1, 1, 1, 1]

[[source]]
fields = ["geometry", "board"]
source = "a book"
evidence = "contradicted"
note = "another book"
)";

class Folder {
 public:
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path() / name) << text;
    return path() / name;
  }
  const fs::path& path() const { return folder_.path; }

 private:
  TemporaryFolder folder_;
};

class Environment {
 public:
  explicit Environment(const std::string& search_path) {
    const char* old = std::getenv("SPIDAR_PROFILE_PATH");
    old_ = old ? old : "";
    setenv("SPIDAR_PROFILE_PATH", search_path.c_str(), 1);
  }
  ~Environment() { setenv("SPIDAR_PROFILE_PATH", old_.c_str(), 1); }

 private:
  std::string old_;
};

std::string error_of(const std::string& name_or_path) {
  return message_of<ProfileError>([&] { load_profile(name_or_path); });
}

}  // namespace

TEST(Profile, FileIsReadIntoTheDeviceFrame) {
  const Folder folder;
  const Profile profile = load_profile(folder.write("mine.toml", kValid).string());
  EXPECT_EQ(profile.name, "mine");
  EXPECT_EQ(profile.description, "test");
  EXPECT_EQ(profile.board, "uart");
  EXPECT_EQ(profile.dac_bits, 12);
  EXPECT_EQ(profile.dac_max_V, 3.3);
  EXPECT_EQ(profile.drive_lag_s, Profile::kDriveLag_s);
  ASSERT_EQ(profile.geometry.count, 6);
  // Left-handed to right-handed: z turns round in both tables. mm · 1e-3 is exact to rounding.
  EXPECT_TRUE(profile.geometry.exit_m[1].isApprox(Eigen::Vector3d(-0.060, -0.061, -0.062), 1e-15));
  EXPECT_TRUE(profile.geometry.grip_m[4].isApprox(Eigen::Vector3d(0, 0.020, -0.005), 1e-15));
  EXPECT_EQ(profile.drives[3].min_tension_N, 0.4);
  EXPECT_EQ(profile.drives[3].max_tension_N, 6);
  EXPECT_EQ(profile.drives[3].newtons_per_volt, 12.5);
  EXPECT_EQ(profile.drives[3].metres_per_count, 2.25e-5);
  EXPECT_EQ(profile.drives[3].motor_sign, -1);
  EXPECT_EQ(profile.drives[3].encoder_sign, 1);
  EXPECT_EQ(profile.min_tension_N()[3], 0.4);
  EXPECT_EQ(profile.max_tension_N()[5], 6);
  EXPECT_EQ(profile.max_tension_N()[6], 0) << "unused strings are zero";
  ASSERT_EQ(profile.provenance.size(), 2u);
  EXPECT_EQ(profile.provenance[1].field, "board");
  EXPECT_EQ(profile.provenance[1].source, "a book");
  EXPECT_EQ(profile.provenance[1].evidence, Evidence::kContradicted);
  EXPECT_EQ(profile.provenance[1].note, "another book");
}

TEST(Profile, RightHandedTableIsTakenAsItIs) {
  const Folder folder;
  std::string text = kValid;
  text.replace(text.find("left-handed"), 4, "right");
  const Profile profile = load_profile(folder.write("mine.toml", text).string());
  EXPECT_TRUE(profile.geometry.exit_m[1].isApprox(Eigen::Vector3d(-0.060, -0.061, 0.062), 1e-15));
}

TEST(Profile, FirstFolderOfTheSearchPathWins) {
  const Folder first;
  const Folder second;
  first.write("a.toml", kValid);
  std::string other = kValid;
  other.replace(other.find("test"), 4, "late");
  second.write("a.toml", other);
  second.write("b.toml", other);
  second.write("notes.txt", "not a profile");
  const Environment environment(first.path().string() + "::" + second.path().string());
  EXPECT_EQ(load_profile("a").description, "test");
  EXPECT_EQ(load_profile("b").description, "late");
  const std::vector<std::string> names = list_profiles();
  EXPECT_EQ(std::count(names.begin(), names.end(), "a"), 1);
  EXPECT_EQ(std::count(names.begin(), names.end(), "b"), 1);
  EXPECT_EQ(std::count(names.begin(), names.end(), "notes"), 0);
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

// Files of the source tree, by which all others are found in tests, are not looked at.
TEST(Profile, ShippedOnesAreInTheLibraryAndFilesComeFirst) {
  const std::vector<std::string> with_files = list_profiles();
  const Profile from_file = load_profile("spidar-gcc");
  const Folder folder;
  const Environment search_path(folder.path().string());
  EXPECT_EQ(list_profiles(), with_files);
  for (const std::string& name : with_files) EXPECT_NO_THROW(load_profile(name)) << name;
  EXPECT_EQ(load_profile("spidar-gcc").geometry.exit_m, from_file.geometry.exit_m);
  folder.write("spidar-gcc.toml", kValid);
  EXPECT_EQ(load_profile("spidar-gcc").description, "test");
  EXPECT_EQ(list_profiles(), with_files);
}

TEST(Profile, UnknownNameListsWhatIsKnownAndWhereItWasSearched) {
  const Folder folder;
  folder.write("only-one.toml", kValid);
  const Environment environment(folder.path().string());
  const std::string error = error_of("spidar-gc");
  expect_contains(error, "\"spidar-gc\"");
  expect_contains(error, "only-one");
  expect_contains(error, folder.path().string());
}

TEST(Profile, ReportsAPathThatIsNoFile) {
  const Folder folder;
  fs::create_directory(folder.path() / "folder.toml");
  expect_contains(error_of((folder.path() / "folder.toml").string()), "not a regular file");
  const std::string missing = (folder.path() / "missing.toml").string();
  expect_contains(error_of(missing), missing);
  expect_contains(error_of(missing), "No such file");
  expect_contains(error_of("/dev/zero"), "not a regular file");
  // A regular file, as far as the system tells.
  expect_contains(error_of("/proc/self/mem"), "cannot be read: Input/output error");
}

TEST(Profile, ATableWithAWrongNameIsNamed) {
  const Folder folder;
  for (const char* const table : {"[[~source]]", "[~]", "[ .a]"}) {
    const std::string path = folder.write("broken.toml", kValid + table + "\n").string();
    const std::string error = error_of(path);
    expect_contains(error, path);
    expect_contains(error, "not TOML");
  }
}

// One line of the valid file is replaced; the error names the file, this line (or the one given),
// the field, what is wrong and what would be right.
struct Broken {
  std::string from;
  std::string to;
  std::vector<std::string> expected;
  std::string at = {};  ///< text on the line that is named; `to` when empty
};

const std::string kExits =
    kValid.substr(kValid.find("exit = ["), kValid.find("grip = [") - kValid.find("exit = ["));
const std::string kGrips =
    kValid.substr(kValid.find("grip = ["), kValid.find("\n\n[strings]") - kValid.find("grip = ["));

/// The same lines with all points in one position.
std::string one_exit(std::string exits) {
  for (const char* point :
       {"[-60, -61, -62]", "[-60, -61, 62]", "[60, -61, 62]", "[60, -61, -62]", "[-60, 61, 62]"})
    exits.replace(exits.find(point), std::string(point).size(), "[-60, 61, -62]");
  return exits;
}

/// With a table in each other, it would fill the stack.
std::string name_of(size_t parts) {
  std::string name = "x";
  while (--parts > 0) name += ".x";
  return name;
}

class BrokenProfile : public testing::TestWithParam<Broken> {};

TEST_P(BrokenProfile, ErrorNamesFileLineFieldAndRemedy) {
  const Broken& broken = GetParam();
  std::string text = kValid;
  const size_t found = text.find(broken.from);
  ASSERT_NE(found, std::string::npos) << broken.from;
  text.replace(found, broken.from.size(), broken.to);

  const std::string at = broken.at.empty() ? broken.to : broken.at;
  const size_t named = text.find(at);
  ASSERT_NE(named, std::string::npos) << at;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(named), '\n');

  const Folder folder;
  const std::string path = folder.write("broken.toml", text).string();
  const std::string error = error_of(path);
  ASSERT_FALSE(error.empty()) << "accepted:\n" << text;
  expect_contains(error, path + ":" + std::to_string(line) + ": ");
  for (const std::string& part : broken.expected) expect_contains(error, part);
}

INSTANTIATE_TEST_SUITE_P(
    Fields, BrokenProfile,
    testing::Values(
        Broken{"dac_bits = 12", "dac_bits = = 12", {"not TOML"}},
        Broken{"dac_bits = 12", "dac_bits = 12ƺ", {"not TOML", "not ASCII", "quotes"}},
        Broken{"dac_bits = 12",
               "s = \"\"\"a \\\" é\"\"\"\" # 'é\né = 'ü'",
               {"not TOML", "not ASCII", "quotes"},
               "é = 'ü'"},
        Broken{"dac_bits = 12",
               "a = 0.5\n" + name_of(250'000) + " = 1",
               {"not TOML", "16 parts"},
               "x.x"},
        Broken{"dac_bits = 12", "[" + name_of(17) + "]", {"not TOML", "16 parts"}},
        Broken{"board = \"uart\"", "bord = \"uart\"", {"bord", "unknown key", "board"}},
        Broken{"board = \"uart\"", "board = \"USB SH4\"", {"board", "\"USB SH4\"", "uart"}},
        Broken{"board = \"uart\"\n", "", {"board", "missing"}, "description"},
        Broken{"description = \"test\"", "description = 3", {"description", "integer", "string"}},
        Broken{"dac_bits = 12", "dac_bits = 12.5", {"dac_bits", "floating-point", "8 to 16"}},
        Broken{"dac_bits = 12", "dac_bits = 24", {"dac_bits", "is 24", "8 to 16"}},
        Broken{"description = \"test\"",
               "description = \"two\\nlines\"",
               {"description", "control character", "one line"}},
        Broken{
            "dac_max_V = 3.3", "dac_max_V = 3300", {"dac_max_V", "is 3300", "at most 60", "volts"}},
        Broken{"dac_max_V = 3.3", "dac_max_V = 0", {"dac_max_V", "is 0", "above zero"}},
        Broken{"dac_max_V = 3.3",
               "dac_max_V = 1e-300",
               {"dac_max_V", "is 1e-300", "at least 0.1", "volts"}},
        Broken{"min_tension_N = [0.3, 0.3, 0.3, 0.4, 0.3, 0.3]\nmax_tension_N = 6",
               "min_tension_N = 1e-301\nmax_tension_N = 1e-300",
               {"strings.max_tension_N", "1e-300 N", "at least 0.1 N"},
               "max_tension_N"},
        Broken{"dac_max_V = 3.3",
               "dac_max_V = 3.3\ndrive_lag_s = 2",
               {"drive_lag_s", "is 2", "at most 0.1", "seconds"},
               "drive_lag_s"},
        Broken{"dac_max_V = 3.3",
               "dac_max_V = 3.3\ndrive_lag_s = -0.001",
               {"drive_lag_s", "must not be negative"},
               "drive_lag_s"},
        Broken{"[strings]",
               "[grip]\nmoment_of_inertia_kg_m2 = 40\n[strings]",
               {"grip.moment_of_inertia_kg_m2", "is 40", "at most 0.002", "kg m²"},
               "moment_of_inertia_kg_m2"},
        Broken{"[strings]",
               "[grip]\nmoment_of_inertia_kg_m2 = 0.021\n[strings]",  // in g m²
               {"grip.moment_of_inertia_kg_m2", "is 0.021", "at most 0.002", "kg m²"},
               "moment_of_inertia_kg_m2"},
        Broken{"[strings]",
               "[grip]\nmoment_of_inertia_kg_m2 = 2.1e-8\n[strings]",
               {"grip.moment_of_inertia_kg_m2", "is 2.1e-08", "at least 1e-07", "kg m²"},
               "moment_of_inertia_kg_m2"},
        Broken{"[strings]",
               "[grip]\nmoment_of_inertia_kg_m2 = [1e-5, 2e-5]\n[strings]",
               {"grip.moment_of_inertia_kg_m2", "2 entries", "three"},
               "moment_of_inertia_kg_m2"},
        Broken{"[strings]",
               "[grip]\nmoment_of_inertia_kg_m2 = [1e-5, 2e-5, 4e-5]\n[strings]",
               {"grip.moment_of_inertia_kg_m2", "sum of the other two"},
               "moment_of_inertia_kg_m2"},
        Broken{"dac_max_V = 3.3", "dac_max_V = nan", {"dac_max_V", "nan", "finite"}},
        Broken{"unit = \"mm\"",
               "unit = \"m\"",
               {"geometry.exit[0]", "geometry.unit"},
               "[-60, -61, -62]"},
        Broken{"[60, -61, 62]", "[60, -61]", {"geometry.exit[2]", "2 coordinates", "three"}},
        Broken{"[60, -61, 62]", "[60, \"y\", 62]", {"geometry.exit[2][1]", "string", "number"}},
        Broken{"  [60, -61, 62],\n", "", {"geometry.exit", "5 strings", "6 to 8"}, "exit = ["},
        Broken{"[-20, 0, 6]]", "]", {"geometry.grip", "5 entries", "must have 6"}, "grip = ["},
        Broken{"[-60, 61, 62]", "[-20, 0, 6]", {"geometry.exit[5]", "grip point"}},
        Broken{
            kExits + kGrips,
            "exit = [[-60, -61, 62], [60, -61, 62], [60, -61, -62], [-60, 61, -62], [-60, 61, "
            "62],\n"
            "[-60.0, -61, 62]]\n"
            "grip = [[-20, 0, 2], [20, 0, 3], [0, -20, 4], [0, 20, 5], [-20, 0, 6], [-20, 0, 2]]",
            {"geometry.exit[5]", "string 0", "same grip point"},
            "[-60.0, -61, 62]"},
        Broken{
            kExits, one_exit(kExits), {"geometry.exit", "pulls to one side", "0.1 N"}, "exit = ["},
        Broken{kGrips,
               "grip = [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]",
               {"geometry.grip", "grip's origin", "turn"}},
        // All on one axis, about which the grip can turn.
        Broken{kExits + kGrips,
               "exit = [[-60, -61, -62], [-60, -61, 62], [60, -61, 62], [60, -61, -62],\n"
               "[-60, 61, -62], [-60, 61, 62], [60, 61, 62], [60, 61, -62]]\n"
               "grip = [[0, -20, 0], [0, -20, 0], [0, -20, 0], [0, -20, 0],\n"
               "[0, 20, 0], [0, 20, 0], [0, 20, 0], [0, 20, 0]]",
               {"geometry.grip", "no string's length changes"},
               "grip = ["},
        Broken{"[0.3, 0.3, 0.3, 0.4, 0.3, 0.3]",
               "[0.3, 0.3, 3.5, 0.4, 0.3, 0.3]",
               {"strings.min_tension_N", "string 2", "3.5 N", "at most 3 N"}},
        Broken{"max_tension_N = 6\nnewtons_per_volt = 12.5",
               "max_tension_N = 600\nnewtons_per_volt = 1250",
               {"strings.max_tension_N", "600 N", "at least 0.1 N and at most 100 N"},
               "max_tension_N"},
        Broken{"newtons_per_volt = 12.5",
               "newtons_per_volt = 12500",
               {"strings.newtons_per_volt", "12500", "steps", "16"}},
        Broken{"metres_per_count = 2.25e-5",
               "metres_per_count = 2.25e-5\nheating_time_s = 1e300",
               {"strings.heating_time_s", "1e+300", "1 to 120", "seconds"},
               "heating_time_s"},
        Broken{"metres_per_count = 2.25e-5",
               "metres_per_count = 2.25e-5\nheating_time_s = 0.01",
               {"strings.heating_time_s", "0.01", "1 to 120"},
               "heating_time_s"},
        Broken{"metres_per_count = 2.25e-5",
               "metres_per_count = 2.25e-5\ncontinuous_tension_N = 7",
               {"strings.continuous_tension_N", "7 N", "max_tension_N"},
               "continuous_tension_N"},
        Broken{"metres_per_count = 2.25e-5",
               "metres_per_count = 2.25e-7",
               {"strings.metres_per_count", "2.25e-07", "1e-06 to 0.0001"}},
        Broken{"[[source]]",
               "[calibration]\nsamples = 9\nresidual_m = 2.5\n[[source]]",
               {"calibration.residual_m", "is 2.5", "at most 0.05", "metres"},
               "residual_m"},
        Broken{"max_tension_N = 6",
               "max_tension_N = 0.35",
               {"strings.max_tension_N", "string 3", "0.35", "min_tension_N", "0.4"}},
        Broken{"max_tension_N = 6",
               "max_tension_N = 60",
               {"strings.max_tension_N", "4.8 V", "dac_max_V", "3.3"}},
        Broken{
            "0.4, 0.3, 0.3]", "0.4, 0.3]", {"strings.min_tension_N", "5 entries", "must have 6"}},
        Broken{"newtons_per_volt = 12.5",
               "newtons_per_volt = -12.5",
               {"strings.newtons_per_volt", "-12.5", "above zero"}},
        Broken{"metres_per_count = 2.25e-5",
               "metres_per_count = 2.25e-2",
               {"strings.metres_per_count", "0.0225", "metres"}},
        Broken{"motor_sign = [1, -1, 1, -1",
               "motor_sign = [1, -1, 1, 0",
               {"strings.motor_sign[3]", "1 or -1"}},
        Broken{"encoder_sign = [-1, -1, 1, 1, 1, 1]",
               "encoder_sign = 1",
               {"strings.encoder_sign", "array"}},
        Broken{"fields = [\"geometry\"",
               "fields = [\"geometri\"",
               {"source[0].fields[0]", "\"geometri\""}},
        Broken{"\"contradicted\"", "\"heard\"", {"source[0].evidence", "\"heard\"", "inferred"}},
        Broken{"source = \"a book\"\n", "", {"source[0].source", "missing"}, "[[source]]"}));

}  // namespace spidar::test::profile_test
