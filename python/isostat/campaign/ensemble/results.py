# SPDX-License-Identifier: BSD-3-Clause
"""From the files of a member to what its ensemble compares.   tested: tests/apps/column_ensemble_test.py"""
import dataclasses
import pathlib
import re
from typing import Any

import h5py
import numpy as np

from isostat import _core
from isostat.campaign.ensemble.members import Member
from isostat.campaign.runs import read_summary
from isostat.results import read_table

LIQUEFIED_RU = 0.95  # r_u above which soil counts as liquefied here
GRAVITY = 9.80665  # m/s2, of the definition of the Arias intensity
PERIODS = (0.1, 0.3, 1.0)  # s, of the spectral accelerations that are compared
Curves = dict[tuple[str, str], np.ndarray]  # by name and unit, the abscissa first


@dataclasses.dataclass
class MemberResults:
    """What a member left. Numbers are in SI and in the order of tables; nan: the member does not have it."""

    member: Member
    summary: dict[str, Any]  # of its run
    numbers: dict[str, float]
    curves: dict[str, Curves]  # points, nodes, grains, spectra, history
    same_as: str = ""  # an earlier member with the same record and packings


def liquefied_thickness(depth: np.ndarray, ru: np.ndarray, height: float) -> float:
    """Of the soil whose r_u exceeded LIQUEFIED_RU, m: each point counts for the soil nearest to it."""
    bounds = np.concatenate([[0], (depth[1:] + depth[:-1]) / 2, [height]])
    return float(np.diff(bounds)[ru > LIQUEFIED_RU].sum())


def arias_intensity(time: np.ndarray, accelerations: list[np.ndarray]) -> float:
    """I_A = pi / (2 g) times the integral of the squared acceleration, of all axes together, m/s."""
    squares = sum((a**2 for a in accelerations), np.zeros_like(time))
    return float(np.pi / (2 * GRAVITY) * (np.diff(time) @ (squares[1:] + squares[:-1]) / 2))


def profile_curves(path: pathlib.Path) -> dict[str, Curves]:
    """Largest r_u, strain and acceleration of each depth."""
    with h5py.File(path) as file:
        depth, node_depth, ru, gamma, acceleration = (
            file[name][()] for name in ("depth", "node_depth", "peak_ru", "peak_gamma", "peak_acceleration"))
    return {"points": {("depth", "m"): depth, ("max_ru", "-"): ru, ("max_gamma", "-"): gamma},
            "nodes": {("depth", "m"): node_depth, ("max_acceleration", "m/s2"): acceleration}}


def grain_curves(path: pathlib.Path) -> Curves:
    """Smallest and last I_R of each packing (of the first, where a point has several)."""
    table = read_table(path)
    packings = [name.removesuffix("_depth") for name in table if re.fullmatch(r"p\d+_depth", name)]
    index = np.array([table[f"{packing}_IR"] for packing in packings])
    return {("depth", "m"): np.array([table[f"{packing}_depth"][0] for packing in packings]),
            ("min_I_R", "-"): np.fmin.reduce(index, axis=1), ("final_I_R", "-"): index[:, -1]}


def history_curves(history, sections: dict, axes: list[str], is_wet: bool, n_depths: int) -> Curves:
    """Motion, settlement and r_u at the times of output.history_interval, straight between the rows."""
    names = [*(f"surface_a{axis}" for axis in axes), "settlement", "max_ru"]
    if number(sections["slope"]["angle"]) > 0 or sections["mesh"]["sides"] != "tied":
        names.append("surface_ux")
    names += [f"d{k}_ru" for k in range(n_depths if is_wet else 0)]
    interval, end = number(sections["output"]["history_interval"]), number(sections["analysis"]["duration"])
    time = interval * np.arange(int(end / interval) + 2)
    time = time[time <= end * (1 + 1e-12)]
    return {("time", "s"): time, **{(name, history.units[name]): np.interp(time, history["time"], history[name])
                                    for name in names}}


def number(value: str) -> float:
    """Of a value with its unit: the text of a scene always has the same unit for a key."""
    return float(value.split()[0])


def read_member(member: Member, folder: pathlib.Path) -> MemberResults:
    """Of a member that has finished.   Raises InputError (damaged files)"""
    try:
        return read_files(member, folder)
    except (KeyError, IndexError, OSError, TypeError, ValueError) as error:
        raise _core.InputError(f"{folder}: is damaged ({error}). Remove it; the same command runs this member again.") from error


def read_files(member: Member, folder: pathlib.Path) -> MemberResults:
    sections, summary = member.scene.to_dict(), read_summary(folder)
    axes = sorted(motion["axis"] for motion in sections.get("motion", []) if motion["axis"] != "z")
    is_wet, history = summary["drainage"] != "dry", read_table(folder / "history.csv")
    curves = profile_curves(folder / "profiles.h5")
    curves["history"] = history_curves(history, sections, axes, is_wet, len(summary["requested_depths"]))
    numbers = {name: summary[name] for name in ("peak_surface", "peak_surface_below", "amplification")}
    numbers["arias_intensity"] = arias_intensity(history["time"], [history[f"surface_a{axis}"] for axis in axes])
    if axes:
        spectra = read_table(folder / "spectra.csv")
        larger = np.max([spectra[f"surface_{axis}_SA"] for axis in axes], axis=0)
        curves["spectra"] = {("period", "s"): spectra["period"], ("surface_Sa", "m/s2"): larger}
        numbers |= {f"surface_Sa_{at:g}s": np.interp(at, spectra["period"], larger) for at in PERIODS}
    numbers["peak_gamma"] = summary["peak_gamma"]
    if is_wet:
        depth, ru, _ = curves["points"].values()
        numbers |= {"max_ru": summary["max_ru"], "liquefied_thickness": liquefied_thickness(depth, ru, summary["height"])}
    numbers["settlement"] = summary["settlement"]
    numbers |= {name: summary[name] for name in ("downslope",) if name in summary}
    numbers |= {f"surface_{key}": summary["surface_motion"][key] for key in ("along_x", "largest", "settlement", "heave")
                if "surface_motion" in summary}
    if (grains := folder / "grain_profiles/history.csv").exists():
        curves["grains"] = grain_curves(grains)
        numbers |= {"min_redundancy": summary["min_redundancy"],
                    "final_redundancy": np.nanmean(curves["grains"]["final_I_R", "-"])}
    return MemberResults(member, summary, {name: np.nan if value is None else float(value)
                                           for name, value in numbers.items()}, curves)


def find_same_packings(results: list[MemberResults]) -> None:
    """Finds members whose points have the same packings, in whatever order at a point, as those of an earlier member with
    the same record: draws of few seeds at few points repeat. They are one sample."""
    first: dict[tuple, str] = {}
    for each in results:
        seeds = tuple(tuple(sorted(point)) for point in each.summary.get("seeds", []))
        name = first.setdefault((each.member.record, seeds or each.member.packings), each.member.name)
        each.same_as = "" if name == each.member.name else name
