// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The lists of the limits of a tick are those of the page.
#include "spidar/grip/tension_chain.h"
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

/// The list of a chain as the page has it, in Markdown.
template <typename Chain>
std::string listed() {
  std::string list;
  int number = 0;
  for (const auto& step : Chain::kSteps) {
    list += std::to_string(++number) + ". **" + step.name + "**: " + step.limit + ", " +
            step.reason + ' ';
  }
  return list;
}

TEST(LimitChains, ThePageListsWhatTheCodeDoes) {
  const std::string text = page();
  for (const std::string& list : {listed<WrenchChain>(), listed<TensionChain>()}) {
    const size_t at = text.find(list);
    ASSERT_NE(at, std::string::npos) << "docs/architecture.md lacks, in this order:\n" << list;
    EXPECT_FALSE(std::isdigit(text[at + list.size()])) << "the page goes on with the list " << list;
  }
}

}  // namespace
}  // namespace spidar::test::limit_chain_test
