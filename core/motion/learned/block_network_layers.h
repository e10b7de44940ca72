// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The layers of the network. block_network.cpp includes this file once for each kind of processor,
/// in a namespace of its own, with SPIDAR_LANES, the floats of a vector, and SPIDAR_TARGET, the
/// attribute of functions for that processor. All sizes are multiples of SPIDAR_LANES.
// NOLINT(llvm-header-guard): no guard.

#define SPIDAR_LAYER SPIDAR_TARGET __attribute__((always_inline)) inline

constexpr int kLanes = SPIDAR_LANES;
/// Compilers split the operations, and keep each vector in a register.
using Lanes = float __attribute__((vector_size(SPIDAR_LANES * sizeof(float))));

SPIDAR_LAYER Lanes load(const float* from) {
  Lanes v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
SPIDAR_LAYER void store(const Lanes& v, float* to) {
  __builtin_memcpy(to, &v, sizeof v);
}
SPIDAR_LAYER Lanes larger(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}
SPIDAR_LAYER Lanes rectified(const Lanes& v) {
  return larger(v, Lanes{});
}

enum class Then { kNothing, kRectify, kAddRectified };

/// The same matrix for `kCount` blocks, which share each load of a weight.
template <int kFrom, int kTo, Then kThen, int kCount>
SPIDAR_LAYER void multiply_some(const float* x, const float* weights, const float* bias, float* y) {
  constexpr int kVectors = kTo / kLanes;
  Lanes sum[kCount][kVectors];
  SPIDAR_UNROLL
  for (int k = 0; k < kCount; ++k) {
    SPIDAR_UNROLL
    for (int o = 0; o < kVectors; ++o) sum[k][o] = load(bias + o * kLanes);
  }
  for (int c = 0; c < kFrom; ++c) {
    const float* const row = weights + c * kTo;
    SPIDAR_UNROLL
    for (int k = 0; k < kCount; ++k) {
      const float value = x[k * kFrom + c];
      SPIDAR_UNROLL
      for (int o = 0; o < kVectors; ++o) sum[k][o] += value * load(row + o * kLanes);
    }
  }
  SPIDAR_UNROLL
  for (int k = 0; k < kCount; ++k) {
    SPIDAR_UNROLL
    for (int o = 0; o < kVectors; ++o) {
      float* const to = y + k * kTo + o * kLanes;
      if constexpr (kThen == Then::kNothing) store(sum[k][o], to);
      if constexpr (kThen == Then::kRectify) store(rectified(sum[k][o]), to);
      if constexpr (kThen == Then::kAddRectified) store(load(to) + rectified(sum[k][o]), to);
    }
  }
}

/// The same matrix for each of `n` blocks. Weights are ordered by input.
template <int kFrom, int kTo, Then kThen = Then::kNothing>
SPIDAR_LAYER void multiply(const float* x, const float* weights, const float* bias, float* y,
                           int n) {
  constexpr int kSums = 12;  // of 16 registers
  constexpr int kTogether = kTo >= kSums * kLanes ? 1 : kSums * kLanes / kTo;
  int i = 0;
  for (; i + kTogether <= n; i += kTogether) {
    multiply_some<kFrom, kTo, kThen, kTogether>(x + i * kFrom, weights, bias, y + i * kTo);
  }
  for (; i < n; ++i) {
    multiply_some<kFrom, kTo, kThen, 1>(x + i * kFrom, weights, bias, y + i * kTo);
  }
}

/// Three by three blocks, `kApart` from each other, each channel by itself. There is nothing beyond
/// the border.
template <int kChannels, int kApart>
SPIDAR_LAYER void look_around(const BlockGrid& grid, const float* x, const float* weights,
                              const float* bias, float* y) {
  constexpr int kVectors = kChannels / kLanes;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column, y += kChannels) {
      Lanes sum[kVectors];
      SPIDAR_UNROLL
      for (int c = 0; c < kVectors; ++c) sum[c] = load(bias + c * kLanes);
      for (int j = -1; j <= 1; ++j) {
        const int there = row + j * kApart;
        if (there < 0 || there >= grid.rows) continue;
        for (int i = -1; i <= 1; ++i) {
          const int beside = column + i * kApart;
          if (beside < 0 || beside >= grid.columns) continue;
          const float* const from = x + (there * grid.columns + beside) * kChannels;
          const float* const tap = weights + ((j + 1) * 3 + i + 1) * kChannels;
          SPIDAR_UNROLL
          for (int c = 0; c < kVectors; ++c) {
            sum[c] += load(from + c * kLanes) * load(tap + c * kLanes);
          }
        }
      }
      SPIDAR_UNROLL
      for (int c = 0; c < kVectors; ++c) store(sum[c], y + c * kLanes);
    }
  }
}

/// Adds to each block what the whole picture shows: mean and maximum of each channel.
SPIDAR_LAYER void add_whole(float* shown, int n) {
  constexpr int kVectors = kHidden / kLanes;
  Lanes sum[kVectors] = {};
  Lanes most[kVectors];
  for (int c = 0; c < kVectors; ++c) most[c] = load(shown + c * kLanes);
  for (int i = 0; i < n; ++i) {
    SPIDAR_UNROLL
    for (int c = 0; c < kVectors; ++c) {
      const Lanes v = load(shown + i * kHidden + c * kLanes);
      sum[c] += v;
      most[c] = larger(v, most[c]);
    }
  }
  float whole[2 * kHidden];
  for (int c = 0; c < kVectors; ++c) {
    store(sum[c] / static_cast<float>(n), whole + c * kLanes);
    store(most[c], whole + kHidden + c * kLanes);
  }
  float add[kHidden];
  multiply_some<2 * kHidden, kHidden, Then::kRectify, 1>(whole, kWhole, kWholeBias, add);
  for (int i = 0; i < n; ++i) {
    SPIDAR_UNROLL
    for (int c = 0; c < kVectors; ++c) {
      float* const to = shown + i * kHidden + c * kLanes;
      store(load(to) + load(add + c * kLanes), to);
    }
  }
}

/// tanh x to 1e-4: a continued fraction, which unlike std::tanh() compilers turn into vectors.
SPIDAR_LAYER Lanes hyperbolic_tangent(Lanes x) {
  const Lanes most = 4.9f - Lanes{};
  x = larger(x, -most);
  x = x > most ? most : x;
  const Lanes x2 = x * x;
  return x * (135135 + x2 * (17325 + x2 * (378 + x2))) /
         (135135 + x2 * (62370 + x2 * (3150 + x2 * 28)));
}

SPIDAR_LAYER Lanes sigmoid(const Lanes& x) {
  return 0.5f + 0.5f * hyperbolic_tangent(0.5f * x);
}

template <int kApart>
SPIDAR_LAYER void convolve(const Arrays& a, int n, const float* deep, const float* deep_bias,
                           const float* flat, const float* flat_bias) {
  look_around<kHidden, kApart>(a.grid, a.shown, deep, deep_bias, a.around);
  multiply<kHidden, kHidden, Then::kAddRectified>(a.around, flat, flat_bias, a.shown, n);
}

/// Replaces a part of what is remembered of each block's content by news.
SPIDAR_LAYER void remember(const Arrays& a, int n) {
  for (int i = 0; i < n; ++i) {
    const float* const shown = a.shown + i * kHidden;
    const float* const before = a.state + static_cast<int>(a.origins[i]) * kState;
    float* const both = a.both + i * kBoth;
    for (int c = 0; c < kHidden; c += kLanes) store(load(shown + c), both + c);
    for (int s = 0; s < kState; s += kLanes) store(load(before + s), both + kHidden + s);
  }
  multiply<kBoth, 2 * kState>(a.both, kGateAndNews, kGateAndNewsBias, a.gates, n);
  for (int i = 0; i < n; ++i) {
    const float* const gate = a.gates + i * 2 * kState;
    for (int s = 0; s < kState; s += kLanes) {
      const Lanes before = load(a.both + i * kBoth + kHidden + s);
      const Lanes news = hyperbolic_tangent(load(gate + kState + s));
      store(before + sigmoid(load(gate + s)) * (news - before), a.state + i * kState + s);
    }
  }
}

SPIDAR_TARGET void run(const Arrays& a) {
  const int n = a.grid.size();
  multiply<kIn, kHidden, Then::kRectify>(a.features, kFirst, kFirstBias, a.shown, n);
  convolve<1>(a, n, kDeep0, kDeep0Bias, kFlat0, kFlat0Bias);
  convolve<2>(a, n, kDeep1, kDeep1Bias, kFlat1, kFlat1Bias);
  add_whole(a.shown, n);
  convolve<4>(a, n, kDeep2, kDeep2Bias, kFlat2, kFlat2Bias);
  remember(a, n);
  look_around<kState, 1>(a.grid, a.state, kSpread, kSpreadBias, a.around);
  for (int i = 0; i < n; ++i) {
    for (int s = 0; s < kState; s += kLanes) {
      const int k = i * kState + s;
      store(load(a.state + k) + load(a.around + k), a.both + i * kBoth + kHidden + s);
    }
  }
  multiply<kBoth, kLast, Then::kRectify>(a.both, kLastLayer, kLastLayerBias, a.shown, n);
  multiply<kLast, kPaddedOut>(a.shown, kAnswer, kAnswerBias, a.gates, n);
  for (int i = 0; i < n; ++i) {
    float* const answer = a.gates + i * kPaddedOut;
    store(sigmoid(load(answer)), answer);
    a.answers[i] = {answer[0], answer[1], answer[2]};
  }
}

#undef SPIDAR_LAYER
