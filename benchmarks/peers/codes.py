# SPDX-License-Identifier: BSD-3-Clause
"""Isostat and YADE in the comparison (LAMMPS and LIGGGHTS: lammps.py). Each has run(test) -> Figures: a block of
constant-volume shear, timed, and the state at its end."""
import dataclasses
import json
import pathlib

from . import packing as packings
from .process import PeerError, System, execute, last_lines

HERE = pathlib.Path(__file__).resolve().parent
MIN_SECONDS, MAX_RUNS = 0.5, 20  # a block is repeated, from the same start, until its timed seconds reach this


@dataclasses.dataclass
class Test:
    """What every code is given."""
    packing: packings.Packing  # in the order of the main comparison
    time_step: float
    rate: float
    warm_up: int
    steps: int
    threads: int
    cores: list
    folder: pathlib.Path  # scratch

    def n_steps(self):
        return self.warm_up + self.steps


@dataclasses.dataclass
class Figures:
    steps_per_s: float
    p: float  # kPa
    q: float  # kPa
    contacts: float  # between grains and with walls
    cores: float  # processor time over elapsed time; nan where unknown

    def nanoseconds(self):
        return 1e9 / self.steps_per_s / self.contacts


def repeated(run, steps):
    """Runs again until enough seconds are timed; speeds are those of all runs together, the state that of the last."""
    done = [run()]
    while sum(steps / f.steps_per_s for f in done) < MIN_SECONDS and len(done) < MAX_RUNS:
        done.append(run())
    return together(done)


def together(runs):
    speed = len(runs) / sum(1 / f.steps_per_s for f in runs)
    return dataclasses.replace(runs[-1], steps_per_s=speed, cores=min(f.cores for f in runs))


def timed(command, test):
    """Runs a program that writes its figures to the file named last, and returns its output and those figures."""
    times = test.folder / "times.json"
    times.unlink(missing_ok=True)
    out = execute([*command, times], test.cores, test.folder)
    if not times.exists():
        raise PeerError(f"{command[0]} wrote no figures; its last lines:\n{last_lines(out.text)}")
    return out, json.loads(times.read_text(encoding="utf-8"))[-1]


class Isostat:
    name = "isostat"

    def __init__(self, program, core):
        self.program = pathlib.Path(program).resolve()
        self.options = execute([self.program, "--help"], [core], None).text
        self.instruction_set = ""

    def has(self, option):
        return option in self.options

    def export(self, specimen, path, core):
        execute([self.program, specimen, "--export", path], [core], None)
        return packings.read_packing(path)

    def run(self, test, source, damping=None, twisting=True):
        """`source` is what whole_step reads: text of spheres, or a folder of tables with contact history."""
        command = [self.program, source, "--rate", test.rate, "--time-step", test.time_step, "--steps", test.steps,
                   "--warm-up", test.warm_up]
        command += ["--threads", test.threads] if test.threads > 1 else []
        command += ["--damping", damping] if damping is not None else []
        command += [] if twisting else ["--no-twisting"]

        def once():
            out, f = timed([*command, "--times"], test)
            self.instruction_set = f["instruction_set"]
            return Figures(f["steps_per_s"], f["p_kPa"], f["q_kPa"], f["contacts"], out.cores)
        return repeated(once, test.steps)


class Yade:
    program, package = "yade", "yade"
    tolerance = 0.01
    at_rest = False

    def __init__(self, name="yade", file=None, system=System(), twisting=True):
        """`file` is a packing that is not the main one, or a state saved by YADE."""
        self.name, self.file, self.system, self.twisting = system.label(name), file, system, twisting
        self.differs = {
            "yade": "Grains are stored by size, largest first, the order in which a packing is generated; contacts "
                    "start without history in both codes. Law, damping, walls, rate and step are the same.",
            "yade-morton": "As yade, but its grains are stored along the Morton curve that Isostat always uses.",
            "yade-state": "YADE continues from its own saved state with contact history, grains as generated; Isostat "
                          "from the tables of that state, with the same history. YADE needs about twice the time per "
                          "step after it has loaded a state than for the same packing built in the running program, "
                          "whatever the order of its grains.",
        }[name]
        if not twisting:
            self.differs += " Neither code has twisting moments."

    def version(self):
        return "YADE " + self.system.version(self.package)

    def install(self, threads):
        self.system.install(self.program, self.package)

    def run(self, test):
        path = self.file
        if path is None:
            path = test.folder / "by_size.txt"
            packings.write_packing(path, test.packing)
        command = ["yade", "-n", "-x", f"-j{test.threads}", HERE / "yade_shear.py", path, test.rate, test.time_step,
                   test.warm_up, test.steps, int(self.twisting)]
        _, f = timed(self.system.inside(command), test)
        if f.get("grains") != len(test.packing.spheres):
            raise PeerError(f"{path} has {f.get('grains', 0):.0f} grains, the specimen has {len(test.packing.spheres)}")
        return Figures(f["steps_per_s"], f["p_kPa"], f["q_kPa"], f["contacts"], f["cores"])
