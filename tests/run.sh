#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Installs missing packages (Debian), builds, and runs the tests, except for suites that take long or
# need more than Debian's packages. The last line is `N passed, N failed, N skipped`; the exit status is
# 0 when nothing failed.
#   tests/run.sh        as a user builds it, in build/
#   tests/run.sh --ci   the same on a bare Debian 12 where warnings are errors, as root; layout; and
#                       again under the sanitizers, in build-ci*/
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. tests/install.sh

builds=()  # folders with test results
checks=()  # arguments for summary.py: what is no meson test

say() { printf '\n== %s\n' "$*"; }

targets=()  # of ninja; none: all

# build_and_test FOLDER [meson setup option...] [-- meson test option...]
build_and_test() {
    local folder=$1 setup=()
    shift
    while (($#)) && [[ $1 != -- ]]; do
        setup+=("$1")
        shift
    done
    # Results of an earlier run would stand for a test program that crashes in this one.
    rm -f "$folder"/*.xml "$folder"/meson-logs/testlog*
    say "building in $folder/"
    # With -Dunity=on, several files are compiled as one, which takes a third of the time.
    if { [[ -f $folder/build.ninja ]] || meson setup "$folder" -Dunity=on "${setup[@]}"; } &&
        { [[ " $* " == *"suite "* ]] || ninja -C "$folder" -j"$(nproc)" "${targets[@]}"; }; then
        say "testing $folder/"
        # Of some suites, meson builds here what they need.
        # Twice as many as processors: many tests wait for a clock instead of computing.
        meson test -C "$folder" --num-processes "$((2 * $(nproc)))" --print-errorlogs "${@:2}" || true
    fi
    if [[ -f $folder/meson-logs/testlog.json ]]; then
        builds+=("$folder")
    else
        checks+=(--failed "build in $folder/")
    fi
}

check_layout() {
    say "layout: $(clang-format --version)"
    local files
    mapfile -t files < <(find include api core spidar plugin tests apps examples -name "*.cpp" -o -name "*.h")
    if clang-format --dry-run --Werror "${files[@]}"; then
        checks+=(--passed layout)
    else
        checks+=(--failed "layout: run clang-format -i on the files above")
    fi
    if tests/check_folders.py; then
        checks+=(--passed folders)
    else
        checks+=(--failed "folders: see the includes above")
    fi
}

# check_site FOLDER: Doxygen reads the public headers, and Sphinx the pages, without a warning. The site stays in
# FOLDER/docs/site, the report in FOLDER/docs/report.pdf.
check_site() {
    say "site: doxygen $(doxygen --version), $(sphinx-build --version)"
    if meson compile -C "$1" docs report; then
        checks+=(--passed "site and report")
    else
        checks+=(--failed "site and report: meson compile -C $1 docs report")
    fi
}

# run_on_bare_debian RESULTS
run_on_bare_debian() {
    local what="tests/run.sh and examples/play.sh --ball on a bare Debian"
    if tests/bare_debian.sh "$1"; then
        checks+=(--passed "$what")
    else
        checks+=(--failed "$what: see above")
    fi
    [[ ! -f $1/meson-logs/testlog.json ]] || builds+=("$1")
}

case ${1-} in
"")
    install_packages build test
    build_and_test build
    ;;
--ci)
    install_packages build test ci
    check_layout
    run_on_bare_debian build-ci-bare
    # Line numbers without variables and the lowest optimisation: the compiler needs a third of the
    # time. Without any, Eigen is too slow for the tests that sample many poses. Four checks of every
    # use of a pointer would double the compiler's time: null and object-size, where the address
    # sanitizer finds most of the same; alignment, which x86 does not need; and vptr, wrong casts
    # between classes. With a sanitizer, GCC takes variables of std::regex for uninitialised.
    unchecked=-fno-sanitize=null,object-size,alignment,vptr
    sanitized=(-Doptimization=1 -Ddebug=false "-Dcpp_args=['-g1','$unchecked','-Wno-maybe-uninitialized']" -Db_lundef=false)
    say "address sanitizer: GLib's table of quarks is left out, which it never frees; plugins are read" \
        "in the test itself, for GStreamer's own process for that is not built with the sanitizer"
    echo "left out: apps, programs of their own; numerics, tests that sample thousands of cases of" \
        "arithmetic and are 10 to 70 times slower here, or count what is taken from the heap; short-films, players" \
        "whose film is over or paused before one that is built with the sanitizer gives force. All have run above."
    export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
    export ASAN_OPTIONS=fast_unwind_on_malloc=0  # else stacks end in GLib
    export LSAN_OPTIONS=suppressions=$PWD/tests/leaks.supp:print_suppressions=0
    export GST_REGISTRY_FORK=no
    build_and_test build-ci-address "${sanitized[@]}" \
        -Db_sanitize=address,undefined -Dbenchmarks=disabled -Dapps=false \
        -Dtest_suites=api,core,element,pipelines,spidar,window -- \
        -t 4 --no-suite short-films
    check_site build-ci-address
    say "thread sanitizer: what runs on several threads, and a player to which anything is done at random." \
        "GLib and GStreamer are not built with it: their locks are told to it (tests/support/tsan_glib.cpp)," \
        "what they do between themselves it does not see"
    echo "left out of all three: suite films, which takes an hour; suite kernel, a virtual machine that needs QEMU" \
        "and a kernel image; suite mpeg, which needs MPEG's reference software; suite packages, which builds the" \
        "Debian packages in a clean Debian; suite players, which needs desktop players; suite soak, which takes an" \
        "hour; suite validate, which needs gst-validate; suite valgrind. Each by meson test -C build --suite NAME"
    threaded=(haptic_session shared_memory simulated_faults tick_trace touch_mailbox boards usb_boards force_feedback
        uart_line guardian)
    targets=(tests/spidar/test_{spidar,usb,guardian} tests/apps/test_play_{numbers,traces}
        tests/pipelines/test_pipelines_random_operations)
    build_and_test build-ci-thread "${sanitized[@]}" \
        -Db_sanitize=thread -Dbenchmarks=disabled -Dwindow=disabled \
        -Dtest_suites=apps,pipelines,spidar -- \
        -t 8 "${threaded[@]}" play_numbers play_traces pipelines_random_operations
    ;;
*)
    echo "error: unknown option $1; usage: tests/run.sh [--ci]" >&2
    exit 2
    ;;
esac

say "summary"
python3 tests/summary.py "${checks[@]}" "${builds[@]}"
