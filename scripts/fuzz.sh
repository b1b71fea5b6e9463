#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Looks for inputs on which a reader breaks, with libFuzzer and sanitizers: HOURS on all cores, shared among the targets
# (tests/fuzz/*.cpp). What it has learnt stays in build/fuzz/corpus, and the next call continues from there; what breaks a
# target is left in build/fuzz/found. A found input belongs, with a word on what it was, into tests/fuzz/corpus/TARGET.
#
#   scripts/fuzz.sh HOURS [TARGET...]    scripts/fuzz.sh 0.1; scripts/fuzz.sh 8 scene plan
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

hours=${1:-}
if ! [[ $hours =~ ^[0-9]*\.?[0-9]+$ ]]; then
  sed -n '3,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
shift
scripts/setup.sh --fuzz
cmake --preset fuzz >/dev/null
folder=build/fuzz
targets=("$@")
((${#targets[@]})) || mapfile -t targets < <(basename -s .seeds $folder/fuzz/*.seeds)
cmake --build --preset fuzz --parallel "$(nproc)" --target "${targets[@]/#/fuzz_}"
mkdir -p $folder/found

# The words of the scenes and numbers that programs get wrong, of which the fuzzer makes new ones.
{
  grep -ohE '^\| `[a-z0-9_.]+`' docs/*scene_reference.md | grep -oE '[a-z0-9_]+'
  printf '%s\n' -0 0.0 1e-300 1e300 1e400 5e-324 nan -inf 4294967296 9223372036854775808 0x10 1_000 1979-05-27 true [] {}
} | sort -u | sed 's/.*/"&"/' >$folder/words.dictionary

seconds=$(awk -v h="$hours" -v cores="$(nproc)" -v n=${#targets[@]} 'BEGIN { print int(3600 * h * cores / n + 0.5) }')
fuzz() {
  local corpus=$folder/corpus/$1 seeds
  mkdir -p "$corpus"
  mapfile -t seeds < <(xargs -r -I{} find {} -type f <"$folder/fuzz/$1.seeds")
  ((${#seeds[@]} == 0)) || cp -n "${seeds[@]}" "$corpus"
  "$folder/bin/fuzz_$1" -max_total_time="$seconds" -max_len=20000 -timeout=20 -rss_limit_mb=2500 -print_final_stats=1 \
    -dict=$folder/words.dictionary -artifact_prefix="$folder/found/$1-" "$corpus" >"$folder/$1.log" 2>&1 ||
    { echo "$1: broke, see $folder/$1.log"; tail -n 30 "$folder/$1.log"; return 1; }
  echo "$1: $(grep -oE 'number_of_executed_units: *[0-9]+' "$folder/$1.log" | grep -oE '[0-9]+') executions," \
    "$(find "$corpus" -type f | wc -l) inputs, $seconds s"
}
export -f fuzz
export folder seconds ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
printf '%s\n' "${targets[@]}" | xargs --max-procs="$(nproc)" -I{} bash -c 'fuzz {}'
