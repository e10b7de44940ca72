// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Eight doubles, one for each string, worked on in pairs: the vector registers that every x86-64
/// and ARM64 has.
#pragma once

namespace spidar {

using Row = double[8];  ///< aligned to 16 bytes
constexpr int kPairs = 4;

using Pair = double __attribute__((vector_size(16), may_alias));

inline Pair& pair(double* row, int p) {
  return reinterpret_cast<Pair*>(row)[p];
}
inline const Pair& pair(const double* row, int p) {
  return reinterpret_cast<const Pair*>(row)[p];
}

inline Pair smaller(Pair a, Pair b) {
  return a < b ? a : b;
}
inline Pair larger(Pair a, Pair b) {
  return a > b ? a : b;
}
inline Pair magnitude(Pair a) {
  return larger(a, -a);
}

/// What a comparison of pairs gives: all bits set where it holds.
using PairMask = decltype(Pair{} < Pair{});

/// Bit 2p and 2p + 1: whether `mask` is set in pair p.
inline unsigned bits(PairMask mask, int p) {
  return (static_cast<unsigned>(mask[0]) & 1u << 2 * p) |
         (static_cast<unsigned>(mask[1]) & 2u << 2 * p);
}

inline double largest(Pair a, Pair b, Pair c, Pair d) {
  const Pair m = larger(larger(a, b), larger(c, d));
  return m[0] > m[1] ? m[0] : m[1];
}

}  // namespace spidar
