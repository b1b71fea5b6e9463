#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""e_min and e_max of Karlsruhe fine sand over seeds, in a box and in a periodic cell, as a table.

    void_ratio_limits.py                      three seeds of 2,000 grains; docs/results/paper/limits.csv
    void_ratio_limits.py --grains 10000       as many grains as the paper's

Finished runs are kept in --work and not run again.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

from speed_error import paths

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOMAINS = ("rigid-box", "periodic-cell")
LIMITS = ("e_min", "e_min_inside", "e_max", "e_max_inside")


def limits_of(options, domain, seed):
    """What void_ratio_limits writes, by name."""
    folder = pathlib.Path(options.work) / f"{domain}_n{options.grains}_s{seed}"
    if not (folder / "limits.json").exists():
        edge = 10 * (options.grains / 10000) ** (1 / 3)
        keys = {"grading.grains": options.grains, "grading.seed": seed, "grading.cloud_edge": f"{edge:.15g} mm",
                "specimen.domain": domain}
        command = [f"{options.build}/bin/void_ratio_limits", "void_ratio_limits.toml", "--output", str(folder),
                   "--overwrite", "--quiet"]
        command += [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        print(folder, flush=True)
    written = json.loads((folder / "limits.json").read_text(encoding="utf-8"))
    return {name: item["value"] for name, item in written.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", type=int, default=2000)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--work", default=str(ROOT / "results/limits"), help="folder of runs")
    parser.add_argument("--build", default=str(ROOT / "build/release"), help="build tree with bin/void_ratio_limits")
    parser.add_argument("--table", default=str(ROOT / "docs/results/paper/limits.csv"))
    options = parser.parse_args()
    rows = []
    for domain in DOMAINS:
        found = [limits_of(options, domain, seed) for seed in range(1, options.seeds + 1)]
        for limit in LIMITS:
            mean, _, error, n = paths.ensemble([limits[limit] for limits in found])
            rows.append([domain, options.grains, limit, f"{mean:.4f}", f"{error:.4f}", n])
    table = pathlib.Path(options.table)
    table.parent.mkdir(parents=True, exist_ok=True)
    with open(table, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["domain of e_min", "grains", "limit", "mean", "standard error", "seeds"])
        out.writerows(rows)
    print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
