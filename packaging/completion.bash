# SPDX-License-Identifier: BSD-3-Clause
# Completion for the programs of Isostat: their options, as --help lists them; for `isostat` its commands, too; else files.
_isostat() {
  local word=${COMP_WORDS[COMP_CWORD]} program=("$1") options
  if [[ $1 == *isostat && $COMP_CWORD -gt 1 ]]; then
    program+=("${COMP_WORDS[1]}")
  fi
  if [[ $word == -* ]]; then
    options=$("${program[@]}" --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*')
  elif [[ $1 == *isostat && $COMP_CWORD == 1 ]]; then
    options=$("$1" --help 2>/dev/null | grep -oE '^  [a-z_]+' | tr -d ' ')
  fi
  mapfile -t COMPREPLY < <(compgen -W "${options:-}" -- "$word")
  ((${#COMPREPLY[@]})) || compopt -o default
}
complete -F _isostat isostat element_test void_ratio_limits micromechanics soil_column rve_replay
