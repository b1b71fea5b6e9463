# SPDX-License-Identifier: BSD-3-Clause
"""Loads at which soil of friction and cohesion collapses: footings, trapdoors, walls. They owe nothing to Isostat.

Plane strain, angles in rad, compression positive. Exact solutions and bounds are those of rigid, perfectly plastic soil
with associated flow; what is neither is called approximate.   tested: tests/apps/limit_loads_test.py

Prandtl (1921), Z. angew. Math. Mech. 1, 15; Reissner (1924), Proc. 1st Int. Congr. Appl. Mech., Delft; Terzaghi (1943),
Theoretical soil mechanics; Davis (1968), in: Soil mechanics, selected topics; Martin (2005), Proc. 11th Int. Conf.
IACMAG, Turin, 4, 441; Lancellotta (2002), Geotechnique 52, 617; Mylonakis, Kloukinas and Papantonopoulos (2007), Soil
Dyn. Earthq. Eng. 27, 957.
"""
import math

import numpy as np

# ---- strip footing: q_u = c N_c + q N_q + gamma B N_gamma / 2 ------------------------------------------------------


def surcharge_factor(friction):
    """N_q of weightless soil, exact (Reissner): e^(pi tan phi) (1 + sin phi)/(1 - sin phi)."""
    return math.exp(math.pi * math.tan(friction)) * passive_rankine(friction)


def cohesion_factor(friction):
    """N_c of weightless soil, exact (Prandtl): (N_q - 1) cot phi, 2 + pi without friction."""
    return 2 + math.pi if friction == 0 else (surcharge_factor(friction) - 1) / math.tan(friction)


# N_gamma by friction angle, deg, of a smooth and of a rough strip on soil without cohesion and surcharge (Martin 2005,
# method of characteristics, exact to the digits shown; characteristics.py finds the same within 0.1 %).
WEIGHT_FACTORS = {20: (1.579, 2.839), 25: (3.461, 6.491), 30: (7.653, 14.75), 35: (17.58, 34.48), 40: (43.19, 85.57)}


def weight_factor(friction, rough):
    """N_gamma between the angles of WEIGHT_FACTORS: logarithm linear in the angle, within 1 %.

    ValueError   outside of 20 to 40 deg"""
    degrees = math.degrees(friction)
    angles = list(WEIGHT_FACTORS)
    if not angles[0] - 1e-9 <= degrees <= angles[-1] + 1e-9:
        raise ValueError(f"friction = {degrees:g} deg; must be in [{angles[0]}, {angles[-1]}] deg, "
                         "where N_gamma is known")
    return math.exp(np.interp(degrees, angles, [math.log(pair[bool(rough)]) for pair in WEIGHT_FACTORS.values()]))


# ---- trapdoor of width B below soil of height H: mean vertical stress on it ----------------------------------------


def krynine(friction):
    """Horizontal over vertical stress at a vertical plane on which friction is fully mobilised: cos^2/(2 - cos^2).
    Mohr's circle of a stress on the plane with obliquity phi (Krynine 1945)."""
    square = math.cos(friction)**2
    return square / (2 - square)


def terzaghi_arching(friction, width, height, weight, lateral=1.0, cohesion=0.0, surcharge=0.0):
    """Terzaghi's approximate active stress: vertical planes above the edges slide, the vertical stress between them is
    uniform, `lateral` = K sigma_v acts on them.

    (B gamma - 2 c)/(2 K tan phi) (1 - e^(-2 K tan phi H/B)) + q e^(-2 K tan phi H/B)

    lateral   K: Terzaghi measured 1 to 1.5; others take krynine(), at_rest() (Jaky) or active_rankine()"""
    rate = 2 * lateral * math.tan(friction)
    left = math.exp(-rate * height / width)
    share = height / width if rate == 0 else (1 - left) / rate
    return (width * weight - 2 * cohesion) * share + surcharge * left


def trapdoor_active_bounds(friction, width, height, weight):
    """The least stress that keeps a trapdoor from sinking, without cohesion: at least that of the block whose sides
    lean inwards by phi (kinematic theorem, Davis 1968: a triangle if H > B/(2 tan phi)), at most gamma H (a uniform
    stress field without arching)."""
    tangent = math.tan(friction)
    tall = tangent > 0 and height > width / (2 * tangent)
    block = weight * (width / (4 * tangent) if tall else height * (1 - height * tangent / width))
    return block, weight * height


def trapdoor_passive_bound(friction, width, height, weight):
    """The stress that lifts a trapdoor is at most that of the block whose sides lean outwards by phi: gamma H (1 +
    tan(phi) H/B) (kinematic theorem)."""
    return weight * height * (1 + math.tan(friction) * height / width)


# ---- earth pressure on a vertical wall, level ground: horizontal stress over vertical one far from the wall ---------


def at_rest(friction):
    """Jaky's K_0 = 1 - sin phi."""
    return 1 - math.sin(friction)


def active_rankine(friction):
    return (1 - math.sin(friction)) / (1 + math.sin(friction))


def passive_rankine(friction):
    return (1 + math.sin(friction)) / (1 - math.sin(friction))


def coulomb(friction, wall_friction, passive=False):
    """Horizontal part of Coulomb's thrust over gamma H^2/2, of the worst plane wedge: good in active cases, far too
    high in passive ones with much friction of the wall. No bound with associated flow."""
    way = -1 if passive else 1
    root = math.sqrt(math.sin(friction + wall_friction) * math.sin(friction) / math.cos(wall_friction))
    return math.cos(friction)**2 / (1 + way * root)**2


def stress_field(friction, wall_friction, passive=False):
    """Horizontal part of the thrust over gamma H^2/2 of a field of stress with a fan at the top of the wall
    (Lancellotta 2002; Mylonakis et al. 2007): exact for a surcharge on weightless soil, where it is the coefficient of
    q, and a close estimate on the safe side of heavy soil."""
    way = 1 if passive else -1
    turn = math.asin(math.sin(wall_friction) / math.sin(friction)) + way * wall_friction
    sine = math.sin(friction)
    return (1 + way * sine * math.cos(turn)) / (1 - way * sine) * math.exp(way * turn * math.tan(friction))
