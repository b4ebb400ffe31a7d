# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Bash completion for the tools of springstep: their options and valid words, as printed by --completion of each tool.
_springstep()
{
    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} name kind words names=
    local tool=${1/#'~/'/"$HOME/"} # as typed
    type -P "$tool" >/dev/null || tool=${tool##*/} # for example $FOLDER/spring-run
    if [[ $word == '=' ]]; then # --method=leapfrog is three words here
        word=
    elif [[ $previous == '=' ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    [[ $previous == -o ]] && previous=--output
    COMPREPLY=()
    while read -r name kind words; do
        names+=" $name"
        [[ $name == "$previous" ]] || continue
        case $kind in
            flag) continue ;;
            words) mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word") ;;
            file | folder)
                compopt -o filenames 2>/dev/null # fails outside of interactive completion
                [[ $kind == file ]] && mapfile -t COMPREPLY < <(compgen -f -- "$word")
                [[ $kind == folder ]] && mapfile -t COMPREPLY < <(compgen -d -- "$word")
                ;;
        esac
        return
    done < <("$tool" --completion 2>/dev/null)
    mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
}
complete -F _springstep @names@
