# SPDX-License-Identifier: BSD-3-Clause
"""Correlations of laboratory tests on sand, next to which the packings are drawn. Pressures in Pa, G in Pa, strains and
damping ratios as shares."""
import numpy as np

ATMOSPHERE = 100e3
CU, D50_MM = 1.5, 0.14  # Karlsruhe fine sand


def small_strain_modulus(void_ratio, pressure, cu=CU):
    """G_max = A (a - e)^2/(1 + e) p_atm^(1-n) p^n, quartz sand, A = 1563 + 3.13 Cu^2.98, a = 1.94 exp(-0.066 Cu),
    n = 0.40 Cu^0.18 (Wichtmann & Triantafyllidis 2009, doi:10.1061/(ASCE)GT.1943-5606.0000096; resonant column)."""
    a, n, factor = 1.94 * np.exp(-0.066 * cu), 0.40 * cu**0.18, 1563 + 3.13 * cu**2.98
    return factor * (a - void_ratio)**2 / (1 + void_ratio) * ATMOSPHERE**(1 - n) * pressure**n


def masing(gamma, reference, curvature):
    """Damping ratio of Masing loops on the backbone 1/(1 + (gamma/reference)^a), polynomial of Darendeli (2001)."""
    ratio = gamma / reference
    first = 100 / np.pi * (4 * (gamma - reference * np.log1p(ratio)) / (gamma**2 / (gamma + reference)) - 2)
    a = curvature
    c1, c2 = -1.1143 * a**2 + 1.8618 * a + 0.2523, 0.0805 * a**2 - 0.0710 * a - 0.0095
    c3 = -0.0005 * a**2 + 0.0002 * a + 0.0003
    return (c1 * first + c2 * first**2 + c3 * first**3) / 100


def with_least(gamma, reference, curvature, least, cycles):
    """G/G_max and damping ratio; both authors reduce Masing damping by b (G/G_max)^0.1 and add the least damping."""
    reduction = 1 / (1 + (gamma / reference)**curvature)
    share = 0.6329 - 0.0057 * np.log(cycles)
    return reduction, share * reduction**0.1 * masing(gamma, reference, curvature) + least


def darendeli(gamma, pressure, cycles=10, frequency=1.0):
    """Darendeli (2001), PhD, University of Texas at Austin, chapters 8 and 9: PI = 0, OCR = 1."""
    atmospheres = pressure / 101.325e3
    least = 0.8005e-2 * atmospheres**-0.2889 * (1 + 0.2919 * np.log(frequency))
    return with_least(gamma, 0.0352e-2 * atmospheres**0.3483, 0.9190, least, cycles)


def menq(gamma, pressure, cu=CU, d50_mm=D50_MM, cycles=10):
    """Menq (2003), PhD, University of Texas at Austin: sandy and gravelly soils."""
    atmospheres = pressure / 101.325e3
    reference = 0.12e-2 * cu**-0.6 * atmospheres**(0.5 * cu**-0.15)
    least = 0.55e-2 * cu**0.1 * d50_mm**-0.3 * atmospheres**-0.08
    return with_least(gamma, reference, 0.86 + 0.1 * np.log10(atmospheres), least, cycles)
