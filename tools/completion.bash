# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# What bash completes for the tools of springstep: their options, and the words that these can be. Each tool tells them.
_springstep()
{
    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} name kind words names=
    local tool=${1/#'~/'/"$HOME/"} # as it is typed
    type -P "$tool" >/dev/null || tool=${tool##*/} # $FOLDER/spring-run, say
    if [[ $word == '=' ]]; then # --method=leapfrog comes as three words
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
                compopt -o filenames 2>/dev/null # fails where no key was pressed
                [[ $kind == file ]] && mapfile -t COMPREPLY < <(compgen -f -- "$word")
                [[ $kind == folder ]] && mapfile -t COMPREPLY < <(compgen -d -- "$word")
                ;;
        esac
        return
    done < <("$tool" --completion 2>/dev/null)
    mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
}
complete -F _springstep @names@
