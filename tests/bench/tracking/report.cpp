// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/report.h"

#include <numeric>

#include "tests/bench/call_timer.h"

namespace spidar::bench {
namespace {

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : 0;
}

/// `| case | name | name | …`
void print_names(const char* first, const std::vector<Pipeline>& pipelines) {
  std::printf("| %-20s", first);
  for (const Pipeline& p : pipelines) std::printf(" | %s", p.name.c_str());
  std::printf(" |\n|---");
  for (size_t k = 0; k < pipelines.size(); ++k) std::printf("|---");
  std::puts("|");
}

}  // namespace

Figures figures(const Score& s) {
  Figures f{};
  f.ms_median = quantile(s.ms, 0.5);
  f.ms_p99 = quantile(s.ms, 0.99);
  f.epe_median = quantile(s.epe_px, 0.5);
  f.epe_mean = mean(s.epe_px);
  f.epe_p95 = quantile(s.epe_px, 0.95);
  f.lost = percent(static_cast<double>(s.lost), static_cast<double>(s.looked_for));
  f.wrong = percent(static_cast<double>(s.wrong), static_cast<double>(s.epe_px.size()));
  f.mean_error = mean(s.mean_error);
  f.object_median = quantile(s.object_error, 0.5);
  f.object_p95 = quantile(s.object_error, 0.95);
  f.missed = percent(s.missed, static_cast<double>(s.object_error.size()));
  f.ghosts = percent(s.ghosts, s.without_object);
  return f;
}

void print_usual(const std::string& size, const std::vector<Pipeline>& pipelines,
                 const std::vector<Score>& scores) {
  std::printf("\n### %s\n\n", size.c_str());
  std::puts(
      "| pipeline | ms median | 99 % | EPE median | mean | 95 % | lost % | wrong % | A mean | "
      "B median | 95 % | missed % | ghosts % |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (size_t k = 0; k < scores.size(); ++k) {
    const Figures f = figures(scores[k]);
    std::printf("| %-28s | %.2f | %.2f | %.3f | %.3f | %.3f | %.1f | %.1f | %.2f | ",
                pipelines[k].description.c_str(), f.ms_median, f.ms_p99, f.epe_median, f.epe_mean,
                f.epe_p95, f.lost, f.wrong, f.mean_error);
    if (scores[k].object_error.empty()) {
      std::puts("– | – | – | – |");
      continue;
    }
    std::printf("%.3f | %.3f | %.1f | %.1f |\n", f.object_median, f.object_p95, f.missed, f.ghosts);
  }
}

void print_hard(const std::vector<Pipeline>& pipelines, const CaseScores& cases) {
  std::puts("\n### Hard cases: wrong % / lost % of tracks; B median, missed %\n");
  print_names("case", pipelines);
  for (const auto& [name, scores] : cases) {
    std::printf("| %-20s", name.c_str());
    for (const Score& score : scores) {
      const Figures f = figures(score);
      std::printf(" | %.0f / %.0f", f.wrong, f.lost);
      if (!score.object_error.empty()) std::printf("; %.2f, %.0f", f.object_median, f.missed);
    }
    std::puts(" |");
  }
}

void print_silent(const std::vector<Pipeline>& pipelines, const CaseScores& cases) {
  std::puts("\n### Nothing to be felt: largest A / B, px a frame\n");
  print_names("case", pipelines);
  for (const auto& [name, scores] : cases) {
    std::printf("| %-20s", name.c_str());
    for (const Score& score : scores) {
      std::printf(" | %.3g", score.largest_mean);
      if (score.without_object > 0) std::printf(" / %.3g", score.largest_object);
    }
    std::puts(" |");
  }
}

}  // namespace spidar::bench
