// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/reports/budget_message.h"

#include "core/analysis/work_ladder.h"

namespace spidar {
namespace {

constexpr gint kFullQuality = 1'000'000;
constexpr gint kRungs = WorkLadder::kLowest + 1;

}  // namespace

void post_budget_message(GstElement* element, GstBuffer* buffer, const FrameReport& report,
                         guint64 frames) {
  if (!report.budget || !report.budget->has_new_rung) return;
  const BudgetReport& budget = *report.budget;
  GstMessage* const message =
      gst_message_new_qos(GST_OBJECT(element), FALSE, report.running_time, report.stream_time,
                          GST_BUFFER_PTS(buffer), GST_BUFFER_DURATION(buffer));
  const double proportion = budget.budget_ns > 0 ? static_cast<double>(budget.cost_ns) /
                                                       static_cast<double>(budget.budget_ns)
                                                 : 1;
  gst_message_set_qos_values(message, 0, proportion,
                             kFullQuality / kRungs * (kRungs - budget.rung));
  gst_message_set_qos_stats(message, GST_FORMAT_BUFFERS, frames, 0);
  gst_element_post_message(element, message);
}

}  // namespace spidar
