#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The tests of the paper as ensembles, with the release build of scripts/demo.sh or test.sh.
#
#   scripts/paper.sh            its figures with 2,000 grains and three seeds: eleven minutes on two cores
#   scripts/paper.sh --whole    with 10,000 grains as in the paper (some six CPU hours, estimated); then, with 2,000, resistance curves,
#                               critical states, specimens made in other ways, slower tests (some three CPU hours)
#
# Interrupted, the same command goes on where it stopped. Further arguments go to benchmarks/paper.py. Tables and figures
# are left in results/paper_*/tables.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

paper() { /usr/bin/python3 benchmarks/paper.py "$@"; }

if [[ "${1:-}" == --whole ]]; then
  shift
  paper --grains 10000 --whole --work results/paper_10000 "$@"
  paper --whole --parts resistance critical ways paces --work results/paper_more "$@"
else
  paper --work results/paper_2000 "$@"
fi
