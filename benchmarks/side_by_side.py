#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Isostat, YADE, LAMMPS and LIGGGHTS on the same packing, law and cores, interleaved: ratios of steps per second.

    side_by_side.py SPECIMEN... [--peers yade,lammps,liggghts] [--debian trixie] [--native] [--threads 1,2] [--rounds 5]

SPECIMEN is what `whole_step` reads: a specimen (.h5), text of spheres (x y z r, box in a comment), or a folder of
tables comp_{particles,contacts,walls}_step0. It is exported as text, and every code starts from that text: no contact
has a history. Each shears the packing at constant volume, at the same rate and time step; the first --warm-up steps are
not timed.
Peers are Debian packages, installed if they are missing (apt-get, as root or with sudo). YADE and LAMMPS can also be
those of other Debians (--debian trixie: yade@trixie, lammps@trixie), each run in a folder that holds that system
(scripts/other_debian.sh), and LAMMPS also one built from Debian's source for this processor (--native: lammps-native).

  yade      grains stored by size, as generated; and `yade-morton`, stored along a space-filling curve as ours are
  --no-twisting  leaves twisting moments out of all codes: YADE 2025.2 has none without a limit (docs/theory.md)
  yade-state  (with --yade-state) YADE from its own saved state, ours from the folder of tables, both with history
  lammps    pair_style granular, one constant stiffness matched to the mean stress of the packing
  liggghts  hooke/stiffness with epsd2, likewise; and `liggghts-static`: rate 0 in both codes, walls at rest, because
            the meshes that are its moving walls cost it a quarter of its time

In each round isostat runs before and after each peer. A round prints both speeds, and p', q and contacts of both codes
after the same number of steps: where they differ by more than 1 % (yade) or 5 % (lammps, liggghts) the ratio is
marked as not one of the same test. Lines for programs to read:

    ratio <peer> <grains> <threads> <median>

What differs between the codes is printed and written, with machine and versions, to --report.
Exit code 0: done; 1: a program failed, or two codes did not run the same test; 2: bad input, nothing written."""
import argparse
import dataclasses
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

from peers import packing as packings
from peers import report
from peers.codes import Isostat, Test, Yade, together
from peers.lammps import Lammps, Liggghts, LiggghtsStatic
from peers.process import PeerError, System

ROOT = pathlib.Path(__file__).resolve().parent.parent
PEERS = ("yade", "lammps", "liggghts")


class BadInput(Exception):
    pass


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("specimens", nargs="+", metavar="SPECIMEN", help="specimen (.h5), text of spheres or folder of tables")
    add("--peers", default=",".join(PEERS), help="any of yade,lammps,liggghts (default: all)")
    add("--threads", default="1", help="numbers of threads, such as 1,2: MPI ranks in LAMMPS and LIGGGHTS (default: 1)")
    add("--rounds", type=int, default=5, help="alternating rounds of which medians are taken (default: 5)")
    add("--cores", default=",".join(map(str, sorted(os.sched_getaffinity(0)))),
        help="cores to pin to; T threads use the first T (default: those this command may use)")
    add("--build", default=str(ROOT / "build" / "release"), help="build tree of isostat (default: build/release)")
    add("--rate", type=float, default=5, help="axial strain rate, 1/s (default: 5)")
    add("--time-step", type=float, help="s (default: 4.8e-8, below 5,000 grains 5e-8)")
    add("--warm-up", type=int, default=500, help="untimed steps (default: 500)")
    add("--steps", type=int, default=1000, help="timed steps (default: 1000)")
    add("--yade-state", action="append", default=[], metavar="FILE.yade.bz2",
        help="state of YADE that belongs to a folder of tables; once per folder, in their order")
    add("--debian", default="", help="other suites of Debian whose YADE and LAMMPS run as well, such as trixie")
    add("--native", action="store_true", help="LAMMPS also from this Debian's source, -O3 -march=native (minutes)")
    add("--twisting", choices=("sds", "marshall"), default="sds", help="twisting model of LAMMPS (default: sds)")
    add("--no-twisting", action="store_true", help="no twisting moments in any code; not with liggghts")
    add("--skin", type=float, default=0.05, help="skin of LAMMPS and LIGGGHTS, in mean radii (default: 0.05)")
    add("--report", default=str(ROOT / "results" / "side_by_side.md"),
        help="page of results, written when all rounds are done (default: results/side_by_side.md)")
    add("--no-report", action="store_true", help="print only")
    return parser.parse_args()


def numbers(text, option, least):
    try:
        values = [int(word) for word in text.split(",")]
    except ValueError:
        values = []
    if not values or min(values) < least:
        raise BadInput(f"{option} {text}: expected whole numbers from {least}, separated by commas")
    return values


def check(options):
    """Options as lists; BadInput before anything is installed, run or written."""
    options.peers = options.peers.split(",")
    for peer in options.peers:
        if peer not in PEERS:
            raise BadInput(f"--peers {peer}: expected some of {','.join(PEERS)}")
    options.systems = [System()] + [System(suite) for suite in options.debian.split(",") if suite]
    if options.no_twisting and ("liggghts" in options.peers or options.yade_state):
        raise BadInput("--no-twisting: LIGGGHTS's rolling and a saved state of YADE have twisting; leave them out")
    options.threads = numbers(options.threads, "--threads", 1)
    options.cores = numbers(options.cores, "--cores", 0)
    if max(options.threads) > len(options.cores):
        raise BadInput(f"--threads {max(options.threads)} on {len(options.cores)} cores: give more with --cores")
    for name, least in (("rounds", 1), ("steps", 1), ("warm_up", 1)):
        if getattr(options, name) < least:
            raise BadInput(f"--{name.replace('_', '-')} {getattr(options, name)}: must be at least {least}")
    for name in ("rate", "time_step", "skin"):
        if getattr(options, name) is not None and not getattr(options, name) > 0:
            raise BadInput(f"--{name.replace('_', '-')} {getattr(options, name)}: must be above 0")
    for path in options.specimens + options.yade_state:
        if not os.path.exists(path):
            raise BadInput(f"{path}: there is no such file or folder")
    options.specimens = [os.path.abspath(path) for path in options.specimens]
    folders = [path for path in options.specimens if os.path.isdir(path)]
    if len(options.yade_state) > len(folders):
        raise BadInput(f"--yade-state given {len(options.yade_state)} times for {len(folders)} folders of tables")
    options.state_of = dict(zip(folders, map(os.path.abspath, options.yade_state)))
    program = pathlib.Path(options.build) / "bin" / "whole_step"
    if not program.exists():
        raise BadInput(f"{program} does not exist; build it: cmake --preset release && "
                       "cmake --build --preset release --target whole_step")
    isostat = Isostat(program, options.cores[0])
    if max(options.threads) > 1 and not isostat.has("--threads"):
        raise BadInput(f"{program} has no option --threads; ask for --threads 1")
    return isostat


def codes_of(peer, options, isostat, morton=None):
    """The codes of a peer: of each Debian, and as they are compared."""
    undamped, twisting = isostat.has("--damping"), not options.no_twisting
    for system in options.systems:
        if peer == "yade":
            yield Yade("yade", None, system, twisting)
            yield Yade("yade-morton", morton, system, twisting)
        elif peer == "lammps":
            model = options.twisting if twisting else "none"
            yield Lammps(undamped, options.skin, model, system)
            if options.native and not system.suite:
                yield Lammps(undamped, options.skin, model, native=True)
    if peer == "liggghts":
        yield Liggghts(undamped, options.skin)
        yield LiggghtsStatic(undamped, options.skin)


def peers_on(specimen, options, isostat, folder, morton):
    """(code, what whole_step reads, its damping) of every comparison on one specimen."""
    for peer in options.peers:
        damping = 0 if peer != "yade" and isostat.has("--damping") else None
        for code in codes_of(peer, options, isostat, morton):
            yield code, folder / "packing.txt", damping
        if peer == "yade" and specimen in options.state_of:
            yield Yade("yade-state", options.state_of[specimen]), specimen, None


def export(isostat, specimen, morton, options):
    """The specimen as text along the Morton curve; BadInput if it cannot be read or does not suit the peers."""
    try:
        packing = isostat.export(specimen, morton, options.cores[0])
        if set(options.peers) & {"lammps", "liggghts"}:
            packings.matched_stiffness(packing)
        return packing
    except (PeerError, ValueError) as error:
        raise BadInput(f"{specimen}: {error}") from error


def compare_on(specimen, options, isostat, folder):
    """All rounds on one specimen, for all numbers of threads."""
    morton = folder / "morton.txt"
    packing = packings.by_size(export(isostat, specimen, morton, options))
    packings.write_packing(folder / "packing.txt", packing)
    grains = len(packing.spheres)
    dt = options.time_step or (4.8e-8 if grains >= 5000 else 5e-8)
    done = []
    for threads in options.threads:
        test = Test(packing, dt, options.rate, options.warm_up, options.steps, threads, options.cores[:threads], folder)
        runs = list(peers_on(specimen, options, isostat, folder, morton))
        comparisons = [report.Comparison(code, public_name(specimen), grains, threads, dt, test.n_steps())
                       for code, _, _ in runs]
        for number in range(1, options.rounds + 1):
            for comparison, (code, source, damping) in zip(comparisons, runs):
                shared = dataclasses.replace(test, rate=0.0) if code.at_rest else test
                before = isostat.run(shared, source, damping, not options.no_twisting)
                peer = code.run(shared)
                after = isostat.run(shared, source, damping, not options.no_twisting)
                comparison.rounds.append(report.Round(together([before, after]), peer))
                print(report.round_line(number, options.rounds, comparison, comparison.rounds[-1]), flush=True)
                for line in report.warnings(comparison, comparison.rounds[-1]):
                    print(line, flush=True)
        done += comparisons
    return done


def public_name(path):
    """Inside the repository the path from its root, elsewhere the last name only: results name no machine's folders."""
    path = pathlib.Path(path)
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else path.name


def public_command():
    """The command as the page shows it: without where it writes and without folders outside the repository."""
    words, given = [], iter(sys.argv[1:])
    for word in given:
        if word in ("--report", "--build"):
            next(given, None)
        elif not word.startswith(("--report=", "--build=")):
            words.append(public_name(os.path.abspath(word)) if "/" in word or os.path.isdir(word) else word)
    return shlex.join(["python3", "benchmarks/side_by_side.py", *words])


def version_of_isostat(isostat):
    found = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty"], capture_output=True, text=True)
    return f"Isostat at commit {found.stdout.strip() or 'unknown'}, instruction set {isostat.instruction_set}"


def run(options):
    isostat = check(options)
    with tempfile.TemporaryDirectory() as scratch:
        for number, specimen in enumerate(options.specimens):  # all can be read, before hours are spent on the first
            export(isostat, specimen, pathlib.Path(scratch) / f"check{number}.txt", options)
        for peer in options.peers:
            for code in codes_of(peer, options, isostat):
                code.install(max(options.threads))
        comparisons = []
        for number, specimen in enumerate(options.specimens):
            folder = pathlib.Path(scratch) / str(number)
            folder.mkdir()
            comparisons += compare_on(specimen, options, isostat, folder)
    codes = {c.code.name: c.code for c in comparisons}
    for name, code in codes.items():
        print(f"differs {name}: {code.differs}")
    for comparison in comparisons:
        print("\n".join(report.ratio_lines(comparison)))
    if not options.no_report:
        versions = [version_of_isostat(isostat)] + sorted({code.version() for code in codes.values()})
        page = report.page(comparisons, public_command(), options.build, versions, options.rounds)
        report.write_replacing(options.report, page)
    return 0 if all(c.is_same_test() for c in comparisons) else 1


def main():
    try:
        return run(parse_arguments())
    except BadInput as error:
        print(f"side_by_side: {error}", file=sys.stderr)
        return 2
    except PeerError as error:
        print(f"side_by_side: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
