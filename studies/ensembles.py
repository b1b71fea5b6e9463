# SPDX-License-Identifier: BSD-3-Clause
"""Means over specimens, and how well they are known."""
import numpy as np

# two-sided 95 % by number of values
STUDENT = {2: 12.7, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 8: 2.36, 10: 2.26, 12: 2.20, 15: 2.14, 20: 2.09}


def ensemble(values):
    """Mean, standard deviation, standard error and number of the values that exist."""
    values = np.array([v for v in values if v is not None and np.isfinite(v)], dtype=float)
    n = values.size
    if n == 0:
        return float("nan"), float("nan"), float("nan"), 0
    deviation = values.std(ddof=1) if n > 1 else float("nan")
    return float(values.mean()), float(deviation), float(deviation / np.sqrt(n)), n


def mean_and_error(values):
    """Mean and its standard error; the error of one value is not known."""
    mean, _, error, _ = ensemble(values)
    return mean, error


def text_of(mean, error, digits):
    """"184 ± 3"."""
    return f"{mean:.{digits}f}" + (f" ± {error:.{digits}f}" if np.isfinite(error) else "")


def mean_and_interval(values):
    """Mean, and half the width of its 95 % interval."""
    mean, _, error, n = ensemble(values)
    return mean, STUDENT[max(k for k in STUDENT if k <= n)] * error if n > 1 else float("nan")
