// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// Median of the length of a vector whose coordinates have standard deviation 1: √(2 ln 2).
constexpr double kRayleighMedian = 1.1774;
/// Median of the absolute value of a normal variable of standard deviation 1.
constexpr double kNormalMedian = 0.6745;

/// The value that the fraction `fraction`, 0 … 1, of [first, last) does not exceed. The range must
/// not be empty; its order is changed.
template <typename Iterator>
typename std::iterator_traits<Iterator>::value_type quantile(Iterator first, Iterator last,
                                                             double fraction) {
  const double highest = static_cast<double>(std::distance(first, last) - 1);
  const Iterator at = first + static_cast<std::ptrdiff_t>(fraction * highest + 0.5);
  std::nth_element(first, at, last);
  return *at;
}

/// Changes the order of `values`.
template <typename Value>
Value quantile(std::vector<Value>& values, double fraction) {
  return quantile(values.begin(), values.end(), fraction);
}

/// The median; for an even number of values, the upper one of the two in the middle.
template <typename Iterator>
typename std::iterator_traits<Iterator>::value_type median(Iterator first, Iterator last) {
  return quantile(first, last, 0.5);
}

template <typename Value>
Value median(std::vector<Value> values) {
  return median(values.begin(), values.end());
}

/// The median of each coordinate. Changes the order of `vectors`, which must not be empty.
template <typename Vector>
Vector median_of_each(std::vector<Vector>& vectors) {
  Vector medians;
  for (Eigen::Index k = 0; k < medians.size(); ++k) {
    const auto middle = vectors.begin() + static_cast<std::ptrdiff_t>(vectors.size() / 2);
    std::nth_element(vectors.begin(), middle, vectors.end(),
                     [k](const Vector& a, const Vector& b) { return a[k] < b[k]; });
    medians[k] = (*middle)[k];
  }
  return medians;
}

}  // namespace spidar
