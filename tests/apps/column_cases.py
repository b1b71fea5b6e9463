# SPDX-License-Identifier: BSD-3-Clause
"""Columns that are solved by Isostat and by others, and how far apart two motions are. For column_others_test.py and
benchmarks/column_others.py."""
import pathlib

import numpy as np
from scipy import signal

from column_masing import ShearBeam

RECORD = pathlib.Path(__file__).resolve().parents[2] / "apps/scenes/motions/simulated_m6.5_20km_x.at2"
HEIGHT, DENSITY, VELOCITY, STRENGTH_RATIO, SURCHARGE, GRAVITY, REFERENCE = 20.0, 1900.0, 200.0, 0.55, 20e3, 9.81, 100e3
DEPTHS = (10.1, 19.9)
HARMONIC = 'kind = "harmonic"\namplitude = "{} m/s2"\nfrequency = "2 Hz"\nduration = "4 s"\nramp = "1 s"'
RECORDED = f'kind = "record"\nfile = "{RECORD}"\npeak = "{{}} m/s2"'


def sand_scene(motion, *, cells=80, elements=128, step=2e-4, duration=5.0, rows=1):
    """20 m of sand whose stiffness and strength follow the mean stress and which shear neither contracts nor dilates.

    motion   text of [[motion]]      step   s      rows   time steps between rows of the histories
    """
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
shear_velocity = "{VELOCITY} m/s"
strength_ratio = {STRENGTH_RATIO}
contraction = 0
dilation = 0
elements = {elements}
[[motion]]
{motion}
[load]
surcharge = "{SURCHARGE} Pa"
[analysis]
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
