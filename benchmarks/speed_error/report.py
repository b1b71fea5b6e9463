# SPDX-License-Identifier: BSD-3-Clause
"""Writes the report in Markdown: what was measured, tables, and what follows from them."""
import math

from speed_error import paths

TARGETS = (0.05, 0.02, 0.01, 0.005, 0.002)
ADAPTIVE = ("default", "tolerance", "wide")
GOOD = 0.02  # error of the path that is accepted


def percent(value, digits=2):
    if value is None or math.isnan(value):
        return "–"
    return "not reached" if math.isinf(value) else f"{100 * value:.{digits}f}"


def plus_minus(ensemble, digits=2, factor=1):
    mean, deviation, error, n = ensemble
    if n == 0 and not math.isinf(mean):
        return "–"
    if math.isinf(mean):
        return "not reached"
    if n == 1:
        return f"{factor * mean:.{digits}f}"
    return f"{factor * mean:.{digits}f} ± {factor * error:.{digits}f}"


def count(value):
    return "–" if value is None or math.isnan(value) else f"{value:,.0f}"


def number(value, digits=2):
    return "–" if value is None or math.isnan(value) else f"{value:.{digits}f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def name_of(row, base):
    label = row.setting.label
    if row.family in ("grains", "reference") or row is base:
        return f"{label}, N = {row.setting.grains:,}" if not label.startswith("N =") else label
    return label


def compared(results):
    """Rows of the base number of grains that are held against the reference, on as many specimens as the default."""
    return [r for r in results.rows.values()
            if r.family not in ("reference", "grains") and r.n_tests >= results.base.n_tests]


def error_table(results):
    rows = []
    for row in results.rows.values():
        if row.family == "reference":
            continue
        rows.append([name_of(row, results.base), plus_minus(row.error("early", 0), 2, 100),
                     plus_minus(row.error("early", 1), 2, 100), plus_minus(row.error("longer", 1), 2, 100),
                     plus_minus(row.error("monotonic", 0), 2, 100), plus_minus(row.error("monotonic", 1), 2, 100),
                     plus_minus(row.error("monotonic_longer", 1), 2, 100),
                     plus_minus(paths.ensemble(row.last_stress), 3)])
    early, longer = results.limits.early_reversals, results.limits.longer_reversals
    return table(["setting", f"cyclic, to reversal {early}: rms", "largest", f"to reversal {longer}: largest",
                  f"monotonic, to {100 * results.limits.early_strain:g} %: rms", "largest",
                  f"to {100 * results.limits.longer_strain:g} %: largest",
                  f"p'/p0' at {100 * results.limits.strain:g} %"], rows)


def ensemble_table(results):
    rows = []
    for row in results.rows.values():
        if row.family == "reference":
            continue
        mean, deviation, error, n = paths.ensemble(row.cycles.values())
        ir = paths.ensemble(row.redundancy.values())
        rows.append([name_of(row, results.base), f"{n} of {row.n_tests}", plus_minus((mean, deviation, error, n)),
                     number(deviation),
                     plus_minus(results.paired_difference(row)) if row.setting.grains == results.base.setting.grains
                     and row is not results.slow else "–",
                     plus_minus(ir), number(ir[1])])
    return table(["setting", "liquefied", "cycles to liquefaction", "standard deviation", "less slow limit, paired",
                  "I_R at onset", "standard deviation"], rows)


def cost_table(results):
    rows = []
    for row in results.rows.values():
        steps = paths.ensemble([f["steps"] for f in row.figures])[0]
        onset_only = row.setting.reversals_after == 0 or row.family == "reference"
        rows.append([name_of(row, results.base), count(steps), count(row.mean("steps_before")),
                     "–" if onset_only else count(row.mean("steps_after")),
                     "–" if onset_only else number(row.mean("reversals_after"), 1),
                     "–" if onset_only else percent(row.mean("strain_after")),
                     "–" if onset_only else count(row.steps_per_strain_after / 100),
                     "–" if onset_only else number(row.mean("indicator_after"), 4),
                     number(paths.ensemble(row.cpu)[0], 1), number(paths.ensemble(row.wall)[0], 1),
                     number(row.milliseconds_per_step, 4), count(paths.ensemble(row.monotonic_steps)[0]),
                     number(paths.ensemble(row.monotonic_cpu)[0], 1)])
    return table(["setting", "steps", "to the onset", "liquefied", "reversals liquefied",
                  "strain travelled liquefied, %",
                  "steps per 1 % of it",
                  "median η liquefied", "CPU s", "wall s", "ms per step", "monotonic: steps", "CPU s"], rows)


def grains_table(results):
    rows_ = results.grains_rows()
    if len(rows_) < 2:
        return "Not run."
    largest, rows = rows_[-1], []
    for row in rows_:
        n = row.setting.grains
        void = paths.ensemble([e for (grains, _), e in results.specimens.items() if grains == n])
        early = results.deviation_of_means(row, largest)
        longer = results.deviation_of_means(row, largest, "longer_paths")
        rows.append([f"{n:,}", plus_minus(void, 4), *(
            (percent(d[0]), percent(d[1]), percent(d[2])) if d else ("–",) * 3 for d in [early]).__next__(),
            percent(longer[1]) if longer else "–", plus_minus(row.error("early", 1), 2, 100),
            plus_minus(paths.ensemble(row.cycles.values())), number(paths.ensemble(row.cycles.values())[1])])
    return table(["N", "void ratio", f"mean path to reversal {results.limits.early_reversals} against N = "
                  f"{largest.setting.grains:,}: rms", "largest", "its standard error",
                  f"to reversal {results.limits.longer_reversals}: largest", "error of rate and step at this N",
                  "cycles", "standard deviation"], rows)


def cheapest(rows, key):
    """The row with the least key, a number or several; rows where one of them is missing do not count."""
    keyed = [(key(row), row) for row in rows]
    keyed = [(k, row) for k, row in keyed if not any(map(math.isnan, k if isinstance(k, tuple) else (k,)))]
    return min(keyed, key=lambda pair: pair[0], default=(None, None))[1]


def path_error(row):
    """The worse of cyclic (longer window) and monotonic (early window); the cyclic one if the other was not run."""
    cyclic, monotonic = row.error("longer")[0], row.error("monotonic")[0]
    return cyclic if math.isnan(monotonic) else max(cyclic, monotonic)


def errors_of(row):
    return f"{percent(row.error('longer')[0])} and {percent(row.error('monotonic')[0])} %"


def recommendation(results):
    """Tolerance and time step with the fewest steps whose paths before liquefaction are within GOOD."""
    found = []
    for families in (("default", "tolerance"), ("default", "step")):
        rows = [r for r in compared(results) if r.family in families and path_error(r) <= GOOD]
        # the same bounds may make two tolerances take the same steps: then the more careful one is taken
        found.append(cheapest(rows, lambda r: (round(results.whole_test(r, results.base.mean("strain_after")), -2),
                                               path_error(r))))
    tolerance, step = found
    reversal, floor = results.limits.longer_reversals, floor_of(results, "longer")
    if tolerance is None or step is None:
        what = "tolerances" if tolerance is None else "time steps"
        return (f"**Recommended:** none of the {what} that were run keeps the early paths within "
                f"{100 * GOOD:g} %. {floor}")
    keys = dict(tolerance.setting.motion)
    text = (f"**Recommended:** `quasi_static_tolerance = {keys.get('quasi_static_tolerance', '0.01')}` (largest error "
            f"of the "
            f"cyclic path to reversal {reversal} and of the monotonic one to {100 * results.limits.early_strain:g} %: "
            f"{errors_of(tolerance)}) and `time_step_safety = "
            f"{dict(step.setting.motion).get('time_step_safety', '0.8')}` ({errors_of(step)}): the fewest steps among "
            f"those within {100 * GOOD:g} % in both.")
    outside = dict.fromkeys(r.setting.label for r in (tolerance, step) if not results.within_scatter(r))
    if results.slow is None or len(results.slow.cycles) < 2:
        text += " Too few realisations to judge cycles to liquefaction."
    elif outside:
        text += f" But cycles to liquefaction ({', '.join(outside)}) lie outside the scatter of the slow limit."
    return f"{text} {floor}"


def floor_of(results, window):
    """How far the slow limit itself lies from the reference: it differs in the time step only."""
    slow = results.slow
    value = slow.error(window)[0] if slow else math.nan
    if math.isnan(value):
        return ""
    return f"The slow limit itself is {percent(value)} % from the reference in the cyclic one."


def costs(candidates, error):
    """"x % error costs y minutes (setting)" for each target that some setting reaches."""
    parts, last = [], None
    for target in (0.1,) + TARGETS:
        row = cheapest([r for r in candidates if error(r) <= target], lambda r: r.minutes)
        if row is None:
            return parts + [f"{100 * target:g} % is not reached by any tolerance that was run"]
        if row is not last:
            parts.append(f"{100 * target:g} % error costs {row.minutes:.2g} minutes ({row.setting.label})")
        last = row
    return parts


def user_sentence(results):
    candidates = [r for r in compared(results) if r.family in ADAPTIVE and not math.isnan(r.minutes)]
    text = (f"**For users:** in a cyclic test of {results.base.setting.grains:,} grains on one core, run to the end of "
            f"the liquefied part, with the error taken at the worst point of the cyclic path to reversal "
            f"{results.limits.longer_reversals}, " + ", ".join(costs(candidates, lambda r: r.error("longer")[0]))
            + f". With that of the monotonic path to {100 * results.limits.early_strain:g} % as well, "
            + ", ".join(costs(candidates, path_error)))
    largest = results.grains_rows()[-1] if results.grains_rows() else None
    if largest is not None and largest is not results.base and largest.n_tests:
        text += (f"; with {largest.setting.grains:,} grains the default ({percent(path_error(largest))} %) costs "
                 f"{largest.minutes:.2g} minutes")
    return text + "."


def verdict(results, strain):
    return "\n\n".join(verdict_of(results, strain, window, reversal) for window, reversal in (
        ("early", results.limits.early_reversals), ("longer", results.limits.longer_reversals)))


def verdict_of(results, strain, window, reversal):
    """Adaptive against fixed rates by the number of steps of the whole cyclic test."""
    whole = [r for r in compared(results) if r.n_tests and r.setting.reversals_after > 0]

    def best(target, *families):
        rows = [r for r in whole if r.family in families and results.qualifies(r, target, window)]
        return cheapest(rows, lambda r: results.whole_test(r, strain))

    cells = []
    for target in TARGETS:
        rows = best(target, *ADAPTIVE), best(target, "rate"), best(target, "inertia")
        steps = [results.whole_test(r, strain) if r else math.nan for r in rows]
        cells.append([f"{100 * target:g}"] + [f"{r.setting.label}: {count(s)}" if r else "none" for r, s in
                                              zip(rows, steps)] +
                     [number(steps[0] / steps[1]), number(steps[0] / steps[2])])
    text = table([f"error to reversal {reversal}, %", "adaptive: steps", "fixed strain rate: steps",
                  "fixed inertial number: steps", "adaptive / strain rate", "adaptive / inertial number"], cells)
    path = [r for r in whole if r.error(window)[0] <= GOOD]
    both = [r for r in path if results.within_scatter(r)]
    sentences = [compare(results, strain, rows, family, f"{100 * GOOD:g} % to reversal {reversal}{condition}")
                 for rows, condition in ((both, " and cycles within the scatter"), (path, ", whatever the cycles"))
                 for family in ("rate", "inertia")]
    sentences += [at_equal_quality(results, strain, path, whole, family) for family in ("rate", "inertia")]
    return text + "\n\n" + "\n".join(f"- {s}" for s in sentences)


def compare(results, strain, rows, family, condition):
    """One sentence: the cheapest adaptive setting among `rows` against the cheapest of a family of fixed ones."""
    what = {"rate": "fixed strain rate", "inertia": "fixed inertial number"}[family]

    def steps(row):
        return results.whole_test(row, strain)

    adaptive = cheapest([r for r in rows if r.family in ADAPTIVE], steps)
    other = cheapest([r for r in rows if r.family == family], steps)
    if adaptive is None or other is None:
        missing = [name for name, row in (("adaptive rate", adaptive), (what, other)) if row is None]
        return f"{condition[0].upper() + condition[1:]}: reached by no {' and no '.join(missing)} that was run."
    ratio = steps(adaptive) / steps(other)
    return (f"{condition[0].upper() + condition[1:]}: the adaptive rate "
            f"**{'reaches' if ratio <= 0.5 else 'does not reach'}** "
            f"it in at most half the steps of the best {what}. {adaptive.setting.label} takes {ratio:.2f} of the steps "
            f"of {other.setting.label} ({adaptive.mean('steps') / other.mean('steps'):.2f} as counted, strains not "
            f"brought to "
            f"the same amount); median η of the liquefied parts {number(adaptive.mean('indicator_after'), 4)} and "
            f"{number(other.mean('indicator_after'), 4)}.")


def at_equal_quality(results, strain, rows, whole, family):
    """Steps of the fixed rate that has the median η of the adaptive setting in the liquefied part, interpolated."""
    what = {"rate": "fixed strain rate", "inertia": "fixed inertial number"}[family]
    limit = 1.1 * results.base.mean("indicator_after")
    adaptive = cheapest([r for r in rows if r.family in ADAPTIVE and r.mean("indicator_after") <= limit],
                        lambda r: results.whole_test(r, strain))
    head = f"Equally near to equilibrium when liquefied, {what}: "
    if adaptive is None:
        return (head + f"no adaptive rate within {100 * GOOD:g} % has a median η up to "
                f"{number(limit, 4)} (default + 10 %).")
    eta = adaptive.mean("indicator_after")
    points = sorted((r.mean("indicator_after"), results.whole_test(r, strain), r.setting.label) for r in whole
                    if r.family == family and not math.isnan(r.mean("indicator_after")))
    for (low, many, slower), (high, few, faster) in zip(points, points[1:]):
        if low <= eta <= high and high > low:
            share = math.log(eta / low) / math.log(high / low)
            interpolated = math.exp((1 - share) * math.log(many) + share * math.log(few))
            ratio = results.whole_test(adaptive, strain) / interpolated
            return (head + f"{adaptive.setting.label} has a median η of {number(eta, 4)} and takes {ratio:.2f} of the "
                           f"steps "
                    f"of the fixed one with that η, interpolated between {slower} and {faster}: "
                    f"**{'at most' if ratio <= 0.5 else 'more than'} half**.")
    return head + f"none was run on both sides of η = {number(eta, 4)} ({adaptive.setting.label})."


TEXT = """# Speed against error

What a tolerance, a rate, a time step, damping and the number of grains cost, and what error they bring.

```sh
{command}
```

{state}

Undrained tests on Karlsruhe fine sand, prepared at 10 deg and 200 kPa: cyclic with q_amp = 60 kPa to {after} reversals
after liquefaction (or a strain of 3 %), monotonic compression to {strain:g} %. One factor at a time around tolerance
0.01 (rate between 0.2 and 2 1/s), time step 0.8 of the critical one, damping 0.2, N = {base:,}; every setting on
the same {seeds} specimens (seeds {seed_list}; fewer for the largest N).

**Errors** are distances in the p'-q plane over p0', against a run of the same specimen with I = {slow_number} and 0.2
of the critical step: cyclic at equal q, point by point (1 kPa apart, and at the reversals) up to reversal {early}, and
up to reversal {longer}; monotonic at equal strain, to {early_strain:g} % and {longer_strain:g} %. "Largest" is the
worst point of a path; figures are means over realisations ± their standard error, in percent of p0'. **Cycles** and
I_R at onset are ensembles: mean ± standard error, standard deviation beside it. The slow limit is {slow}.
"Wide" lets the rate go from 0.02 to 20 1/s.

{recommendation}

{sentence}

## Adaptive against fixed rates

Steps of the whole cyclic test, liquefied part included, of the cheapest setting that keeps the error at the worst point
of the path (mean over realisations) within a target and whose mean cycles to liquefaction lie within one standard
deviation of the slow limit ({cycles}). Specimens strain differently after liquefaction, so its steps are brought to the
same strain travelled, {travelled} % (that of the default). Adaptive: any tolerance, wide bounds or not. Settings that
were run to the onset only cannot compete. The fixed rates stand a factor of 2 to 4 apart, the inertial numbers 3 to 10,
the tolerances 2 to 3: a ratio is no surer than that.

{verdict}

## Errors of the path

{errors}

## Liquefaction, ensembles

{ensembles}

## Number of grains

Mean path of all realisations of N against that of the largest N, and the error of rate and time step against the
reference of the same specimens. Void ratios differ: the same preparation friction makes small specimens looser (walls).

{grains}

## Cost

Means over realisations. CPU time includes start and output; ms per step is CPU time over steps. η is the indicator of
[theory.md](../theory.md#8-strain-rate-from-a-tolerance), median over steps. {preparation}

{cost}

## Figures

![error against minutes](speed_error/pareto.png)

![cycles to liquefaction](speed_error/ensembles.png)
"""


def write(results, command):
    base, slow = results.base, results.slow
    seeds = sorted(base.early_paths)
    cycles = paths.ensemble(slow.cycles.values()) if slow else paths.ensemble([])
    reference = results.of_families("reference")
    strain = base.mean("strain_after")
    state = (f"{results.done} of {results.planned} runs done, {results.cpu / 3600:.2f} CPU hours, "
             f"{len(results.binaries)} build{'s' if len(results.binaries) != 1 else ''} of the program: "
             f"{'; '.join(sorted(results.builds))}.")
    prepared = ", ".join(f"{paths.ensemble(cpu)[0]:.0f} s for N = {n:,}"
                         for n, cpu in sorted(results.preparation.items()))
    after = base.setting.reversals_after if results.limits.reversals_after is None else results.limits.reversals_after
    return TEXT.format(
        command=command, state=state, after=after, strain=100 * results.limits.strain, base=base.setting.grains,
        seeds=len(seeds), seed_list=", ".join(map(str, seeds)), early=results.limits.early_reversals,
        slow_number=dict(reference[0].setting.motion)["inertial_number"] if reference else "–",
        early_strain=100 * results.limits.early_strain, longer_strain=100 * results.limits.longer_strain,
        longer=results.limits.longer_reversals, slow=slow.setting.label if slow else "not run",
        cycles=f"{number(cycles[0])}, standard deviation {number(cycles[1])}", travelled=percent(strain),
        recommendation=recommendation(results), sentence=user_sentence(results), verdict=verdict(results, strain),
        errors=error_table(results), ensembles=ensemble_table(results), grains=grains_table(results),
        preparation=f"Preparation took {prepared}." if prepared else "", cost=cost_table(results))
