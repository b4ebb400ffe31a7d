# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Test points for shell scripts, in the Test Anything Protocol. Sourced; creates a directory $scratch for the script.
set -u

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
tap_count=0
tap_failed=0
tap_skipped=0

# tap_point STATUS NAME [OUTPUT-FILE]: the output is shown where the point fails
tap_point() {
    tap_count=$((tap_count + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $tap_count - $2"
    else
        echo "not ok $tap_count - $2"
        tap_failed=$((tap_failed + 1))
        if [ $# -gt 2 ]; then sed 's/^/# /' "$3"; fi
    fi
}

# holds NAME COMMAND...: the command succeeds
holds() {
    local name=$1 status
    shift
    "$@" >"$scratch/output" 2>&1 </dev/null
    status=$?
    tap_point $status "$name" "$scratch/output"
}

# refused PATTERN NAME COMMAND...: the command fails, and says why
refused() {
    local pattern=$1 name=$2 status=0
    shift 2
    if "$@" >"$scratch/output" 2>&1 </dev/null; then
        echo "succeeded; should have failed with a message like '$pattern'" >>"$scratch/output"
        status=1
    else
        grep -Eq -e "$pattern" "$scratch/output" || status=1
    fi
    tap_point $status "$name" "$scratch/output"
}

# skipped NAME REASON
skipped() {
    tap_count=$((tap_count + 1))
    tap_skipped=$((tap_skipped + 1))
    echo "ok $tap_count - $1 # SKIP $2"
}

# cloned SOURCE-ROOT CLONE: a repository of what git has there, or would have
cloned() {
    git init -q -b main "$2" && (cd "$1" && git -c core.excludesFile= --git-dir "$2/.git" --work-tree . add .) &&
        git -C "$2" -c user.name=a -c user.email=a@example.org commit -qm a && git -C "$2" reset -q --hard
}

# Last in a script: status 0 after a complete plan, as TAP wants.
tap_done() {
    echo "1..$tap_count"
}
