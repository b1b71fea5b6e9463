#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The tests of the paper as ensembles, with the release build of scripts/demo.sh or test.sh.
#
#   scripts/paper.sh            2,000 grains, three seeds: half an hour on two cores
#   scripts/paper.sh --whole    10,000 grains as in the paper, and resistance curves of 2,000 at every density and
#                               pressure: some hours; interrupted, it goes on where it stopped
#
# Further arguments go to benchmarks/paper.py. Tables and figures are left in results/paper_*/tables.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

paper() { /usr/bin/python3 benchmarks/paper.py "$@"; }

if [[ "${1:-}" == --whole ]]; then
  shift
  paper --grains 10000 --whole --parts monotonic cyclic drained --work results/paper_10000 "$@"
  paper --whole --parts resistance --work results/paper_resistance "$@"
else
  paper --work results/paper_2000 "$@"
fi
