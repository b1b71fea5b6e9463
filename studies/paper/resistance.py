# SPDX-License-Identifier: BSD-3-Clause
"""Resistance curves CSR = a N^-b, what depth and density do to them, and the critical-state line."""
import numpy as np

from studies.paper import plan

MONOTONIC = ("compression", "extension", "drained")
REFERENCE = 15  # cycles: a magnitude 7.5 earthquake


def fitted_ratios(tests):
    """Those at which every specimen liquefied: the others would count by their weakest specimens alone."""
    spared = {ratio for ratio, n in tests if not np.isfinite(n)}
    return {ratio for ratio, _ in tests} - spared


def power_law(tests):
    """(b, CSR at 15 cycles) of tests (ratio, cycles): least squares of log N against log CSR, because N scatters at a
    given CSR. Nothing of fewer than two ratios that count, or of a curve that does not fall."""
    counted = fitted_ratios(tests)
    tests = [test for test in tests if test[0] in counted]
    if len(counted) < 2:
        return None
    ratio, cycles = (np.log([test[k] for test in tests]) for k in (0, 1))
    slope, intercept = np.polyfit(ratio, cycles, 1)
    if slope >= 0:
        return None
    return -1 / slope, float(np.exp((np.log(REFERENCE) - intercept) / slope))


def with_error(seeds, value):
    """value(seeds), a tuple, and its standard errors by the jackknife: all tests of a cloud are left out together,
    because they are not independent. Nothing where there is no value; errors not a number where one is missing."""
    seeds = sorted(seeds)
    whole = value(seeds)
    if whole is None:
        return None
    found = [value([s for s in seeds if s != seed]) for seed in seeds]
    if len(seeds) < 2 or None in found:
        return whole, (np.nan,) * len(whole)
    n = len(seeds)
    return whole, tuple(np.sqrt((n - 1) / n * ((np.array(c) - np.mean(c))**2).sum()) for c in zip(*found))


def curves(cyclic_tests):
    """A row for each preparation and pressure: the fit, and K_sigma, the resistance at 15 cycles over that of the same
    preparation and the same clouds at 200 kPa; both with their errors over seeds."""
    groups = {}
    for row in cyclic_tests:
        if "deg" in row["specimen"]:
            groups.setdefault(row["specimen"], []).append(row)

    def law(label, seeds):
        tests = [(row["q_amp/(2 p0')"], row["cycles"]) for row in groups[label] if row["seed"] in seeds]
        return power_law(tests)

    def k_sigma(label, reference, seeds):
        laws = law(label, seeds), law(reference, seeds)
        return None if None in laws else (laws[0][1] / laws[1][1],)

    rows = []
    for label, tests in groups.items():
        seeds = {row["seed"] for row in tests}
        fit = with_error(seeds, lambda some, label=label: law(label, some))
        if fit is None:
            continue
        reference = f"{label.split(',')[0]}, {plan.P0} kPa"
        ratio = None
        if label != reference and reference in groups:
            ratio = with_error(seeds, lambda some, label=label: k_sigma(label, reference, some))
        (b, resistance), (b_error, error) = fit
        rows.append({"specimen": label, "p0' (kPa)": tests[0]["p0' (kPa)"], "e": np.mean([row["e"] for row in tests]),
                     "tests": len(tests), "not liquefied": sum(not np.isfinite(row["cycles"]) for row in tests),
                     "ratios in the fit": len(fitted_ratios([(row["q_amp/(2 p0')"], row["cycles"]) for row in tests])),
                     "b": b, "b s.e.": b_error, "CSR at 15 cycles": resistance, "CSR at 15 cycles s.e.": error,
                     "K_sigma": ratio[0][0] if ratio else np.nan, "K_sigma s.e.": ratio[1][0] if ratio else np.nan})
    return rows


def critical_states(tests):
    """Ends of monotonic tests of the contacts of the paper, mean of the last twentieth of the strain, and how far e
    and ln p' changed over the last tenth. The line e = Gamma - lambda ln(p'/kPa) is fitted to the drained tests of
    periodic cells, because walls loosen a box the more the flatter it gets; it gives the state parameter
    psi = e - (Gamma - lambda ln p0') of the cells."""
    rows = []
    for run, h in tests:
        if run.kind in MONOTONIC and run.packing.young == 10 and not run.slow:
            strain = np.abs(h.eps_y)
            last = strain > 0.95 * strain[-1]
            before = (strain > 0.85 * strain[-1]) & (strain < 0.9 * strain[-1])
            rows.append({"test": run.kind, "walls": run.packing.way != plan.NO_WALLS, "specimen": run.packing.label,
                         "seed": run.seed, "p0' (kPa)": run.packing.pressure, "e0": h.e[0],
                         "|eps_1| (%)": 100 * strain[-1], "e": h.e[last].mean(), "p' (kPa)": h.p[last].mean() / 1e3,
                         "q/p'": (np.abs(h.q[last]) / h.p[last]).mean(), "change of e": h.e[last].mean() -
                         h.e[before].mean(), "change of ln p'": np.log(h.p[last].mean() / h.p[before].mean())})
    cells = [row for row in rows if not row["walls"]]
    line = with_error({row["seed"] for row in cells},
                      lambda seeds: state_line([row for row in cells if row["seed"] in seeds])) if cells else None
    for row in cells if line else ():
        (row["Gamma"], row["lambda"]), (row["Gamma s.e."], row["lambda s.e."]) = line
        row["state parameter at the start"] = row["e0"] - (row["Gamma"] - row["lambda"] * np.log(row["p0' (kPa)"]))
    return rows


def state_line(rows):
    """(Gamma, lambda), or nothing of fewer than three pressures before shearing."""
    if len({row["p0' (kPa)"] for row in rows}) < 3:
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
