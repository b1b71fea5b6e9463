#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up, builds the release preset and runs every test but those labelled `long`. The last lines are ctest's own; the
# exit code is not 0 if anything failed. Arguments go to ctest: scripts/test.sh -R layering
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)"

ctest --preset release --parallel "$(nproc)" "$@"
