# SPDX-License-Identifier: BSD-3-Clause
"""What one packing shows: small strains, and drained, undrained and cyclic triaxial tests, all from p0' = 200 kPa."""
import isostat
import numpy as np

from studies.scenes import scene_of

GRAINS = 1000
PRESSURES = (50, 200)  # kPa; the tests begin at the last
DRAINED_STRAIN, LAST = 0.2, 0.17  # the critical state is the mean from LAST on
WINDOW = 0.02  # of axial strain, over which peak and dilatancy are taken
CYCLES, AMPLITUDE = 30, "65 kPa"
PACE = 2e-3  # inertial number, as in calibrations


def friction_angle(ratio):
    """phi of q/p' in triaxial compression, deg: sin(phi) = 3 M/(6 + M)."""
    return float(np.degrees(np.arcsin(3 * ratio / (6 + ratio))))


def stage(kind):
    if kind == "undrained-cyclic":
        return {"kind": kind, "deviator_amplitude": AMPLITUDE,
                "until": {"cycles": CYCLES, "reversals_after_liquefaction": 6, "strain": 0.1}}
    return {"kind": kind, "strain": DRAINED_STRAIN if kind == "drained" else 0.05}


def drained(h):
    """Friction at peak and in the critical state, greatest dilatancy, contraction before it."""
    strain = np.linspace(0, DRAINED_STRAIN, 501)
    ratio, volume = (np.interp(strain, h["eps_y"] - h["eps_y"][0], values)
                     for values in (h["q"] / h["p"], h["eps_x"] + h["eps_y"] + h["eps_z"]))
    half = round(WINDOW / (strain[1] - strain[0]) / 2)
    mean = np.convolve(ratio, np.full(2 * half + 1, 1 / (2 * half + 1)), "valid")
    rate = -(volume[2 * half:] - volume[:-2 * half]) / WINDOW
    return {"peak friction": friction_angle(mean.max()),
            "critical friction": friction_angle(ratio[strain >= LAST].mean()), "dilatancy": float(rate.max()),
            "contraction": float(volume.max() - volume[0])}


def undrained(h):
    return {"least p'": float(h["p"].min() / h["p"][0])}


def cyclic(h):
    """Cycles to p'/p0' < 0.01, CYCLES if it is not reached; mean double amplitude of strain in the cycles after it."""
    onset = np.flatnonzero(h["liquefied"])
    if not onset.size:
        return {"cycles": float(CYCLES), "strain per cycle": float("nan")}
    turns = h["reversals"][onset[0]]
    after = [h["eps_y"][h["reversals"] == k] for k in range(int(turns) + 1, int(h["reversals"][-1]))]
    return {"cycles": turns / 2,
            "strain per cycle": float(np.mean([np.ptp(half) for half in after])) if after else float("nan")}


TESTS = {"drained": drained, "undrained-monotonic": undrained, "undrained-cyclic": cyclic}


def observe(results, seed, contact, preparation, expansion):
    """All observables of one packing.   preparation: friction while it is compressed, as in a scene"""
    def scene(pressure, stages=(), **motion):
        return isostat.Scene(scene_of("sensitivity", GRAINS, seed, {
            "domain": "periodic-cell", "pressure": f"{pressure} kPa", "preparation_friction": preparation,
            "expansion": expansion}, stages,
            contact=contact, motion=motion))

    found, moduli = {}, []
    for pressure in PRESSURES:
        specimen = isostat.prepare(scene(pressure), cache=results.parent / "specimens", threads=1, quiet=True)
        stiffness = isostat.Rve(specimen.snapshot).stiffness()
        moduli.append(float(np.mean(np.diag(stiffness)[3:])))
    found |= {"e": specimen.snapshot.void_ratio, "G": moduli[-1],
              "exponent of G": float(np.log(moduli[1] / moduli[0]) / np.log(PRESSURES[1] / PRESSURES[0]))}
    for kind, measure in TESTS.items():
        test = scene(PRESSURES[-1], [stage(kind)], inertial_number=PACE)
        found |= measure(isostat.run(test, specimen=specimen, threads=1, quiet=True).history)
    return {"observables": found}
