#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Isostat and YADE on the same packing, law and core, interleaved: ratio of steps per second.

    side_by_side.py SPECIMEN.h5 [--build build/release] [--rounds 5] [--core 0] [--rate 5] [--time-step 4.8e-8]

Installs YADE from Debian if it is missing. Both codes read the same text of spheres and box (contacts start without
history in both), shear it at constant volume at the same rate and time step, first 500 steps untimed. Rounds alternate
A B A B; each prints both speeds, and the stresses both have reached show that they ran the same test. The last line is
`ratio yade <grains> <threads> <median>`.
"""
import argparse
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def install_yade():
    if shutil.which("yade"):
        return
    print("installing yade", flush=True)
    prefix = [] if subprocess.run(["id", "-u"], capture_output=True, text=True).stdout.strip() == "0" else ["sudo"]
    subprocess.run(prefix + ["apt-get", "install", "-y", "--no-install-recommends", "yade"], check=True,
                   stdout=subprocess.DEVNULL)


def run(command, name):
    """The figures of one timed block, as a dictionary."""
    out = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    lines = [line for line in out.stdout.splitlines() if line.startswith(name + " ")]
    if not lines:
        sys.exit(f"{name} printed no figures:\n{out.stdout[-2000:]}\n{out.stderr[-2000:]}")
    return {key: float(value) for key, value in re.findall(r"(\w+) ([-+0-9.e]+)(?= |$)", lines[-1][len(name) + 1:])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("specimen")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--core", default="0")
    parser.add_argument("--rate", type=float, default=5)
    parser.add_argument("--time-step", type=float, default=4.8e-8)
    parser.add_argument("--yade-steps", type=int, default=300)
    parser.add_argument("--our-steps", type=int, default=3000)
    options = parser.parse_args()
    install_yade()
    ours = pathlib.Path(options.build) / "bin" / "whole_step"
    pin = ["taskset", "-c", options.core]
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        packing = str(pathlib.Path(folder) / "packing.txt")
        subprocess.run([str(ours), options.specimen, "--export", packing], check=True)
        grains = sum(1 for line in open(packing) if not line.startswith("#"))
        for number in range(options.rounds):
            a = run(pin + [str(ours), packing, "--rate", str(options.rate), "--time-step", str(options.time_step),
                           "--steps", str(options.our_steps), "--warm-up", "500"], "isostat")
            b = run(pin + ["yade", "-n", "-x", "-j1", str(HERE / "peers" / "yade_shear.py"), packing, str(options.rate),
                           str(options.time_step), str(options.yade_steps), "1"], "yade")
            # the same test: our stresses after as many steps as YADE took
            check = run(pin + [str(ours), packing, "--rate", str(options.rate), "--time-step", str(options.time_step),
                               "--steps", str(options.yade_steps), "--warm-up", "500"], "isostat")
            ratios.append(a["steps_per_s"] / b["steps_per_s"])
            print(f"round {number + 1}: isostat {a['steps_per_s']:.1f} steps/s ({a['ns_per_contact_step']:.1f} ns per contact), "
                  f"yade {b['steps_per_s']:.2f} steps/s ({b['ns_per_contact_step']:.0f} ns), ratio {ratios[-1]:.1f}; "
                  f"after {500 + options.yade_steps} steps p' {check['p_kPa']:.2f} / {b['p_kPa']:.2f} kPa, "
                  f"q {check['q_kPa']:.2f} / {b['q_kPa']:.2f} kPa, contacts {check['contacts']:.0f} / {b['contacts']:.0f}",
                  flush=True)
    print(f"ratio yade {grains} 1 {statistics.median(ratios):.1f}")


if __name__ == "__main__":
    main()
