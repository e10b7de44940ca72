// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The network answers as the one in core/motion/world/network.py that PyTorch runs.
#include <cmath>

#include <gtest/gtest.h>

#include "core/motion/learned/block_features.h"
#include "core/motion/learned/block_network.h"
#include "core/motion/learned/block_network_weights.h"

namespace spidar::test::block_network_test {
namespace {

namespace check = network_weights::check;
constexpr size_t kBlocks = size_t{check::kRows} * check::kColumns;

/// The same as check_inputs() in core/motion/world/network.py.
std::vector<float> features_of(size_t frame) {
  std::vector<float> features(kBlocks * kFeatures);
  for (size_t i = 0; i < features.size(); ++i) {
    const auto k = static_cast<double>(frame * features.size() + i);
    features[i] = static_cast<float>(std::sin(0.37 * k + 0.001 * std::pow(std::fmod(k, 101), 2)));
  }
  return features;
}
std::vector<uint32_t> origins_of(size_t frame) {
  std::vector<uint32_t> origins(kBlocks);
  for (size_t i = 0; i < kBlocks; ++i)
    origins[i] = static_cast<uint32_t>((3 * frame + 5 * i) % kBlocks);
  return origins;
}

/// Most of the difference is that of the functions that stand for tanh.
constexpr double kMostDifference = 1e-3;

void expect_answers(BlockNetwork& network) {
  BlockGrid grid;
  grid.columns = check::kColumns;
  grid.rows = check::kRows;
  const float* expected = check::kAnswers;
  for (size_t frame = 0; frame < check::kFrames; ++frame) {
    for (const BlockAnswer& answer : network.answer(grid, origins_of(frame), features_of(frame))) {
      ASSERT_NEAR(answer.moves, *expected++, kMostDifference) << "frame " << frame;
      ASSERT_NEAR(answer.votes, *expected++, kMostDifference) << "frame " << frame;
      ASSERT_NEAR(answer.graphics, *expected++, kMostDifference) << "frame " << frame;
    }
  }
}

TEST(BlockNetwork, AnswersAsPyTorchDoes) {
  BlockNetwork network;
  expect_answers(network);
}

TEST(BlockNetwork, RemembersNothingAfterAReset) {
  BlockNetwork network;
  expect_answers(network);
  network.reset();
  expect_answers(network);
}

}  // namespace
}  // namespace spidar::test::block_network_test
