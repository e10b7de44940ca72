// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/json_text.h"
#include "tests/support/test.h"

namespace spidar::test::json_text_test {
namespace {

/// Why it cannot be read; empty when it can.
std::string why_not(const std::string& text) {
  std::string why;
  const bool is_wrong = parse_json(text, why).is_discarded();
  EXPECT_EQ(is_wrong, !why.empty());
  return why;
}

std::string nested(size_t depth) {
  return std::string(depth, '[') + std::string(depth, ']');
}

TEST(JsonText, IsReadUpToABoundOfDepth) {
  EXPECT_EQ(why_not(nested(kMaxJsonDepth)), "");
  EXPECT_EQ(why_not("{\"a\":\n" + nested(kMaxJsonDepth) + "}"),
            "its arrays and objects lie more than 64 deep in each other at line 2, column 64");
  // Also as a member before another one, where lists of members copied what they contain.
  for (const size_t depth : {size_t{100'000}, size_t{4'000'000}}) {
    EXPECT_NE(why_not("{\"a\":" + nested(depth) + ",\"b\":1}"), "");
    EXPECT_NE(why_not(std::string(depth, '{')), "");
  }
  // Side by side, and in strings, they are not deep.
  std::string flat = "[[]";
  for (int i = 0; i < 1000; ++i) flat += ",[{}]";
  EXPECT_EQ(why_not(flat + "]"), "");
  EXPECT_EQ(why_not(R"({"\"[":")" + std::string(1000, '[') + R"(\\"})"), "");
}

TEST(JsonText, SaysWhereItIsWrong) {
  EXPECT_EQ(why_not(""), "it is no JSON: it ends too early");
  EXPECT_EQ(why_not("{\"a\":"), "it is no JSON: it ends too early");
  EXPECT_EQ(why_not("{\n  \"a\": x}"), "it is no JSON: line 2, column 8 is wrong");
  EXPECT_EQ(why_not("\xff"), "it is no JSON: line 1, column 1 is wrong");
  EXPECT_EQ(why_not("[1e999]"), "it has a number that is beyond 1.8e308");
  EXPECT_EQ(why_not("]]]"), "it is no JSON: line 1, column 1 is wrong");
}

TEST(JsonText, OfEqualMembersTheLastCounts) {
  std::string why;
  EXPECT_EQ(parse_json(R"({"a":1,"a":2})", why)["a"], 2);
}

}  // namespace
}  // namespace spidar::test::json_text_test
