// What touching a picture costs: the relief of a frame, a look-up.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "core/touch/relief.h"
#include "tests/bench/call_timer.h"

namespace {

using namespace spidar;
using bench::quantile;

void print_times(const char* name, const bench::CallTimes& times, double unit_ns) {
  std::printf("%-32s median %8.3f, 99.9 %% %8.3f\n", name, quantile(times.median, 0.5) / unit_ns,
              quantile(times.median, 0.999) / unit_ns);
}

void time_reliefs() {
  std::puts("A frame's relief, milliseconds:");
  constexpr size_t kFrames = 300;
  constexpr int kPasses = 3;
  HeightField field(0.06, 0.03375);
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::pair{427, 240}, {640, 480}, {1920, 1080}}) {
    std::vector<uint8_t> bytes(static_cast<size_t>(2 * width * height));
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    ReliefBuilder builder;
    char name[64];
    std::snprintf(name, sizeof name, "brightness, %d×%d", width, height);
    const ImageView picture{bytes.data(), width, height, width};
    print_times(
        name,
        bench::time_calls(
            kFrames, kPasses, [] {}, [&](size_t) { builder.from_brightness(picture, {}, field); }),
        1e6);
    std::snprintf(name, sizeof name, "depth of 16 bits, %d×%d", width, height);
    const DepthView depth{bytes.data(), width, height, 2 * width, 2, false};
    print_times(name,
                bench::time_calls(
                    kFrames, kPasses, [] {},
                    [&](size_t) {
                      builder.from_depth(depth, {1, 65535}, {}, field);
                    }),
                1e6);
  }
}

}  // namespace

int main() {
  bench::pin_to_one_core();
  time_reliefs();
}
