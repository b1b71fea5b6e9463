#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The same test by element_test and from Python, alternately: steps per second, and whether the histories are equal.

    taskset -c 0 python3 benchmarks/python_speed.py                 # five rounds of 2,000 grains
    PYTHONPATH=build/release/python taskset -c 0 /usr/bin/python3 benchmarks/python_speed.py --rounds 9

Both run on one thread from one prepared specimen, write the same files and draw no figures.
"""
import argparse
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENE = """title = "speed"
[grading]
grains = {grains}
d50 = "0.45 mm"
[contact]
young = "1 GPa"
friction = "18 deg"
rolling = {{ stiffness = 0.3, limit = 0.5 }}
twisting = {{ stiffness = 0.3 }}
[specimen]
domain = "periodic-cell"
preparation_friction = "10 deg"
[[stage]]
kind = "undrained-cyclic"
deviator_amplitude = "40 kPa"
max_steps = {steps}
[output]
snapshots = "none"
paraview = false
"""


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--grains", type=int, default=2000)
    parser.add_argument("--steps", type=int, default=20000)
    parser.add_argument("--rounds", type=int, default=5)
    return parser.parse_args()


def main():
    arguments = parse()
    sys.path.insert(0, str(arguments.build / "python"))
    import isostat  # pylint: disable=import-outside-toplevel  (the build is an argument)
    text = SCENE.format(grains=arguments.grains, steps=arguments.steps)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "speed.toml").write_text(text, encoding="utf-8")
        scene, cache = isostat.Scene(folder / "speed.toml"), folder / "specimens"
        isostat.prepare(scene, cache=cache)
        rates = {"element_test": [], "Python": [], "Python, on_step": []}
        for k in range(arguments.rounds):
            subprocess.run([arguments.build / "bin/element_test", folder / "speed.toml", "-o", folder / f"p{k}", "-q",
                            "--no-figures", "--threads", "1"], check=True, stdout=subprocess.DEVNULL)
            isostat.run(scene, folder / f"m{k}", cache=cache, threads=1)
            isostat.run(scene, folder / f"s{k}", cache=cache, threads=1, on_step=lambda moment: moment.p > 0)
            for way, run in zip(rates, "pms"):
                summary = isostat.read(folder / f"{run}{k}").summary
                rates[way].append(summary["steps"] / summary["seconds"])
                same = (folder / f"{run}{k}/history.csv").read_bytes() == (folder / "p0/history.csv").read_bytes()
                if not same:
                    sys.exit(f"{run}{k}: another history than that of the program")
    print(f"{arguments.grains} grains, {arguments.rounds} alternating rounds, histories equal bit for bit")
    for way, values in rates.items():
        ratios = [value / program for value, program in zip(values, rates["element_test"])]
        print(f"{way:<16} {statistics.median(values):8.0f} steps/s   of the program {statistics.median(ratios):.3f} "
              f"({min(ratios):.3f} to {max(ratios):.3f})")


if __name__ == "__main__":
    main()
