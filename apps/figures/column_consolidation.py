# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a consolidation: isochrones of the pore pressure and settlement, next to Terzaghi's series."""
import numpy as np
from matplotlib.colors import LogNorm

from .column_analysis import Terzaghi
from .column_soil import TIMES, depth_axis, time_bar
from .common import BLACK, BLUE, note, plt
from .drawing import draws

UNITS = (("years", 365.25 * 86400), ("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0), ("s", 1.0))
TIME_FACTORS = (0.01, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5)
MIN_COMPARED = 0.01  # time factor from which the exact series is compared: earlier the mesh cannot show the front


def unit_of(last):
    """Name and length (s) of the unit for times up to the last one: the largest that is not longer than half of it."""
    return next(((name, length) for name, length in UNITS if last >= 2 * length), UNITS[-1])


def exact_solution(column):
    layer, load = column.uniform_elastic(), column.step_load()
    if not layer or not load or layer["permeability"] <= 0 or column.water["table"] > 0:
        return None
    has_air = layer["saturation"] < 1 or column.water["henry"] > 0  # its stiffness rises with the depth
    return None if has_air or layer["permeability_law"] != "constant" else Terzaghi(layer, column.water, load)


def chosen_rows(time, exact):
    """Rows after t = 0, which a logarithm does not have, nearest to round time factors, or spread evenly."""
    targets = np.geomspace(time[time > 0][0], time[-1], 8) if exact is None else \
        np.array(TIME_FACTORS) * exact.height**2 / exact.c
    targets = targets[targets <= 1.05 * time[-1]]
    return np.unique([int(np.argmin(np.where(time > 0, np.abs(time - t), np.inf))) for t in targets])


@draws("fig_isochrones")
def isochrones(column):
    """Excess pore pressure over the depth, next to Terzaghi's series if it applies; dotted: boundaries between
    layers."""
    pressure = column.profile("u")
    if not column.consolidation or pressure is None:
        return None
    depth, time, exact = column.profiles["depth"], column.profiles["time"], exact_solution(column)
    rows = chosen_rows(time, exact)
    if rows.size == 0:
        return None
    figure, axes = plt.subplots(figsize=(5.6, 4.4), layout="constrained")
    unit, length = unit_of(time[-1])
    time = time / length
    norm = LogNorm(*(time[rows[[0, -1]]] if rows.size > 1 else np.array([0.5, 2]) * time[rows[0]]))
    time_bar(figure, axes, norm, norm.vmax, unit=unit)
    fine = np.linspace(0, exact.thickness, 400) if exact else None
    for row in rows:
        axes.plot(pressure[row] / 1e3, depth, color=TIMES(norm(time[row])), linewidth=2.2 if exact else 1.2,
                  label="computed" if row == rows[-1] else None)
        if exact:
            axes.plot(exact.pressure(fine, length * time[row]) / 1e3, fine, color=BLACK, linewidth=0.8,
                      linestyle=(0, (4, 2)), label="Terzaghi" if row == rows[-1] else None)
    if exact:
        time = length * time
        report("pore pressure", [np.abs(pressure[k] - exact.pressure(depth, time[k])).max() / exact.p0
                                 for k in range(len(time))], time, exact, "of the initial one")
        axes.legend(loc="upper right")
    axes.set(xlim=(0, None), xlabel="Excess pore pressure $u$ (kPa)", ylabel="Depth (m)")
    depth_axis(column, axes, depth)
    return figure


def report(what, differences, time, exact, unit):
    """Largest difference from the time factor on at which it is fair to compare."""
    late = exact.time_factor(time) >= MIN_COMPARED
    if late.any():
        worst = np.where(late, differences, 0)
        at = int(np.argmax(worst))
        print(f"{what}: largest difference from Terzaghi's series {worst[at]:.2e} {unit}, at T = "
              f"{exact.time_factor(time[at]):.3g} (T >= {MIN_COMPARED})")


@draws("fig_settlement")
def settlement(column):
    """Settlement against time, next to Terzaghi's if it applies."""
    if not column.consolidation or not column.has("settlement"):
        return None
    after = column.time > 0
    time, values, exact = column.time[after], column["settlement"][after], exact_solution(column)
    if len(time) < 2:
        note("settlement: fewer than two times; not drawn")
        return None
    figure, axes = plt.subplots(figsize=(5.8, 3.6), layout="constrained")
    unit, length = unit_of(time[-1])
    axes.plot(time / length, 1e3 * values, color=BLUE, linewidth=2.4, alpha=0.75, label="computed")
    if exact:
        fine = np.geomspace(time[0], time[-1], 400)
        axes.plot(fine / length, 1e3 * exact.settlement(fine), color=BLACK, linewidth=0.9, linestyle=(0, (4, 2)),
                  label="Terzaghi")
        last = exact.thickness * exact.load / exact.modulus
        report("settlement", np.abs(values - exact.settlement(time)) / last, time, exact, "of the last one")
        axes.legend(loc="lower left")
        factor = length * exact.c / exact.height**2
        second = axes.secondary_xaxis("top", functions=(lambda t: t * factor, lambda t_v: t_v / factor))
        second.set_xlabel("Time factor $T_v$")
    axes.set(xscale="log", xlim=(time[0] / length, time[-1] / length), ylim=(0, None))
    axes.invert_yaxis()
    axes.set(xlabel=f"Time ({unit})", ylabel="Settlement (mm)")
    return figure
