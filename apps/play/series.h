// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Curves for a picture, in limited memory however long the video is.
#pragma once

#include <array>
#include <cstddef>
#include <ostream>
#include <vector>

/// N quantities over time. Keeps every sample until there are kMaxBins; from then on, neighbours
/// are merged into their smallest and largest value, so that peaks remain visible.
template <size_t N>
class Series {
 public:
  using Values = std::array<double, N>;

  /// Times should rise; a sample whose time does not is merged into the previous bin.
  void add(double time_s, const Values& values) {
    if (bins_.empty() || time_s >= bins_.back().time_s + width_s_) {
      if (bins_.size() == kMaxBins) halve();
      bins_.push_back({time_s, values, values});
    } else {
      bins_.back().merge(values);
    }
  }

  /// Writes two rows for each bin, smallest and largest values, so that a line through them fills
  /// the range; one row where they are equal.
  void write(std::ostream& out) const {
    for (const Bin& bin : bins_) {
      write_row(out, bin.time_s, bin.least);
      if (bin.least != bin.largest) write_row(out, bin.time_s, bin.largest);
    }
  }

 private:
  static constexpr size_t kMaxBins = 8000;

  struct Bin {
    double time_s;
    Values least;
    Values largest;

    void merge(const Values& values) {
      for (size_t i = 0; i < N; ++i) {
        if (values[i] < least[i]) least[i] = values[i];
        if (values[i] > largest[i]) largest[i] = values[i];
      }
    }
  };

  void halve() {
    width_s_ = 2 * (bins_.back().time_s - bins_.front().time_s) / kMaxBins;
    std::vector<Bin> old;
    old.swap(bins_);
    for (const Bin& bin : old) {
      if (bins_.empty() || bin.time_s >= bins_.back().time_s + width_s_) {
        bins_.push_back(bin);
      } else {
        bins_.back().merge(bin.least);
        bins_.back().merge(bin.largest);
      }
    }
  }

  static void write_row(std::ostream& out, double time_s, const Values& values) {
    out << time_s;
    for (const double value : values) out << ' ' << value;
    out << '\n';
  }

  std::vector<Bin> bins_;
  double width_s_ = 0;
};
