// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Runs a fuzz target without a fuzzer: on the given files and all files of the given folders, and
// on seeded inputs of numbers of all sizes, special numbers, and plain noise.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

using Random = std::mt19937_64;

double random_number(Random& random) {
  constexpr double kSpecial[] = {0,
                                 -0.0,
                                 1,
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::max(),
                                 std::numeric_limits<double>::min(),
                                 std::numeric_limits<double>::denorm_min(),
                                 std::numeric_limits<double>::epsilon()};
  std::normal_distribution<double> normal;
  switch (random() % 64) {
    case 0:
      return kSpecial[random() % std::size(kSpecial)];
    case 1:
      return std::ldexp(normal(random), static_cast<int>(random() % 2000) - 1000);
    case 2:
    case 3:
      return 0;
    default:
      return normal(random);
  }
}

std::vector<uint8_t> random_input(uint64_t seed) {
  Random random(seed);
  std::vector<uint8_t> bytes(1 + 80 * sizeof(double));
  bytes[0] = static_cast<uint8_t>(seed % 4 ? 9 : random());  // mostly eight strings
  for (size_t i = 0; i < 80; ++i) {
    double x = random_number(random);
    if (i >= 54 && i < 62 && random() % 8) x = -std::fabs(x);                // t_min
    if (((i >= 62 && i < 70) || i >= 78) && random() % 8) x = std::fabs(x);  // t_max, ε, ℓ
    std::memcpy(&bytes[1 + i * sizeof x], &x, sizeof x);
  }
  if (random() % 16 == 0) bytes.resize(random() % bytes.size());
  if (random() % 16 == 0)
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
  return bytes;
}

void run_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

// Arguments: how many seeded inputs, then files and folders.
int main(int argc, char** argv) {
  const int inputs = argc > 1 ? std::atoi(argv[1]) : 0;
  for (int i = 2; i < argc; ++i) {
    if (!std::filesystem::is_directory(argv[i])) {
      run_file(argv[i]);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) run_file(entry.path());
  }
  for (int seed = 0; seed < inputs; ++seed) {
    const std::vector<uint8_t> bytes = random_input(static_cast<uint64_t>(seed));
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%d inputs\n", inputs);
}
