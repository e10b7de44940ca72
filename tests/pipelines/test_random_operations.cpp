// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Random operations at random times, in real time and with all threads: nothing crashes or hangs,
// every tick is within its limits, and afterwards the player plays as before.
//
// SPIDAR_OPERATIONS is the number of operations (default 300), SPIDAR_SEED the seed (default 1).
// The same seed gives the same operations and pauses; the interleaving of the threads differs.
#include "tests/pipelines/random_operations.h"
#include "tests/support/test.h"

namespace spidar::test::random_operations_test {
namespace {

uint64_t number_from(const char* variable, uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

void set_defaults(GstElement* element) {
  for (const std::string& name : random_properties(G_OBJECT(element))) {
    GParamSpec* spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), name.c_str());
    g_object_set_property(G_OBJECT(element), name.c_str(), g_param_spec_get_default_value(spec));
  }
  g_object_set(element, "device", "sim", "profile", "spidar-g", "trace", nullptr, nullptr);
}

/// Everything works again, and the force is felt. Waits for that without a limit; the test has one.
void expect_to_play(TormentedPlayer& player) {
  player.stop();
  player.disturb(Upstream::kNothing);
  set_defaults(player.element());
  GstElement* sink = player.part("sink");
  g_object_set(sink, "sync", TRUE, nullptr);
  gst_object_unref(sink);
  player.set_caps("video/x-raw,format=GRAY8,width=320,height=240,framerate=25/1");
  std::fprintf(stderr, "waiting for a force\n");
  player.set_state(GST_STATE_PLAYING);
  const HapticLoop& loop = player.state().feed.output.session()->loop();
  while (loop.snapshot().last.commanded.force_N.norm() < 0.1) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  player.drain_bus();
  player.stop();
}

TEST(RandomOperations, DoNoHarm) {
  unsetenv("DISPLAY");  // no debug window, which is a warning
  unsetenv("WAYLAND_DISPLAY");
  const uint64_t count = number_from("SPIDAR_OPERATIONS", 300);
  const uint64_t seed = number_from("SPIDAR_SEED", 1);
  const std::string replay = "SPIDAR_SEED=" + std::to_string(seed);
  RandomSource random(seed);
  TormentedPlayer player;
  std::vector<Operation> operations = interruptible_operations(player);
  for (Operation& operation : other_operations()) operations.push_back(std::move(operation));
  player.set_state(GST_STATE_PLAYING);
  for (uint64_t n = 0; n < count && !testing::Test::HasFailure(); ++n) {
    const Operation& operation = draw(operations, random);
    SCOPED_TRACE(replay + ", operation " + std::to_string(n) + ": " + operation.name);
    // Printed before the operation: if the program crashes, the last line names the cause.
    std::fprintf(stderr, "%s %zu %s\n", replay.c_str(), static_cast<size_t>(n),
                 operation.name.c_str());
    operation.run(player, random);
    player.drain_bus();
    // Mostly too short for anything to settle; sometimes long enough for a force.
    const std::chrono::milliseconds longest(random.chance(0.04) ? 300 : 4);
    std::this_thread::sleep_for(longest * random.fraction());
  }
  SCOPED_TRACE(replay + ", after all operations");
  expect_to_play(player);
  std::fprintf(stderr, "%zu of %zu ticks felt\n", static_cast<size_t>(player.watch().felt()),
               static_cast<size_t>(player.watch().ticks()));
}

}  // namespace
}  // namespace spidar::test::random_operations_test
