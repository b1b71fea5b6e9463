# SPDX-License-Identifier: BSD-3-Clause
"""Resistance curves CSR = a N^-b, what depth and density do to them, and the critical-state line."""
import numpy as np

from paper import plan

REFERENCE = 15  # cycles: a magnitude 7.5 earthquake


def power_law(tests):
    """(b, CSR at 15 cycles) of tests (ratio, cycles): least squares of log N against log CSR, because N scatters at a
    given CSR. Nothing of fewer than two ratios, or of a curve that does not fall."""
    ratio, cycles = (np.log([test[k] for test in tests]) for k in (0, 1))
    if len(set(ratio)) < 2:
        return None
    slope, intercept = np.polyfit(ratio, cycles, 1)
    if slope >= 0:
        return None
    return -1 / slope, float(np.exp((np.log(REFERENCE) - intercept) / slope))


def without_each_seed(tests, value):
    """Standard error by the jackknife over seeds: all tests of a specimen are left out together."""
    seeds = sorted({seed for seed, *_ in tests})
    found = [value([test[1:] for test in tests if test[0] != seed]) for seed in seeds]
    if len(seeds) < 2 or any(f is None for f in found):
        return (np.nan, np.nan)
    n = len(seeds)
    return tuple(np.sqrt((n - 1) / n * ((np.array(column) - np.mean(column))**2).sum()) for column in zip(*found))


def curves(cyclic_tests):
    """A row for each preparation and pressure: the fit with its error over seeds, and K_sigma, the resistance at 15
    cycles over that of the same preparation at 200 kPa."""
    groups = {}
    for row in cyclic_tests:
        if "deg" in row["specimen"]:
            groups.setdefault(row["specimen"], []).append(row)
    rows = []
    for label, tests in groups.items():
        liquefied = [(row["seed"], row["q_amp/(2 p0')"], row["cycles"]) for row in tests if np.isfinite(row["cycles"])]
        law = power_law([test[1:] for test in liquefied]) if liquefied else None
        if law is None:
            continue
        error = without_each_seed(liquefied, power_law)
        rows.append({"specimen": label, "p0' (kPa)": tests[0]["p0' (kPa)"], "e": np.mean([row["e"] for row in tests]),
                     "tests": len(tests), "not liquefied": len(tests) - len(liquefied), "b": law[0],
                     "b s.e.": error[0], "CSR at 15 cycles": law[1], "CSR at 15 cycles s.e.": error[1]})
    at_reference = {row["specimen"]: row["CSR at 15 cycles"] for row in rows}
    for row in rows:
        reference = at_reference.get(f"{row['specimen'].split(',')[0]}, {plan.P0} kPa")
        row["K_sigma"] = row["CSR at 15 cycles"] / reference if reference else np.nan
    return rows


def critical_states(tests):
    """Ends of monotonic tests of the contacts of the paper, mean of the last twentieth of the strain; the line
    e = Gamma - lambda ln(p'/kPa) fitted to those strained by 10 % or more, taken as critical; and the state parameter
    psi = e - (Gamma - lambda ln p0') of the specimens."""
    rows = []
    for run, h in tests:
        if run.packing.young == 10 and not run.slow:
            strain = np.abs(h.eps_y)
            last = strain > 0.95 * strain[-1]
            rows.append({"test": run.kind, "specimen": run.packing.label, "seed": run.seed,
                         "|eps_1| (%)": 100 * strain[-1], "e": h.e[last].mean(), "p' (kPa)": h.p[last].mean() / 1e3,
                         "q/p'": (np.abs(h.q[last]) / h.p[last]).mean(), "p0' (kPa)": run.packing.pressure,
                         "e0": h.e[0]})
    line = state_line([row for row in rows if row["|eps_1| (%)"] > 9.9])
    for row in rows:
        if line:
            row["Gamma"], row["lambda"] = line
            row["state parameter at the start"] = row["e0"] - (line[0] - line[1] * np.log(row["p0' (kPa)"]))
    return rows


def state_line(rows):
    """(Gamma, lambda), or nothing of fewer than three pressures."""
    if len({round(row["p' (kPa)"]) for row in rows}) < 3:
        return None
    slope, gamma = np.polyfit(np.log([row["p' (kPa)"] for row in rows]), [row["e"] for row in rows], 1)
    return float(gamma), float(-slope)


def reconsolidation(tests):
    """Volumetric strain of a liquefied specimen that drains to its first pressure, against the largest shear strain
    that it has seen, gamma = 1.5 |eps_1| at constant volume."""
    return [{"specimen": run.packing.label, "seed": run.seed, "e": h.e[0],
             "largest gamma (%)": 150 * np.abs(h.eps_y).max(), "eps_v (%)": 100 * h.drained_strain,
             "q at its beginning (kPa)": h.q[-1] / 1e3, "p' at its beginning (kPa)": h.p[-1] / 1e3}
            for run, h in tests if run.looks_behind_onset and h.onset is not None]
