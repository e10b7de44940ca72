// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// In a player of a country with decimal commas, what programs read and write has decimal points.
#include <clocale>
#include <locale>

#include "core/choice/feel_rules.h"
#include "core/fields.h"
#include "core/track/exchange_formats.h"
#include "core/track/funscript.h"
#include "spidar/devices/inverse3/packets.h"
#include "spidar/devices/sound/packets.h"
#include "spidar/profiles/profile_file.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::locale_test {
namespace {

/// 1.234,5 in C and in C++ as long as it lives; not `set` if the locale cannot be made.
class Commas {
 public:
  Commas() {
    const std::string name = "de_DE.UTF-8";
    run("localedef -f UTF-8 -i de_DE " + (folder_.path / name).string());
    setenv("LOCPATH", folder_.path.c_str(), 1);
    set = std::setlocale(LC_ALL, name.c_str()) != nullptr;
    if (set) std::locale::global(std::locale(name));
  }
  ~Commas() {
    std::locale::global(std::locale::classic());
    unsetenv("LOCPATH");
  }
  Commas(const Commas&) = delete;
  Commas& operator=(const Commas&) = delete;

  bool set = false;

 private:
  TemporaryFolder folder_;
};

SampleSource one_sample() {
  return {1, [](const SampleSource::Take& take) { take({0.25F, 0, 0, 0, 0, 0}); }};
}

/// All that is written, and read again, with numbers in it.
std::string everything() {
  std::string text;
  CsvLine csv(CsvLine::Of::kValues, text);
  const auto add = [&text](const std::string& part) { text += part + '\n'; };
  for (const Eigen::Vector3d& direction :
       sound::Settings::parse("sound", "a,1=0.6/0.8/0,2=-1.5/0/2e-1").direction)
    csv("direction", "", axes(direction), "");
  add(FeelRules("1.5-2.25 object at 0.31,0.62 gain 1.5").text());
  Profile profile = load_profile(kDefaultProfile);
  profile.calibration = CalibrationRecord{12345, 1.5e-5};
  const std::string written = profile_text(profile);
  add(written);
  add(profile_text(parse_profile(written, "", profile.name)));
  write_ahap(one_sample(), add, kAhapTolerance, 1.5);
  write_funscript(one_sample(), 0, add);
  write_hjif(one_sample(), add);
  csv("numbers", "", Parts{{"half", 0.5}, {"whole", uint64_t{12345}}}, "");
  std::array<uint8_t, 200> packet{};
  inverse3::State device;
  device.id = "1";
  const size_t length = inverse3::encode_force(device, {0.5, 1, 2}, {packet.data(), packet.size()});
  text.append(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(length));
  return text;
}

TEST(Locale, ChangesNothingThatAProgramReads) {
  const std::string plain = everything();
  const Commas commas;
  if (!commas.set) GTEST_SKIP() << "no locale with commas can be made: install locales";
  std::array<char, 8> shown{};
  std::snprintf(shown.data(), shown.size(), "%.1f", 0.5);
  ASSERT_STREQ(shown.data(), "0,5");
  EXPECT_EQ(everything(), plain);
}

}  // namespace
}  // namespace spidar::test::locale_test
