// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/learned/block_network.h"

#include "core/motion/learned/block_features.h"
#include "core/motion/learned/block_network_weights.h"

#ifdef __clang__
#define SPIDAR_UNROLL _Pragma("unroll")
#else
#define SPIDAR_UNROLL _Pragma("GCC unroll 12")
#endif

namespace spidar {
namespace {

using namespace network_weights;
static_assert(kIn == kFeatures, "the weights are those of other features");
static_assert(kOut == 3, "moves, votes and graphics");
constexpr int kBoth = kHidden + kState;

/// What the layers work on, block by block.
struct Arrays {
  BlockGrid grid;
  const uint32_t* origins;
  const float* features;
  float* shown;   ///< by a block and those around it
  float* around;  ///< sums of one layer
  float* state;   ///< memory of each block
  float* both;    ///< `shown` and `state`
  float* gates;   ///< how much of the state is replaced, and by what
  BlockAnswer* answers;
};

namespace any_processor {
#define SPIDAR_LANES 4
#define SPIDAR_TARGET
#include "core/motion/learned/block_network_layers.h"
#undef SPIDAR_LANES
#undef SPIDAR_TARGET
}  // namespace any_processor

#ifdef __x86_64__
namespace with_avx2 {
#define SPIDAR_LANES 8
#define SPIDAR_TARGET __attribute__((target("avx2,fma")))
#include "core/motion/learned/block_network_layers.h"
#undef SPIDAR_LANES
#undef SPIDAR_TARGET
}  // namespace with_avx2

void run(const Arrays& arrays) {
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  has_avx2 ? with_avx2::run(arrays) : any_processor::run(arrays);
}
#else
void run(const Arrays& arrays) {
  any_processor::run(arrays);
}
#endif

}  // namespace

const int BlockNetwork::kMemory = kBoth;

const std::vector<BlockAnswer>& BlockNetwork::answer(const BlockGrid& grid,
                                                     const std::vector<uint32_t>& origins,
                                                     const std::vector<float>& features) {
  const auto n = static_cast<size_t>(grid.size());
  if (state_.size() != n * kState) state_.assign(n * kState, 0);
  shown_.resize(n * kHidden);
  around_.resize(n * kHidden);
  both_.resize(n * kBoth);
  gates_.resize(n * 2 * kState);
  answers_.resize(n);
  run({grid, origins.data(), features.data(), shown_.data(), around_.data(), state_.data(),
       both_.data(), gates_.data(), answers_.data()});
  return answers_;
}

}  // namespace spidar
