# SPDX-License-Identifier: BSD-3-Clause
"""Bearing capacity of heavy frictional soil by the method of characteristics (Sokolovskii 1965; Martin 2005).

Plane strain, c = 0, unit weight gamma = 1, surcharge q; x along the surface from the edge of a
smooth strip, which is at x < 0, z down. With s the mean stress (compression positive), a the angle of its largest
principal stress to z, e = pi/4 - phi/2:

    beta   dx/dz = tan(a + e)    ds + 2 s tan(phi) da = gamma (dz - tan(phi) dx)
    alpha  dx/dz = tan(a - e)    ds - 2 s tan(phi) da = gamma (dz + tan(phi) dx)

Beta lines start at the free surface (a = pi/2), cross the alpha lines that leave the edge and the surface, and end at
the strip (a = 0). Differences are those of the mean of both ends, order 2.   tested: tests/apps/limit_loads_test.py
"""
import math


class SmoothStrip:
    def __init__(self, friction, surcharge=1e-6, fan=30, ratio=1.15):
        """friction   phi, rad     surcharge   over gamma times the length of surface that is solved, 1
        fan   alpha lines that leave the edge     ratio   of the distances of beta lines from the edge"""
        self.tangent, self.sine, self.e = math.tan(friction), math.sin(friction), math.pi / 4 - friction / 2
        self.surcharge = surcharge
        start = surcharge / (1 - self.sine)
        angles = [math.pi / 2 * (1 - k / fan) for k in range(fan + 1)]
        line = [(0.0, 0.0, start * math.exp(2 * self.tangent * (math.pi / 2 - a)), a) for a in angles]
        self.pressure = [(0.0, line[-1][2] * (1 + self.sine))]  # below the strip: distance from the edge, stress
        steps = math.ceil(math.log(50 / surcharge) / math.log(ratio))  # the first is small against q/gamma
        for k in range(-steps, 1):
            new = [(ratio**k, 0.0, start, math.pi / 2)]
            for point in line:
                new.append(self._meeting(point, new[-1]))
            new.append(self._at_strip(new[-1]))
            self.pressure.append((-new[-1][0], new[-1][2] * (1 + self.sine)))
            line = new

    def _meeting(self, a, b):
        """Where the alpha line from a meets the beta line from b: x, z, s, angle."""
        (xa, za, sa, ta), (xb, zb, sb, tb) = a, b
        s, angle = (sa + sb) / 2, (ta + tb) / 2
        for _ in range(100):
            ma, mb = math.tan((ta + angle) / 2 - self.e), math.tan((tb + angle) / 2 + self.e)
            z = (xb - xa + ma * za - mb * zb) / (ma - mb)
            x = xa + ma * (z - za) if abs(ma) < abs(mb) else xb + mb * (z - zb)
            ka, kb = self.tangent * (sa + s), self.tangent * (sb + s)
            from_a = sa - ka * ta + (z - za) + self.tangent * (x - xa)
            from_b = sb + kb * tb + (z - zb) - self.tangent * (x - xb)
            before, angle = (s, angle), (from_b - from_a) / (ka + kb)
            s = from_a + ka * angle
            if abs(angle - before[1]) + abs(s / before[0] - 1) < 1e-10:
                return x, z, s, angle
        raise ArithmeticError("characteristics do not meet")

    def _at_strip(self, b):
        xb, zb, sb, tb = b
        x, s = xb - math.tan(tb / 2 + self.e) * zb, sb
        for _ in range(50):
            before, s = s, sb + self.tangent * (sb + s) * tb - zb - self.tangent * (x - xb)
            if abs(s / before - 1) < 1e-14:
                break
        return x, 0.0, s, 0.0

    def factor(self):
        """N_gamma: load of a strip of width B over gamma B^2 / 2, without surcharge.

        Far from the edge, where q no longer counts, the pressure grows by gamma N_gamma per length from either edge to
        the middle, k = dp/dx: load k B^2/4 = N_gamma gamma B^2/2."""
        (x1, p1), (x2, p2) = self.pressure[-2:]
        return (p2 - p1) / (x2 - x1) / 2
