#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Runs a fuzz target under libFuzzer with the address and undefined-behaviour sanitizers (apt-get install clang
# libclang-rt-14-dev). What it finds is in build/found_TARGET/, what ends it in crash-*.
#   tests/fuzz/run.sh feel|funscript|hjif|pose|profile|protocols|screen|tension|window [SECONDS]   ten minutes by default
# Add valuable findings to the corpus: build/fuzz_pose -merge=1 tests/fuzz/corpus/pose build/found_pose
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

target=${1-}
sources=(core/grip/{matrices,tension_solver,pose_solver,pose_fit,string_geometry}.cpp
    core/{json_text,track/funscript,track/hjif,choice/feel_rules,touch/height_field}.cpp
    spidar/devices/*/packets.cpp spidar/profiles/{profile_file,profile_writer}.cpp spidar/{part_file,whole_file}.cpp
    plugin/window/view/messages.cpp)
if [[ ! -d tests/fuzz/corpus/$target || -z $target ]]; then
    echo "error: there is no target '$target'; there are: $(cd tests/fuzz/corpus && echo ./* | tr -d ./)" >&2
    exit 2
fi
mkdir -p "build/found_$target"
read -ra gstreamer <<<"$(pkg-config --cflags --libs gstreamer-video-1.0)"
clang++ -std=c++17 -O1 -g -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined \
    -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 -isystem /usr/include/eigen3 -I. \
    "tests/fuzz/fuzz_$target.cpp" "${sources[@]}" "${gstreamer[@]}" -o "build/fuzz_$target"
exec "build/fuzz_$target" -max_total_time="${2-600}" -max_len=1024 "build/found_$target" "tests/fuzz/corpus/$target"
