# SPDX-License-Identifier: BSD-3-Clause
"""Packings as the peers need them, and the state a code has reached, computed from positions.

A packing is text of spheres, lines `x y z r` (m), with the box in a comment `# box xlo xhi ylo yhi zlo zhi`."""
import dataclasses
import math

YOUNG, STIFFNESS_RATIO, FRICTION = 1e10, 0.3, math.tan(math.radians(18))
ROLLING, TWISTING, DENSITY = 0.3, 0.3, 2650.0


@dataclasses.dataclass
class Packing:
    box: list      # xlo xhi ylo yhi zlo zhi, m
    spheres: list  # tuples x y z r, m

    def mean_radius(self):
        return sum(s[3] for s in self.spheres) / len(self.spheres)


@dataclasses.dataclass
class Stiffness:
    """One stiffness for all contacts, for codes that know no other: see matched_stiffness."""
    normal: float    # between grains, N/m
    wall: float      # N/m
    reduced: float   # mean of r1 r2 over the mean of (r1 r2/(r1 + r2))^2, 4 for equal spheres [-]
    product: float   # mean of r1 r2, m2
    damping: float   # N s/m


def read_packing(path):
    box, spheres = None, []
    for number, line in enumerate(open(path), 1):
        words = line.split()
        if words[:2] == ["#", "box"]:
            box = [float(w) for w in words[2:]]
        elif words and words[0] != "#":
            if len(words) != 4:
                raise ValueError(f"{path}:{number}: \"{line.strip()}\"; expected x y z r (m)")
            spheres.append(tuple(float(w) for w in words))
    if not spheres or box is None or len(box) != 6:
        raise ValueError(f"{path}: no spheres or no comment `# box xlo xhi ylo yhi zlo zhi`")
    return Packing(box, spheres)


def write_packing(path, packing):
    with open(path, "w") as out:
        out.write("# box " + " ".join(f"{b:.17g}" for b in packing.box) + "\n")
        out.writelines("%.17g %.17g %.17g %.17g\n" % s for s in packing.spheres)


def write_lammps_data(path, packing, types=1, style="sphere"):
    """Data file for LAMMPS and LIGGGHTS, id type diameter density x y z; the simulation box is that of the walls."""
    with open(path, "w") as out:
        out.write(f"packing\n\n{len(packing.spheres)} atoms\n{types} atom types\n\n")
        for k, axis in enumerate("xyz"):
            out.write(f"{packing.box[2 * k]:.17g} {packing.box[2 * k + 1]:.17g} {axis}lo {axis}hi\n")
        out.write(f"\nAtoms # {style}\n\n")
        out.writelines(f"{i} 1 {2 * r:.17g} {DENSITY} {x:.17g} {y:.17g} {z:.17g}\n"
                       for i, (x, y, z, r) in enumerate(packing.spheres, 1))


def by_size(packing):
    """Largest first: the order in which codes that fill a box with random spheres make and keep them."""
    return Packing(packing.box, sorted(packing.spheres, key=lambda s: -s[3]))


def touching_pairs(spheres):
    """(i, j, overlap) of the spheres that touch, found in a grid of cells as wide as the largest sphere."""
    width = 2 * max(s[3] for s in spheres)
    cells = {}
    for i, s in enumerate(spheres):
        cells.setdefault((int(s[0] // width), int(s[1] // width), int(s[2] // width)), []).append(i)
    half = [(a, b, c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1) if (a, b, c) > (0, 0, 0)]
    for (a, b, c), members in cells.items():
        others = [j for d in half for j in cells.get((a + d[0], b + d[1], c + d[2]), ())]
        for place, i in enumerate(members):
            x, y, z, r = spheres[i]
            for j in members[place + 1:] + others:
                u, v, w, q = spheres[j]
                square = (x - u) ** 2 + (y - v) ** 2 + (z - w) ** 2
                if square < (r + q) ** 2:
                    yield i, j, r + q - math.sqrt(square)


def wall_overlaps(packing):
    """(wall, radius, overlap) of the spheres that touch a wall; walls 0..5 are x- x+ y- y+ z- z+."""
    for s in packing.spheres:
        for wall, place in enumerate(packing.box):
            overlap = s[3] - (s[wall // 2] - place if wall % 2 == 0 else place - s[wall // 2])
            if overlap > 0:
                yield wall, s[3], overlap


def matched_stiffness(packing):
    """The one stiffness that gives this packing the mean stress it has with kn = 2 E r1 r2/(r1 + r2), at walls E r:
    the mean of kn over the contacts, weighted with overlap times branch. Damping: a pair of mean grains loses 4 d of
    its energy in a cycle, as with local damping d = 0.2; the damping ratio is then d/pi."""
    weight = moment = product = reduced = wall_weight = wall_moment = count = 0
    for i, j, overlap in touching_pairs(packing.spheres):
        r, q = packing.spheres[i][3], packing.spheres[j][3]
        weight += overlap * (r + q)
        moment += 2 * YOUNG * r * q / (r + q) * overlap * (r + q)
        product += r * q
        reduced += (r * q / (r + q)) ** 2
        count += 1
    for _, r, overlap in wall_overlaps(packing):
        wall_weight += overlap
        wall_moment += YOUNG * r * overlap
    if not count or not wall_weight:
        raise ValueError("the packing has no contacts, or none with a wall; give one under pressure")
    normal = moment / weight
    mass = DENSITY * 4 / 3 * math.pi * packing.mean_radius() ** 3
    return Stiffness(normal, wall_moment / wall_weight, product / reduced, product / count,
                     2 * 0.2 / math.pi * math.sqrt(normal * mass / 2))


def sheared_box(box, rate, time):
    """Walls that have moved uniformly: y shortens by rate, x and z lengthen by rate/2 of their first edge."""
    moved = list(box)
    for k, share in enumerate((0.25, -0.5, 0.25)):
        way = share * rate * time * (box[2 * k + 1] - box[2 * k])
        moved[2 * k] -= way
        moved[2 * k + 1] += way
    return moved


def reached(packing, wall_stiffness):
    """p', q (kPa) of the walls and the number of contacts, from positions; the walls are elastic and frictionless."""
    force = [0.0] * 6
    contacts = sum(1 for _ in touching_pairs(packing.spheres))
    for wall, _, overlap in wall_overlaps(packing):
        force[wall] += wall_stiffness * overlap
        contacts += 1
    edge = [packing.box[2 * k + 1] - packing.box[2 * k] for k in range(3)]
    stress = [0.5e-3 * (force[2 * k] + force[2 * k + 1]) / (edge[(k + 1) % 3] * edge[(k + 2) % 3]) for k in range(3)]
    return sum(stress) / 3, stress[1] - 0.5 * (stress[0] + stress[2]), contacts
