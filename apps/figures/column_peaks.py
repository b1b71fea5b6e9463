# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the largest values of a column over the depth, and of its resistance to liquefaction."""
import numpy as np
from matplotlib.ticker import MaxNLocator

from .column_box import is_box
from .column_soil import MIN_RU, depth_axis
from .common import BLACK, BLUE, RED, letters, plt
from .drawing import draws
from .site_response import resistance

# column of profile.csv, factor, label, unit, whether it jumps between layers, and from which value on it is drawn
# (in SI): less is the error of a mesh
SPECS = (("PGA", 1, "PGA", "m/s$^2$", False, 1e-2),
         ("gamma_max", 100, r"$\gamma_\mathrm{max}$", "%", True, 1e-7),
         ("CSR", 1, r"CSR = 0.65 $\tau/\sigma_{v0}^\prime$", "", True, 1e-3),
         ("ru_max", 1, "Largest $r_u$", "", True, MIN_RU),
         ("PGD", 100, "Displacement", "cm", False, 1e-6))


def row_of(n):
    """Panels over the depth side by side, and their figure."""
    figure, panels = plt.subplots(1, n, figsize=(1.9 * n + 0.4, 4.0), sharey=True, squeeze=False, layout="constrained")
    figure.get_layout_engine().set(w_pad=0.08)
    letters(panels)
    panels[0, 0].set_ylabel("Depth (m)")
    return figure, panels[0]


@draws("fig_peaks")
def peaks(column):
    """Largest values of all steps over the depth: horizontal acceleration, shear strain, cyclic stress ratio (until
    r_u of the point reaches 0.5), r_u, horizontal displacement (against a rigid base); a dot marks the largest of each,
    whose value and depth are above it; dotted: boundaries between layers. profile.csv has them, with velocity, shear
    stress and settlement."""
    table = column.peak_profile
    specs = [spec for spec in SPECS if spec[0] in table and np.nanmax(np.nan_to_num(table[spec[0]])) > spec[-1]]
    if not column.shaken or is_box(column) or not specs:
        return None
    figure, panels = row_of(len(specs))
    for axes, (name, factor, label, unit, jumps, _) in zip(panels, specs):
        known = np.isfinite(table[name])
        values, depth = factor * table[name][known], table["depth"][known]
        z, curve = column.broken(depth, values) if jumps else (depth, values)
        at = int(np.argmax(values))
        axes.plot(curve, z, color=BLACK, linewidth=1.2)
        axes.plot(values[at], depth[at], "o", color=BLACK, markersize=3.5, clip_on=False, zorder=5)
        axes.set_title(f"{values[at]:.3g} {unit}\nat {depth[at]:.3g} m", loc="right", fontsize=8.5, pad=5)
        axes.set(xlabel=label + (f" ({unit})" if unit else ""), xlim=(0, None))
        axes.xaxis.set_major_locator(MaxNLocator(4))
        depth_axis(column, axes, depth)
    return figure


@draws("fig_liquefaction")
def liquefaction(column):
    """Cyclic stress ratio CSR against the cyclic resistance ratio CRR of the layers that have one (magnitude 7.5,
    15 cycles; multiply CRR by MSF for another), and the factor of safety CRR/CSR, over the depth; dashed: a factor of
    1, dotted: boundaries between layers. CSR is 0.65 of the largest shear stress until r_u of the point reaches 0.5,
    because later spikes are those of soil that dilates; 0.65 is for earthquakes, cycles of one amplitude have CSR/0.65.
    The stress is the resultant of all axes that are shaken, CRR that of shear in one direction."""
    found = resistance(column)
    if found is None or not np.isfinite(found[3]).any():
        return None
    depth, csr, crr, safety = found
    figure, (ratios, factors) = row_of(2)
    for values, label, style in ((csr, "CSR", {"color": BLACK}), (crr, "CRR", {"color": BLUE, "linewidth": 1.6})):
        z, curve = column.broken(depth, values)
        ratios.plot(curve, z, label=label, **style)
    ratios.set(xlabel="CSR, CRR (magnitude 7.5)", xlim=(0, 1.15 * np.nanmax(np.append(csr, crr))))
    ratios.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0.2, handlelength=1.2)
    z, curve = column.broken(depth, safety)
    factors.plot(curve, z, color=BLACK)
    factors.axvline(1, color=RED, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    factors.set(xlabel="Factor of safety CRR/CSR", xlim=(0, min(3, 1.1 * np.nanmax(np.append(safety, 1)))))
    for axes in (ratios, factors):
        depth_axis(column, axes, depth)
    return figure
