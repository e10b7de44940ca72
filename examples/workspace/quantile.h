#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

/// The value that the share `share`, 0 … 1, of `values` does not exceed. There is at least one
/// value; their order is changed.
inline double quantile(std::vector<double>& values, double share) {
  const double last = static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<ptrdiff_t>(share * last + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}
