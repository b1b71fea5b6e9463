# SPDX-License-Identifier: BSD-3-Clause
"""What an ensemble leaves: statistics over its members, tables, summary, figures.

tested: tests/apps/column_ensemble_test.py
"""
import json
import os
import pathlib
import warnings

import numpy as np

from isostat import _core
from isostat.campaign import command
from isostat.campaign.ensemble.results import LIQUEFIED_RU, PERIODS, MemberResults, find_same_packings
from isostat.campaign.folder import write_replacing

FEWEST_FOR_BAND = 3  # values: of two, 16 and 84 % would be the two drawn together
BAND = ("mean", "p16", "p50", "p84")
SHOWN = {  # numbers of a member: unit, label in the summary as in that of a run, factor to the unit of the label
    "peak_surface": ("m/s2", "peak surface (m/s2)", 1),
    "peak_surface_below": ("m/s2", "... below {highest_frequency:.4g} Hz (m/s2)", 1),
    "amplification": ("-", "amplification (-)", 1),
    "arias_intensity": ("m/s", "Arias intensity (m/s)", 1),
    **{f"surface_Sa_{at:g}s": ("m/s2", f"S_a({at:g} s) of surface (m/s2)", 1) for at in PERIODS},
    "peak_gamma": ("-", "peak shear strain (%)", 100),
    "max_ru": ("-", "largest r_u (-)", 1),
    "liquefied_thickness": ("m", "liquefied thickness (m)", 1),
    "settlement": ("m", "settlement (mm)", 1000),
    "downslope": ("m", "moved downslope (m)", 1),
    "surface_along_x": ("m", "surface along x, at output.x (m)", 1),
    "surface_largest": ("m", "... where it is most (m)", 1),
    "surface_settlement": ("m", "surface sank (m)", 1),
    "surface_heave": ("m", "surface rose (m)", 1),
    "min_redundancy": ("-", "smallest I_R (-)", 1),
    "final_redundancy": ("-", "I_R at the end, mean (-)", 1)}


def statistics(values: np.ndarray) -> dict[str, np.ndarray]:
    """Over the first axis, the members, without their nan. Percentiles are on straight lines between the ordered values,
    nan for fewer than FEWEST_FOR_BAND; the standard error is that of the mean, s / sqrt(n) with n - 1 in s, nan for one."""
    n = np.sum(~np.isnan(values), axis=0)
    percentile = np.nanpercentile if np.isnan(values).any() else np.percentile  # the former is slow
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # where there is no value, nan is the answer
        low, median, high = percentile(values, (16, 50, 84), axis=0)
        return {"n": n, "mean": np.nanmean(values, axis=0),
                "standard_error": np.nanstd(values, axis=0, ddof=1) / np.sqrt(n),
                "p16": np.where(n < FEWEST_FOR_BAND, np.nan, low), "p50": median,
                "p84": np.where(n < FEWEST_FOR_BAND, np.nan, high),
                "min": np.nanmin(values, axis=0), "max": np.nanmax(values, axis=0)}


def bands_text(differing: list[MemberResults], kind: str) -> str:
    """A table `x, then mean, 16, 50, 84 % of each curve`.   Raises RunFailure"""
    (over, *names), (x, *_) = zip(*differing[0].curves[kind].items())
    for each in differing:
        if not np.array_equal(each.curves[kind][over], x):
            raise _core.RunFailure(f"member {each.member.name}: its {kind} are not those of member "
                                   f"{differing[0].member.name}. Start it again: --overwrite")
    head, columns = ["{} ({})".format(*over)], [x]
    for name, unit in names:
        found = statistics(np.array([each.curves[kind][name, unit] for each in differing]))
        head += [f"{name}_{what} ({unit})" for what in BAND]
        columns += [found[what] for what in BAND]
    return "".join(",".join(row) + "\n" for row in [head, *([f"{value:.10g}" for value in row] for row in zip(*columns))])


def members_text(results: list[MemberResults]) -> str:
    """members.csv: a row for each member."""
    rows = [["member", "packings", "record", "same_as", *(f"{name} ({SHOWN[name][0]})" for name in results[0].numbers)]]
    rows += [[each.member.name, str(each.member.packings), os.path.basename(each.member.record), each.same_as,
              *(f"{value:.10g}" for value in each.numbers.values())] for each in results]
    return "".join(",".join(row) + "\n" for row in rows)


def cell(value: float, digits: int) -> str:
    return f"{'-':>13}" if np.isnan(value) else f"{value:>13.{digits}g}"


def head_text(title: str, results: list[MemberResults], n_differing: int, n_asked: int) -> str:
    text = f"\n{title or 'Ensemble of a soil column'}\n  members                  {len(results)} of {n_asked} finished\n"
    same = ", ".join(f"{each.member.name} as {each.same_as}" for each in results if each.same_as)
    if same:
        text += (f"  the same packings        {same}; they count once, n = {n_differing}. More seeds (mixed_realisations, "
                 "and a library that has them) give more that differ\n")
    if n_differing < FEWEST_FOR_BAND:
        text += f"  no percentiles           of n = {n_differing}: figures have the members and their mean\n"
    return text + f"\n  {'':<30}{'mean':>13}{'+- s.e.':>13}{'16 %':>13}{'median':>13}{'84 %':>13}{'n':>4}\n"


def report(scene, results: list[MemberResults], n_asked: int, failures: dict[str, str], folder: pathlib.Path,
           figures: bool) -> None:
    """Leaves members.csv, bands_*.csv, ensemble.json, summary.txt and the figures of members that have finished."""
    find_same_packings(results)
    differing = [each for each in results if not each.same_as]
    found = {name: statistics(np.array([each.numbers[name] for each in differing])) for name in differing[0].numbers}
    text = head_text(scene.title, results, len(differing), n_asked)
    for name, of in found.items():
        _, label, factor = SHOWN[name]
        cells = (cell(factor * of[what], digits) for what, digits in
                 (("mean", 4), ("standard_error", 2), ("p16", 4), ("p50", 4), ("p84", 4)))
        text += f"  {label.format_map(differing[0].summary):<30}{''.join(cells)}{of['n']:>4}\n"
    text += "".join(f"  failed: {name}: {why}\n" for name, why in sorted(failures.items()))
    numbers = {"title": scene.title, "members": len(results), "differing": len(differing), "asked": n_asked,
               "liquefied_ru": LIQUEFIED_RU, "depths": differing[0].summary["requested_depths"],
               "numbers": {name: {"unit": SHOWN[name][0], **{what: None if np.isnan(x) else x.item()
                                                             for what, x in of.items()}} for name, of in found.items()}}
    for kind in differing[0].curves:
        write_replacing(folder / f"bands_{kind}.csv", bands_text(differing, kind))
    write_replacing(folder / "members.csv", members_text(results))
    write_replacing(folder / "ensemble.json", json.dumps(numbers, indent=2, ensure_ascii=False) + "\n")
    command.leave(folder, text, "column_ensemble", figures)
