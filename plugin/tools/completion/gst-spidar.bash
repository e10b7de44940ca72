# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# What bash completes after spidarctl, spidartrack and spidar-feel. All words come from the programs, so that there is no
# second list of them; files are completed where no word fits.
# shellcheck shell=bash

_gst_spidar() {
    # Bash takes a colon for a word of its own, as in sim:sh4; zsh does not.
    local typed=() glue="" part i
    for ((i = 0; i <= COMP_CWORD; ++i)); do
        part=${COMP_WORDS[i]}
        if [[ -n $glue || $part == :* ]] && ((${#typed[@]} > 0)); then
            typed[${#typed[@]} - 1]+=$part
        else
            typed+=("$part")
        fi
        if [[ $part == *: ]]; then glue=1; else glue=""; fi
    done
    local at=$((${#typed[@]} - 1))
    local program=${typed[0]} word=${typed[at]} before=${typed[at - 1]}
    local command=() help words=""
    if [[ $program != *spidar-feel ]] && ((at > 1)); then command=("${typed[1]}"); fi
    help=$("$program" "${command[@]}" --help 2>/dev/null)
    # Bash takes the = of NAME=VALUE for a word of its own, zsh does not.
    local property="" front=""
    if [[ $before == = ]]; then
        property=${typed[at - 2]}
    elif [[ $word == = ]]; then
        property=$before word=""
    elif [[ $word == *=* ]]; then
        property=${word%%=*} front=$property=
    fi
    if [[ $program == *spidar-feel && -n $property ]]; then
        words=$("$program" --properties 2>/dev/null | sed -nE "s/^$property=\{(.*)\}$/\1/p" | tr , '\n' | sed "s/^/$front/")
    elif [[ $word == -* ]]; then
        words=$(grep -oE -- '--[a-z][a-z-]*' <<<"$help" | sort -u)
    elif [[ $before == --* ]]; then
        # --axis CHANNEL:{fx,fy,fz}
        words=$(sed -nE "s/^ *(-[a-z],)?$before .*\{(.*)\}.*/\2/p" <<<"$help" | tr , ' ')
    elif ((at == 1)) && [[ $program != *spidar-feel ]]; then
        words=$(sed -nE '/^Subcommands:/,/^$/s/^  ([a-z]+) .*/\1/p' <<<"$help")
    elif ((at == 2)) && grep -q '^  DEVICE ' <<<"$help"; then
        words=$("$program" list --json 2>/dev/null | sed -nE 's/^ *"device": "(.*)",?$/\1/p')
    elif [[ $program == *spidar-feel && -z $(compgen -f -- "$word") ]]; then
        words=$("$program" --properties 2>/dev/null | sed 's/=.*/=/')
    fi
    # shellcheck disable=SC2207  # zsh has no mapfile, and no word has a space
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    # The value follows at once. There is no completion to change where a test calls this.
    if [[ ${COMPREPLY[0]-} == *= ]]; then compopt -o nospace 2>/dev/null; fi
    # What bash replaces begins after the last colon.
    if [[ $word == *:* && ${COMP_WORDBREAKS-} == *:* ]]; then COMPREPLY=("${COMPREPLY[@]#"${word%"${word##*:}"}"}"); fi
}
complete -o bashdefault -o default -F _gst_spidar spidarctl spidartrack spidar-feel
