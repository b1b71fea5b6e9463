# SPDX-License-Identifier: BSD-3-Clause
"""A column of nonlinear soil that owes nothing to Isostat: a hyperbola with Masing's rules, and a shear beam.

tau = G gamma / (1 + G |gamma| / tau_max)                                             Hardin and Drnevich (1972)
Unloading and reloading follow tau = tau_r + 2 f((gamma - gamma_r)/2) from the last turning point (Masing 1926); a
branch that meets an older one, or the backbone, continues along that (Pyke 1979; Kramer 1996, 6.4.3: extended rules).

tested: tests/apps/column_others_test.py
"""
import numpy as np


class Masing:
    """n points side by side; each remembers the turning points of its strain that no later one has passed."""

    def __init__(self, modulus, strength):
        """modulus   G of small strain, (n,), Pa        strength   tau_max, (n,), Pa"""
        self.modulus, self.strength = np.broadcast_arrays(*map(np.atleast_1d, (modulus, strength)))
        n = len(self.modulus)
        self.points = np.arange(n)
        self.strain, self.stress, self.direction = np.zeros(n), np.zeros(n), np.zeros(n)
        self.turns = np.zeros(n, dtype=int)                      # how many turning points are remembered
        self.memory = np.zeros((2, 8, n))                        # their strains and stresses, the oldest first

    def backbone(self, strain):
        return self.modulus * strain / (1 + self.modulus * np.abs(strain) / self.strength)

    def _remember(self, turned):
        if turned.any() and self.turns[turned].max() == self.memory.shape[1]:
            self.memory = np.concatenate([self.memory, np.zeros_like(self.memory)], axis=1)
        at = self.points[turned]
        self.memory[0, self.turns[at], at], self.memory[1, self.turns[at], at] = self.strain[at], self.stress[at]
        self.turns[at] += 1

    def _forget(self, strain, way):
        """Pairs of turning points whose loop closes, and the first one if the backbone is met."""
        while True:
            older = self.memory[0, np.maximum(self.turns - 2, 0), self.points]
            closed = (self.turns >= 2) & ((strain - older) * way >= 0) & (way != 0)
            if not closed.any():
                break
            self.turns[closed] -= 2
        self.turns[(self.turns == 1) & (strain * way >= np.abs(self.memory[0, 0])) & (way != 0)] = 0

    def to(self, strain):
        """Stress after going straight to a strain, (n,), Pa."""
        way = np.sign(strain - self.strain)
        self._remember(way * self.direction < 0)
        self._forget(strain, way)
        last = self.memory[:, np.maximum(self.turns - 1, 0), self.points]
        branch = last[1] + 2 * self.backbone((strain - last[0]) / 2)
        stress = np.where(self.turns > 0, branch, self.backbone(strain))
        self.stress = np.where(way == 0, self.stress, stress)
        self.direction = np.where(way == 0, self.direction, way)
        self.strain = strain.copy()
        return self.stress


class ShearBeam:
    """Masses joined by springs of shear on a rigid base that moves: linear elements of one height, lumped masses, one
    point of soil in the middle of each, central differences (velocities at half steps)."""

    def __init__(self, height, n, density, soil):
        """soil(depth) -> (modulus, strength) at the middles of the n elements, Pa   height m, density kg/m3"""
        self.h = height / n
        self.depth = (np.arange(n) + 0.5) * self.h
        self.law = Masing(*soil(self.depth))
        self.mass = np.full(n, density * self.h)
        self.mass[0] /= 2
        self.stable = self.h * np.sqrt(density / self.law.modulus.max())

    def run(self, time, motion, step, depths=()):
        """Moves the base by an acceleration that is straight between samples.

        time, motion   of the samples, s and m/s2      step   at most; made a whole part of time[-1], s
        Returns time of the rows, absolute acceleration of the surface, strain and stress of the elements at the depths.
        """
        steps = int(np.ceil(time[-1] / step - 1e-9))
        dt = time[-1] / steps
        if dt > self.stable:
            raise ValueError(f"step {dt} s is above the stable one, {self.stable} s")
        base = np.interp(dt * np.arange(steps + 1), time, motion)
        at = [int(np.argmin(np.abs(self.depth - z))) for z in depths]
        u, v = np.zeros(len(self.mass)), np.zeros(len(self.mass))
        surface, strain, stress = np.zeros(steps + 1), np.zeros((len(at), steps + 1)), np.zeros((len(at), steps + 1))
        tau = self.law.stress
        for k in range(steps + 1):                               # everything of a row is of time k dt
            force = -np.diff(tau, prepend=0)                     # tau grows downwards; it pulls a mass back
            relative = force / self.mass - base[k]
            surface[k] = relative[0] + base[k]
            strain[:, k], stress[:, k] = self.law.strain[at], tau[at]
            v = v + relative * (dt / 2 if k == 0 else dt)
            u = u + v * dt
            tau = self.law.to(-np.diff(u, append=0) / self.h)
        return dt * np.arange(steps + 1), surface, strain, stress
