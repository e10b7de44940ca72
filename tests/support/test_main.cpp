// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// main() of a program with the tests of a folder: `test_core test_rest.cpp test_safety.cpp` runs
/// those of these source files; without a file, all, or those of --gtest_filter.
#include <algorithm>
#include <iostream>
#include <iterator>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace {

std::string name_of(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

/// Returns the tests of these files, as --gtest_filter names them. Removes the files that have
/// tests from `files`.
std::string filter_of(std::set<std::string>& files) {
  std::string filter;
  std::set<std::string> found;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) {
      const testing::TestInfo& test = *suite.GetTestInfo(j);
      const std::string file = name_of(test.file());
      if (files.count(file) == 0) continue;
      found.insert(file);
      filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  for (const std::string& file : found) files.erase(file);
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc > 1) {
    std::set<std::string> files;
    std::transform(argv + 1, argv + argc, std::inserter(files, files.end()), name_of);
    GTEST_FLAG_SET(filter, filter_of(files));
    for (const std::string& file : files)
      std::cerr << "error: this program has no test of a file " << file << "\n";
    if (!files.empty()) return 2;
  }
  return RUN_ALL_TESTS();
}
