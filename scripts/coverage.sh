#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Which lines and branches of base, dem, fem and coupling the tests run through: a table of the files, those with the
# most lines left first, in build/coverage/coverage.txt, and every line in build/coverage/html/index.html. Branches that
# exceptions take out of a call are not counted. Arguments choose tests, as those of ctest; an hour and more for all.
#
#   scripts/coverage.sh          scripts/coverage.sh -L unit
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh --coverage
cmake --preset coverage >/dev/null
cmake --build --preset coverage --parallel "$(nproc)"
find build/coverage -name '*.gcda' -delete
ctest --preset coverage --parallel "$(nproc)" "$@" || echo "coverage: some tests have failed"
mkdir -p build/coverage/html
options=(--root . --object-directory build/coverage --exclude-throw-branches --exclude-unreachable-branches --sort-uncovered)
for folder in base dem fem coupling; do
  options+=(--filter "$folder/")
done
gcovr "${options[@]}" --json build/coverage/coverage.json --html-details build/coverage/html/index.html
gcovr --root . --add-tracefile build/coverage/coverage.json --sort-uncovered --txt build/coverage/coverage.txt
for folder in base dem fem coupling; do
  gcovr --root . --add-tracefile build/coverage/coverage.json --filter "$folder/" --print-summary --txt "build/coverage/$folder.txt" |
    grep -E '^(lines|branches)' | sed "s/^/$folder: /"
done
