// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/delay_report.h"

#include <cstdarg>
#include <cstdio>
#include <ostream>

#include "core/touch/contact_force.h"

namespace spidar {
namespace {

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  char line[256];
  va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

const char* of_profile(StatedLag stated) {
  switch (stated) {
    case StatedLag::kTooSmall:
      return "too small: surfaces may shake";
    case StatedLag::kRight:
      return "right";
    case StatedLag::kMore:
      return "more than is needed, which is safe";
  }
  return "";
}

}  // namespace

void print_delay(std::ostream& out, const Profile& profile, const DelayTest& test, int late_ticks) {
  if (!test.measured()) {
    out << "drive lag   not measured: " << test.trouble << '\n';
    return;
  }
  const LagFit& fit = *test.fit;
  const LagVerdict verdict = judge_lag(profile, fit, late_ticks);
  out << text("drive lag   %.2f ms, standard error %.2f ms; from %.2f to %.2f ms (99.7 %%)\n",
              1e3 * fit.lag_s, 1e3 * fit.error_s, 1e3 * fit.least_s, 1e3 * fit.most_s)
      << text("moved       %.2f kg, %.1f N s/m, %.0f N/m, by %.1f mm at most; misfit %.1f; %d s\n",
              fit.mass_kg, fit.damping_N_s_m, fit.stiffness_N_m, 1e3 * test.moved_m, fit.misfit,
              test.periods);
  if (late_ticks > 0)
    out << text(
        "answers     some take longer than 0.7 ms and count %d ms later while playing, which "
        "is added below\n",
        late_ticks);
  out << text("delay       t_d = %.1f ms at most: 1.5 ms of the loop, %.1f ms of the drive\n",
              1e3 * verdict.delay_s, 1e3 * verdict.safe_lag_s)
      << text("profile     drive_lag_s = %.4f; it has %g, %s\n", verdict.safe_lag_s,
              profile.drive_lag_s, of_profile(verdict.stated))
      << text("stiffness   %.0f N/m at most, with a damping of %.1f K t_d = %.1f N s/m\n",
              verdict.stiffness_N_m, ContactSettings().damping, verdict.damping_N_s_m);
}

std::string delay_summary(const Profile& profile, const DelayTest& test, int late_ticks) {
  if (test.fault) return "does not conform: there was a fault while it was measured";
  if (!test.measured()) return "not measured";
  if (judge_lag(profile, *test.fit, late_ticks).stated != StatedLag::kTooSmall) return "conforms";
  return text("does not conform: drive_lag_s = %g of the profile is too small",
              profile.drive_lag_s);
}

}  // namespace spidar
