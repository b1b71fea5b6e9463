# SPDX-License-Identifier: BSD-3-Clause
"""The trials of a calibration and their runs.   tested: tests/apps/calibrate_test.py"""
import concurrent.futures
import dataclasses
import pathlib
import time
from collections import Counter
from collections.abc import Iterable
from typing import Any

from isostat import _core
from isostat.campaign import command
from isostat.campaign.calibrate.curves import Comparison, compare, read_laboratory, read_model, total_misfit
from isostat.campaign.calibrate.scenes import Parameter, SceneMaker
from isostat.campaign.folder import write_replacing
from isostat.campaign.runs import CRASHED, Run, complete


@dataclasses.dataclass
class Outcome:
    """Result of the runs of one curve in one trial."""

    misfit: float  # the penalty of a curve that failed
    scatter: float | None = None
    failure: str = ""  # why one of its runs failed


@dataclasses.dataclass
class Trial:
    number: int  # from 1
    id: str  # its folder, from the values
    values: list[float]  # of the parameters
    curves: list[Outcome | None]  # of the plan; None: not computed (blind)
    misfit: float = 0  # of the fitted curves
    done: bool = False


def trial_id(parameters: list[Parameter], values: list[float]) -> str:
    """FNV-1a of the values as scenes have them. Folders of earlier calls depend on it."""
    hashed = 14695981039346656037
    for parameter, value in zip(parameters, values):
        for byte in f"{parameter.curve} {parameter.key}={parameter.text(value)}\n".encode():
            hashed = (hashed ^ byte) * 1099511628211 % 2**64
    return f"{hashed:016x}"


class Trials:
    """Runs trials, and answers those that have been run from what they left. A run that has finished, or failed by
    itself, is never run again; one that was killed continues from its checkpoint."""

    def __init__(self, plan: Any, scenes: SceneMaker, folder: pathlib.Path, executor: concurrent.futures.Executor,
                 quiet: bool):
        self.plan, self.scenes, self.folder, self.executor = plan, scenes, folder, executor
        self.laboratory = [read_laboratory(curve, scenes.pressure(curve)) for curve in plan.curve]
        self.by_id: dict[str, Trial] = {}
        self.last: Trial | None = None  # to end
        self.runs_done, self.computed, self.begin = 0, 0, time.monotonic()  # of this call
        self.progress = command.Progress(self.state, quiet)

    @property
    def seconds(self) -> float:
        return time.monotonic() - self.begin

    def is_complete(self, trial: Trial) -> bool:
        """Whether no run of a fitted curve failed."""
        return not any(outcome and outcome.failure and not curve.blind
                       for curve, outcome in zip(self.plan.curve, trial.curves))

    @property
    def all(self) -> list[Trial]:
        return list(self.by_id.values())

    def best(self) -> Trial | None:
        """Smallest misfit, the first of equals; of trials all of whose fitted curves ran, if there are any."""
        done = [trial for trial in self.all if trial.done]
        return min(done, key=lambda trial: (not self.is_complete(trial), trial.misfit), default=None)

    def is_known(self, values: list[float]) -> bool:
        return trial_id(self.scenes.parameters, values) in self.by_id

    def evaluate(self, points: Iterable[list[float]]) -> list[Trial]:
        """The fitted curves of points, all runs side by side.

        Raises KeyboardInterrupt, RunFailure (a run crashed or was killed)
        """
        trials = []
        for values in points:
            name = trial_id(self.scenes.parameters, values)
            trials.append(self.by_id.setdefault(name, Trial(len(self.by_id) + 1, name, values,
                                                            [None] * len(self.plan.curve))))
        self.execute({trial.id: trial for trial in trials if not trial.done}.values(), False)
        return trials

    def place(self, trial: Trial, curve: Any, seed: int) -> pathlib.Path:
        return self.folder / "runs" / trial.id / f"{curve.name}_seed{seed}"

    @property
    def seeds(self) -> range:
        return range(self.plan.specimens.first_seed, self.plan.specimens.first_seed + self.plan.specimens.seeds)

    def prepared_run(self, trial: Trial, curve: Any, seed: int) -> Run | None:
        """None: it need not be run. If no scene can be made from the values, that is a failure of the run."""
        at = self.place(trial, curve, seed).absolute()
        if beside(at, "failed").exists():
            return None
        try:
            text = self.scenes.trial(trial.values, curve, seed).text
        except _core.InputError as error:
            at.parent.mkdir(parents=True, exist_ok=True)
            write_replacing(beside(at, "failed"), str(error))
            return None
        run = Run(f"{at.parent.name}/{at.name}", text, beside(at, "toml"), at, beside(at, "log"))
        return None if run.is_finished else run

    def execute(self, trials: Iterable[Trial], blind: bool) -> None:
        """All runs of some trials that have not been done, side by side."""
        trial_of: dict[Run, Trial] = {}
        crashed = ""
        for trial in trials:
            runs = [self.prepared_run(trial, curve, seed) for curve in self.plan.curve if curve.blind == blind
                    for seed in self.seeds]
            trial_of |= {run: trial for run in runs if run}
            if not any(runs):
                self.conclude(trial, blind)
        left = Counter(trial.id for trial in trial_of.values())

        def ended(run, code, _):
            nonlocal crashed
            if code >= CRASHED:
                crashed = f"{run.results}: ended with code {code}: {run.reason}"
                return
            self.runs_done += 1
            if code:
                write_replacing(beside(run.results, "failed"), run.reason)
            left[trial_of[run].id] -= 1
            if not left[trial_of[run].id]:
                self.computed += 1
                self.conclude(trial_of[run], blind)

        complete(self.executor, trial_of, ended, self.progress.waiting)
        if crashed:
            raise _core.RunFailure(f"{crashed}\n  It was stopped from outside or crashed. What has been run is kept, "
                                   "the same command tries it again.")

    def outcome(self, trial: Trial, number: int) -> Outcome:
        curve = self.plan.curve[number]
        for seed in self.seeds:
            if (failed := beside(self.place(trial, curve, seed), "failed")).exists():
                return Outcome(self.plan.misfit.penalty, None, f"seed {seed}: {failed.read_text(encoding='utf-8')}")
        try:
            result = self.comparison(trial, number)
        except _core.InputError as error:
            return Outcome(self.plan.misfit.penalty, None, str(error))
        return Outcome(result.misfit, result.scatter)

    def comparison(self, trial: Trial, number: int) -> Comparison:
        """The curves behind an outcome, which did not fail."""
        curve = self.plan.curve[number]
        models = [read_model(self.place(trial, curve, seed), curve) for seed in self.seeds]
        return compare(self.laboratory[number], models, curve, self.plan.misfit)

    def conclude(self, trial: Trial, blind: bool) -> None:
        for k, curve in enumerate(self.plan.curve):
            if curve.blind == blind:
                trial.curves[k] = self.outcome(trial, k)
        if blind:
            return
        trial.misfit = total_misfit([outcome.misfit if outcome else 0 for outcome in trial.curves], self.plan)
        trial.done, self.last = True, trial
        write_replacing(self.folder / "trials.csv", self.table())
        self.progress.say("")

    def state(self) -> str:
        """" 12 %  trial 7 of at most 60: misfit 0.1320, best 0.0980 in trial 4, ETA 20 min at most"."""
        done, most, best = sum(trial.done for trial in self.all), self.plan.budget.trials, self.best()
        if best is None or self.last is None:
            return f"  0 %  of at most {most} trials"
        failed = "" if self.is_complete(self.last) else " (a run FAILED)"
        text = (f"{100 * done / most:3.0f} %  trial {self.last.number} of at most {most}: "
                f"misfit {self.last.misfit:.4f}{failed}, best {best.misfit:.4f} in trial {best.number}")
        if self.computed and done < most:
            text += f", ETA {command.duration_text((most - done) * self.seconds / self.computed)} at most"
        return text

    def table(self) -> str:
        """trials.csv: number, values in the units of the keys, misfits, folder."""
        fitted = [(k, curve.name) for k, curve in enumerate(self.plan.curve) if not curve.blind]
        rows = [["trial (-)", *(parameter.label for parameter in self.scenes.parameters), "misfit (-)",
                 *(f"misfit of {name} (-)" for _, name in fitted), "failed curves", "folder"]]
        for trial in self.all:
            if trial.done:
                outcomes = [(name, trial.curves[k]) for k, name in fitted]
                rows.append([str(trial.number), *(p.number(value) for p, value in zip(self.scenes.parameters, trial.values)),
                             f"{trial.misfit:.6f}", *(f"{outcome.misfit:.6f}" for _, outcome in outcomes if outcome),
                             " ".join(name for name, outcome in outcomes if outcome and outcome.failure),
                             f"runs/{trial.id}"])
        return "".join(",".join(row) + "\n" for row in rows)


def beside(results: pathlib.Path, ending: str) -> pathlib.Path:
    return results.with_name(f"{results.name}.{ending}")
