# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# What bash completes after spidarctl, spidartrack and spidar-feel. All words come from their --help, so that there is
# no second list of them; files are completed where no word fits.
# shellcheck shell=bash

_gst_spidar() {
    local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
    local command=() help words=""
    if [[ $program != *spidar-feel ]] && ((COMP_CWORD > 1)); then command=("${COMP_WORDS[1]}"); fi
    help=$("$program" "${command[@]}" --help 2>/dev/null)
    if [[ $word == -* ]]; then
        words=$(grep -oE -- '--[a-z][a-z-]*' <<<"$help" | sort -u)
    elif [[ $before == --* ]]; then
        # --axis CHANNEL:{fx,fy,fz}
        words=$(sed -nE "s/^ *(-[a-z],)?$before .*\{(.*)\}.*/\2/p" <<<"$help" | tr , ' ')
    elif ((COMP_CWORD == 1)); then
        words=$(sed -nE '/^Subcommands:/,/^$/s/^  ([a-z]+) .*/\1/p' <<<"$help")
    elif ((COMP_CWORD == 2)) && grep -q '^  DEVICE ' <<<"$help"; then
        words=$("$program" list --json 2>/dev/null | sed -nE 's/^ *"device": "(.*)",?$/\1/p')
    fi
    # shellcheck disable=SC2207  # zsh has no mapfile, and no word has a space
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    # Bash takes what is before a colon for a word of its own.
    if type __ltrimcolon_completions >/dev/null 2>&1; then __ltrimcolon_completions "$word"; fi
}
complete -o bashdefault -o default -F _gst_spidar spidarctl spidartrack spidar-feel
