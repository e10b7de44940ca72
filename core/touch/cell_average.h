// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The mean of a picture's samples in each cell of a height field.
#pragma once

#include <cstddef>
#include <vector>

#include "core/touch/height_field.h"

namespace spidar {

/// The samples of a line that contribute to each cell, with weights that add up to 1. With at least
/// as many samples as cells, the weights average over the cell and count samples on its border in
/// part; with fewer, they interpolate between the two nearest samples.
class CellSpans {
 public:
  struct Span {
    int first = 0;
    int count = 0;
    const float* weight = nullptr;
  };

  /// Allocates only when `samples` differs from the last call. `samples` and `cells` ≥ 1.
  void set(int samples, int cells);

  Span span(int cell) const noexcept {
    const Cell& c = cells_[static_cast<size_t>(cell)];
    return {c.first, c.count, weights_.data() + c.weight};
  }

 private:
  struct Cell {
    int first = 0;
    int count = 0;
    size_t weight = 0;  // index of its first weight
  };

  void add_mean(double begin, double end, int samples);
  void add_interpolated(double place, int samples);

  int samples_ = 0;
  std::vector<Cell> cells_;
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
      const CellSpans::Span span = down_.span(cell);
      begin_cells();
      for (int k = 0; k < span.count; ++k) {
        const int y = span.first + k;
        // Neighbouring cells can share a row of samples, so the last two rows are cached.
        Line& line = lines_[y & 1];
        if (line.y != y) {
          read_row(y, samples_.data());
          reduce(y, line);
        }
        add(line, span.weight[k]);
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

  void start(int width, int height);
  void reduce(int y, Line& line) noexcept;
  void begin_cells() noexcept;
  void add(const Line& line, float weight) noexcept;
  void end_cells(float* cells) const noexcept;

  CellSpans across_;
  CellSpans down_;
  std::vector<float> samples_;
  Line lines_[2];
  float sum_[kColumns] = {};
  float weight_[kColumns] = {};
};

}  // namespace spidar
