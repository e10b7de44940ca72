// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/pipelines/random_operations.h"

#include "tests/support/test.h"

namespace spidar::test {
namespace {

constexpr GstClockTime kLength = 10 * GST_SECOND;
constexpr double kRates[] = {0.25, 0.5, 1, 1, 1, 2, 4, -0.5, -1, -4};

GstClockTime position(RandomSource& random) {
  return random.below(kLength);
}

/// Flushing seek of at most this length. A player that is not running refuses it.
void jump(TormentedPlayer& player, RandomSource& random, double rate, int flags,
          GstClockTime length) {
  const GstClockTime start = position(random);
  player.seek(rate, GST_SEEK_FLAG_FLUSH | flags, start, start + length);
}

/// Without a flush. That waits for the source to leave its streaming thread alone, which it hardly
/// ever does but at the end of a segment: at 240 frames/s, three frames later.
void append(TormentedPlayer& player, RandomSource& random, int flags) {
  jump(player, random, 1, GST_SEEK_FLAG_SEGMENT, 12 * GST_MSECOND);
  if (!player.reaches_end_of_segment()) return;
  const GstClockTime start = position(random);
  player.seek(1, flags, start, start + random.below(GST_SECOND));
}

/// Sends the event with which a pipeline changes the rate without a seek to the elements. The sink
/// is left out, because it reports a critical error without a segment.
void change_rate_instantly(TormentedPlayer& player, RandomSource& random) {
  const GstClockTime now = gst_element_get_current_running_time(player.element());
  const GstClockTime shown = GST_CLOCK_TIME_IS_VALID(now) ? now : 0;
  GstPad* pad = gst_element_get_static_pad(player.element(), "src");
  gst_pad_send_event(pad, gst_event_new_instant_rate_sync_time(0.5 + 2 * random.fraction(), shown,
                                                               random.below(2 * shown + 1)));
  gst_object_unref(pad);
}

std::string any_caps(RandomSource& random) {
  constexpr const char* kFormats[] = {"GRAY8", "I420", "NV12", "Y444", "RGB", "BGRx"};
  constexpr int kRates_Hz[] = {12, 24, 60, 100, 100, 240};
  const int64_t width = random.between(16, 160), height = random.between(16, 120);
  return std::string("video/x-raw,format=") + random.one_of(kFormats) +
         ",width=" + std::to_string(width) + ",height=" + std::to_string(height) +
         ",framerate=" + std::to_string(random.one_of(kRates_Hz)) + "/1";
}

void set_property(TormentedPlayer& player, RandomSource& random, const std::string& name) {
  GObjectClass* object_class = G_OBJECT_GET_CLASS(player.element());
  GValue value = G_VALUE_INIT;
  set_random_value(g_object_class_find_property(object_class, name.c_str()), random, &value);
  g_object_set_property(G_OBJECT(player.element()), name.c_str(), &value);
  g_value_unset(&value);
}

/// Properties that are strings; they take effect when the element is next opened or started.
void set_texts(TormentedPlayer& player, RandomSource& random) {
  constexpr const char* kDevices[] = {"sim", "sim", "sim", "none"};
  constexpr const char* kProfiles[] = {"spidar-g", "spidar-g645", "spidar-g6x3-v1-l"};
  const std::string folder = player.folder().path.string();
  const std::string traces[] = {"", folder + "/f.csv", folder + "/f.jsonl", folder + "/no/f.csv"};
  g_object_set(player.element(), "device", random.one_of(kDevices), "profile",
               random.one_of(kProfiles), "trace", random.one_of(traces).c_str(), nullptr);
}

void read_everything(TormentedPlayer& player) {
  GstStructure* stats = nullptr;
  g_object_get(player.element(), "stats", &stats, nullptr);
  ASSERT_NE(stats, nullptr);
  gst_structure_free(stats);
  gint64 answer = 0;
  gst_element_query_position(player.pipeline(), GST_FORMAT_TIME, &answer);
  gst_element_query_duration(player.pipeline(), GST_FORMAT_TIME, &answer);
}

void set_sync(TormentedPlayer& player, bool sync) {
  GstElement* sink = player.part("sink");
  g_object_set(sink, "sync", sync, nullptr);
  gst_object_unref(sink);
}

void set_latency(TormentedPlayer& player, RandomSource& random) {
  gst_pipeline_set_latency(GST_PIPELINE(player.pipeline()), random.below(50) * GST_MSECOND);
  gst_bin_recalculate_latency(GST_BIN(player.pipeline()));
}

/// As an application does when the clock is lost.
void change_clock(TormentedPlayer& player, RandomSource& random) {
  auto* clock = static_cast<GstClock*>(g_object_new(
      GST_TYPE_SYSTEM_CLOCK, "clock-type",
      random.chance(0.5) ? GST_CLOCK_TYPE_MONOTONIC : GST_CLOCK_TYPE_REALTIME, nullptr));
  player.set_state(GST_STATE_PAUSED);
  gst_pipeline_use_clock(GST_PIPELINE(player.pipeline()), clock);
  player.set_state(GST_STATE_PLAYING);
  gst_object_unref(clock);
}

/// As in a player, from frame to frame in PAUSED. GstBaseSink (seen in 1.22) hangs in a flush that
/// comes while it steps.
void step_frame(TormentedPlayer& player, RandomSource&) {
  player.set_state(GST_STATE_PAUSED);
  if (!player.reaches(GST_STATE_PAUSED)) return;
  gst_element_send_event(player.pipeline(),
                         gst_event_new_step(GST_FORMAT_BUFFERS, 1, 1.0, TRUE, FALSE));
  player.reaches(GST_STATE_PAUSED);
}

void unplug(TormentedPlayer& player, LinkFault fault) {
  if (SimulatedDevice* device = player.device()) device->set_fault(fault);
}

/// From another thread at an arbitrary time, while this thread does something else.
void stop_in_the_midst(TormentedPlayer& player, RandomSource& random) {
  const std::vector<Operation> others = interruptible_operations(player);
  const std::chrono::microseconds after(random.below(4000));
  std::thread stopping([&player, after] {
    std::this_thread::sleep_for(after);
    player.set_state(GST_STATE_NULL);
  });
  for (int i = 0; i < 3; ++i) draw(others, random).run(player, random);
  stopping.join();
  player.stop();
  player.set_state(GST_STATE_PLAYING);
}

}  // namespace

std::vector<Operation> interruptible_operations(const TormentedPlayer& player) {
  using Player = TormentedPlayer;
  using Random = RandomSource;
  std::vector<Operation> all{
      {"flushing seek", 8, [](Player& p, Random& r) { jump(p, r, 1, 0, kLength); }},
      {"seek to a key unit", 2,
       [](Player& p, Random& r) {
         jump(p, r, 1, GST_SEEK_FLAG_KEY_UNIT | GST_SEEK_FLAG_SNAP_BEFORE, kLength);
       }},
      {"trick mode", 2,
       [](Player& p, Random& r) { jump(p, r, 4, GST_SEEK_FLAG_TRICKMODE, kLength); }},
      {"another rate", 4, [](Player& p, Random& r) { jump(p, r, r.one_of(kRates), 0, kLength); }},
      {"segment seek", 2,
       [](Player& p, Random& r) { jump(p, r, 1, GST_SEEK_FLAG_SEGMENT, GST_SECOND / 10); }},
      {"seek to a short piece", 2,
       [](Player& p, Random& r) { jump(p, r, 1, 0, r.below(GST_SECOND / 10)); }},
      {"instant rate", 3, change_rate_instantly},
      {"other caps", 2, [](Player& p, Random& r) { p.set_caps(any_caps(r)); }},
      {"other caps, wide", 1,
       [](Player& p, Random&) {
         p.set_caps("video/x-raw,format=I420,width=320,height=240,framerate=25/1");
       }},
      {"texts", 1, set_texts},
      {"stats", 2, [](Player& p, Random&) { read_everything(p); }},
      {"end of stream", 1, [](Player& p, Random&) { p.disturb(Upstream::kEnd); }},
      {"as fast as it goes", 1, [](Player& p, Random&) { set_sync(p, false); }},
      {"in time", 3, [](Player& p, Random&) { set_sync(p, true); }},
      {"latency", 2, set_latency},
      {"gap", 1, [](Player& p, Random&) { p.disturb(Upstream::kGap); }},
      {"gap frame", 1, [](Player& p, Random&) { p.disturb(Upstream::kGapFrame); }},
      {"discontinuity", 1, [](Player& p, Random&) { p.disturb(Upstream::kDiscont); }},
      {"no timestamp", 1, [](Player& p, Random&) { p.disturb(Upstream::kNoTimestamp); }},
      {"timestamp twice", 1, [](Player& p, Random&) { p.disturb(Upstream::kSameAsBefore); }},
      {"timestamp back", 1, [](Player& p, Random&) { p.disturb(Upstream::kEarlier); }},
      {"error upstream", 1, [](Player& p, Random&) { p.disturb(Upstream::kError); }},
  };
  for (const std::string& name : random_properties(G_OBJECT(player.element()))) {
    all.push_back({name, 1, [name](Player& p, Random& r) { set_property(p, r, name); }});
  }
  return all;
}

std::vector<Operation> other_operations() {
  using Player = TormentedPlayer;
  using Random = RandomSource;
  return {
      {"pause", 4, [](Player& p, Random&) { p.set_state(GST_STATE_PAUSED); }},
      {"play", 12, [](Player& p, Random&) { p.set_state(GST_STATE_PLAYING); }},
      {"pause and wait", 1,
       [](Player& p, Random&) {
         p.set_state(GST_STATE_PAUSED);
         p.reaches(GST_STATE_PAUSED);
       }},
      {"play and wait", 3,
       [](Player& p, Random&) {
         p.set_state(GST_STATE_PLAYING);
         p.reaches(GST_STATE_PLAYING);
       }},
      {"ready", 1, [](Player& p, Random&) { p.set_state(GST_STATE_READY); }},
      {"null", 1, [](Player& p, Random&) { p.stop(); }},
      {"null from another thread", 1, stop_in_the_midst},
      {"clock lost", 1, change_clock},
      {"frame step", 1, step_frame},
      {"seek without flush", 3, [](Player& p, Random& r) { append(p, r, 0); }},
      {"segment seek without flush", 2,
       [](Player& p, Random& r) { append(p, r, GST_SEEK_FLAG_SEGMENT); }},
      {"unplug", 1, [](Player& p, Random&) { unplug(p, LinkFault::kGone); }},
      {"timeouts", 1, [](Player& p, Random&) { unplug(p, LinkFault::kTimeout); }},
      {"bad replies", 1, [](Player& p, Random&) { unplug(p, LinkFault::kWrongReply); }},
      {"plug in", 8, [](Player& p, Random&) { unplug(p, LinkFault::kNone); }},
      {"lost pulses", 1,
       [](Player& p, Random& r) {
         if (SimulatedDevice* device = p.device()) {
           device->set_count_error(static_cast<int>(r.below(7)),
                                   static_cast<int32_t>(r.between(-50, 50)));
         }
       }},
  };
}

const Operation& draw(const std::vector<Operation>& operations, RandomSource& random) {
  uint64_t sum = 0;
  for (const Operation& operation : operations) sum += static_cast<uint64_t>(operation.weight);
  auto at = static_cast<int64_t>(random.below(sum));
  for (const Operation& operation : operations) {
    at -= operation.weight;
    if (at < 0) return operation;
  }
  return operations.back();
}

}  // namespace spidar::test
