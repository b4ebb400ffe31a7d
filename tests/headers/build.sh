# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Compiles bits.c, interface.c and the library's sources as in a user's own build. Sourced; $root is the source root.
# shellcheck disable=SC2154
bits=$root/tests/headers/bits

# compile DIRECTORY SOURCES COMPILER FLAG...: objects, several compilers at once
compile() {
    local directory=$1 sources=$2
    shift 2
    mkdir -p "$directory" && (cd "$directory" &&
        printf '%s\0' "$sources"/*/*.c "$bits.c" "$root/tests/headers/interface.c" | xargs -0 -n 1 -P "$(nproc)" "$@" -I"$root/include" -I"$root/src" -c)
}

# link DIRECTORY COMPILER FLAG...: a program
link() { "${@:2}" "$1"/*.o -lm -o "$1/bits"; }

# build DIRECTORY SOURCES COMPILER FLAG...: objects and a program
build() { compile "$@" && link "$1" "${@:3}"; }
