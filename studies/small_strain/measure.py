# SPDX-License-Identifier: BSD-3-Clause
"""How one run is done: specimen, loading, what is measured."""
import types

import isostat
import numpy as np

from studies.scenes import RESISTANCE, cloud_edge

PRESSURES = (20, 50, 100, 200, 400, 800)  # kPa, of `stiffness`
DEPTHS = (1, 2, 3, 5, 7, 10, 15, 20)  # m, of `velocity`
BUOYANT_WEIGHT = 9.7e3  # N/m3, of saturated ground of 1,970 kg/m3 under water
CYCLES = 3             # of `reduction`
STEPS = 12             # increments of a quarter of a cycle
DAMPING = 0.2          # local, of packings that answer to a strain
MIN_STEPS = 300        # time steps of an increment, at least
TOLERANCE = 1e-4       # of stresses that are kept, over p'
NORMAL = np.eye(3, dtype=bool)


def element(results, run, contact, **options):
    """The packing of a run, isotropically consolidated."""
    scene = isostat.Scene(
        grading={"grains": run.grains, "seed": run.seed, "cloud_edge": cloud_edge(run.grains, ".3f")},
        contact=contact | RESISTANCE,
        specimen={"domain": "periodic-cell", "pressure": f"{run.pressure} kPa",
                  "preparation_friction": f"{run.degrees} deg"})
    specimen = isostat.prepare(scene, cache=results.parent / "specimens")
    return isostat.Rve(specimen.snapshot, min_steps=MIN_STEPS, **options)


def accepted(response):
    """@raises RuntimeError  a rejected increment"""
    if not response:
        raise RuntimeError(response.reason)


def state(rve):
    """Moduli of the contact network and what they belong to."""
    stiffness, network = rve.stiffness(), rve.snapshot().network()
    return {"mean_stress": -np.trace(rve.stress) / 3, "void_ratio": rve.void_ratio, "density": rve.dry_density,
            "shear_modulus": float(np.mean(np.diag(stiffness)[3:])), "constrained_modulus":
            float(np.mean(np.diag(stiffness)[:3])), "coordination": network["coordination_number"]}


def stiffness(results, run, contact):
    """Moduli at each pressure, one packing compressed from one to the next."""
    rve = element(results, types.SimpleNamespace(**run), contact)
    states = [state(rve)]
    for pressure in PRESSURES[1:]:
        previous = states[-1]["mean_stress"] / 1e3
        for target in np.geomspace(previous, pressure, 9)[1:]:
            accepted(rve.mixed(np.zeros((3, 3)), -1e3 * target * np.eye(3), np.ones((3, 3), dtype=bool), TOLERANCE))
        states.append(state(rve))
    return {"states": states}


def velocity(results, run, contact):
    """Of vertical shear waves at each depth of a deposit, loaded by the weight above without lateral strain."""
    rve = element(results, types.SimpleNamespace(**run), contact)
    vertical, states = np.zeros((3, 3), dtype=bool), []
    vertical[1, 1] = True
    for depth in DEPTHS:
        target, present = BUOYANT_WEIGHT * depth, -rve.stress[1, 1]
        for stress in np.geomspace(present, target, 5)[1:]:
            accepted(rve.mixed(np.zeros((3, 3)), -stress * np.eye(3), vertical, TOLERANCE))
        c = rve.stiffness()
        modulus = (c[3, 3] + c[5, 5]) / 2  # shear in the planes yz and xy, y being vertical
        states.append({**state(rve), "depth": depth, "lateral": -(rve.stress[0, 0] + rve.stress[2, 2]) / 2,
                       "velocity": float(np.sqrt(modulus / 1970))})
    return {"states": states}


def loop(gamma, tau):
    """Secant modulus and damping ratio of a closed loop, energy lost over 4 pi times the energy of the secant."""
    amplitude = (gamma.max() - gamma.min()) / 2
    secant = (tau[gamma.argmax()] - tau[gamma.argmin()]) / (2 * amplitude)
    lost = np.sum((tau[1:] + tau[:-1]) / 2 * np.diff(gamma))
    return {"secant": float(secant), "damping_ratio": float(lost / (2 * np.pi * secant * amplitude**2))}


def reduction(results, run, contact):
    """Drained cycles of simple shear: the normal stresses stay what they are."""
    run = types.SimpleNamespace(**run)
    rve = element(results, run, contact, damping=DAMPING)
    first = state(rve)
    kept, increment = rve.stress * NORMAL, np.zeros((3, 3))
    gamma, tau, pressure = [0.0], [rve.stress[0, 1]], [first["mean_stress"]]
    for sign in [1] * STEPS + ([-1] * 2 * STEPS + [1] * 2 * STEPS) * CYCLES:
        increment[0, 1] = sign * run.amplitude / STEPS
        accepted(rve.mixed(increment, kept, NORMAL, TOLERANCE))
        gamma.append(gamma[-1] + increment[0, 1])
        tau.append(rve.stress[0, 1])
        pressure.append(-np.trace(rve.stress) / 3)
    last = slice(-4 * STEPS - 1, None)  # from the last peak but one to the last
    return {**first, **loop(np.array(gamma)[last], np.array(tau)[last]),
            "gamma": gamma, "tau": tau, "p": pressure, "void_ratio_after": rve.void_ratio}
