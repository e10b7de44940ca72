// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <glib-object.h>

namespace spidar::test {

/// Random numbers for tests, the same for the same seed with every standard library, because they
/// use none of its distributions.
class RandomSource {
 public:
  explicit RandomSource(uint64_t seed) : engine_(seed) {}

  /// 0 … below − 1
  uint64_t below(uint64_t bound) { return engine_() % bound; }
  int64_t between(int64_t low, int64_t high) {
    return low + static_cast<int64_t>(below(static_cast<uint64_t>(high - low) + 1));
  }
  /// 0 … 1, without 1
  double fraction() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  bool chance(double probability) { return fraction() < probability; }

  template <typename Array>
  const auto& one_of(const Array& choices) {
    return choices[below(std::size(choices))];
  }

 private:
  std::mt19937_64 engine_;
};

/// Sets `value` to a valid value of such a property (boolean, number, enumeration): its default in
/// four of five cases, otherwise an end of its range or a value between.
void set_random_value(GParamSpec* spec, RandomSource& random, GValue* value);

/// Names of the writable properties of such kinds that the class of `object` itself defines.
std::vector<std::string> random_properties(GObject* object);

}  // namespace spidar::test
