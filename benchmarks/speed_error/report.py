# SPDX-License-Identifier: BSD-3-Clause
"""Writes the report in Markdown: what was measured, tables, and what follows from them."""
import math
import textwrap

from speed_error import paths


def number(value, digits=2):
    return "–" if value is None or math.isnan(value) else f"{value:,.{digits}f}"


def counted(n, noun):
    return f"{n} {noun}{'s' * (n != 1)}"


def plus_minus(ensemble, digits=2, factor=1):
    mean, _, error, n = ensemble
    if n < 2:
        return number(factor * mean, digits)
    return f"{factor * mean:.{digits}f} ± {factor * error:.{digits}f}"


def percent(ensemble, digits=2):
    return plus_minus(ensemble, digits, 100)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def error_table(results):
    limits = results.limits
    rows = [[row.setting.label, str(len(row.errors["longer"])), percent(row.error("early", 0)),
             percent(row.error("early")), percent(row.error("longer", 0)), percent(row.error("longer")),
             percent(row.error("monotonic")), percent(row.error("monotonic_longer")),
             plus_minus(paths.ensemble(row.last_stress), 3)] for row in results.rows if row.errors["longer"]]
    return table(["setting", "specimens", f"cyclic, to reversal {limits.early_reversals}: rms", "largest",
                  f"to reversal {limits.longer_reversals}: rms", "largest",
                  f"monotonic, to {100 * limits.early_strain:g} %: largest",
                  f"to {100 * limits.longer_strain:g} %: largest", f"p'/p0' at {100 * limits.strain:g} %"], rows)


def ensemble_table(results):
    rows = []
    for row in results.rows:
        if not row.figures:
            continue
        cycles, redundancy = (paths.ensemble(values.values()) for values in (row.cycles, row.redundancy))
        comparable = row.setting.grains == results.base.setting.grains and row is not results.slow
        paired = results.paired_difference(row) if comparable else paths.ensemble([])
        rows.append([row.setting.label, f"{len(row.cycles)} of {len(row.figures)}", plus_minus(cycles),
                     number(cycles[1]), plus_minus(paired), str(paired[3] or "–"), plus_minus(redundancy),
                     number(redundancy[1])])
    return table(["setting", "liquefied", "cycles to liquefaction", "standard deviation", "less slow limit, paired",
                  "pairs", "I_R at onset", "standard deviation"], rows)


def cost_table(results):
    rows = []
    for row in results.rows + list(results.references.values()):
        if not row.figures:
            continue
        label = f"{row.setting.label}, N = {row.setting.grains:,}" if row.family == "reference" else row.setting.label
        rows.append([label, number(row.mean("steps_before"), 0), number(row.seconds_to_onset, 1),
                     number(row.steps_per_strain_after / 100, 0), number(row.mean("steps"), 0),
                     number(paths.ensemble(row.cpu)[0], 1), number(row.milliseconds_per_step, 4),
                     number(paths.ensemble(row.monotonic_steps)[0], 0),
                     number(paths.ensemble(row.monotonic_cpu)[0])])
    return table(["setting", "steps to the onset", "CPU s to the onset", "steps per 1 % of strain liquefied",
                  "steps of the test", "CPU s", "ms per step",
                  f"monotonic, to {100 * results.limits.early_strain:g} %: steps", "CPU s"], rows)


def grains_table(results):
    rows_ = results.grains_rows()
    largest, rows = rows_[-1], []
    for row in rows_:
        n = row.setting.grains
        void = paths.ensemble([e for (grains, _), e in results.specimens.items() if grains == n])
        means = [results.deviation_of_means(row, largest, window) for window in ("early", "longer")]
        cells = [number(100 * value) for found in means for value in (found[1:] if found else (math.nan,) * 2)]
        cycles = paths.ensemble(row.cycles.values())
        rows.append([f"{n:,}", str(len(row.figures)), plus_minus(void, 4), *cells, percent(row.error()),
                     plus_minus(cycles), number(cycles[1])])
    early, longer = results.limits.early_reversals, results.limits.longer_reversals
    return table(["N", "specimens", "void ratio", f"mean path to reversal {early} against N = "
                  f"{largest.setting.grains:,}: largest", "standard error", f"to reversal {longer}: largest",
                  "standard error", f"error at this N, to reversal {longer}", "cycles", "standard deviation"], rows)


def user_sentence(results):
    """Error against minutes of the rates, the fastest first, and what the default does besides."""
    base, limits = results.base, results.limits
    rates = sorted((r for r in results.rows if r.family in ("default", "inertia") and r.errors["longer"]
                    and not math.isnan(r.seconds_to_onset)), key=lambda r: r.seconds_to_onset)
    costs = ", ".join(f"{r.seconds_to_onset / 60:.2g} minutes for {percent(r.error())} % ({r.setting.label})"
                      for r in rates)
    cycles, paired = paths.ensemble(base.cycles.values()), results.paired_difference(base)
    text = (f"**For users:** a cyclic test of {base.setting.grains:,} grains up to initial liquefaction costs on one "
            f"core, by the error at the worst point of its path to reversal {limits.longer_reversals}: {costs}. "
            f"At the default ({counted(len(base.figures), 'specimen')}) the monotonic path is within "
            f"{percent(base.error('monotonic'), 1)} % of p0' to a strain of {100 * limits.early_strain:g} % and within "
            f"{percent(base.error('monotonic_longer'), 1)} % to {100 * limits.longer_strain:g} %, and tests "
            f"liquefy after {plus_minus(cycles, 1)} cycles")
    if paired[3]:
        text += (f"; less those of the same specimen at the slow limit, {results.slow.setting.label}, that is "
                 f"{plus_minus(paired, 1)} ({counted(paired[3], 'pair')})")
    return text + "."


TEXT = """# Speed against error

What a rate, a time step, damping, free grains, walls that push and the number of grains cost, and what error they
bring. Written by `benchmarks/speed_error.py`; how to run it is in
[benchmarks/README.md](../../benchmarks/README.md#speed-against-error).

```sh
{command}
```

{state}

Undrained tests on Karlsruhe fine sand, prepared at 10 deg and 200 kPa: cyclic with q_amp = 60 kPa to {after} reversals
after liquefaction (or a strain of 3 %), monotonic compression to {strain:g} %. One factor at a time around the default:
inertial number 4e-4 (some 8 1/s), time step 0.8 of the critical one, dashpots 0.05, local damping 0.1, damping of free
grains 0.1, grains carried with the walls, N = {base:,}. Slow settings end with the onset and at a strain of
{longer_strain:g} %. The default was run on {specimens}, the other settings on as many of the same as the tables say.

**Errors** are distances in the p'-q plane over p0', against a run of the same specimen with I = {slow_number} and half
the time step, {reference_step} of the critical one: cyclic at equal q, point by point (1 kPa apart, and at the
reversals) up to reversal {early}, and up to reversal {longer}; monotonic at equal strain, to {early_strain:g} % and
{longer_strain:g} %. "Largest" is the worst point of a path; figures are means over realisations ± their standard error,
in percent of p0'. **Cycles** and I_R at onset are ensembles: mean ± standard error, standard deviation beside it.
"Paired" is the mean difference to the slow limit ({slow}), specimen by specimen, ± its standard error. The range behind
"±" is missing where there is one specimen.

{sentence}

## Errors of the path

{errors}

![error against time](speed_error/pareto.png)

## Liquefaction, ensembles

{ensembles}

![cycles to liquefaction](speed_error/ensembles.png)

Thin bars: standard deviation; thick bars: standard error; dots: specimens; grey band: the slow limit and its standard
deviation.

## Number of grains

Mean path of all realisations of N against that of the largest N, with the standard error of their difference, and the
error of rate and time step against the reference of the same specimens. Void ratios differ: the same preparation
friction makes small specimens looser (walls).

{grains}

## Cost

Means over realisations. CPU time includes start and output; ms per step is CPU time over steps. {preparation}

{cost}
"""


def wrapped(text):
    """Paragraphs of at most 120 columns; tables, figures and code are left as they are."""
    blocks = text.split("\n\n")
    return "\n\n".join(block if block.lstrip()[:1] in "|!#`" else
                       textwrap.fill(block, 120, break_long_words=False, break_on_hyphens=False) for block in blocks)


def write(results, command):
    base, limits = results.base, results.limits
    reference = dict(results.references[base.setting.grains].setting.motion)
    state = (f"{results.done} of {results.planned} runs done, {results.cpu / 60:.1f} CPU minutes, "
             f"{counted(len(results.binaries), 'build')} of the program: {'; '.join(sorted(results.builds))}.")
    if results.done < results.planned:
        state += " **The campaign is not complete**; figures of few specimens say little about scatter."
    prepared = ", ".join(f"{paths.ensemble(cpu)[0]:.1f} s for N = {n:,}"
                         for n, cpu in sorted(results.preparation.items()))
    return wrapped(TEXT.format(
        command=command, state=state, after=base.setting.reversals_after, strain=100 * limits.strain,
        base=base.setting.grains, specimens=counted(len(base.tracks["early"]), "specimen"),
        slow_number=reference["inertial_number"], reference_step=reference["time_step_safety"],
        early=limits.early_reversals, longer=limits.longer_reversals, early_strain=100 * limits.early_strain,
        longer_strain=100 * limits.longer_strain,
        slow=f"{results.slowest.label}, default time step{'' if results.slow else '; not run yet'}",
        sentence=user_sentence(results), errors=error_table(results), ensembles=ensemble_table(results),
        grains=grains_table(results), cost=cost_table(results),
        preparation=f"Preparation took {prepared}." if prepared else "")) + "\n"
