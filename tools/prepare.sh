# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# Common steps of the commands in tools/, which source this file: install missing packages, configure, compile.

set -euo pipefail

command=$(basename "$0")
me=tools/$command
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
build=$root/build

say() {
    printf '%s: %s\n' "$me" "$*" >&2
}

# read_arguments OPTION ARGUMENT...: prints $usage for --help, and sets $chosen if the option is given
# shellcheck disable=SC2034,SC2154 # variables of the command
read_arguments() {
    chosen=
    local argument
    for argument in "${@:2}"; do
        if [[ $argument == --help ]]; then
            printf '%s\n\n' "$usage"
            echo 'Status: 0 success, 1 a step failed, 2 invalid usage, 3 packages are missing and cannot be installed, or build/ is not a'
            echo 'build of this tree.'
            exit 0
        elif [[ $argument != "$1" ]]; then
            say "\"$argument\" is not an option; tools/$command --help lists them"
            exit 2
        fi
        chosen=yes
    done
}

# Tests for the program, header or module itself and not with a package manager, so it works on every system.
present() {
    local kind=$1 name=$2
    case $kind in
    command) command -v "$name" >/dev/null ;;
    header) # not #include: SUNDIALS with MPI includes mpi.h, which is in a folder that only Meson finds
        printf '#if !__has_include(<%s>)\n#error\n#endif\n' "$name" | cc -E - >/dev/null 2>&1
        ;;
    pkgconfig) pkg-config --exists "$name" 2>/dev/null ;;
    wasm32) echo 'int main(void) { return 0; }' | "$name" --target=wasm32-wasi -x c - -o /dev/null 2>/dev/null ;;
    python) /usr/bin/python3 -c "import $name" 2>/dev/null ;; # the interpreter of the Meson files
    *)
        say "packages.txt: unknown kind \"$kind\""
        exit 1
        ;;
    esac
}

# Lists missing packages of all commands and of this command: report, test ...
missing_packages() {
    local kind name package for
    while read -r kind name package for; do
        if [[ -n $kind && $kind != '#'* && ${for:-$command} == "$command" ]] && ! present "$kind" "$name"; then
            echo "$package"
        fi
    done <"$root/tools/packages.txt"
}

give_up() {
    say "$1; these Debian packages, or their equivalents, are missing:" "${@:2}"
    exit 3
}

install_missing() {
    local -a missing as_root=()
    mapfile -t missing < <(missing_packages)
    wait $! # its status
    ((${#missing[@]})) || return 0
    command -v apt-get >/dev/null || give_up 'packages cannot be installed automatically on this system' "${missing[@]}"
    if ((EUID)); then
        command -v sudo >/dev/null || give_up 'installing packages requires root or sudo' "${missing[@]}"
        as_root=(sudo)
    fi
    say "installing ${missing[*]}"
    as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300)
    if ! { "${as_root[@]}" update && "${as_root[@]}" install --no-install-recommends "${missing[@]}"; } >&2 </dev/null; then
        give_up 'apt-get failed' "${missing[@]}"
    fi
    mapfile -t missing < <(missing_packages)
    ((${#missing[@]} == 0)) || give_up 'apt-get succeeded, but the installed files were not found' "${missing[@]}"
}

# Under sudo in a user's checkout, only the packages need root. The build belongs to the owner of the checkout.
return_to_owner() {
    local owner
    owner=$(stat -c %u "$root")
    if ((EUID == 0 && owner != 0)) && [[ ${SUDO_UID:-} == "$owner" ]]; then
        exec sudo -u "#$owner" -- "$root/$me" "$@"
    fi
}

# Succeeds if build/ is absent, empty, started by these commands, or a Meson build of this tree.
own_build() {
    [[ -e $build || -L $build ]] || return 0
    [[ -d $build && -w $build && -x $build ]] || return
    if [[ ! -e $build/meson-info/meson-info.json ]]; then
        [[ -z $(find "$build" -mindepth 1 -maxdepth 1 ! -name 'meson-*' ! -name live ! -name 'docs*' ! -name '.*') ]]
        return
    fi
    command -v python3 >/dev/null || return 0 # Meson cannot run either, and fails with a message
    python3 - "$build" "$root" <<'END' 2>/dev/null
import json, os, sys
with open(sys.argv[1] + '/meson-info/meson-info.json', encoding='utf-8') as info:
    sys.exit(not os.path.samefile(json.load(info)['directories']['source'], sys.argv[2]))
END
}

check_build() {
    own_build && return
    say "$build is not a Meson build of this tree, or cannot be written; rename or remove it"
    exit 3
}

# prepare ARGUMENTS...: the arguments of the script
prepare() {
    check_build
    install_missing
    return_to_owner "$@"
    local -a how=()
    [[ ! -e $build/build.ninja ]] || how=(--reconfigure) # packages may have been installed since it was configured
    meson setup "${how[@]}" -Dtools=enabled -Dreferences=enabled -Dtests=enabled -Dreport=enabled "$build" "$root" >&2
    if ((${#how[@]})); then # Meson saves its options after the build file, for which ninja would configure a second time
        touch "$build/build.ninja"
        ninja -C "$build" -t restat build.ninja >&2
    fi
    meson compile -C "$build" >&2
}
