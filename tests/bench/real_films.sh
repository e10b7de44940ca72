#!/bin/sh
# The table of real films in docs/tracking.md: real_films.sh BUILD FOLDER. What FOLDER holds is said
# in real_films.py. No film is part of this repository.
set -eu
cd "$(dirname "$0")/../.."
build=${1:?usage: tests/bench/real_films.sh BUILD FOLDER}
meson compile -C "$build" gstspidar
exec python3 tests/bench/real_films.py "$build" "${2:?usage: tests/bench/real_films.sh BUILD FOLDER}"
