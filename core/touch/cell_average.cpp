// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/cell_average.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spidar {

void CellSpans::set(int samples, int cells) {
  if (samples == samples_ && static_cast<size_t>(cells) == cells_.size()) return;
  samples_ = samples;
  cells_.clear();
  weights_.clear();
  const double size = static_cast<double>(samples) / cells;  // of a cell, in samples
  for (int c = 0; c < cells; ++c) {
    if (samples >= cells) {
      add_mean(c * size, (c + 1) * size, samples);
    } else {
      add_interpolated((c + 0.5) * size - 0.5, samples);
    }
  }
}

void CellSpans::add_mean(double begin, double end, int samples) {
  // Keeps a rounding error at a border between two samples from adding a sample.
  constexpr double kRounding = 1e-9;
  const int first = static_cast<int>(std::floor(begin + kRounding));
  const int last = std::min(static_cast<int>(std::ceil(end - kRounding)), samples) - 1;
  cells_.push_back({first, last - first + 1, weights_.size()});
  for (int i = first; i <= last; ++i) {
    const double covered = std::min(end, i + 1.0) - std::max(begin, static_cast<double>(i));
    weights_.push_back(static_cast<float>(covered / (end - begin)));
  }
}

void CellSpans::add_interpolated(double place, int samples) {
  const double inside = std::clamp(place, 0.0, samples - 1.0);
  const int first = static_cast<int>(inside);
  const auto share = static_cast<float>(inside - first);
  cells_.push_back({first, share > 0 ? 2 : 1, weights_.size()});
  weights_.push_back(1 - share);
  if (share > 0) weights_.push_back(share);
}

void CellAverage::start(int width, int height) {
  across_.set(width, kColumns);
  down_.set(height, kRows);
  samples_.resize(static_cast<size_t>(width));
  for (Line& line : lines_) line.y = -1;
}

void CellAverage::reduce(int y, Line& line) noexcept {
  line.y = y;
  for (int x = 0; x < kColumns; ++x) {
    const CellSpans::Span span = across_.span(x);
    const float* const samples = samples_.data() + span.first;
    float sum = 0;
    float weight = 0;
    for (int k = 0; k < span.count; ++k) {
      const bool hole = std::isnan(samples[k]);
      sum += hole ? 0.0F : span.weight[k] * samples[k];
      weight += hole ? 0.0F : span.weight[k];
    }
    line.sum[x] = sum;
    line.weight[x] = weight;
  }
}

void CellAverage::begin_cells() noexcept {
  std::fill(sum_, sum_ + kColumns, 0.0F);
  std::fill(weight_, weight_ + kColumns, 0.0F);
}

void CellAverage::add(const Line& line, float weight) noexcept {
  for (int x = 0; x < kColumns; ++x) {
    sum_[x] += weight * line.sum[x];
    weight_[x] += weight * line.weight[x];
  }
}

void CellAverage::end_cells(float* cells) const noexcept {
  for (int x = 0; x < kColumns; ++x) {
    cells[x] = weight_[x] > 0 ? sum_[x] / weight_[x] : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace spidar
