#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up, builds the release preset and runs every test but those labelled `long`; before that, those of the finite
# elements in a debug build. The last lines are ctest's own; the
# exit code is not 0 if anything failed. Arguments go to ctest: scripts/test.sh -R layering
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)"

# The continuum half once more with the checks of deal.II's debug library, without its long convergence studies.
cmake --preset debug
cmake --build --preset debug --parallel "$(nproc)" --target verification_waves verification_consolidation
GTEST_FILTER='-ShearLayer.*:Biot.*Regimes' ctest --preset debug -R '^verification_(waves|consolidation)$'

ctest --preset release "$@"
