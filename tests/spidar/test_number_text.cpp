// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers and messages become texts as long as they are.
#include "core/number_text.h"
#include "spidar/text.h"
#include "tests/support/test.h"

namespace spidar::test::number_text_test {
namespace {

TEST(NumberText, HasRoomForEveryNumber) {
  using Double = std::numeric_limits<double>;
  const std::pair<std::string, NumberText> cases[] = {
      {"-2.2250738585072014e-308", NumberText(-Double::min())},
      {"-1.7976931348623157e+308", NumberText(Double::lowest())},
      {"5e-324", NumberText(Double::denorm_min())},
      {"0.3", NumberText(0.3)},
      {"-9223372036854775808", NumberText(std::numeric_limits<int64_t>::min())},
      {"18446744073709551615", NumberText(std::numeric_limits<uint64_t>::max())},
  };
  for (const auto& [text, number] : cases) EXPECT_EQ(std::string(number), text);
}

TEST(NumberText, IsReadAgainIfItIsOneNumber) {
  for (const double number : {-2.2250738585072014e-308, 0.1, 3.0, -0.0})
    EXPECT_EQ(number_of(NumberText(number)), number);
  for (const char* text : {"", "1,5", "1.5 ", " 1", "nan", "inf", "1e999", "x"})
    EXPECT_FALSE(number_of(text)) << text;
}

/// A question about motors is asked whole, however long the name of the device is.
TEST(ReportText, IsNotCut) {
  const std::string name(2000, 'x');
  EXPECT_EQ(formatted("Push %s with %.1f N?", name.c_str(), 2.0), "Push " + name + " with 2.0 N?");
  EXPECT_EQ(formatted("none"), "none");
}

}  // namespace
}  // namespace spidar::test::number_text_test
