# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of one test, from its history: characteristic states of monotonic tests, what happens around liquefaction."""
import numpy as np

LIQUEFIED = 0.01  # p'/p0'
FABRIC_FLOOR = 0.001  # p'/p0' below which contacts are too few for a fabric
COUNTS = {"IR": "Eq. 2", "IR_no_twist": "without twisting", "IR_sliding": "sliding only",
          "IR_walls": "Eq. 2 with walls"}
FRACTIONS = ("f_S", "f_R", "f_SR", "f_NSR")


def redundancy_with_walls(history, grains):
    """Eq. 2 with contacts of frictionless walls: one constraint each, and grains that only walls touch are active."""
    constraints = 6 * (grains - history.N0) * history.IR + history.C_wall
    return constraints / (6 * (grains - history.N_floating))


def undrained_states(strain, p, q):
    """Rows of the instability state (None without softening), of the least p' and of the end; |strain| rises."""
    least = int(np.argmin(p))
    peak = int(np.argmax(np.abs(q[:least + 1])))
    softens = peak < least and abs(q[least]) < 0.98 * abs(q[peak])
    return {"instability": peak if softens else None, "least p'": least, "end": len(strain) - 1}


def undrained_numbers(history):
    """{state: (|strain| in %, p' and |q| in kPa, |q|/p')}; not a number where there is none."""
    strain, p, q = np.abs(history.eps_y), history.p, np.abs(history.q)
    numbers = {}
    for name, row in undrained_states(strain, p, q).items():
        if row is None:
            numbers[name] = (np.nan,) * 4
        elif name == "end":
            last = strain > 0.95 * strain[-1]
            stresses = p[last].mean() / 1e3, q[last].mean() / 1e3
            numbers[name] = (100 * strain[-1], *stresses, stresses[1] / stresses[0])
        else:
            numbers[name] = (100 * strain[row], p[row] / 1e3, q[row] / 1e3, q[row] / p[row])
    return numbers


def friction_angle(axial, radial):
    """Mobilised, degrees: sin phi = (s1 - s3)/(s1 + s3)."""
    return np.degrees(np.arcsin((axial - radial) / (axial + radial)))


def drained_numbers(strain, volume_strain, axial, radial):
    """Of a drained compression test, strains as shares, compression positive: peak friction (degrees, mean over 1 % of
    strain) and where it is (%), friction at the end, largest dilatancy -d eps_v/d eps_1 over 1 % of strain, and eps_v
    at 10 % and at the end (%)."""
    grid = np.arange(0, strain[-1] + 1e-9, 0.0025)
    phi, volume = (np.interp(grid, strain, column) for column in (friction_angle(axial, radial), volume_strain))
    means = np.convolve(phi, np.full(5, 0.2), mode="valid")
    peak = int(np.argmax(means))
    return {"peak friction (deg)": means[peak], "strain at peak (%)": 100 * grid[peak + 2],
            "end friction (deg)": means[-1], "dilatancy": (-(volume[4:] - volume[:-4]) / 0.01).max(),
            "eps_v at 10 % (%)": 100 * np.interp(0.1, grid, volume), "eps_v at the end (%)": 100 * volume_strain[-1]}


def crossings(values, level):
    """Rows in which values come from below to the level or above it."""
    return np.flatnonzero((values[:-1] < level) & (values[1:] >= level)) + 1


def goes_on(history):
    """Whether the test liquefies and there are half cycles behind the onset."""
    return history.onset is not None and history.reversals[-1] > history.reversals[history.onset]


def cyclic_numbers(history):
    """Up to the onset, around it and, of a test that continues for half a cycle at least, behind it."""
    onset = history.onset
    behind = slice(onset, None) if goes_on(history) else None
    ratio = history.p / history.p0
    before = slice(0, len(ratio) if onset is None else onset + 1)
    numbers = {"cycles": np.nan if onset is None else history.reversals[onset] / 2,
               "cycles applied": history.reversals[-1] / 2,
               "largest strain before (%)": 100 * np.abs(history.eps_y[before]).max(),
               "IR at the start": history.IR[0]}
    for column, name in COUNTS.items():
        count = getattr(history, column)
        numbers[f"I_R at onset, {name}"] = np.nan if onset is None else count[onset]
        below = np.flatnonzero(count[before] < 1)
        numbers[f"p'/p0' where I_R falls below 1, {name}"] = ratio[below[0]] if below.size else np.nan
    numbers.update(fabric_numbers(history, before))
    numbers.update(swings(history, before))
    numbers["p'/p0' at the end"] = ratio[-1]
    for column in FRACTIONS:
        numbers[f"{column} before"] = strain_mean(history, column, before)
        numbers[f"{column} after"] = strain_mean(history, column, behind) if behind else np.nan
    numbers["largest strain after, compression (%)"] = 100 * history.eps_y[behind].max() if behind else np.nan
    numbers["largest strain after, extension (%)"] = -100 * history.eps_y[behind].min() if behind else np.nan
    if behind:
        carries = ratio[behind] > FABRIC_FLOOR
        numbers["correlation of I_R and |F_yx| after"] = np.corrcoef(
            history.IR[behind][carries], np.abs(history.F_yx[behind][carries]))[0, 1]
        soft = np.abs(history.q[behind]) < 0.1 * np.abs(history.q[before]).max()
        way = np.diff(travelled(history, behind), prepend=0)
        numbers["share of strain at |q| < q_amp/10 after"] = way[soft].sum() / way.sum()
    return numbers


def swings(history, before):
    """Of the half cycles up to the onset: mean range of a number within one, and mean I_R of their thirds."""
    half = history.reversals[before]
    third = half[-1] / 3
    numbers = {"mean I_R in the first third": history.IR[before][half <= third].mean(),
               "mean I_R in the last third": history.IR[before][half >= 2 * third].mean()}
    for name in ("IR", "f_S", "f_R"):
        column = getattr(history, name)[before]
        ranges = [np.ptp(column[half == k]) for k in np.unique(half)]
        numbers[f"mean range of {name} in a half cycle before"] = np.mean(ranges)
    return numbers


def fabric_numbers(history, before):
    """Largest anisotropies up to the onset, in the first and the last third of those reversals, and after it."""
    anisotropy = np.abs(history.F_yx)
    third = history.reversals[before][-1] / 3
    reversals = history.reversals[before]
    numbers = {"largest |F_xx - F_zz| before": np.abs(history.Fxx - history.Fzz)[before].max(),
               "largest |F_yx| before": anisotropy[before].max(),
               "largest |F_yx| in the first third": anisotropy[before][reversals <= third].max(),
               "largest |F_yx| in the last third": anisotropy[before][reversals >= 2 * third].max()}
    after = slice(history.onset, None)
    numbers["largest |F_yx| after"] = largest_anisotropy(history, after) if goes_on(history) else np.nan
    return numbers


def largest_anisotropy(history, rows):
    """Where enough contacts carry."""
    anisotropy, ratio = np.abs(history.F_yx[rows]), history.p[rows] / history.p0
    return anisotropy[ratio > FABRIC_FLOOR].max(initial=0)


def strain_mean(history, column, rows):
    """Mean by the strain travelled; not a number of a test that ends at the onset."""
    strain = history.eps_y[rows]
    if len(strain) < 2:
        return np.nan
    return np.average(getattr(history, column)[rows], weights=np.abs(np.gradient(strain)) + 1e-15)


def half_cycles(history):
    """One row for each whole half cycle after the onset."""
    onset = history.onset
    if onset is None:
        return []
    ends = [row for row in history.reversal_rows if row >= onset]
    rows = []
    for begin, end in zip(ends, ends[1:]):
        part = slice(begin, end + 1)
        ratio, index = history.p[part] / history.p0, history.IR[part]
        recovered = crossings(ratio, LIQUEFIED)
        first, last = (index[recovered[k]] if recovered.size else np.nan for k in (0, -1))
        sliding = history.f_S[part]
        turns = np.flatnonzero(np.diff(np.sign(history.F_yx[part])) != 0)
        rows.append({"direction": "compression" if history.q[end] > 0 else "extension",
                     "strain travelled (%)": 100 * abs(history.eps_y[end] - history.eps_y[begin]),
                     "strain at its end (%)": 100 * history.eps_y[end], "least I_R": index.min(),
                     "I_R at its beginning": index[0], "largest p'/p0'": ratio.max(),
                     "I_R as F_yx changes sign": index[turns[-1] + 1] if turns.size else np.nan,
                     "I_R as p'/p0' first passes 0.01": first, "I_R as it last does": last,
                     "largest |F_yx|": largest_anisotropy(history, part), "F_yx at its end": history.F_yx[end],
                     "p'/p0' at the most sliding": ratio[int(np.argmax(sliding))],
                     "largest f_S": sliding.max(), "f_S at its end": sliding[-1]})
    return rows


def travelled(history, rows):
    """Axial strain travelled since the first of the rows."""
    return np.cumsum(np.abs(np.diff(history.eps_y[rows], prepend=history.eps_y[rows][:1])))


def bins(measure, begin, points):
    """Rows from `begin` on in equal parts of a measure that rises over them: a slice for each, none empty."""
    edges = np.searchsorted(measure, np.linspace(0, measure[-1], points + 1)).clip(0, len(measure) - 1)
    edges[-1] = len(measure)
    return [slice(begin + low, begin + max(low + 1, high)) for low, high in zip(edges, edges[1:])]


def phases(history, points=20):
    """[(x, slice of rows)] on an axis on which seeds can be averaged: x from 0 to 1 is the share of the half cycles to
    the onset, from 1 to 2 that of the strain travelled from the onset to the next reversal, then whole half cycles, the
    first towards compression, each by the share of the strain travelled in it."""
    onset = history.onset
    if onset is None:
        return []
    way = travelled(history, slice(0, onset + 1))
    ends = [0, *(row for row in history.reversal_rows if 0 < row < onset), onset]
    measures = [(0, np.interp(way, way[ends], np.arange(len(ends))))]
    ends = [row for row in history.reversal_rows if row > onset]
    if ends:
        measures.append((onset, travelled(history, slice(onset, ends[0] + 1))))
    if len(ends) > 1 and history.q[ends[0]] > 0:
        ends = ends[1:]  # at a reversal in extension: seeds liquefy on either side
    measures += [(begin, travelled(history, slice(begin, end + 1))) for begin, end in zip(ends, ends[1:])]
    return [(section + (k + 0.5) / points, rows) for section, (begin, measure) in enumerate(measures)
            for k, rows in enumerate(bins(measure, begin, points))]
