// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/text.h"
#include "tests/support/test.h"

namespace spidar::test::printable_test {
namespace {

TEST(Printable, KeepsTextInEveryLanguage) {
  for (const char* text : {"", "Logitech G29", "Größe, 手触り, ручка", "\xF0\x9F\x8E\xAE ~!?"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ReplacesWhatATerminalObeysAndWhatIsNoText) {
  EXPECT_EQ(printable("Name \x1b]0;title\x07\x1b[2J\r\n\t\x7f"), "Name ?]0;title??[2J????");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\xC2\x9B"
                      "2J"),
            "?2J")
      << "CSI in one character";
  EXPECT_EQ(printable("a\xE2\x80\xAEtxt"), "a?txt") << "from right to left";
  EXPECT_EQ(printable("\x9B"
                      "\xC3"),
            "??")
      << "no UTF-8, and half a character";
  EXPECT_EQ(printable("\xC0\xAF"), "??") << "longer than needed";
  EXPECT_EQ(printable("\xED\xA0\x80"), "???") << "half of a pair of UTF-16";
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "????") << "beyond Unicode";
  EXPECT_EQ(printable("\xFF\xFE"), "??");
}

}  // namespace
}  // namespace spidar::test::printable_test
