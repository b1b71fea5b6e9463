# SPDX-License-Identifier: BSD-3-Clause
"""Columns that are solved by Isostat and by others, and how far apart two motions are.

For the study column_others and tests/apps/column_others_test.py.
"""
import pathlib

import numpy as np
from scipy import signal

from studies.column_layers import Layers
from studies.column_masing import ShearBeam

ROOT = pathlib.Path(__file__).resolve().parents[1]
RECORD = ROOT / "apps/scenes/motions/simulated_m6.5_20km_x.at2"
HEIGHT, DENSITY, VELOCITY, STRENGTH_RATIO, SURCHARGE, GRAVITY, REFERENCE = 20.0, 1900.0, 200.0, 0.55, 20e3, 9.81, 100e3
DEPTHS = (10.1, 19.9)
HARMONIC = 'kind = "harmonic"\namplitude = "{} m/s2"\nfrequency = "2 Hz"\nduration = "4 s"\nramp = "1 s"'
RICKER = 'kind = "ricker"\namplitude = "0.001 m/s2"\nfrequency = "4 Hz"'
ROCK = {"velocity": 800.0, "density": 2300.0}
RECORDED = f'kind = "record"\nfile = "{RECORD}"\npeak = "{{}} m/s2"'


def sand_scene(motion, *, cells=80, elements=128, step=2e-4, duration=5.0, rows=1, rock=None):
    """20 m of sand whose stiffness and strength follow the mean stress and which shear neither contracts nor dilates.

    motion   text of [[motion]]      step   s      rows   time steps between rows of the histories      rock   as ROCK
    """
    base = f'density = "{rock["density"]} kg/m3"\nshear_velocity = "{rock["velocity"]} m/s"' if rock else ""
    return f"""title = "sand that neither contracts nor dilates"
[mesh]
degree = 1
[water]
drainage = "dry"
[[layer]]
thickness = "{HEIGHT} m"
cells = {cells}
density = "{DENSITY} kg/m3"
k0 = 1.0
material = "iwan"
reference_pressure = "100 kPa"
shear_velocity = "{VELOCITY} m/s"
strength_ratio = {STRENGTH_RATIO}
contraction = 0
dilation = 0
elements = {elements}
[base]
kind = "{"compliant" if rock else "rigid"}"
{base}
[[motion]]
{motion}
[load]
surcharge = "{SURCHARGE} Pa"
[analysis]
viscosity = "0 ms"
duration = "{duration} s"
time_step = "{step} s"
[output]
history_interval = "{rows * step} s"
depths = ["{DEPTHS[0]} m", "{DEPTHS[1]} m"]
"""


def sand(depth):
    """Shear modulus of small strain and shear strength of that sand, Pa."""
    p = SURCHARGE + DENSITY * GRAVITY * depth
    return DENSITY * VELOCITY**2 * np.sqrt(p / REFERENCE), STRENGTH_RATIO * p


def sand_beam(n):
    return ShearBeam(HEIGHT, n, DENSITY, sand)


def sand_layers(n, rock=None):
    """The sand at small strain in n layers, and the reference strains in the middle of them."""
    depth = (np.arange(n) + 0.5) * HEIGHT / n
    modulus, strength = sand(depth)
    layers = Layers(np.full(n, HEIGHT / n), np.sqrt(modulus / DENSITY), DENSITY,
                    rock=(rock["velocity"], rock["density"]) if rock else None)
    return layers, strength / modulus


def published():
    """The example of nrattle (tests/reference/nrattle): rows of the profile, frequencies, amplification."""
    profile, table = (np.loadtxt(ROOT / f"tests/reference/nrattle/{name}.csv", delimiter=",", skiprows=1)
                      for name in ("profile", "amplification"))
    return profile, *table.T


def published_layers():
    """Rows of that profile, by wave speed in five parts. Neighbours that are equal are one layer, and those that are
    equal to the half-space belong to it."""
    layers = []
    for thickness, *soil in published()[0]:
        if layers and layers[-1][1:] == soil:
            layers[-1][0] += thickness
        else:
            layers.append([thickness, *soil])
    layers = np.array(layers[:-1])
    edges = [0, 1100, 1400, 1900, 2600, np.inf]
    return [layers[(layers[:, 1] >= slow) & (layers[:, 1] < fast)] for slow, fast in zip(edges, edges[1:])]


def write_published(folder, corner):
    """Tables of the profile, and the motion: a smooth pulse of acceleration, whose spectrum falls from 1 at 0 Hz
    to 0.64 at `corner`, Hz."""
    for k, rows in enumerate(published_layers()):
        np.savetxt(folder / f"layers_{k}.csv", rows, fmt="%.10g", delimiter=",", comments="",
                   header="thickness (m),shear_velocity (m/s),density (kg/m3)")
    width = 0.15 / corner
    time = np.arange(0, 16 * width, 1e-4)
    np.savetxt(folder / "pulse.txt", np.column_stack([time, np.exp(-((time / width - 8) ** 2) / 2)]))


def published_scene(folder, corner, per_wave, duration):
    """The same profile as a scene of soil_column, whose tables and motion write_published() has put into a folder.

    corner   highest frequency, Hz      per_wave   elements for the shortest wave, at least      duration   s
    """
    rock = published()[0][-1, 1:]
    scene = f'[base]\nkind = "compliant"\ndensity = "{rock[1]} kg/m3"\nshear_velocity = "{rock[0]} m/s"\n'
    for k, rows in enumerate(published_layers()):
        size = rows[:, 1].min() / corner / per_wave
        scene += (f'[[layer]]\ntable = "{folder}/layers_{k}.csv"\ncell_size = "{size} m"\n'
                  'material = "elastic"\npoisson_ratio = 0.0\n')
    return scene + (f'[water]\ndrainage = "dry"\n[[motion]]\nkind = "record"\nfile = "{folder}/pulse.txt"\n'
                    'unit = "m/s2"\n'
                    f'[analysis]\nviscosity = "0 ms"\nduration = "{duration} s"\n[output]\nhistory_interval = "1 ms"\n')


def amplification(rows, frequency):
    """Fourier spectrum of the surface over that of the motion that was given."""
    turn = np.exp(-2j * np.pi * np.outer(frequency, rows["time"]))
    return np.abs(turn @ rows["surface_ax"]) / np.abs(turn @ rows["input_ax"])


def low_passed(motion, interval, corner):
    """Butterworth of order 4, forward and backward: no delay."""
    return signal.sosfiltfilt(signal.butter(4, 2 * corner * interval, output="sos"), motion)


def largest_difference(a, b):
    """Largest |a - b| over the largest |b|."""
    return float(np.abs(a - b).max() / np.abs(b).max())


def response_spectrum(motion, interval, periods, damping=0.05):
    """Largest absolute acceleration of oscillators, as many as periods; by the Fourier transform, with rest behind."""
    n = 2 * len(motion)
    spectrum, w = np.fft.rfft(motion, n), 2 * np.pi * np.fft.rfftfreq(n, interval)
    result = []
    for w0 in 2 * np.pi / np.asarray(periods):
        spring = w0**2 + 2j * damping * w0 * w
        result.append(np.abs(np.fft.irfft(spectrum * spring / (spring - w**2), n)).max())
    return np.array(result)


def iwan_polygon(n):
    """Nodes of tau/tau_max over gamma/gamma_r that n Iwan elements follow (fem/material/iwan.hpp, fit_hyperbola)."""
    lift, last = (0.018 * (12 / n) ** 1.53, 1) if n > 32 else (0.018 * (12 / n) ** 1.35, 1.2)
    x = lift * (last / lift**2) ** (np.arange(n) / (n - 1))
    f = (1 + lift) * x / (1 + x)
    f[0], f[-1] = x[0], 1
    return np.append(0, x), np.append(0, f)
