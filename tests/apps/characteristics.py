# SPDX-License-Identifier: BSD-3-Clause
"""Bearing capacity of heavy frictional soil by the method of characteristics (Sokolovskii 1965; Martin 2005).

Plane strain, c = 0, unit weight gamma = 1, surcharge q; x along the surface from the edge of a strip, which is at
x < 0, z down. With s the mean stress (compression positive), a the angle of its largest principal stress to z,
e = pi/4 - phi/2:

    beta   dx/dz = tan(a + e)    ds + 2 s tan(phi) da = gamma (dz - tan(phi) dx)
    alpha  dx/dz = tan(a - e)    ds - 2 s tan(phi) da = gamma (dz + tan(phi) dx)

Beta lines start at the free surface (a = pi/2), cross the alpha lines that leave the edge and the surface, and end at
the strip: a = 0 if it is smooth; if it is rough a = -pi/4 - phi/2, where alpha lines touch it and friction is fully
mobilised. Differences are those of the mean of both ends, order 2.   tested: tests/apps/limit_loads_test.py
"""
import math


class Strip:
    def __init__(self, friction, rough=False, surcharge=1e-5, fan=30, ratio=1.15):
        """friction   phi, rad     surcharge   over gamma times the length of surface that is solved, 1
        fan   alpha lines that leave the edge     ratio   of the distances of beta lines from the edge"""
        self.tangent, self.sine, self.e = math.tan(friction), math.sin(friction), math.pi / 4 - friction / 2
        self.surcharge, self.rough = surcharge, rough
        self.end = -math.pi / 4 - friction / 2 if rough else 0.0
        start = surcharge / (1 - self.sine)
        angles = [math.pi / 2 + (self.end - math.pi / 2) * k / fan for k in range(fan + 1)]
        self.lines = [[(0.0, 0.0, start * math.exp(2 * self.tangent * (math.pi / 2 - a)), a) for a in angles]]
        steps = math.ceil(math.log(50 / surcharge) / math.log(ratio))  # the first is small against q/gamma
        for k in range(-steps, 1):
            new = [(ratio**k, 0.0, start, math.pi / 2)]
            for point in self.lines[-1]:
                new.append(self._meeting(point, new[-1]))
            new.append(self._at_strip(new[-1]))
            self.lines.append(new)

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
        x, s = xb - math.tan((tb + self.end) / 2 + self.e) * zb, sb
        for _ in range(50):
            before, s = s, sb + self.tangent * (sb + s) * (tb - self.end) - zb - self.tangent * (x - xb)
            if abs(s / before - 1) < 1e-14:
                break
        return x, 0.0, s, self.end

    def pressure(self, point):
        """Vertical stress, and the shear stress on horizontal planes."""
        _, _, s, a = point
        return s * (1 + self.sine * math.cos(2 * a)), s * self.sine * math.sin(2 * a)

    def factor(self):
        """N_gamma: load of a strip of width B over gamma B^2 / 2, without surcharge.

        Far from the edge, where q no longer counts, lengths have no scale but the distance from the edge."""
        if self.rough:
            half, load = self.halves()[-1]
            return load / half**2
        first, last = (line[-1] for line in self.lines[-2:])  # k = dp/dx: load k B^2/4 = N_gamma gamma B^2/2
        return (self.pressure(last)[0] - self.pressure(first)[0]) / (first[0] - last[0]) / 2

    def halves(self):
        """Half of the width of strips that these lines bear, and half of the load, rising.

        Below the middle part of a rough one is a rigid wedge on the alpha line that comes to the middle with a = 0.
        Load: the pressure outside the wedge, and what bears it less its weight."""
        feet = [line[-1] for line in self.lines]
        found = []
        for first, line in enumerate(self.lines):
            outside = self._borne(feet[:first + 1])
            if not self.rough:
                found.append((-feet[first][0], outside))
                continue
            start = len(line) - 1
            way = [line[start + k] for k, line in enumerate(self.lines[first:])]
            turn = next((k for k, point in enumerate(way) if point[3] >= 0), None)
            if turn:
                part = -way[turn - 1][3] / (way[turn][3] - way[turn - 1][3])
                middle = tuple(a + part * (b - a) for a, b in zip(way[turn - 1], way[turn]))
                found.append((-middle[0], outside + self._borne([*way[:turn], middle])))
        return found

    def _borne(self, points):
        """Vertical force that soil below a line bears from above, less the weight between line and surface."""
        force = 0
        for a, b in zip(points, points[1:]):
            (normal_a, shear_a), (normal_b, shear_b) = self.pressure(a), self.pressure(b)
            force += (normal_a + normal_b - a[1] - b[1]) / 2 * (a[0] - b[0]) + (shear_a + shear_b) / 2 * (b[1] - a[1])
        return force


def bearing_capacity(friction, cohesion, weight, width, rough, **lines):
    """Mean pressure at which a strip on soil of unit weight `weight` collapses, without the error of adding up
    c N_c and gamma B N_gamma/2, which is on the safe side. Cohesion is a surcharge c cot phi on soil without it, and
    as much less of the load (Caquot 1934). `lines` are those of Strip."""
    half = 0.02  # of the length of surface that is solved: wedges of rough strips are far from its end
    surcharge = cohesion / math.tan(friction)
    halves, loads = zip(*Strip(friction, rough, half * surcharge / (weight * width / 2), **lines).halves())
    k = next(k for k, x in enumerate(halves) if x > half)
    part = (half - halves[k - 1]) / (halves[k] - halves[k - 1])
    mean = [loads[i] / halves[i] for i in (k - 1, k)]
    return (mean[0] + part * (mean[1] - mean[0])) / half * weight * width / 2 - surcharge
