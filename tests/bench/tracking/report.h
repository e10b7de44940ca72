// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tables, as Markdown, and the same figures as CSV.
#pragma once

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/tracking/pipelines.h"
#include "tests/bench/tracking/score.h"

namespace spidar::bench {

/// Scores by case, one for each pipeline.
using CaseScores = std::vector<std::pair<std::string, std::vector<Score>>>;

/// What stands in tables: quantiles, shares in per cent.
struct Figures {
  double ms_median, ms_p99;
  double epe_median, epe_mean, epe_p95;
  double lost, wrong;
  double mean_error;  ///< of A, mean
  double object_median, object_p95, missed;
  double ghosts;
};
Figures figures(const Score& score);

/// All usual cases of one size together.
void print_usual(const std::string& size, const std::vector<Pipeline>& pipelines,
                 const std::vector<Score>& scores);
/// Tracks wrong and lost, object velocity, object missed; a row a case.
void print_hard(const std::vector<Pipeline>& pipelines, const CaseScores& cases);
/// The largest motion where there is none.
void print_silent(const std::vector<Pipeline>& pipelines, const CaseScores& cases);

}  // namespace spidar::bench
