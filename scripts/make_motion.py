#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simulates the horizontal acceleration of an earthquake on hard rock and writes it as PEER AT2 text.

    make_motion.py [--magnitude 6.5] [--distance 20] [--seed 2] ... --out STEM      writes STEM_x.at2, STEM_y.at2
    make_motion.py --check [the same options]                                       prints numbers, writes nothing

Stochastic method with a point source (Boore 2003, Pure Appl. Geophys. 160, 635-676). Gaussian noise n(t) times the
window w(t) gets a spectrum of mean square 1, and then the amplitude of the target:

    Y(f) = C M0 (2 pi f)^2 / (1 + (f/f0)^2)  /R  exp(-pi f R / (Q(f) b))  exp(-pi kappa f)
    log10 M0 = 1.5 M + 16.05 (dyne cm)            moment (Hanks and Kanamori 1979)
    f0 = 4.9e6 b (stress drop / M0)^(1/3)         corner frequency, b in km/s, stress drop in bar (Brune 1970)
    C = 0.55 sqrt(1/2) 2 / (4 pi rho b^3 1 km)    radiation pattern, share of one component, free surface
    Q(f) = Q0 f^n                                 loss along the path; the spreading 1/R holds below about 70 km
    w(t) = a (t/t_e)^p exp(-c t/t_e)              Saragoni and Hart (1974), 1 at 0.2 t_e, 0.05 at t_e
    t_e = 2 (1/f0 + 0.05 R)                       duration at the source and that of the path (R in km)

Only the amplitude of Y is prescribed. Its source term gets the phase of Brune's pulse, 1/(1 + i f/f0)^2, so that hardly
anything moves before the window opens and the ground comes back to rest. The two components have the same Y and
independent noise. Left out: amplification by softer rock and soil near the surface, finite fault, near-fault pulses, P
waves.
"""
import argparse
import pathlib
import shlex
import sys

import numpy as np

GRAVITY = 9.80665  # m/s2, what g means in a record
LEAD = 1.0  # s of rest before the window opens
PER_LINE = 8


def corner_frequency(p):
    return 4.9e6 * p.shear_velocity * (p.stress_drop / moment(p)) ** (1 / 3)


def moment(p):
    return 10 ** (1.5 * p.magnitude + 16.05)  # dyne cm


def target(p, f):
    """Y(f), m/s, complex by the phase of the source; 1e-20 brings km, g/cm3 and dyne cm to cm, 1e-2 to m."""
    constant = 0.55 * np.sqrt(0.5) * 2 / (4 * np.pi * p.density * p.shear_velocity**3) * 1e-20
    source = constant * moment(p) * (2j * np.pi * f) ** 2 / (1 + 1j * f / corner_frequency(p)) ** 2
    quality = p.q0 * np.maximum(f, 1e-9) ** p.q_exponent
    path = np.exp(-np.pi * f * p.distance / (quality * p.shear_velocity)) / p.distance
    return 1e-2 * source * path * np.exp(-np.pi * p.kappa * f)


def window(p, t):
    """Saragoni and Hart with its peak at epsilon t_e and the value eta at t_e."""
    epsilon, eta = 0.2, 0.05
    power = -epsilon * np.log(eta) / (1 + epsilon * (np.log(epsilon) - 1))
    x = np.maximum(t - LEAD, 0) / (2 * (1 / corner_frequency(p) + 0.05 * p.distance))
    return (np.e / epsilon * x) ** power * np.exp(-power / epsilon * x)


def simulate(p, component, seed):
    """Accelerations, m/s2. Circles of the transform are kept off by as much rest again as the record is long."""
    n = int(round(p.duration / p.interval)) + 1
    size = 2 ** int(np.ceil(np.log2(2 * n)))
    noise = np.zeros(size)
    random = np.random.RandomState([seed, component])  # a stream that no version of numpy changes
    noise[:n] = random.standard_normal(n) * window(p, p.interval * np.arange(n))
    spectrum = np.fft.rfft(noise)
    spectrum /= np.sqrt(np.mean(np.abs(spectrum) ** 2))
    frequencies = np.fft.rfftfreq(size, p.interval)
    return np.fft.irfft(spectrum * target(p, frequencies), size)[:n] / p.interval


# --- file ------------------------------------------------------------------------------------------------------------


def command(p):
    """The command that makes the file again, with every parameter."""
    words = ["make_motion.py"]
    for name, value in vars(p).items():
        if name not in ("out", "check", "realisations"):
            words += ["--" + name.replace("_", "-"), f"{value:g}"]
    return shlex.join(words)


def write(p, path, component, a):
    lines = [f"SIMULATED MOTION, NOT A RECORD. Component {'xy'[component]} of two; seed {p.seed}",
             f"M {p.magnitude:g} at {p.distance:g} km, hard rock; stochastic point source (Boore 2003); {command(p)}",
             "ACCELERATION TIME SERIES IN UNITS OF G",
             f"NPTS= {len(a)}, DT= {p.interval:.4f} SEC"]
    for start in range(0, len(a), PER_LINE):
        lines.append("".join(f"{value:10.6f}" for value in a[start:start + PER_LINE] / GRAVITY))
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    print(f"{path}: {len(a)} values, {path.stat().st_size / 1000:.0f} kB, peak {np.abs(a).max() / GRAVITY:.3f} g")


# --- checks ----------------------------------------------------------------------------------------------------------


def integrate(a, dt):
    """Velocity and displacement, exact for accelerations that are linear in between."""
    v = np.concatenate([[0], np.cumsum(dt * (a[1:] + a[:-1]) / 2)])
    d = np.concatenate([[0], np.cumsum(dt * v[:-1] + dt**2 * (2 * a[:-1] + a[1:]) / 6)])
    return v, d


def quadratic_baseline(a, dt):
    """Less a parabola: end velocity 0, smallest sum of squared velocities (as baseline = "quadratic" in a scene)."""
    t = np.linspace(0, 1, len(a))

    def level(x):
        return x - integrate(x, dt)[0][-1] / (dt * (len(x) - 1))

    a, powers = level(a), [level(t), level(t**2)]
    velocities = np.column_stack([integrate(x, dt)[0] for x in powers])
    c = np.linalg.lstsq(velocities, integrate(a, dt)[0], rcond=None)[0]
    return a - c[0] * powers[0] - c[1] * powers[1]


def usual_peak(p):
    """Median PGA in g and its ln standard deviation, V_s30 = 760 m/s, R_JB = R (Boore and Atkinson 2008)."""
    r, m = np.hypot(p.distance, 1.35), p.magnitude
    bent = 0.28805 * (m - 6.75) - 0.10164 * (m - 6.75) ** 2 if m <= 6.75 else 0.0
    return np.exp((-0.6605 + 0.1197 * (m - 4.5)) * np.log(r) - 0.01151 * (r - 1) - 0.53804 + bent), 0.566


def check_spectrum(p):
    """Root mean square of the Fourier amplitudes of many seeds over the target, in bands of a sixth of an octave."""
    n = int(round(p.duration / p.interval)) + 1
    size = 2 ** int(np.ceil(np.log2(n)))
    f = np.fft.rfftfreq(size, p.interval)
    square, peaks = np.zeros(len(f)), []
    for seed in range(p.realisations):
        a = simulate(p, 0, seed)
        square += (p.interval * np.abs(np.fft.rfft(a, size))) ** 2 / p.realisations
        peaks.append(np.abs(a).max() / GRAVITY)
    edges = 0.1 * 2 ** np.arange(0, np.log2(0.4 / p.interval / 0.1), 1 / 6)
    bands = [(f >= low) & (f < high) for low, high in zip(edges, edges[1:])]
    requested = np.abs(target(p, f)) ** 2
    ratio = np.array([np.sqrt(square[band].sum() / requested[band].sum()) for band in bands if band.any()])
    median, (usual, sigma) = np.median(peaks), usual_peak(p)
    print(f"{p.realisations} seeds: rms Fourier amplitude over target, {edges[0]:.2g} to {edges[-1]:.3g} Hz: "
          f"{ratio.min():.3f} to {ratio.max():.3f}, mean {ratio.mean():.4f}")
    print(f"{p.realisations} seeds: median PGA {median:.3f} g; rock of 760 m/s, Boore and Atkinson (2008): "
          f"{usual:.3f} g, within a factor of {np.exp(sigma):.2f} in two of three cases")
    return np.abs(ratio - 1).max() < 0.05 and abs(np.log(median / usual)) < sigma


def check_component(p, component):
    a = simulate(p, component, p.seed)
    raw_v, raw_d = integrate(a, p.interval)
    v, d = integrate(quadratic_baseline(a, p.interval), p.interval)
    arias = np.cumsum(a**2) * p.interval * np.pi / (2 * GRAVITY)
    strong = p.interval * (np.searchsorted(arias, 0.95 * arias[-1]) - np.searchsorted(arias, 0.05 * arias[-1]))
    print(f"{'xy'[component]}: PGA {np.abs(a).max() / GRAVITY:.3f} g, PGV {np.abs(v).max():.3f} m/s, PGD "
          f"{np.abs(d).max():.3f} m, Arias {arias[-1]:.3f} m/s, 5 to 95 % of it in {strong:.1f} s")
    print(f"   at the end, as written: v = {raw_v[-1]:.1e} m/s, d = {raw_d[-1]:.1e} m; with the quadratic baseline: "
          f"v = {v[-1]:.1e} m/s, d = {d[-1]:.1e} m")
    return abs(v[-1]) < 1e-9 and abs(d[-1]) < 0.2 * np.abs(d).max()  # the parabola leaves an offset, but no drift


def check(p):
    print(f"moment {moment(p):.3g} dyne cm, corner frequency {corner_frequency(p):.3f} Hz")
    good = [check_spectrum(p)] + [check_component(p, component) for component in (0, 1)]
    print("as expected" if all(good) else "NOT as expected")
    return 0 if all(good) else 1


def parameters(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default, text in (
            ("magnitude", 6.5, "moment magnitude M"), ("distance", 20, "R from the source, km"),
            ("stress-drop", 80, "bar"), ("shear-velocity", 3.5, "b at the source, km/s"),
            ("density", 2.8, "rho at the source, g/cm3"), ("q0", 180, "Q at 1 Hz"),
            ("q-exponent", 0.45, "n in Q0 f^n"), ("kappa", 0.03, "loss near the surface, s"),
            ("interval", 0.005, "between samples, s"), ("duration", 25, "s")):
        parser.add_argument("--" + name, type=float, default=default, help=f"{text} (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=2, help="of the noise (default: %(default)s)")
    parser.add_argument("--realisations", type=int, default=2000, help="seeds of --check (default: %(default)s)")
    parser.add_argument("--check", action="store_true", help="print how well target and motion agree")
    parser.add_argument("--out", type=pathlib.Path, help="path and stem of the two files")
    p = parser.parse_args(arguments)
    if not p.check and p.out is None:
        parser.error("give --out STEM, or --check")
    if min(p.distance, p.stress_drop, p.shear_velocity, p.density, p.q0, p.interval) <= 0 or p.duration < 5:
        parser.error("distances, stresses, velocities and intervals must be > 0, the duration 5 s at least")
    return p


def main():
    p = parameters()
    if p.check:
        return check(p)
    p.out.parent.mkdir(parents=True, exist_ok=True)
    for component in (0, 1):
        write(p, p.out.with_name(p.out.name + f"_{'xy'[component]}.at2"), component, simulate(p, component, p.seed))
    return 0


if __name__ == "__main__":
    sys.exit(main())
