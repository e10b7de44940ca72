// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/device/session_stats.h"

#include <algorithm>

namespace spidar {
namespace {

guint64 not_negative(int64_t ns) {
  return static_cast<guint64>(std::max<int64_t>(ns, 0));
}

}  // namespace

void describe_session(const HapticSession& session, GstStructure* structure) {
  const HapticLoop& loop = session.loop();
  const LoopSnapshot snapshot = loop.snapshot();
  const LoopCounters& counters = snapshot.counters;
  const Scheduling& scheduling = session.scheduling();
  gst_structure_set(
      structure, "device", G_TYPE_STRING, session.grip().name().c_str(), "device-state",
      G_TYPE_STRING, to_string(snapshot.last.device), "real-time", G_TYPE_BOOLEAN,
      scheduling.real_time ? TRUE : FALSE, "scheduling", G_TYPE_STRING, scheduling.detail.c_str(),
      "ticks", G_TYPE_UINT64, counters.ticks, "overruns", G_TYPE_UINT64, counters.overruns,
      "exchange-errors", G_TYPE_UINT64, counters.exchange_errors, "pose-errors", G_TYPE_UINT64,
      counters.pose_errors, "times-lost", G_TYPE_UINT64, counters.times_lost, "pose-trouble",
      G_TYPE_STRING, to_string(snapshot.pose_trouble), "motor-heat", G_TYPE_DOUBLE,
      snapshot.motor_heat, "held-back", G_TYPE_BOOLEAN, snapshot.held_back ? TRUE : FALSE,
      "held-back-ticks", G_TYPE_UINT64, counters.held_back_ticks, "faulty-string", G_TYPE_INT,
      snapshot.last.faulty_string, "grip-held", G_TYPE_BOOLEAN, snapshot.last.held ? TRUE : FALSE,
      "grip-speed", G_TYPE_DOUBLE, snapshot.last.velocity.linear_m_s.norm(), "vibration-share",
      G_TYPE_DOUBLE, snapshot.vibration.share, "vibration-left", G_TYPE_DOUBLE,
      snapshot.vibration.left, "wakeup-median", G_TYPE_UINT64,
      not_negative(session.timing().lateness.quantile_ns(0.5)), "wakeup-p999", G_TYPE_UINT64,
      not_negative(session.timing().lateness.quantile_ns(0.999)), "skew-median", G_TYPE_UINT64,
      not_negative(loop.skew().quantile_ns(0.5)), "skew-p99", G_TYPE_UINT64,
      not_negative(loop.skew().quantile_ns(0.99)), nullptr);
  const Wrench& delivered = snapshot.last.delivered;
  gst_structure_set(structure, "force-x", G_TYPE_DOUBLE, delivered.force_N.x(), "force-y",
                    G_TYPE_DOUBLE, delivered.force_N.y(), "force-z", G_TYPE_DOUBLE,
                    delivered.force_N.z(), "torque-x", G_TYPE_DOUBLE, delivered.torque_Nm.x(),
                    "torque-y", G_TYPE_DOUBLE, delivered.torque_Nm.y(), "torque-z", G_TYPE_DOUBLE,
                    delivered.torque_Nm.z(), nullptr);
  GValue tensions = G_VALUE_INIT;
  g_value_init(&tensions, GST_TYPE_ARRAY);
  for (const double tension_N : snapshot.last.tension_N) {
    GValue tension = G_VALUE_INIT;
    g_value_init(&tension, G_TYPE_DOUBLE);
    g_value_set_double(&tension, tension_N);
    gst_value_array_append_and_take_value(&tensions, &tension);
  }
  gst_structure_take_value(structure, "tensions", &tensions);
  const Contact& contact = snapshot.last.contact;
  gst_structure_set(structure, "touching", G_TYPE_BOOLEAN, contact.touching ? TRUE : FALSE,
                    "touch-depth-mm", G_TYPE_DOUBLE, 1e3 * contact.depth_m, "touch-force",
                    G_TYPE_DOUBLE, contact.force_N.norm(), "touch-stiffness-share", G_TYPE_DOUBLE,
                    contact.stiffness_share, nullptr);
  const LinkHealth link = session.grip().health();
  gst_structure_set(structure, "link-fault", G_TYPE_STRING, to_string(link.last_fault),
                    "link-timeouts", G_TYPE_UINT64, link.count(LinkFault::kTimeout), "link-errors",
                    G_TYPE_UINT64, link.errors(), "link-late-replies", G_TYPE_UINT64,
                    link.late_replies, "round-trip-median", G_TYPE_UINT64,
                    not_negative(link.round_trip_median_ns), "round-trip-p99", G_TYPE_UINT64,
                    not_negative(link.round_trip_p99_ns), nullptr);
}

}  // namespace spidar
