# SPDX-License-Identifier: BSD-3-Clause
"""Shear waves in layers over elastic rock, in the frequency domain; and the equivalent-linear method on top of it.

In layer m, z downwards from its top, u = A exp(i k z) + B exp(-i k z) with k = w/V*, V* = sqrt(G*/rho): A goes up. u
and G* du/dz are continuous and the surface is free, so A and B follow from the surface down (Thomson 1950, Haskell
1953; Kramer 1996, 7.2.1.4). G* = G (1 + 2 i D).

tested: tests/apps/column_others_test.py
"""
import numpy as np


class Layers:
    def __init__(self, thickness, velocity, density, damping=0.0, rock=None):
        """Of n layers from the surface down: m, m/s, kg/m3, part of critical.

        rock   (velocity, density) of the half-space below, undamped; None: a rigid base
        """
        self.thickness = np.asarray(thickness, float)
        self.velocity, self.density, self.damping = (np.broadcast_to(np.asarray(x, float), self.thickness.shape)
                                                     for x in (velocity, density, damping))
        self.rock = rock

    def waves(self, frequency):
        """(A, B, k) of each layer and of what is below the last, if the surface moves by 1: (n + 1, frequencies)."""
        w = 2 * np.pi * np.maximum(np.asarray(frequency, float), 1e-9)
        velocity = self.velocity * np.sqrt(1 + 2j * self.damping)
        stiffness, k = self.density * velocity**2, w / velocity[:, None]
        bottom = stiffness[-1:], k[-1:]
        if self.rock is not None:
            bottom = np.array([self.rock[1] * self.rock[0] ** 2]), w[None] / self.rock[0]
        stiffness, k = np.append(stiffness, bottom[0]), np.vstack([k, bottom[1]])
        up, down = np.full(k.shape, 0.5 + 0j), np.full(k.shape, 0.5 + 0j)
        for m, h in enumerate(self.thickness):
            ratio = stiffness[m] * k[m] / (stiffness[m + 1] * k[m + 1])
            a, b = up[m] * np.exp(1j * k[m] * h), down[m] * np.exp(-1j * k[m] * h)
            up[m + 1], down[m + 1] = (a * (1 + ratio) + b * (1 - ratio)) / 2, (a * (1 - ratio) + b * (1 + ratio)) / 2
        return up, down, k

    def surface(self, frequency):
        """Motion of the surface over that of the rigid base, or of the rock's outcrop (twice the wave that goes up)."""
        up, down, _ = self.waves(frequency)
        return 1 / (2 * up[-1] if self.rock is not None else up[-1] + down[-1])

    def strains(self, frequency):
        """Shear strain in the middle of each layer over the acceleration of base or outcrop, s2/m: (n, frequencies)."""
        up, down, k = (x[:-1] for x in self.waves(frequency))
        middle = 1j * k * self.thickness[:, None] / 2
        w = 2 * np.pi * np.maximum(np.asarray(frequency, float), 1e-9)
        gradient = 1j * k * (up * np.exp(middle) - down * np.exp(-middle))  # z downwards
        return gradient * self.surface(frequency) / w**2                    # -du/dz of u = -a/w^2


def hyperbola(strain):
    """Secant modulus over G and damping of a hyperbola with Masing's rules; strain over the reference strain tau_max/G.

    The loop of f(x) = x/(1 + x) holds 8 (integral of f - x f/2); D is that over 2 pi x f (Ishihara 1996, 3.21).
    """
    x = np.maximum(np.asarray(strain, float), 1e-3)  # below, round-off: D = 2 x/(3 pi) there
    f = x / (1 + x)
    damping = 4 * (x - np.log1p(x) - x * f / 2) / (np.pi * x * f)
    small = np.asarray(strain, float) < 1e-3
    return 1 / (1 + np.asarray(strain, float)), np.where(small, 2 * np.asarray(strain, float) / (3 * np.pi), damping)


def equivalent_linear(layers, curve, motion, interval, *, ratio=0.65, passes=30):
    """Each layer has the secant modulus and damping of `ratio` times its largest strain (Schnabel, Lysmer, Seed 1972).

    layers   with the moduli of small strain        motion   acceleration of base or outcrop, at an interval in s
    curve    function of the strains of the layers: G/G_max and damping ratio
    Returns surface acceleration, largest strain of each layer, change of the strains in the last pass over the largest.
    """
    n = 2 * len(motion)
    frequency, spectrum = np.fft.rfftfreq(n, interval), np.fft.rfft(motion, n)
    largest, change = np.zeros(len(layers.thickness)), 1.0
    for _ in range(passes):
        secant, damping = curve(ratio * largest)
        soft = Layers(layers.thickness, layers.velocity * np.sqrt(secant), layers.density, damping, layers.rock)
        before, largest = largest, np.abs(np.fft.irfft(spectrum * soft.strains(frequency), n)).max(axis=1)
        change = np.abs(largest - before).max() / largest.max()
        if change < 1e-4:
            break
    return np.fft.irfft(spectrum * soft.surface(frequency), n)[:len(motion)], largest, change
