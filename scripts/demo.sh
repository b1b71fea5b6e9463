#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A small specimen liquefies: builds the release preset, runs an undrained cyclic test and lists the figures it made.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

results=results/demo
scripts/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target element_test
build/release/bin/element_test apps/scenes/quick_cyclic_liquefies.toml --output "$results" --overwrite

# The application draws its own figures; draw them here if it could not.
for figure in fig_stress_path fig_redundancy fig_contact_fractions fig_fabric; do
  if [[ ! -s "$results/figures/$figure.png" ]]; then
    /usr/bin/python3 scripts/plots.py "$results"
    break
  fi
done
echo "figures:"
ls -1 "$results"/figures/*.png
