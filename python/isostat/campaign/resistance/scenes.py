# SPDX-License-Identifier: BSD-3-Clause
"""The scenes of a resistance curve: one cyclic scene at several amplitudes on several specimens.

tested: tests/apps/resistance_test.py
"""
import argparse
import math
import pathlib

from isostat import _core
from isostat.campaign.resistance.outcome import Kind, Outcome
from isostat.campaign.runs import Run
from isostat.campaign.scenes import below_campaign, in_si
from isostat.figures.files import NOT_SHEARED
from isostat.scene import Scene

ENOUGH = 0.04  # of gamma, beyond which nothing is left to be seen
KINDS = {"undrained-cyclic": Kind("triaxial", "q_amp / (2 p0')", "eps_y", 1.5),
         "undrained-cyclic-simple-shear": Kind("simple shear", "tau_amp / sigma'_v0", "gamma_xy", 1)}


def parse_ratios(text: str) -> list[float]:
    """"0.10,0.13, 0.2" as numbers.   Raises InputError"""
    ratios: list[float] = []
    for word in text.replace(",", " ").split():
        try:
            ratio = float(word)
        except ValueError:
            ratio = math.nan
        if not 0 < ratio <= 1:
            raise _core.InputError(f"--ratios {text}: \"{word}\" is not a number in (0, 1]. Give cyclic stress ratios "
                                   "between commas, e.g. --ratios 0.10,0.15,0.20.")
        if f"{ratio:g}" in [f"{other:g}" for other in ratios]:  # as runs are named
            raise _core.InputError(f"--ratios {text}: {ratio:g} appears twice. For more tests at a ratio raise "
                                   "--realisations.")
        ratios.append(ratio)
    if not ratios:
        raise _core.InputError("--ratios holds no number. Give cyclic stress ratios between commas, e.g. --ratios "
                               "0.10,0.15,0.20.")
    return ratios


class Campaign:
    """A cyclic scene, run at several amplitudes on several specimens."""

    def __init__(self, scene: Scene, ratios: list[float], options: argparse.Namespace):
        self.title, self.ratios, self.seeds = scene.title, ratios, range(1, options.realisations + 1)
        self.limit = options.cycles
        shared = scene.to_dict()
        self.stages = shared.get("stage", [])
        self.kind = self._cyclic()
        self.p0 = self._consolidation(shared["specimen"])
        if shared["specimen"].get("file") and options.realisations > 1:
            raise _core.InputError(f"{self.title}: specimen.file is one specimen, which no seed changes. Give "
                                   "--realisations 1, or let the scene prepare its specimens.")
        cyclic = self.stages[-1]
        for key in ("deviator_amplitude", "stress_ratio"):
            cyclic.pop(key, None)  # what differs between the runs is not part of what they share
        until = cyclic.setdefault("until", {})
        until["cycles"], until["reversals_after_liquefaction"] = options.cycles, options.reversals_after
        until["strain"] = self.max_strain = min(until["strain"], ENOUGH / self.kind.gamma_factor)
        self.liquefaction_ratio = cyclic["liquefaction_ratio"]
        shared["grading"]["seed"] = 1
        below_campaign(shared)
        self.shared = shared

    def _cyclic(self) -> Kind:
        n_shear = sum(stage["kind"] not in NOT_SHEARED and not stage.get("consolidation") for stage in self.stages)
        if not any(stage["kind"] in KINDS for stage in self.stages):
            raise _core.InputError(f"{self.title}: no cyclic stage, so there is no CSR to vary. Give a scene with kind = "
                                   "\"undrained-cyclic-simple-shear\" or \"undrained-cyclic\", e.g. "
                                   "quick_cyclic_simple_shear.toml.")
        if n_shear > 1 or self.stages[-1]["kind"] not in KINDS:
            raise _core.InputError(f"{self.title}: {n_shear} shear stages of {len(self.stages)} stages; the cyclic stage "
                                   "must be the last and the only one that shears. Leave the others out.")
        return KINDS[self.stages[-1]["kind"]]

    def _consolidation(self, specimen) -> float:
        """p0' before the stage, as the scene asks for it, Pa."""
        standard = specimen.get("pressure", "200 kPa")
        pressure, isotropic = standard, specimen.get("consolidation", "isotropic") == "isotropic"
        for stage in self.stages[:-1]:
            if stage["kind"] in ("compress", "rebalance"):
                pressure, isotropic = stage.get("pressure", standard), True
            elif stage["kind"] == "k0-compress":
                isotropic = False
        if not isotropic and self.kind.test == "triaxial":
            raise _core.InputError(f"{self.title}: consolidated without lateral strain; CSR = q_amp / (2 p0') of a "
                                   "triaxial test needs isotropic consolidation. Take it, or cyclic simple shear.")
        return in_si(pressure)

    def scene(self, seed: int, ratio: float | None = None) -> Scene:
        """Of a run; without a ratio one that only prepares its specimen."""
        what = "specimen" if ratio is None else f"CSR {ratio:g}"
        scene = self.shared | {"title": f"{self.title}; {what}, seed {seed}",
                               "grading": self.shared["grading"] | {"seed": seed}}
        if ratio is None:
            del scene["stage"]
        else:
            scene["stage"] = [*self.stages[:-1], self.stages[-1] | self.kind.amplitude(ratio, self.p0)]
        return Scene(scene)

    def runs(self, folder: pathlib.Path) -> list[tuple[Run, Outcome]]:
        """Seed by seed, highest ratio first."""
        return [(Run.below(folder, f"csr{ratio:g}_seed{seed}", self.scene(seed, ratio)),
                 Outcome(ratio, seed)) for seed in self.seeds for ratio in sorted(self.ratios, reverse=True)]

    def preparations(self, folder: pathlib.Path, runs: list[tuple[Run, Outcome]]) -> list[tuple[Run, int]]:
        """Runs that only prepare a specimen that unfinished runs need, with its seed: so that these, side by side, do not
        prepare the same one."""
        needed = sorted({outcome.seed for run, outcome in runs if not run.is_finished})
        if self.shared["specimen"].get("file"):
            return []
        preparing = [(Run.below(folder, f"specimen_seed{seed}", self.scene(seed)), seed)
                     for seed in needed]
        return [(run, seed) for run, seed in preparing if not run.is_finished]

    def take(self, run: Run, outcome: Outcome, code: int = 0) -> None:
        """Notes what a run came to."""
        try:
            if code == 0:
                outcome.read(run.results, len(self.stages) - 1, self.kind, self.max_strain)
            elif code != 130:
                outcome.status, outcome.note = "failed", f"exit code {code}: {run.reason}"
        except _core.InputError as error:  # its files are damaged
            outcome.status, outcome.note = "failed", str(error)
