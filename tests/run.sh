#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Installs missing packages (Debian), builds, and runs the tests, except for suites that take long or
# need more than Debian's packages. The last line is `N passed, N failed, N skipped`; the exit status is
# 0 when nothing failed.
#   tests/run.sh        as a user builds it, in build/: whether it works on this machine, in pipelines and with devices
#   tests/run.sh --all  that, and then the tests of every part
#   tests/run.sh --ci   all of that on a bare Debian 12 where warnings are errors, as root; layout; and
#                       again under the sanitizers, in build-ci*/
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. tests/install.sh

ahead=     # the process of build_ahead
declare -A begun=()  # the processes of begin_check, by name
builds=()  # folders with test results
checks=()  # arguments for summary.py: what is no meson test
most_again=5  # tests that may fail beside others and pass alone

# With the minutes and seconds since the start.
say() { printf '\n== %d:%02d %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"; }

# configure FOLDER [meson setup option...]
configure() {
    # With -Dunity=on, several files are compiled as one, which takes a third of the time.
    [[ -f $1/build.ninja ]] || meson setup "$1" -Dunity=on "${@:2}" || checks+=(--failed "meson setup $1")
}

# build_ahead FOLDER [ninja target...]: begins to build while something else is tested, in the time that this
# leaves to the processors. What it prints, errors too, comes again when the folder is built.
build_ahead() {
    chrt --idle 0 ninja -C "$1" -j"$(nproc)" "${@:2}" >/dev/null 2>&1 &
    ahead=$!
}

# Ninja removes what is half made.
stop_building_ahead() {
    [[ -n $ahead ]] || return 0
    kill "$ahead" 2>/dev/null || true
    wait "$ahead" || true
    ahead=
}

# build FOLDER [ninja target...]: fails when that fails.
build() {
    say "building in $1/"
    stop_building_ahead
    ninja -C "$1" -j"$(nproc)" "${@:2}" || { checks+=(--failed "build in $1/") && false; }
}

# run_tests FOLDER PATIENCE [meson test option...]: what they need is built. A timeout, PATIENCE times that of
# the test, is for what hangs, not for what is slow on a busy machine. Up to five programs that fail while others
# run beside them run again alone. Those that pass then count as passed, and the summary names them: on a busy
# machine, for instance, a guardian sets a device to rest whose player gets no processor time for 50 ms.
run_tests() {
    say "testing $1/"
    # Results of an earlier run would stand for a test program that crashes in this one.
    rm -f "$1"/*.xml "$1"/meson-logs/testlog*
    # Twice as many as processors: many tests wait for a clock instead of computing.
    meson test -C "$1" --no-rebuild -t "$2" --num-processes "$((2 * $(nproc)))" --print-errorlogs "${@:3}" || {
        local failed
        mapfile -t failed < <(python3 tests/summary.py --list-failed "$1")
        # More than a few are no matter of a busy machine.
        if ((${#failed[@]} > 0 && ${#failed[@]} < 6)); then
            say "again, alone: ${failed[*]}"
            meson test -C "$1" --no-rebuild -t "$2" --num-processes 1 --print-errorlogs --logbase testlog-alone "${failed[@]}" || true
        fi
    }
    [[ ! -f $1/meson-logs/testlog.json ]] || builds+=("$1")
}

check_layout() {
    say "layout: $(clang-format --version)"
    local files
    mapfile -t files < <(find core spidar plugin tests examples -name "*.cpp" -o -name "*.h")
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

# compile_executed FOLDER: what is linked with each program there, so that it leaves in FOLDER/executed/, if there is
# one, which functions it has executed.
compile_executed() {
    mkdir -p "$1"
    clang++ -std=c++17 -O1 -fPIC "-DEXECUTED_IN=\"$PWD/$1/executed\"" -c tests/support/executed.cpp -o "$1/executed.o"
}

# begin_check NAME COMMAND...: begins a check, beside what follows.
begin_check() {
    nice -n 19 "${@:2}" >"$(check_output "$1")" 2>&1 &
    begun[$1]=$!
}

check_output() { echo "build-ci-address/${1// /-}.log"; }

# end_check NAME: waits for it and says what it printed, if it has begun.
end_check() {
    [[ -n ${begun[$1]-} ]] || return 0
    say "$1"
    local result=(--passed "$1")
    wait "${begun[$1]}" || result=(--failed "$1: see above")
    cat "$(check_output "$1")"
    checks+=("${result[@]}")
}

# What ccache keeps of these builds, beside the Debian that is kept (tests/debian_folder.sh).
use_cache() {
    export CCACHE_DIR=${XDG_CACHE_HOME:-$HOME/.cache}/gst-spidar/ccache CCACHE_MAXSIZE=3G CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
    # As its manual says for precompiled headers.
    export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
}

# run_on_bare_debian RESULTS
run_on_bare_debian() {
    local what="tests/run.sh, examples/play.sh --ball and the regression figures on a bare Debian"
    if tests/bare_debian.sh debian-12 "$1"; then
        checks+=(--passed "$what")
    else
        checks+=(--failed "$what: see above")
    fi
    local folder
    for folder in "$1"/first "$1"; do
        [[ ! -f $folder/meson-logs/testlog.json ]] || builds+=("$folder")
    done
}

# What shows that it works on this machine, in pipelines, with devices and from the command line; then the rest.
first_suites=(api element pipelines spidar)
other_suites=(core docs examples numerics window)

# with_suites OPTION SUITE...: OPTION before each.
with_suites() { printf -- "$1 %s " "${@:2}"; }

run_first_tests() {
    configure build "-Dtest_suites=$(IFS=, && echo "${first_suites[*]}")"
    # shellcheck disable=SC2046
    ! build build || run_tests build 2 $(with_suites --suite "${first_suites[@]}") $(with_suites --no-suite numerics long)
}

case ${1-} in
"")
    install_packages build test
    continue_as_caller tests/run.sh
    run_first_tests
    say "left out: the tests of every part, which take twice as long (tests/run.sh --all)"
    ;;
--all)
    install_packages build test
    continue_as_caller tests/run.sh --all
    run_first_tests
    # The log of the next run has its place.
    if ((${#builds[@]})); then
        mkdir -p build/first && rm -rf build/first/meson-logs && cp -r build/meson-logs build/first/
        builds=(build/first)
        meson configure build "-Dtest_suites=$(IFS=, && echo "${first_suites[*]},${other_suites[*]}")"
        # shellcheck disable=SC2046
        ! build build || run_tests build 2 $(with_suites --suite "${other_suites[@]}" long)
    fi
    ;;
--ci)
    most_again=3  # of some 450: the processors of a virtual machine may stand still for 100 ms
    install_packages build test ci
    check_layout
    use_cache
    # Line numbers without variables and the lowest optimisation: the compiler needs a third of the
    # time. Without any, Eigen is too slow for the tests that sample many poses. Four checks of every
    # use of a pointer would double the compiler's time: null and object-size, where the address
    # sanitizer finds most of the same; alignment, which x86 does not need; and vptr, wrong casts
    # between classes. Clang compiles with the address sanitizer in some 60 % of GCC's time, and finds what
    # GCC does not; in its DWARF 5, addr2line of Debian 12 takes one file for another. With the thread sanitizer,
    # GCC takes variables of std::regex for uninitialised.
    unchecked=-fno-sanitize=null,object-size,alignment,vptr
    flags="'-g1','-fno-omit-frame-pointer','$unchecked'"
    # Clang takes over a minute for tension_solver.cpp when it unrolls the loops together with their checks. A
    # precompiled header from the cache has other times than those that it would note.
    clang_only="'-gdwarf-4','-mllvm','-pragma-unroll-threshold=0','-Xclang','-fno-pch-timestamp'"
    sanitized=(-Doptimization=1 -Ddebug=false -Db_lundef=false -Dexamples=false)
    compile_executed build-ci-address
    CC=clang CXX=clang++ configure build-ci-address "${sanitized[@]}" \
        "-Dcpp_args=[$clang_only,$flags,'-fsanitize-coverage=func,trace-pc-guard']" \
        "-Dcpp_link_args=$PWD/build-ci-address/executed.o" -Db_sanitize=address,undefined \
        -Dtest_suites=api,core,element,pipelines,spidar,window
    configure build-ci-thread "${sanitized[@]}" \
        "-Dcpp_args=[$flags,'-fpch-preprocess','-Wno-maybe-uninitialized']" \
        -Db_sanitize=thread -Dplugin=disabled -Dtest_suites=spidar
    threaded=tests/spidar/test_spidar

    build_ahead build-ci-address
    run_on_bare_debian build-ci-bare
    say "address sanitizer: GLib's table of quarks is left out, which it never frees; plugins are read" \
        "in the test itself, for GStreamer's own process for that is not built with the sanitizer"
    echo "left out: examples, programs of their own; numerics, tests that sample thousands of cases of" \
        "arithmetic and are 10 to 70 times slower here, or count what is taken from the heap; films, commands and" \
        "pipelines_player_mouse, which play for minutes; api_installed and api_python. All have run above."
    export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
    # By the fast way, stacks end in GLib; twelve calls instead of thirty are enough for leaks.supp.
    export ASAN_OPTIONS=fast_unwind_on_malloc=0:malloc_context_size=12
    export LSAN_OPTIONS=suppressions=$PWD/tests/leaks.supp:print_suppressions=0
    export GST_REGISTRY_FORK=no
    if build build-ci-address; then
        build_ahead build-ci-thread "$threaded"
        rm -rf build-ci-address/executed && mkdir build-ci-address/executed
        run_tests build-ci-address 4
        # The tests there execute something of each source.
        begin_check "sources executed" tests/check_executed.py build-ci-address
    fi
    begin_check "names and braces" tests/check_tidy.sh --quick
    # Doxygen reads the public headers, and Sphinx the pages, without a warning. The site stays in docs/site there.
    begin_check "site" meson compile -C build-ci-address docs
    say "thread sanitizer: the 1 kHz loop and the queues to and from it"
    ! build build-ci-thread "$threaded" || run_tests build-ci-thread 8 --suite threaded
    end_check "sources executed"
    end_check "site"
    end_check "names and braces"
    say "left out of all three: suite films, which takes an hour; suite hazards, which takes some minutes; suite kernel," \
        "a virtual machine that needs QEMU and a kernel image; suite packages, which builds the Debian packages in a" \
        "clean Debian; suite players, which needs desktop players; suite soak, which takes an hour; suite subproject," \
        "which builds all again; suite valgrind. tests/README.md says when to run each."
    ;;
*)
    echo "error: unknown option $1; usage: tests/run.sh [--all | --ci]" >&2
    exit 2
    ;;
esac

say "summary"
python3 tests/summary.py --most-again "$most_again" "${checks[@]}" "${builds[@]}"
