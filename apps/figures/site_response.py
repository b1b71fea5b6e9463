# SPDX-License-Identifier: BSD-3-Clause
"""What an engineer takes out of a shaken column: motions as files, intensities, spectra, the period of the site, CSR
against CRR. All from the files of a run, in SI units.   tested: tests/apps/site_response_test.py"""
import numpy as np

from .column_analysis import response_spectrum, smoothed_transfer
from .common import BadInput

GRAVITY = 9.80665
HUSID = (0.05, 0.95)  # shares of the Arias intensity between which the significant duration is
LIQUEFYING = 0.5  # r_u from which on soil has no frequency of its own, as the CSR of profile.csv has it for stress
BEGINNING = "ISOSTAT SITE RESPONSE ANALYSIS"  # of an AT2 file
A_LINE = 5  # accelerations in a line of it


def input_name(column):
    """What the motion put in is, in the words of DEEPSOIL: that of the outcrop of the rock, or that within, at the base
    itself."""
    return "outcrop" if column.base else "within"


# --- motions ---------------------------------------------------------------------------------------------------------


def motion(column, where="surface", axis="x"):
    """Accelerations (m/s2, absolute) and their interval (s), from the rows of the history.

    where   "surface"; "input"; "within", at the base; or one of output.depths, m: of the node that is nearest to it
    Raises BadInput
    """
    if isinstance(where, str):
        name = {"within": "base"}.get(where, where) + f"_a{axis}"
    else:
        name = f"{prefix_at(column, where)}_a{axis}"
    if not column.has(name):
        raise BadInput(f"there is no motion {where} along {axis} in history.csv")
    return column.motion(name)


def prefix_at(column, depth):
    """Of the columns of an output depth.   Raises BadInput"""
    requested = column.summary.get("requested_depths", [])
    for asked, node, (_, prefix) in zip(requested, column.motion_depths, column.points):
        if node is not None and min(abs(asked - depth), abs(node - depth)) < 1e-6:
            return prefix
    raise BadInput(f"depth = {depth:g} m: must be one of output.depths ({', '.join(f'{z:g} m' for z in requested)}), "
                   "at which motions are recorded. Add it there and run the scene again")


def write_at2(column, path, where="surface", axis="x"):
    """A motion in the format AT2 of PEER, in g, ten digits each.   Raises BadInput"""
    if not column.shaken:
        raise BadInput("the run has no motion: nothing was shaken")
    if axis not in column.moving:
        raise BadInput(f"axis = {axis}: the run has no motion along it, but along {', '.join(column.moving) or 'none'}")
    a, dt = motion(column, where, axis)
    words = [f"{value:17.9E}" for value in np.asarray(a) / GRAVITY]
    lines = ["".join(words[k:k + A_LINE]) for k in range(0, len(words), A_LINE)]
    header = [BEGINNING, f"{where}, {axis}".upper(), "ACCELERATION TIME SERIES IN UNITS OF G",
              f"NPTS= {len(words)}, DT= {dt:.10g} SEC"]
    path.write_text("\n".join([*header, *lines, ""]), encoding="ascii")


def spectrum(column, where="surface", axis="x", periods=None, damping=None):
    """Periods (s), absolute and pseudo acceleration SA and PSA (m/s2) of oscillators on a motion. Of the rows of the
    history, which hold frequencies up to a quarter of their number in a second; those of surface and input from every
    step are in spectra.csv."""
    periods = np.geomspace(0.02, 5, 160) if periods is None else np.asarray(periods, dtype=float)
    damping = column.spectrum_damping if damping is None else damping
    a, dt = motion(column, where, axis)
    return (periods, *(response_spectrum(a, dt, periods, damping, pseudo) for pseudo in (False, True)))


def intensity(a, dt):
    """{PGA m/s2, arias m/s, D5_95 s, CAV m/s} of a motion.

    Arias intensity pi/(2g) int a^2 dt (Arias 1970); D5-95 between 5 and 95 % of it (Trifunac & Brady 1975,
    doi:10.1785/BSSA0650030581); cumulative absolute velocity int |a| dt (EPRI 1988, NP-5930).
    """
    a = np.asarray(a, dtype=float)
    husid = np.concatenate([[0], np.cumsum(a[1:]**2 + a[:-1]**2)]) * dt / 2
    times = np.interp(np.multiply(HUSID, husid[-1]), husid, dt * np.arange(len(a)))
    return {"PGA": float(np.abs(a).max()), "arias": float(np.pi / (2 * GRAVITY) * husid[-1]),
            "D5_95": float(times[1] - times[0]), "CAV": float(dt * (np.abs(a[1:]) + np.abs(a[:-1])).sum() / 2)}


def intensity_at(column, where="surface", axis="x"):
    """intensity() of a motion, from the rows of the history."""
    return intensity(*motion(column, where, axis))


# --- site ------------------------------------------------------------------------------------------------------------


def site(column):
    """{height m, travel_time s, mean_velocity, V_s30 m/s, period s}, or {} where the velocities are not known. At the
    start of the run.

    travel_time   of a shear wave, sum h/V_s; mean_velocity H over it; period four times it: 4H/V_s
    V_s30         30 m over the travel time through them, below the column in the rock of a compliant base; None above a
                  rigid base that is less deep
    """
    speeds = column.velocities.get("shear_velocity")
    if speeds is None or not (speeds > 0).all():
        return {}
    top, bottom = column.shares(column.velocities["depth"])
    times, height = (bottom - top) / speeds, float(bottom[-1])
    time, upper = float(times.sum()), float((np.clip(30 - top, 0, bottom - top) / speeds).sum())
    deep = height >= 30 - 1e-9
    rock = (30 - height) / column.base["velocity"] if column.base else np.nan
    return {"height": height, "travel_time": time, "mean_velocity": height / time, "period": 4 * time,
            "V_s30": 30 / upper if deep else 30 / (time + rock) if column.base else None}


def transfer(column, axis="x", over=None, f=None):
    """Frequencies (Hz) and ratio of the Fourier amplitudes of the surface over another motion, both smoothed (Konno and
    Ohmachi 1998, b = 80); not-a-number where that motion has less than 2 % of its largest amplitude.

    over   "within": the transfer function of the soil; "outcrop": the amplification against the outcrop, only above a
           compliant base. Default: the motion put in
    """
    over = over or input_name(column)
    if over == "outcrop" and not column.base:
        raise BadInput("there is no outcrop motion: the base is rigid, and its motion is the one within")
    below, dt = motion(column, "input" if over == "outcrop" else "within", axis)
    f = np.geomspace(0.1, min(25, 0.25 / dt), 600) if f is None else np.asarray(f, dtype=float)
    return f, smoothed_transfer(motion(column, "surface", axis)[0], below, dt, f)


def largest_ru(column):
    """Over the depth, of all steps; 0 where no point has any."""
    return float(np.nanmax(np.nan_to_num(column.peak_profile["ru_max"]))) if column.peak_profile else 0.0


def first_frequency(column, axis="x"):
    """f1 (Hz): where the transfer function over the motion put in is largest below the middle of the first two modes of
    an elastic layer, 2/T with T = 4H/V_s. Sand that softens has it lower than 1/T. None: no motion says it, or sand
    liquefies, which has no one frequency while it softens and dilates."""
    period = site(column).get("period")
    if period is None or largest_ru(column) >= LIQUEFYING:
        return None
    f, ratio = transfer(column, axis, f=np.geomspace(0.2 / period, 2 / period, 400))
    known = np.isfinite(ratio)
    return float(f[np.nanargmax(ratio)]) if known.mean() > 0.5 else None


# --- liquefaction ----------------------------------------------------------------------------------------------------


def resistance(column):
    """Depth (m), CSR, CRR and factor of safety CRR/CSR of each point of profile.csv, not-a-number in layers without
    resistance; None if no layer of summary.json has `crr`, or if depths do not say the layer (mesh.file).

    CSR   0.65 of the largest resultant shear stress, until r_u of the point reaches 0.5, over sigma'_v0: what comes
          later are spikes of soil that dilates. 0.65 is for earthquakes; cycles of one amplitude have CSR/0.65
    CRR   of magnitude 7.5 (15 cycles), level ground and shear in one direction; magnitude 7.5: multiply CRR by MSF for
          another
    """
    given = [layer.get("crr") for layer in column.summary.get("layers", [])]
    if not column.peak_profile or not any(given) or column.is_drawn:
        return None
    profile = column.peak_profile
    points = np.isfinite(profile["CSR"])
    depth, csr = profile["depth"][points], profile["CSR"][points]
    crr = np.array([given[k] if given[k] else np.nan for k in column.layer_at(depth)], dtype=float)
    return depth, csr, crr, crr / np.where(csr > 0, csr, np.nan)
