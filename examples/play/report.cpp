#include "examples/play/report.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "examples/gnuplot.h"

namespace {

/// A column; NaN stays empty.
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

gboolean print_field(GQuark name, const GValue* value, void*) {
  char* const text =
      G_VALUE_HOLDS_STRING(value) ? g_value_dup_string(value) : g_strdup_value_contents(value);
  std::printf("  %s %s\n", g_quark_to_string(name), text);
  g_free(text);
  return TRUE;
}

template <typename Curve>
void write_curve(const Curve& curve, const std::string& path) {
  std::ofstream file(path);
  curve.write(file);
  if (!file.flush()) throw std::runtime_error(path + ": could not be written");
}

}  // namespace

void print_report(const SessionRecord::Numbers& numbers, const GstStructure* stats) {
  std::printf("\n%" PRIu64 " frames in %.1f s, %" PRIu64 " of them shown\n\n", numbers.frames,
              numbers.duration_s, numbers.shown);
  std::printf("%-26s%10s%10s%10s%10s%10s\n", "", "median", "95 %", "99 %", "99.9 %", "maximum");
  print_row("speed, px/s", numbers.speed_px_s);
  print_row("force wanted, N", numbers.wanted_N);
  print_row("force at the grip, N", numbers.delivered_N);
  print_row("analysis, ms a frame", number_of(stats, "analysis-ms-median"),
            number_of(stats, "analysis-ms-p95"), NAN, NAN, number_of(stats, "analysis-ms-max"));
  print_row("loop wakes up late, ms", numbers.lateness_ms);
  print_row("force - picture, ms", numbers.skew.signed_ms().quantile(0.5), NAN, NAN, NAN, NAN);
  print_row("|force - picture|, ms", numbers.skew.size_ms());

  if (numbers.ticks > 0) {
    std::printf(
        "\nForce above %.2f N, which a hand feels: %.1f %% of the time\n", kFelt_N,
        100.0 * static_cast<double>(numbers.felt_ticks) / static_cast<double>(numbers.ticks));
  }
  std::printf("Force - picture: from %.3f to %+.3f ms over %" PRIu64
              " frames; positive when the force is later\n",
              numbers.skew.signed_ms().min(), numbers.skew.signed_ms().max(),
              numbers.skew.signed_ms().count());
  std::printf("Statistics of the element:\n");
  gst_structure_foreach(stats, print_field, nullptr);
}

void draw_report(const SessionRecord::Numbers& numbers, const std::string& title,
                 const std::string& folder, const std::string& png_path) {
  const std::string frames = folder + "/frames.dat";
  const std::string ticks = folder + "/ticks.dat";
  write_curve(numbers.frames_curve, frames);
  write_curve(numbers.ticks_curve, ticks);
  run_gnuplot("play.gp", {{"png", png_path},
                          {"title", title},
                          {"frames", frames},
                          {"ticks", numbers.ticks == 0 ? "" : ticks}});
}
