// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The list of the limits of a wrench is that of the page.
#include "spidar/loop/wrench_chain.h"
#include "tests/support/test.h"

namespace spidar::test::limit_chain_test {
namespace {

/// The text of docs/architecture.md, which SPIDAR_PAGE names, each run of white space as one space.
std::string page() {
  const char* const path = std::getenv("SPIDAR_PAGE");
  std::ifstream file(path ? path : "docs/architecture.md");
  std::string text, word;
  while (file >> word) text += word + ' ';
  return text;
}

TEST(WrenchChain, ThePageListsWhatTheCodeDoes) {
  std::string list;
  for (const WrenchChain::Step& step : WrenchChain::kSteps) {
    const auto number = 1 + &step - WrenchChain::kSteps.data();
    list += std::to_string(number) + ". **" + step.name + "**: " + step.limit + ", " + step.reason +
            ' ';
  }
  const std::string text = page();
  const size_t at = text.find(list);
  ASSERT_NE(at, std::string::npos) << "docs/architecture.md lacks, in this order:\n" << list;
  EXPECT_FALSE(std::isdigit(text[at + list.size()])) << "the page goes on with the list";
}

}  // namespace
}  // namespace spidar::test::limit_chain_test
