# SPDX-License-Identifier: BSD-3-Clause
"""What a resistance curve leaves: tables, fit, summary, figure.   tested: tests/apps/resistance_test.py"""
import json
import math
import pathlib
from typing import Any

from isostat.campaign import command
from isostat.campaign.folder import write_replacing
from isostat.campaign.resistance.outcome import REFERENCE, Outcome, fit_power_law
from isostat.campaign.resistance.scenes import Campaign


def table_text(outcomes: list[Outcome]) -> str:
    """resistance.csv: one row per run; what was not reached is an empty cell."""
    def cell(value, form):
        return "" if value is None else format(value, form)
    rows = ["CSR (-),seed (-),N_liquefaction (-),N_double_amplitude_3 (-),N_single_amplitude_3.75 (-),N_applied (-),e (-),"
            "wall (s),status"]
    rows += [",".join([f"{r.ratio:g}", str(r.seed), cell(r.to_liquefaction, "g"), cell(r.to_double_amplitude, "g"),
                       cell(r.to_single_amplitude, "g"), f"{r.cycles:g}", cell(r.void_ratio, ".5f"),
                       cell(r.seconds, ".1f"), r.status]) for r in outcomes]
    return "\n".join(rows) + "\n"


def mean_text(values: list[float | None]) -> str:
    """Geometric mean; "-" unless all runs have a value."""
    return "-" if None in values else f"{math.exp(sum(map(math.log, values)) / len(values)):.1f}"


def cycles_text(outcome: Outcome) -> str:
    return {"liquefied": f"{outcome.to_liquefaction or 0:g}", "censored": f">{outcome.cycles:g}",
            "missing": "-"}.get(outcome.status, outcome.status)


def fit_text(fit: dict[str, Any] | None, outcomes: list[Outcome]) -> str:
    if not fit:
        return "  fit                      none: fewer than two ratios have a run that liquefied, or all within a cycle"
    error = (f"b +- {fit['b_error']:.3f}, R^2 = {fit['R2']:.3f}" if fit["b_error"] is not None
             else "whose error two runs cannot give")
    left_out = f" ({fit['left_out']} did not liquefy and are left out)" if fit["left_out"] else ""
    reached = [outcome.to_liquefaction for outcome in outcomes if outcome.to_liquefaction is not None]
    outside = "" if min(reached) <= REFERENCE <= max(reached) else " (extrapolated)"
    return (f"  fit                      CSR = {fit['a']:.4f} N^-{fit['b']:.3f}, {error}, {fit['runs']} runs{left_out}\n"
            f"  CSR at 15 cycles         {fit['CSR_15']:.4f}{outside}")


def summary_text(campaign: Campaign, outcomes: list[Outcome], fit: dict[str, Any] | None) -> str:
    lines = ["", campaign.title, f"  CSR                      {campaign.kind.ratio}, {campaign.kind.test}",
             f"  liquefied                p'/p0' < {campaign.liquefaction_ratio:g}; at most {campaign.limit} cycles",
             "  cycles                   half the reversals; means over seeds are geometric, - if a run has none", "",
             f"  {'CSR':>6}  {'mean N':>8}  {'N 3 % DA':>9}  {'N 3.75 % SA':>12}  N to liquefaction, seed by seed"]
    for ratio in sorted(campaign.ratios):
        runs = [outcome for outcome in outcomes if outcome.ratio == ratio]
        means = [mean_text([getattr(outcome, name) for outcome in runs])
                 for name in ("to_liquefaction", "to_double_amplitude", "to_single_amplitude")]
        lines.append(f"  {ratio:>6g}  {means[0]:>8}  {means[1]:>9}  {means[2]:>12}  {', '.join(map(cycles_text, runs))}")
    lines += ["", fit_text(fit, outcomes)]
    found = [outcome.void_ratio for outcome in outcomes if outcome.void_ratio is not None]
    if found:
        seconds = sum(outcome.seconds or 0 for outcome in outcomes)
        lines += [f"  void ratios              {min(found):.4f} to {max(found):.4f}",
                  f"  wall time of the runs    {seconds / 60:.1f} min"]
    lines += [f"  failed: CSR {outcome.ratio:g}, seed {outcome.seed}: {outcome.note}" for outcome in outcomes
              if outcome.status == "failed"]
    return "\n".join(lines) + "\n"


def report(campaign: Campaign, outcomes: list[Outcome], folder: pathlib.Path, figures: bool) -> None:
    """Leaves resistance.csv, resistance.json, summary.txt and the figure."""
    fit = fit_power_law(outcomes)
    numbers = {"title": campaign.title, "test": campaign.kind.test, "liquefaction_ratio": campaign.liquefaction_ratio,
               "cycles": campaign.limit, "fit": fit}
    write_replacing(folder / "resistance.csv", table_text(outcomes))
    write_replacing(folder / "resistance.json", json.dumps(numbers, indent=2) + "\n")
    any_ended = any(outcome.status not in ("missing", "failed") for outcome in outcomes)
    command.leave(folder, summary_text(campaign, outcomes, fit), "resistance", figures and any_ended)
