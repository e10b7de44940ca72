// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The benchmarks of spidar-bench. Each takes its name and the arguments after it, and returns the
/// exit status; std::exception: what is wrong with them, or what could not be measured.
#pragma once

namespace spidar::bench {

int camera(int argc, char** argv);
int cost(int argc, char** argv);
int ladder(int argc, char** argv);
int lag(int argc, char** argv);
int loop(int argc, char** argv);
int pose(int argc, char** argv);
int real_film(int argc, char** argv);
int regression(int argc, char** argv);
int released(int argc, char** argv);
int safety(int argc, char** argv);
int skew(int argc, char** argv);
int stability(int argc, char** argv);
int tension(int argc, char** argv);
int touch_strings(int argc, char** argv);
int turns(int argc, char** argv);
int workspace(int argc, char** argv);

}  // namespace spidar::bench
