# SPDX-License-Identifier: BSD-3-Clause
"""How one run is done: specimen, loading, what is measured."""
import time

import isostat
import numpy as np

from . import plan

STEPS = 12             # increments of a quarter of a cycle
MIN_STEPS = 300        # time steps of an increment, at least
TOLERANCE = 1e-4       # of stresses that are kept, over p'
NORMAL = np.eye(3, dtype=bool)


def specimen(run, cache, grains, pressure, laws=plan.STIFFNESS_LAWS):
    """The packing of a run, isotropically consolidated."""
    scene = isostat.Scene(
        grading={"grains": grains, "cloud_edge": f"{10 * (grains / 10000) ** (1 / 3):.3f} mm", "seed": run.seed},
        contact={**laws[run.law], "friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5},
                 "twisting": {"stiffness": 0.3}},
        specimen={"domain": "periodic-cell", "pressure": f"{pressure} kPa",
                  "preparation_friction": f"{run.degrees} deg"})
    return isostat.prepare(scene, cache=cache).snapshot


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


def stiffness(run, cache, grains):
    """Moduli at each pressure, one packing compressed from one to the next."""
    start = time.perf_counter()
    rve = isostat.Rve(specimen(run, cache, grains, run.pressure), min_steps=MIN_STEPS)
    states = [state(rve)]
    for pressure in plan.PRESSURES[1:]:
        previous = states[-1]["mean_stress"] / 1e3
        for target in np.geomspace(previous, pressure, 9)[1:]:
            accepted(rve.mixed(np.zeros((3, 3)), -1e3 * target * np.eye(3), np.ones((3, 3), dtype=bool), TOLERANCE))
        states.append(state(rve))
    return {"states": states, "seconds": time.perf_counter() - start}


def velocity(run, cache, grains):
    """Of vertical shear waves at each depth of a deposit, loaded by the weight above without lateral strain."""
    start = time.perf_counter()
    rve = isostat.Rve(specimen(run, cache, grains, run.pressure, plan.GROUND), min_steps=MIN_STEPS)
    vertical, states = np.zeros((3, 3), dtype=bool), []
    vertical[1, 1] = True
    for depth in plan.DEPTHS:
        target, present = plan.BUOYANT_WEIGHT * depth, -rve.stress[1, 1]
        for stress in np.geomspace(present, target, 5)[1:]:
            accepted(rve.mixed(np.zeros((3, 3)), -stress * np.eye(3), vertical, TOLERANCE))
        c = rve.stiffness()
        modulus = (c[3, 3] + c[5, 5]) / 2  # shear in the planes yz and xy, y being vertical
        states.append({**state(rve), "depth": depth, "lateral": -(rve.stress[0, 0] + rve.stress[2, 2]) / 2,
                       "velocity": float(np.sqrt(modulus / 1970))})
    return {"states": states, "seconds": time.perf_counter() - start}


def loop(gamma, tau):
    """Secant modulus and damping ratio of a closed loop, energy lost over 4 pi times the energy of the secant."""
    amplitude = (gamma.max() - gamma.min()) / 2
    secant = (tau[gamma.argmax()] - tau[gamma.argmin()]) / (2 * amplitude)
    lost = np.sum((tau[1:] + tau[:-1]) / 2 * np.diff(gamma))
    return {"secant": float(secant), "damping_ratio": float(lost / (2 * np.pi * secant * amplitude**2))}


def reduction(run, cache, grains):
    """Cycles of simple shear. Drained: the normal stresses stay what they are; undrained: the volume does."""
    start = time.perf_counter()
    rve = isostat.Rve(specimen(run, cache, grains, run.pressure), min_steps=MIN_STEPS, damping=run.damping)
    first = state(rve)
    kept, increment = rve.stress * NORMAL, np.zeros((3, 3))
    gamma, tau, pressure = [0.0], [rve.stress[0, 1]], [first["mean_stress"]]
    for sign in [1] * STEPS + ([-1] * 2 * STEPS + [1] * 2 * STEPS) * plan.CYCLES:
        increment[0, 1] = sign * run.amplitude / STEPS
        accepted(rve.mixed(increment, kept, NORMAL, TOLERANCE) if run.drained else rve.undrained(increment))
        gamma.append(gamma[-1] + increment[0, 1])
        tau.append(rve.stress[0, 1])
        pressure.append(-np.trace(rve.stress) / 3)
    last = slice(-4 * STEPS - 1, None)  # from the last peak but one to the last
    return {**first, **loop(np.array(gamma)[last], np.array(tau)[last]),
            "gamma": gamma, "tau": tau, "p": pressure, "void_ratio_after": rve.void_ratio,
            "seconds": time.perf_counter() - start}
