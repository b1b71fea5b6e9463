#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A small specimen liquefies, then a deposit of ten of them: builds the release preset, runs an undrained cyclic test and a
# soil column with grains at its Gauss points, and lists the figures they made.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

results=results/demo
scripts/setup.sh
cmake --preset release
# All programs: the commands that the README names next are there, too.
cmake --build --preset release --parallel "$(nproc)" --target element_test soil_column isostat \
  micromechanics rve_replay void_ratio_limits
build/release/bin/element_test apps/scenes/quick_cyclic_liquefies.toml --output "$results" --overwrite

# The application draws its own figures; draw them here if it could not.
for figure in fig_stress_path fig_redundancy fig_contact_fractions fig_fabric; do
  if [[ ! -s "$results/figures/$figure.png" ]]; then
    PYTHONPATH=apps /usr/bin/python3 -m figures element_test "$results"
    break
  fi
done

# Specimens of 300 grains, then the column that is made of them; the scene looks for them in results/.
build/release/bin/isostat library apps/scenes/rve_library.toml --output results/quick_library.h5 --append \
  --pressures "20 kPa,100 kPa" --set contact.young="1 GPa" --set grading.grains=300
build/release/bin/soil_column apps/scenes/column/quick_grains_10m.toml --output results/demo_column --overwrite

echo "figures:"
ls -1 "$results"/figures/*.png results/demo_column/figures/*.png
