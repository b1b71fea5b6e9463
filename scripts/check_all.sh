#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The gates besides the tests of the release preset. All are tried, and the last lines say what each found.
#
#   scripts/check_all.sh             the whole tree, with fem, coupling and MPI, and Debian 13: some two hours on two cores
#   scripts/check_all.sh --grains    base and dem alone: some 25 minutes
#   scripts/check_all.sh [--grains] GATE...    only these of the gates
#
#   format      clang-format on every file
#   docs        scripts/docs.sh on the release preset: the site without a warning, no link that leads nowhere
#   tidy        clang-tidy (.clang-tidy) on the libraries and programs, of the grains on the dozen sources that were
#               changed last: one takes half a minute. Tests are left out, as the macros of GoogleTest break a dozen of its
#               rules in each of them
#   sanitizers  tests with address and undefined-behaviour sanitizers and library assertions: of the grains the unit and
#               hard tests, of the whole tree all. Warnings are errors in scripts/test.sh only, as GCC's are wrong about
#               what the sanitizers put in
#   debian13    not of the grains: scripts/other_debian.sh, which needs the rights of root
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=asan
folders=(base dem fem coupling apps)
tidy_options=()
if [[ "${1:-}" == --grains ]]; then
  preset=asan-grains
  folders=(base dem)
  tidy_options=(-DISOSTAT_FEM=OFF)
  shift
fi
gates=("$@")
if ((${#gates[@]} == 0)); then
  gates=(format docs tidy sanitizers)
  [[ $preset == asan-grains ]] || gates+=(debian13)
fi

format() {
  git ls-files '*.cpp' '*.hpp' '*.c' '*.h' | xargs clang-format --dry-run -Werror
}

docs() {
  scripts/setup.sh --docs && scripts/docs.sh
}

# Sources of the folders: all, or of the grains the dozen that were changed last.
sources() {
  local all=("${folders[@]/%//*.cpp}")
  if [[ $preset == asan-grains ]]; then
    git log -30 --format= --name-only -- "${all[@]}" |
      awk 'NR == FNR { there[$0] = 1; next } there[$0] && !seen[$0]++ && ++n <= 12' <(git ls-files "${all[@]}") -
  else
    git ls-files "${all[@]}"
  fi
}

# One process for each file. What clang-tidy writes on its error output is how many warnings of others it has left out.
tidy() {
  cmake --preset tidy "${tidy_options[@]}" >/dev/null &&
    sources | xargs --no-run-if-empty --max-procs="$(nproc)" --max-args=1 clang-tidy --quiet -p build/tidy 2>/dev/null
}

sanitizers() {
  cmake --preset "$preset" && cmake --build --preset "$preset" --parallel "$(nproc)" &&
    ctest --preset "$preset" --parallel "$(nproc)"
}

debian13() {
  scripts/other_debian.sh trixie
}

failed=0
verdicts=()
gate() {
  echo "== $1"
  local start=$SECONDS verdict=passed
  "$1" || { verdict=FAILED; failed=1; }
  verdicts+=("$1: $verdict after $(((SECONDS - start + 30) / 60)) min")
}

scripts/setup.sh --gates || exit 1
for name in "${gates[@]}"; do
  gate "$name"
done
printf 'check_all: %s\n' "${verdicts[@]}"
exit $failed
