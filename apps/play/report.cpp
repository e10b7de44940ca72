// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/play/report.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "apps/gnuplot.h"
#include "apps/play/summary.h"
#include "apps/play/unfelt.h"
#include "core/analysis/no_force_reason.h"
#include "core/force/motion_rendering.h"

namespace {

/// A column of the table; NaN is left empty.
void print_cell(double value) {
  if (std::isnan(value)) {
    std::printf("%10s", "");
  } else {
    std::printf("%10.*f", std::abs(value) < 10 ? 3 : 1, value);
  }
}

void print_row(const char* name, double median, double p95, double p99, double p999, double max) {
  std::printf("%-26s", name);
  for (const double value : {median, p95, p99, p999, max}) print_cell(value);
  std::printf("\n");
}

void print_row(const char* name, const Histogram& values) {
  if (values.count() == 0) return;
  print_row(name, values.quantile(0.5), values.quantile(0.95), values.quantile(0.99),
            values.quantile(0.999), values.max());
}

double number_of(const GstStructure* stats, const char* name) {
  double value = NAN;
  gst_structure_get_double(stats, name, &value);
  return value;
}

uint64_t count_of(const GstStructure* stats, const char* name) {
  guint64 value = 0;
  gst_structure_get_uint64(stats, name, &value);
  return value;
}

std::string text_of(const GstStructure* stats, const char* name) {
  const char* const text = gst_structure_get_string(stats, name);
  return text != nullptr ? text : "";
}

ElementFacts facts_of(const GstStructure* stats) {
  ElementFacts facts;
  facts.analysis_ms_median = number_of(stats, "analysis-ms-median");
  facts.analysis_ms_max = number_of(stats, "analysis-ms-max");
  facts.track_frames = count_of(stats, "track-frames");
  facts.device = text_of(stats, "device");
  if (facts.device.empty()) return facts;
  facts.device_state = text_of(stats, "device-state");
  facts.pose_trouble = text_of(stats, "pose-trouble");
  facts.times_lost = count_of(stats, "times-lost");
  facts.exchange_errors = count_of(stats, "exchange-errors");
  facts.refused_wrenches = count_of(stats, "refused-wrenches");
  gst_structure_get_int(stats, "faulty-string", &facts.faulty_string);
  return facts;
}

std::string to_text(const GValue* value) {
  char text[32];
  if (G_VALUE_HOLDS_DOUBLE(value)) {
    std::snprintf(text, sizeof(text), "%.5g", g_value_get_double(value));
    return text;
  }
  char* const string =
      G_VALUE_HOLDS_STRING(value) ? g_value_dup_string(value) : gst_value_serialize(value);
  const std::string result = string != nullptr ? string : "-";
  g_free(string);
  return result;
}

/// Continues a paragraph of "name value" pairs; `column` is the present position in the line.
gboolean print_field(GQuark name, const GValue* value, void* column) {
  if (name == g_quark_from_static_string("limit-reason")) return TRUE;  // already printed above
  const std::string pair = std::string(g_quark_to_string(name)) + " " + to_text(value);
  auto& at = *static_cast<size_t*>(column);
  constexpr size_t kWidth = 78;
  const char* separator = at == 0 ? "" : ", ";
  if (at + 2 + pair.size() > kWidth) {
    separator = ",\n";
    at = 0;
  }
  std::printf("%s%s", separator, pair.c_str());
  at += 2 + pair.size();
  return TRUE;
}

template <typename Curve>
void write_curve(const Curve& curve, const std::string& path) {
  std::ofstream file(path);
  curve.write(file);
  if (!file.flush()) throw std::runtime_error(path + ": could not be written");
}

}  // namespace

void print_report(const SessionRecord::Numbers& numbers, const GstStructure* stats, bool verbose) {
  const char* const limit = gst_structure_get_string(stats, "limit");
  std::printf("\n%s%s", summary_text(numbers, facts_of(stats)).c_str(),
              unfelt_text(numbers.limits, limit ? limit : "").c_str());
  if (!verbose) return;
  std::printf("\n%-26s%10s%10s%10s%10s%10s\n", "", "median", "95 %", "99 %", "99.9 %", "maximum");
  print_row("speed, px/s", numbers.speed_px_s);
  print_row("force wanted, N", numbers.wanted_N);
  print_row("force at the grip, N", numbers.delivered_N);
  print_row("analysis, ms a frame", number_of(stats, "analysis-ms-median"),
            number_of(stats, "analysis-ms-p95"), NAN, NAN, number_of(stats, "analysis-ms-max"));
  print_row("loop wakes up late, ms", numbers.lateness_ms);
  print_row("force - picture, ms", numbers.skew.signed_ms());
  print_row("  without its sign", numbers.skew.size_ms());
  std::printf("\nFields of `stats`:\n");
  size_t column = 0;
  gst_structure_foreach(stats, print_field, &column);
  std::printf("\n");
}

void draw_report(const SessionRecord::Numbers& numbers, double max_force_N,
                 const std::string& title, const std::string& folder, const std::string& png_path) {
  const auto if_felt = [](double size_N) { return size_N >= spidar::kFeltForce_N ? "1" : ""; };
  const std::string frames = folder + "/frames.dat";
  const std::string ticks = folder + "/ticks.dat";
  write_curve(numbers.frames_curve, frames);
  write_curve(numbers.ticks_curve, ticks);
  run_gnuplot("play.gp",
              {{"png", png_path}, {"frames", frames}, {"ticks", numbers.ticks == 0 ? "" : ticks}},
              {{"title", title},
               {"max_force", std::to_string(max_force_N)},
               {"arm", std::to_string(spidar::kTorqueArm_m)},
               {"depth", if_felt(numbers.largest_depth_N)},
               {"roll", if_felt(numbers.largest_roll_Nm / spidar::kTorqueArm_m)}});
}
