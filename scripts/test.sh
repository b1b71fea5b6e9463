#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up, builds the release preset and runs every test. The last lines are ctest's own; the exit code is not 0 if
# anything failed. Arguments go to ctest: scripts/test.sh -R layering. Where the variable CI is set, warnings are errors.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
cmake --preset release ${CI:+-DISOSTAT_WERROR=ON}
cmake --build --preset release --parallel "$(nproc)"

ctest --preset release --parallel "$(nproc)" "$@"
