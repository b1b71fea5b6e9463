# SPDX-License-Identifier: BSD-3-Clause
"""Analysis of a soil column's motions: response spectra, transfer functions and exact solutions. SI units."""
import numpy as np
from scipy.signal import lfilter

STEPS_PER_PERIOD = 64


# --- response spectrum -----------------------------------------------------------------------------------------------


def oscillator_step(omega, damping, h):
    """Exact step of u'' + 2 xi w u' + w^2 u = -a under linear a: x1 = A x0 + b0 a0 + b1 a1, x = (u, u')."""
    damped = omega * np.sqrt(1 - damping**2)
    decay = np.exp(-damping * omega * h)
    c, s = decay * np.cos(damped * h), decay * np.sin(damped * h) / damped
    step = np.array([[c + damping * omega * s, s], [-omega**2 * s, c - damping * omega * s]])

    def response(a, slope):  # the particular solution p + q tau is left out of the free vibration
        q = -slope / omega**2
        p = (-a - 2 * damping * omega * q) / omega**2
        return step @ np.array([-p, -q]) + np.array([p + q * h, q])

    return step, response(1.0, -1 / h), response(0.0, 1 / h)


def acceleration(a, h, omega, damping, pseudo=False):
    """Of an oscillator at rest: the exact step as a recursive filter, absolute y = -(w^2 u + 2 xi w u'), or pseudo
    y = -w^2 u."""
    step, b0, b1 = oscillator_step(omega, damping, h)
    out = -np.array([omega**2, 0 if pseudo else 2 * damping * omega])
    rest = step - np.trace(step) * np.eye(2)
    numerator = [out @ b1, out @ (b0 + rest @ b1), out @ rest @ b0]
    denominator = [1.0, -np.trace(step), np.linalg.det(step)]
    start = [-numerator[0] * a[0], -(out @ rest @ b1) * a[0]]  # at rest, though a(0) may differ from 0
    return lfilter(numerator, denominator, a, zi=start)[0]


def response_spectrum(a, dt, periods, damping=0.05, pseudo=False):
    """Peak absolute acceleration SA, or pseudo-acceleration PSA, of oscillators (Nigam and Jennings 1969,
    doi:10.1785/BSSA0590020909: exact for a that is linear between samples).

    Steps are T/64 at most, which misses 0.13 % of a peak at most; one period of free vibration follows the motion.
    """
    spectrum = []
    for period in periods:
        n = int(np.ceil(STEPS_PER_PERIOD * dt / period))
        fine = np.interp(np.arange((len(a) - 1) * n + 1) / n, np.arange(len(a)), a)
        fine = np.concatenate([fine, np.zeros(int(np.ceil(period * n / dt)))])
        spectrum.append(np.abs(acceleration(fine, dt / n, 2 * np.pi / period, damping, pseudo)).max())
    return np.array(spectrum)


# --- transfer function -----------------------------------------------------------------------------------------------


def is_cut_off(a):
    """Whether a record ends before its motion: its Fourier integral is not that of the motion."""
    return np.abs(a[-max(1, len(a) // 20):]).max() > 0.2 * np.abs(a).max()


def fourier(a, dt):
    """Frequencies (Hz) and the Fourier integral of a motion that has died away, finely spaced by zeros behind it."""
    size = 2 ** int(np.ceil(np.log2(4 * len(a))))
    return np.fft.rfftfreq(size, dt), dt * np.fft.rfft(a, size)


def smoothed(f, amplitude, centres, bandwidth=80.0):
    """Konno and Ohmachi (1998), doi:10.1785/BSSA0880010228: weights (sin(x)/x)^4, x = b log10(f/fc); wider bands where
    frequencies are higher, and where `f` is too coarse for them: two of its frequencies on either side."""
    inside = f > 0
    bandwidth = np.minimum(bandwidth, np.pi / np.log10(1 + 2 * (f[1] - f[0]) / centres))[:, None]
    x = bandwidth * np.log10(f[inside][None, :] / centres[:, None])
    weights = np.where(np.abs(x) < np.pi * 3, np.sinc(x / np.pi) ** 4, 0)
    return weights @ amplitude[inside] / weights.sum(axis=1)


def transfer_function(of_surface, of_input, dt, f_max):
    """Surface over input: frequencies, ratio, and where the input is strong enough (2 % of its peak) for it to mean
    something."""
    f, upper = fourier(of_surface, dt)
    lower = np.abs(fourier(of_input, dt)[1])
    kept = (f > 0) & (f <= f_max)
    strong = lower[kept] > 0.02 * lower.max()
    return f[kept], np.abs(upper[kept]) / np.where(lower[kept] > 0, lower[kept], np.inf), strong


def smoothed_transfer(of_surface, of_input, dt, centres):
    f, upper = fourier(of_surface, dt)
    lower = np.abs(fourier(of_input, dt)[1])
    kept = f < 2 * centres[-1]
    below = smoothed(f[kept], lower[kept], centres)
    strong = below > 0.02 * below.max()
    return np.where(strong, smoothed(f[kept], np.abs(upper[kept]), centres) / np.where(below > 0, below, 1), np.nan)


def exact_transfer(f, layer, base, mass_damping=0.0, viscosity=0.0, viscous_above=25.0):
    """|F| of a uniform elastic layer, surface over the motion of a rigid base or the outcrop of an elastic one.

    rigid:     F = 1 + (w/w*)^2 (1/cos(k* H) - 1)                          damping of the motion relative to the base
    compliant: F = 1 / (cos k* H + i G* k* / (w rho_r V_r) sin k* H)
    w*^2 = w^2 - i w a_M, k* = w*/V*, V*^2 = V_s^2 (1 + i w beta i w/(i w + w_c)), G* = rho V*^2
    """
    w = 2 * np.pi * f
    complex_w = np.sqrt(w**2 - 1j * w * mass_damping)
    velocity = layer["velocity"] * np.sqrt(1 - viscosity * w**2 / (1j * w + 2 * np.pi * viscous_above))
    k = complex_w / velocity
    if base is None:
        return np.abs(1 + (w / complex_w) ** 2 * (1 / np.cos(k * layer["height"]) - 1))
    impedance = layer["density"] * velocity**2 * k / (w * base["density"] * base["velocity"])
    return np.abs(1 / (np.cos(k * layer["height"]) + 1j * impedance * np.sin(k * layer["height"])))


# --- consolidation ---------------------------------------------------------------------------------------------------


class Terzaghi:
    """A uniform layer of thickness B under a sudden load q, drained at the surface (H = B), or at its base as well
    (H = B/2). With D = 2 G (1 - nu)/(1 - 2 nu), S = n/K_f:

    p0 = q/(1 + S D), c = k/(rho_f g)/(1/D + S), T = c t/H^2, m = (j + 1/2) pi
    p(z, t) = p0 sum 2/m sin(m z/H) exp(-m^2 T), settlement = (q - p0) B/D + p0 B/D (1 - sum 2/m^2 exp(-m^2 T))
    """

    def __init__(self, layer, water, load):
        self.thickness, self.load = layer["height"], load
        self.height = self.thickness / (2 if water.get("base") == "drained" else 1)  # the longest way of the water
        nu, shear = layer["poisson_ratio"], layer["density"] * layer["velocity"] ** 2
        self.modulus = 2 * shear * (1 - nu) / (1 - 2 * nu)
        storage = layer["porosity"] / water["bulk_modulus"]
        self.p0 = load / (1 + storage * self.modulus)
        mobility = layer["permeability"] / water.get("relative_viscosity", 1) / (water["density"] * water["gravity"])
        self.c = mobility / (1 / self.modulus + storage)
        self.m = (np.arange(400) + 0.5) * np.pi

    def time_factor(self, t):
        return self.c * np.asarray(t) / self.height**2

    def pressure(self, depth, t):
        decay = 2 / self.m * np.exp(-self.m**2 * self.time_factor(t))
        return self.p0 * np.sin(np.outer(depth / self.height, self.m)) @ decay

    def settlement(self, t):
        left = np.exp(-np.outer(self.time_factor(t), self.m**2)) @ (2 / self.m**2)
        return self.thickness / self.modulus * (self.load - self.p0 * left)
