# SPDX-License-Identifier: BSD-3-Clause
"""What a calibration leaves.   tested: tests/apps/calibrate_test.py"""
import json
import math
import pathlib
from typing import Any

from isostat.campaign import command
from isostat.campaign.calibrate.trials import Outcome, Trials
from isostat.campaign.folder import write_replacing
from isostat.campaign.runs import read_summary
from isostat.scene import toml_text

AT_BOUND = 0.01  # share of the bounds within which a value counts as being at one


def place_text(share: float) -> str:
    return "  AT THE LOWER BOUND" if share < AT_BOUND else "  AT THE UPPER BOUND" if share > 1 - AT_BOUND else ""


def remarks(parameters: list[Any]) -> str:
    return "".join(f"  {parameter.label}: {parameter.remark}\n" for parameter in parameters if parameter.remark)


def misfit_text(outcome: Outcome | None) -> str:
    return "-" if outcome is None else "failed" if outcome.failure else f"{outcome.misfit:.4f}"


def scatter(outcome: Outcome | None) -> float | None:
    return outcome.scatter if outcome else None


class Report:
    """Of trials, the first of which is the start; `ending`: why the search ended."""

    def __init__(self, trials: Trials, ending: str):
        self.trials, self.ending = trials, ending
        self.plan, self.scenes, self.parameters = trials.plan, trials.scenes, trials.scenes.parameters
        self.start = trials.all[0]
        self.best = trials.best() or self.start
        self.curves = list(zip(self.plan.curve, self.start.curves, self.best.curves))

    def parameter_table(self) -> str:
        width = max(len(parameter.label) for parameter in self.parameters)
        text = f"\n  {'parameter':<{width}} {'start':>14} {'best':>14}\n"
        for p, start, best in zip(self.parameters, self.start.values, self.best.values):
            text += f"  {p.label:<{width}} {p.number(start):>14} {p.number(best):>14}{place_text(p.share(best))}\n"
        return text + remarks(self.parameters)

    def curve_table(self) -> str:
        text = (f"\n  {'misfit of curve':<24} {'weight':>7} {'start':>10} {'best':>10} {'scatter':>10}  (of the best: "
                "standard error of its mean over the seeds)\n")
        for curve, start, best in self.curves:
            error = scatter(best)
            weight = "blind" if curve.blind else f"{curve.weight:g}"
            text += (f"  {curve.name:<24} {weight:>7} {misfit_text(start):>10} {misfit_text(best):>10} "
                     f"{'-' if error is None else format(error, '.4f'):>10}\n")
        text += f"  {'fitted, together':<24} {'':>7} {self.start.misfit:>10.4f} {self.best.misfit:>10.4f}\n"
        blind = [(curve.name, start, best) for curve, start, best in self.curves if curve.blind and start and best]
        worse = [name for name, start, best in blind if best.misfit > start.misfit + (best.scatter or 0)]
        return text + (f"  {len(worse)} of {len(blind)} blind curves became WORSE: {', '.join(worse)}\n" * bool(worse))

    def summary(self) -> str:
        failures = "".join(f"  failed: trial {trial.number}, {curve.name}, {outcome.failure}\n"
                           for trial in self.trials.all
                           for curve, outcome in zip(self.plan.curve, trial.curves) if outcome and outcome.failure)
        sizes = self.plan.specimens
        return (f"\n{self.plan.title}\n  {len(self.trials.all)} trials with {sizes.seeds} specimens of {sizes.grains} "
                f"grains; best: trial {self.best.number}\n  ended because {self.ending}\n{self.parameter_table()}"
                f"{self.curve_table()}{failures}\n  this call: {self.trials.runs_done} runs in "
                f"{command.duration_text(self.trials.seconds)}\n")

    def curves_csv(self) -> str:
        """Laboratory, start and best at the compared strains; an empty cell where a run failed."""
        text = ("curve,blind (-),eps_1 (-),q laboratory (Pa),q start (Pa),q best (Pa),q best s.d. (Pa),second,"
                "second laboratory,second start,second best,second best s.d.\n")
        for k, (curve, *outcomes) in enumerate(self.curves):
            start, best = (self.trials.comparison(trial, k) if outcome and not outcome.failure else None
                           for trial, outcome in zip((self.start, self.best), outcomes))
            there = best or start
            if not there:
                continue
            second = "eps_v (-)" if curve.test == "drained" else "p' (Pa)"
            columns = [[which[row] if which else None for which in (
                there.laboratory, start and start.mean, best and best.mean, best and best.deviation)] for row in (1, 2)]
            for i, strain in enumerate(there.laboratory.strain):
                q, other = ([("" if column is None else f"{column[i]:.6g}") for column in each] for each in columns)
                text += ",".join([curve.name, str(int(curve.blind)), f"{strain:.6g}", *q, second, *other]) + "\n"
        return text

    def numbers(self) -> dict[str, Any]:
        """calibrate.json, read by apps/figures/calibrate.py."""
        parameters = [{"label": p.label, "key": p.key, "curve": p.curve, "low": p.number(p.low),
                       "high": p.number(p.high), "log": p.is_log, "start": p.text(start), "best": p.text(best),
                       "bound": place_text(p.share(best))}
                      for p, start, best in zip(self.parameters, self.start.values, self.best.values)]
        curves = [{"name": curve.name, "test": curve.test, "blind": curve.blind, "weight": curve.weight,
                   "start": start and start.misfit, "best": best and best.misfit, "scatter": scatter(best),
                   "failure": best.failure if best else ""} for curve, start, best in self.curves]
        return {"title": self.plan.title, "trials": len(self.trials.all), "start": 1, "best": self.best.number,
                "misfit_start": self.start.misfit, "misfit_best": self.best.misfit, "ending": self.ending,
                "grains": self.plan.specimens.grains, "seeds": self.plan.specimens.seeds, "parameters": parameters,
                "curves": curves}

    def sand(self) -> str:
        """best_sand.toml: a sand for scenes (dem/scene/sand.hpp), prepared as the first fitted curve is."""
        done = [(curve, best.misfit) for curve, _, best in self.curves if best and not best.failure]
        first = next(curve for curve in self.plan.curve if not curve.blind)
        scene = self.scenes.full_test(self.best.values, first).to_dict()
        grading, contact, specimen = scene["grading"], scene["contact"], scene["specimen"]
        for table, key in ((grading, "grains"), (grading, "cloud_edge"), (grading, "seed"), (specimen, "pressure"),
                           (specimen, "cache")):
            table.pop(key, None)
        fitted, blind = ([(curve.name, misfit) for curve, misfit in done if curve.blind is which] for which in (False, True))
        sand = {"source": f"isostat calibrate, {self.plan.title}",
                "tests": "; ".join(f"{word}: {', '.join(name for name, _ in some) or 'none'}"
                                   for word, some in (("fitted", fitted), ("not fitted", blind)))}
        if fitted:
            pressures = [self.scenes.pressure(curve) / 1e3 for curve, _ in done]
            void_ratios = [read_summary(self.trials.place(self.best, curve, seed))["void_ratio"] for curve, _ in done
                           for seed in self.trials.seeds]
            sand |= {"misfit": round(self.best.misfit, 4), "lowest_pressure": f"{min(pressures):g} kPa",
                     "highest_pressure": f"{max(pressures):g} kPa", "lowest_void_ratio": round(min(void_ratios), 4),
                     "highest_void_ratio": round(max(void_ratios), 4),
                     "largest_strain": round(max(self.scenes.end(curve) for curve, _ in done), 6)}
        if blind:
            sand["blind_misfit"] = round(math.sqrt(sum(misfit**2 for _, misfit in blind) / len(blind)), 4)
        return toml_text({"sand": sand, "grading": grading, "contact": contact, "specimen": specimen})

    def leave(self, folder: pathlib.Path, figures: bool) -> None:
        """Leaves curves.csv, calibrate.json, best_scene.toml, best_sand.toml, best/CURVE.toml, summary.txt and figures."""
        (folder / "best").mkdir(exist_ok=True)
        write_replacing(folder / "best_scene.toml", self.scenes.full_scene(self.best.values).text)
        write_replacing(folder / "best_sand.toml", self.sand())
        for curve in self.plan.curve:
            write_replacing(folder / "best" / f"{curve.name}.toml", self.scenes.full_test(self.best.values, curve).text)
        write_replacing(folder / "curves.csv", self.curves_csv())
        write_replacing(folder / "calibrate.json", json.dumps(self.numbers(), indent=2, ensure_ascii=False) + "\n")
        command.leave(folder, self.summary(), "calibrate", figures)
        if self.trials.is_complete(self.best):
            print(f"  best set ready to run: {folder / 'best_scene.toml'}; with the state of each curve: "
                  f"{folder / 'best'}")
        else:
            print("  NO SET RAN: in every trial a run failed, and none can be recommended. Other bounds or densities "
                  "may.")
