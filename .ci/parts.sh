# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# What .ci/run and .ci/full have in common: a copy of the checkout to work on, parts that are counted and timed, the
# table of them at the end. Sourced by both.
set -uo pipefail

export CI=true DEBIAN_FRONTEND=noninteractive
exec </dev/null

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
declare -A jobs=() # those of start, by name
chmod 755 "$work" # tests run as another user, too
clean_up() {
    trap '' HUP INT PIPE TERM # one signal stops the script, the next does not stop rm
    for job in "${jobs[@]}"; do kill -- "-$job" 2>/dev/null; done
    rm -rf --one-file-system "$work"
}
trap clean_up EXIT
tree=$work/springstep
mkdir "$tree"
tar -C "$root" --exclude-vcs --exclude='./build*' -c . | tar -C "$tree" -x

closing='^([0-9]+) passed, ([0-9]+) failed, ([0-9]+) skipped$'
passed=0 failed=0 skipped=0 all_processor=0
rows=() failed_tests=()

# minutes SECONDS: with one decimal
minutes() { printf '%d.%d' $((($1 + 3) / 60)) $(((($1 + 3) / 6) % 10)); }

# row NAME SECONDS PROCESSOR-SECONDS RESULT
row() { rows+=("$(printf '%-24s %7s %10s  %s' "$1" "$(minutes "$2")" "$(minutes "$3")" "$4")"); }

# timed FILE COMMAND...: in a subshell of its own. Writes to FILE its seconds, and those of the processor with all children.
timed() (
    status=0 begin=$SECONDS
    "${@:2}" || status=1
    times >"$1.times"
    awk -v wall=$((SECONDS - begin)) '{ for (i = 1; i <= 2; i++) { split($i, t, /[ms]/); sum += 60 * t[1] + t[2] } }
        END { printf "%d %d\n", wall, sum }' "$1.times" >"$1"
    exit "$status"
)

# start NAME COMMAND...: beside the parts that follow, until the part of that name, which is given no command
start() {
    local name=$1
    shift
    set -m # a process group of its own, for clean_up
    timed "$work/$name.seconds" "$@" >"$work/$name.log" 2>&1 &
    set +m
    jobs[$name]=$!
}

# run_part NAME [COMMAND...]: shows what it prints, and leaves it in $work/log and its times in $seconds and $processor
run_part() {
    local name=$1 status=0 times=$work/seconds
    shift
    printf '\n=== %s\n' "$name"
    if [ $# -gt 0 ]; then
        timed "$times" "$@" 2>&1 | tee "$work/log" || status=1
    else
        times=$work/$name.seconds
        wait "${jobs[$name]}" || status=1
        tee "$work/log" <"$work/$name.log"
    fi
    read -r seconds processor <"$times"
    all_processor=$((all_processor + processor))
    return $status
}

# suite NAME COMMAND...: a part that runs tests and prints their count. It fails if a test does, or none was counted.
suite() {
    local result counted status=0
    run_part "$@" || status=1
    result=$(grep -E "$closing" "$work/log" | tail -n 1)
    if [[ $result =~ $closing ]]; then
        counted=${BASH_REMATCH[2]}
        passed=$((passed + BASH_REMATCH[1]))
        failed=$((failed + counted))
        skipped=$((skipped + BASH_REMATCH[3]))
    else
        counted=0 status=1 result='no count of tests'
    fi
    if [ $status -ne 0 ]; then
        mapfile -t -O ${#failed_tests[@]} failed_tests < <(grep -aE '^(FAILED|not ok) ' "$work/log" | head -n 20 | sed "s|^|$1: |")
        result="FAILED: $result"
        if [ "$counted" -eq 0 ]; then failed=$((failed + 1)); fi
    fi
    row "$1" "$seconds" "$processor" "$result"
}

# check NAME COMMAND...: a part that counts as one test
check() {
    local result=passed
    if run_part "$@"; then
        passed=$((passed + 1))
    else
        result=FAILED
        failed=$((failed + 1))
    fi
    row "$1" "$seconds" "$processor" "$result"
}

install_packages() {
    apt-get -q update && apt-get -q -y install --no-install-recommends "$@"
}

# build_and_test NAME SUITES MESON-OPTION...: all tests except those of the named suites
build_and_test() {
    local build=$work/$1 without status=0
    read -ra without <<<"$2"
    shift 2
    meson setup "$build" "$tree" -Dwerror=true -Dtools=enabled -Dtests=enabled -Dreport=disabled "$@" &&
        meson compile -C "$build" || return
    meson test -C "$build" --no-rebuild --print-errorlogs "${without[@]/#/--no-suite=}" || status=1
    python3 "$tree/tools/count_tests.py" "$build/meson-logs" || status=1
    return $status
}

# under_sanitizers SUITES: the tests except those of the named suites. Without -fno-sanitize-recover a sanitizer prints its
# finding and the test passes. -O1 and -g1 halve the time to compile; -g1 leaves the line numbers.
under_sanitizers() {
    CC=gcc build_and_test sanitizers "$1" -Db_sanitize=address,undefined -Db_lundef=false -Ddebug=false -Doptimization=1 \
        -Dc_args='-fno-sanitize-recover=all -g1'
}

# Last: the tests that failed, the table and the sum of the counts; its status is that of the script.
finish() {
    row total $SECONDS $all_processor ''
    if [ ${#failed_tests[@]} -gt 0 ]; then printf '\n%s' "${failed_tests[@]}"; fi
    printf '\n%-24s minutes  processor  result\n' part
    printf '%s\n' "${rows[@]}"
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" -eq 0 ]
}
