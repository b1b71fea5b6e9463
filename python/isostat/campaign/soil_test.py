# SPDX-License-Identifier: BSD-3-Clause
"""isostat soil-test: element tests of the material of a column's layer, on one Gauss point, in seconds.

    drained cycles of strain        G/G_max and damping, of the last of three cycles from 1e-6 to 1e-2
    undrained cycles of stress      cycles to liquefaction (r_u = 0.95, or |gamma| = 3 % if that comes first) at several
                                    cyclic stress ratios; CRR at 15 cycles; exponent b
    then drained compression        volumetric strain against the largest shear strain, at tau = 0

tested: tests/python/soil_point_test.py
"""
import argparse
import dataclasses
import json
import math
import pathlib
import re

import numpy as np

from isostat import _core
from isostat.campaign import command
from isostat.campaign.folder import CampaignFolder, write_replacing
from isostat.campaign.resistance.outcome import REFERENCE, Outcome, fit_power_law
from isostat.campaign.resistance.scenes import parse_ratios
from isostat.figures.files import read_parsed

STRAINS = np.geomspace(1e-6, 1e-2, 17)
STEPS = 50  # of a quarter of a cycle
AROUND = (0.8, 0.9, 1, 1.1, 1.2)  # ratios over CRR(15), unless they are given
MOST_CYCLES = 200
MORE = (0, 0.5, 1, 2, 5)  # cycles after liquefaction
STRONGEST = 2  # CSR that no sand reaches


@dataclasses.dataclass
class SoilTest:
    """What soil_test() finds. Stresses in Pa, strains as numbers, compression positive."""

    layer: str
    material: str
    vertical_stress: float
    shear_modulus: float  # G_max
    modulus: np.ndarray  # (n, 3): amplitude of gamma, G/G_max, damping ratio
    resistance: np.ndarray  # (n, 2): CSR, cycles to liquefaction (inf: not within 200)
    crr: float | None  # CSR that liquefies in 15 cycles; None: it does not liquefy
    crr_of_scene: float | None  # what n1_60cs, qc1ncs or relative_density ask for at the stress in situ, if it is tested
    b: float | None  # of CSR = a N^-b through `resistance`
    reconsolidation: np.ndarray  # (n, 2): largest |gamma|, volumetric strain back to sigma'_v0
    path: np.ndarray  # (n, 5): gamma, tau, sigma'_v, p', eps_v of the test at CRR(15), or of the highest ratio


def secant_and_damping(point, strain):
    """G and damping ratio of the last of three drained cycles; D = area / (2 pi G gamma^2)."""
    point.shear(strain, STEPS, drained=True)
    for _ in range(3):
        path = np.concatenate([point.shear(part, 2 * STEPS, drained=True) for part in (-2 * strain, 2 * strain)])
    gamma, tau = np.vstack([path[-1], path])[:, :2].T  # closed
    modulus = np.ptp(tau) / (2 * strain)
    area = np.sum((tau[1:] + tau[:-1]) / 2 * np.diff(gamma))
    return modulus, area / (2 * math.pi * modulus * strain**2) if modulus > 0 else math.nan


def resistance_at_15(point, vertical):
    """CSR that liquefies in 15 cycles, by bisection to 0.1 %; None where more stress only reaches the strength."""
    def cycles(ratio):
        return point.fresh().cyclic_shear(ratio * vertical, REFERENCE)[0]
    low, high = 1e-3, STRONGEST
    while high / low > 1.001:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if cycles(middle) <= REFERENCE else (middle, high)
    return high if 1 < cycles(high) <= REFERENCE else None


def settled(point, vertical, tau, more):
    """(largest |gamma|, volumetric strain) of a point that liquefies, rests at tau = 0 and drains; None: it does not."""
    cycles, path = point.cyclic_shear(tau, MOST_CYCLES, more)
    if not math.isfinite(cycles):
        return None
    path = np.vstack([path, point.shear_to(0)])
    return np.abs(path[:, 0]).max(), point.compress_to(vertical)[-1, 4]


def soil_test(scene, layer=None, *, vertical_stress=None, ratios=None):
    """Element tests of the material of a layer, on one Gauss point at its stress in the middle of the layer.

    scene            ColumnScene      layer  its name; None: the first that is elastic, iwan, mohr_coulomb or umat
    vertical_stress  effective, Pa; None: in situ
    ratios           cyclic stress ratios tau/sigma'_v0; None: five around CRR(15)

    Returns SoilTest. Raises InputError, and RunFailure as SoilPoint does.
    """
    from isostat import column  # pylint: disable=import-outside-toplevel  (the wheel is without it)
    point = column.SoilPoint(scene, layer, vertical_stress)
    vertical = -point.stress[2]
    found = [secant_and_damping(point.fresh(), strain) for strain in STRAINS]
    modulus = [(strain, g / point.shear_modulus, damping) for strain, (g, damping) in zip(STRAINS, found)]
    crr = resistance_at_15(point, vertical)
    ratios = ratios or ([crr * part for part in AROUND] if crr else [])
    tests = [point.fresh().cyclic_shear(ratio * vertical, MOST_CYCLES, 5) for ratio in ratios]
    fit = fit_power_law([Outcome(ratio, 0, to_liquefaction=cycles if math.isfinite(cycles) else None)
                         for ratio, (cycles, _) in zip(ratios, tests)])
    volumes = [settled(point.fresh(), vertical, crr * vertical, more) for more in MORE] if crr else []
    start = (0, point.stress[4], vertical, -np.mean(point.stress[:3]), 0)
    path = np.vstack([start, point.fresh().cyclic_shear((crr or max(ratios, default=0.1)) * vertical, REFERENCE, 5)[1]])
    return SoilTest(point.layer, point.material, vertical, point.shear_modulus, np.array(modulus),
                    np.array([(ratio, cycles) for ratio, (cycles, _) in zip(ratios, tests)]).reshape(-1, 2), crr,
                    None if vertical_stress else point.crr, fit and fit["b"], np.array([v for v in volumes if v]).reshape(-1, 2), path)


def table_text(names, rows):
    return "\n".join([",".join(names), *(",".join("" if math.isinf(x) else f"{x:.6g}" for x in row) for row in rows)]) + "\n"


def summary_text(title, test):
    lines = ["", title, f"  layer                    {test.layer}, {test.material}, sigma'_v0 = {test.vertical_stress / 1e3:.4g} "
             f"kPa, G_max = {test.shear_modulus / 1e6:.4g} MPa", "",
             f"  {'gamma (%)':>10}  {'G/G_max':>8}  {'damping (%)':>11}"]
    lines += [f"  {100 * gamma:>10.3g}  {ratio:>8.3f}  {100 * abs(damping):>11.2f}" for gamma, ratio, damping in test.modulus[::2]]
    if test.crr is None:
        lines += ["", "  resistance               does not liquefy: shear builds up no pore pressure that would"]
    if len(test.resistance):
        lines += ["", f"  {'CSR':>10}  cycles to r_u = 0.95 or 3 % single amplitude"]
        lines += [f"  {ratio:>10.4g}  {f'{n:.2f}' if math.isfinite(n) else f'>{MOST_CYCLES}'}" for ratio, n in test.resistance]
    if test.crr is not None:
        target = f" (scene: {test.crr_of_scene:.4f})" if test.crr_of_scene else ""
        b = f"; b = {test.b:.3f}" if test.b is not None else ""
        lines.append(f"  CRR at 15 cycles         {test.crr:.4f}{target}{b}")
    if len(test.reconsolidation):
        lines += ["", "  reconsolidation          " + ", ".join(f"{100 * v:.2f} % after {100 * g:.2g} %" for g, v in test.reconsolidation)
                  + " of shear strain"]
    return "\n".join(lines) + "\n"


def leave(folder, title, test, figures):
    """modulus.csv, resistance.csv, reconsolidation.csv, path.csv, soil_test.json, summary.txt and the figure."""
    tables = {"modulus": (("gamma (-)", "G_ratio (-)", "damping (-)"), test.modulus),
              "resistance": (("CSR (-)", "N_liquefaction (-)"), test.resistance),
              "reconsolidation": (("gamma_max (-)", "eps_v (-)"), test.reconsolidation),
              "path": (("gamma (-)", "tau (Pa)", "sigma_v (Pa)", "p (Pa)", "eps_v (-)"), test.path)}
    for name, (names, rows) in tables.items():
        write_replacing(folder / f"{name}.csv", table_text(names, rows))
    numbers = {"title": title, "layer": test.layer, "material": test.material, "sigma_v0": test.vertical_stress,
               "shear_modulus": test.shear_modulus, "CRR_15": test.crr, "CRR_of_scene": test.crr_of_scene, "b": test.b}
    write_replacing(folder / "soil_test.json", json.dumps(numbers, indent=2) + "\n")
    command.leave(folder, summary_text(title, test), "soil_test", figures)


def pressure(text):
    """"100 kPa" in Pa, for argparse."""
    try:
        return _core._quantity(text, "pressure")  # pylint: disable=protected-access
    except _core.InputError as error:
        raise argparse.ArgumentTypeError(f"{text}: {error}; give e.g. \"100 kPa\"") from error


def run(options):
    from isostat import column  # pylint: disable=import-outside-toplevel
    ratios = parse_ratios(options.ratios) if options.ratios else None
    scene = column.ColumnScene(options.scene, set=command.overrides(options.set))
    of_layer = "_" + re.sub(r"\W+", "_", options.layer) if options.layer else ""
    folder = options.output or pathlib.Path(f"{scene.folder}_soil_test{of_layer}")
    test = soil_test(scene, options.layer, vertical_stress=options.vertical_stress, ratios=ratios)
    kept = folder / "soil_test.json"
    other = read_parsed(kept)["layer"] if kept.is_file() and not options.overwrite else test.layer
    if other != test.layer:
        raise _core.InputError(f"{folder}: has results of the layer \"{other}\". Choose another --output, or --overwrite to "
                               "replace them.")
    CampaignFolder(folder, {"scene.toml": scene.text}, overwrite=options.overwrite, program="soil_column")
    leave(folder, f"{scene.title}: {test.layer or 'layer'}", test, not options.no_figures)


def main(words: list[str]) -> int:
    line = command.line_of("soil-test", "Element tests of the material of a column's layer: G/G_max and damping, cycles "
                           "to liquefaction, settlement after it")
    command.add_scene(line, "scene file (TOML) of soil_column")
    line.add_argument("--layer", help="its name, or layer.2 (default: the first that is elastic, iwan, mohr_coulomb or umat)")
    line.add_argument("--vertical-stress", type=pressure, help='effective, e.g. "100 kPa" (default: that in the middle of the layer)')
    line.add_argument("--ratios", help="cyclic stress ratios tau/sigma'_v0, e.g. 0.10,0.15,0.20 (default: five around that "
                      "of 15 cycles)")
    line.add_argument("-o", "--output", type=pathlib.Path, help="results folder (default: results/<scene name>_soil_test, with "
                      "_<layer> where one is named)")
    line.add_argument("--overwrite", action="store_true", help="replace results of another scene or layer in this folder")
    line.add_argument("--no-figures", action="store_true", help="leave no figure and no report")
    options = line.parse_args(words)
    return command.run(lambda: run(options))
