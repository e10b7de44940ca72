// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/options.h"

#include <charconv>
#include <stdexcept>

namespace spidar::bench {
namespace {

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  size_t begin = 0;
  for (size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = list.find(',', begin);
    parts.push_back(list.substr(begin, end - begin));
  }
  return parts;
}

/// 1 … `most`; throws naming `what`.
int number(const std::string& text, int most, const std::string& what) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= 1 && value <= most) {
    return value;
  }
  throw std::invalid_argument(what + ": '" + text + "' is not a number from 1 to " +
                              std::to_string(most));
}

std::pair<int, int> size(const std::string& text) {
  const size_t cross = text.find('x');
  if (cross == std::string::npos) {
    throw std::invalid_argument("--sizes: '" + text + "' is not WIDTHxHEIGHT");
  }
  const int width = number(text.substr(0, cross), 8192, "--sizes");
  const int height = number(text.substr(cross + 1), 8192, "--sizes");
  if (width < 160 || height < 90 || width % 2 != 0 || height % 2 != 0) {
    throw std::invalid_argument("--sizes: '" + text + "' is odd or below 160x90");
  }
  return {width, height};
}

}  // namespace

const char* const kUsage =
    "usage: bench_tracking [OPTION...]\n"
    "  --sizes WxH,...      default 640x360,1280x720\n"
    "  --full               four sizes up to 3840x2160, 2 scenes, 2 rounds: 10 minutes\n"
    "  --scenes N           pictures that each case is made from, default 1; hard cases: 4 at "
    "least\n"
    "  --rounds N           times that each film is run, default 1\n"
    "  --cases NAME,...     default all\n"
    "  --pipelines NAME,... default all\n"
    "  --middlebury FOLDER  of folders with frame10.png, frame11.png, flow10.flo\n"
    "  --csv FILE           the same figures, a row for each size, case and pipeline\n"
    "  --list               names of cases and pipelines\n";

Options parse_options(int argc, const char* const* argv) {
  Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string name = argv[k];
    if (name == "--full") {
      options.sizes = {{640, 360}, {1280, 720}, {1920, 1080}, {3840, 2160}};
      options.scenes = 2;
      options.rounds = 2;
      continue;
    }
    const bool known = name == "--sizes" || name == "--scenes" || name == "--rounds" ||
                       name == "--cases" || name == "--pipelines" || name == "--middlebury" ||
                       name == "--csv";
    if (!known) throw std::invalid_argument("unknown option '" + name + "'");
    if (k + 1 == argc) throw std::invalid_argument(name + ": needs a value");
    const std::string value = argv[++k];
    if (name == "--sizes") {
      options.sizes.clear();
      for (const std::string& s : split(value)) options.sizes.push_back(size(s));
    } else if (name == "--scenes") {
      options.scenes = number(value, 100, name);
    } else if (name == "--rounds") {
      options.rounds = number(value, 1000, name);
    } else if (name == "--cases") {
      options.cases = split(value);
    } else if (name == "--pipelines") {
      options.pipelines = split(value);
    } else if (name == "--middlebury") {
      options.middlebury = value;
    } else {
      options.csv = value;
    }
  }
  return options;
}

}  // namespace spidar::bench
