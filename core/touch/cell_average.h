// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/touch/height_field.h"

namespace spidar::touch {

/// The samples of a line that contribute to each cell, with weights that add up to 1. With at least
/// as many samples as cells, the weights average over the cell and count samples on its border in
/// part; with fewer, they interpolate between the two nearest samples.
class CellSpans {
 public:
  struct Span {
    int first = 0;
    int count = 0;
    size_t weight = 0;  // index of the first weight
  };

  /// Allocates only when `samples` differs from the last call. `samples` and `cells` ≥ 1.
  void set(int samples, int cells) {
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

  const Span& span(int cell) const noexcept { return cells_[static_cast<size_t>(cell)]; }
  const float* weights(const Span& span) const noexcept { return weights_.data() + span.weight; }

 private:
  void add_mean(double begin, double end, int samples) {
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
  void add_interpolated(double position, int samples) {
    const double inside = std::clamp(position, 0.0, samples - 1.0);
    const int first = static_cast<int>(inside);
    const auto fraction = static_cast<float>(inside - first);
    cells_.push_back({first, fraction > 0 ? 2 : 1, weights_.size()});
    weights_.push_back(1 - fraction);
    if (fraction > 0) weights_.push_back(fraction);
  }

  int samples_ = 0;
  std::vector<Span> cells_;
  std::vector<float> weights_;
};

/// Averages a picture into the cells of a height field. A NaN sample is a hole and is ignored.
class CellAverage {
 public:
  static constexpr int kColumns = HeightField::kColumns;
  static constexpr int kRows = HeightField::kRows;

  /// Computes the mean of each cell, NaN if the cell contains only holes. `read_row(y, values)`
  /// writes the `width` samples of row y. Allocates only when the size differs from the last call.
  template <typename ReadRow>
  void read(int width, int height, ReadRow&& read_row, float* cells) {
    start(width, height);
    for (int cell = 0; cell < kRows; ++cell) {
      const CellSpans::Span& span = down_.span(cell);
      const float* const weight = down_.weights(span);
      begin_cells();
      for (int k = 0; k < span.count; ++k) {
        const int y = span.first + k;
        // Neighbouring cells can share a row of samples, so the last two rows are cached.
        Line& line = lines_[y & 1];
        if (line.y != y) {
          read_row(y, samples_.data());
          reduce(y, line);
        }
        add(line, weight[k]);
      }
      end_cells(cells + cell * kColumns);
    }
  }

 private:
  /// A row of samples reduced to the columns of the field.
  struct Line {
    int y = -1;
    float sum[kColumns];     // of weight · value, without holes
    float weight[kColumns];  // total, without holes
  };

  void start(int width, int height) {
    across_.set(width, kColumns);
    down_.set(height, kRows);
    samples_.resize(static_cast<size_t>(width));
    for (Line& line : lines_) line.y = -1;
  }
  void reduce(int y, Line& line) noexcept {
    line.y = y;
    for (int x = 0; x < kColumns; ++x) {
      const CellSpans::Span& span = across_.span(x);
      const float* const weights = across_.weights(span);
      const float* const samples = samples_.data() + span.first;
      float sum = 0;
      float weight = 0;
      for (int k = 0; k < span.count; ++k) {
        const bool hole = std::isnan(samples[k]);
        sum += hole ? 0.0F : weights[k] * samples[k];
        weight += hole ? 0.0F : weights[k];
      }
      line.sum[x] = sum;
      line.weight[x] = weight;
    }
  }
  void begin_cells() noexcept {
    std::fill(sum_, sum_ + kColumns, 0.0F);
    std::fill(weight_, weight_ + kColumns, 0.0F);
  }
  void add(const Line& line, float weight) noexcept {
    for (int x = 0; x < kColumns; ++x) {
      sum_[x] += weight * line.sum[x];
      weight_[x] += weight * line.weight[x];
    }
  }
  void end_cells(float* cells) const noexcept {
    for (int x = 0; x < kColumns; ++x) {
      cells[x] = weight_[x] > 0 ? sum_[x] / weight_[x] : std::numeric_limits<float>::quiet_NaN();
    }
  }

  CellSpans across_;
  CellSpans down_;
  std::vector<float> samples_;
  Line lines_[2];
  float sum_[kColumns] = {};
  float weight_[kColumns] = {};
};

}  // namespace spidar::touch
