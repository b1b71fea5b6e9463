# SPDX-License-Identifier: BSD-3-Clause
"""The curve of a test, measured or computed: what files of the laboratory may have wrong, and how far two curves are apart.

tested: tests/python/calibration_curves_test.py
"""
import csv
import dataclasses
import math
import pathlib
import re
from typing import Any, NamedTuple

import numpy as np

from isostat import _core
from isostat.campaign.calibrate.plan import read_text
from isostat.campaign.calibrate.scenes import direction
from isostat.results import read_table

PRESSURE = 0.25  # of the lateral stress or p': wrong units and wrong tests are further off
ISOTROPY = 0.25  # |q| / p' of the first row
GREATEST_RATIO = 14  # of principal stresses: an angle of friction of 60 deg
LEAST_RATIO = 1.2  # at the largest |q|: what any sand reaches within half a percent
SHORT = 0.005  # strain_end below which the last is not asked
GREATEST_STRESS = 1e12  # Pa
FIRST_STRAIN = 0.003  # up to here volumes change as an elastic body's
LEAST_VOLUME = 0.006  # largest |eps_v| / strain_end
STRAIN_UNITS, STRESS_UNITS = {"%": 0.01, "-": 1}, {"Pa": 1, "kPa": 1e3, "MPa": 1e6}


class Curve(NamedTuple):
    """A monotonic test, row by row. Compression positive, as the files have it; but `strain` grows in the direction of
    the test, in extension as in compression."""

    strain: np.ndarray  # axial, linear or logarithmic as the laboratory has it
    q: np.ndarray  # axial minus radial stress, Pa
    other: np.ndarray  # drained: volumetric strain, from 0; undrained: mean effective stress p', Pa


@dataclasses.dataclass
class Comparison:
    """A laboratory curve and the model's at the compared strains: mean and standard deviation over the seeds."""

    laboratory: Curve
    mean: Curve
    deviation: Curve
    misfit: float
    scatter: float | None  # standard error of the mean, in the measure of the misfit; None for one seed


def read_model(folder: pathlib.Path, plan: Any) -> Curve:
    """history.csv of a finished run of element_test, with strains as the laboratory has them.   Raises InputError"""
    history = read_table(folder / "history.csv")
    try:
        x, y, z, p, q = (history[name] for name in ("eps_x", "eps_y", "eps_z", "p", "q"))
    except KeyError as error:
        raise _core.InputError(f"{folder / 'history.csv'}: is damaged ({error.args[0]}).") from error
    def as_measured(strains):
        return strains if plan.strains == "logarithmic" else np.array([-math.expm1(-strain) for strain in strains])
    strain = direction(plan) * as_measured(y)
    rows = np.flatnonzero(np.diff(np.maximum.accumulate(strain), prepend=-np.inf) > 0)  # a step may have two rows
    return Curve(strain[rows], q[rows], (as_measured(x + y + z) if plan.test == "drained" else p)[rows])


def interpolated(curve: Curve, strains: np.ndarray) -> Curve:
    x = curve.strain
    k = np.clip(np.searchsorted(x, strains), 1, len(x) - 1)
    t = (strains - x[k - 1]) / (x[k] - x[k - 1])
    return Curve(strains, *(np.where(strains > x[-1], y[-1], y[k - 1] + t * (y[k] - y[k - 1])) for y in curve[1:]))


def compared_strains(laboratory: Curve, plan: Any, settings: Any) -> np.ndarray:
    """strain_end i/n or strain_end (i/n)^2, i = 1..n, without those before the laboratory's first row."""
    share = np.arange(1, settings.points + 1) / settings.points
    strains = plan.strain_end * (share * share if settings.spacing == "quadratic" else share)
    return strains[strains >= laboratory.strain[0]]


def compare(laboratory: Curve, models: list[Curve], plan: Any, settings: Any) -> Comparison:
    """The distance of the mean of the model's curves to the laboratory's, with v the volumetric strain of a drained and
    p' of an undrained test:

        misfit^2 = 1/(2n) sum_i [ ((q_i - q_i^lab)/max|q^lab|)^2 + ((v_i - v_i^lab)/max|v^lab|)^2 ]

    Maxima over the compared strains; between rows curves are straight. The scatter has the standard error of the mean
    in place of the differences: a misfit of this size cannot be distinguished from none.

    Raises InputError: a laboratory curve that is zero throughout; a model curve that ends too early
    """
    strains = compared_strains(laboratory, plan, settings)
    for model in models:
        last = model.strain[-1] if len(model.strain) else 0
        if len(model.strain) < 2 or last < 0.99 * plan.strain_end:
            raise _core.InputError(f"the run ended at a strain of {last:g}, before {plan.strain_end:g}")
    measured, there = interpolated(laboratory, strains), [interpolated(model, strains) for model in models]
    n, means, deviations, off, scatter = len(models), [], [], np.zeros(len(strains)), np.zeros(len(strains))
    for k, what in ((1, "q"), (2, "the volumetric strain" if plan.test == "drained" else "p'")):
        scale = np.abs(measured[k]).max()
        if scale == 0:
            raise _core.InputError(f"{plan.path}: {what} is zero throughout ({plan.where}); must vary because misfits "
                                   "are shares of its largest value. Give another curve.")
        rows = np.array([model[k] for model in there])
        means.append(running_sum(rows / n))
        deviations.append(np.sqrt(running_sum((rows - means[-1]) ** 2) / (n - 1)) if n > 1 else np.zeros(len(strains)))
        off += ((means[-1] - measured[k]) / scale) ** 2
        scatter += (deviations[-1] / scale) ** 2
    count = 2 * len(strains)
    return Comparison(measured, Curve(strains, *means), Curve(strains, *deviations),
                      math.sqrt(running_sum(off) / count),
                      math.sqrt(running_sum(scatter) / count / n) if n > 1 else None)


def running_sum(rows: np.ndarray) -> Any:
    """Row after row: the same to the last bit on any machine, which the search builds on."""
    return np.add.accumulate(rows)[-1]


def total_misfit(misfits: list[float], plan: Any) -> float:
    """sqrt(sum w m^2 / sum w) over the fitted curves of `misfits`, which are in the order of the plan."""
    fitted = np.array([(curve.weight * misfit * misfit, curve.weight) for curve, misfit in zip(plan.curve, misfits)
                       if not curve.blind])
    squares, weights = running_sum(fitted)
    return math.sqrt(squares / weights)


# --- laboratory ------------------------------------------------------------------------------------------------------


def split_name(column: str) -> tuple[str, str]:
    """"sigma_r (kPa)" as ("sigma_r", "kPa"); no unit: ""."""
    found = re.fullmatch(r"(.*?) *[\[(]([^\[(]*)[\])]", column)
    return (found[1], found[2]) if found else (column, "")


class Table:
    """A laboratory file, in SI. The names of the columns are the plan's, their units those of the file's header."""

    def __init__(self, plan: Any):
        self.plan = plan
        reader = csv.reader(read_text(plan.path, "a table").splitlines(), skipinitialspace=True)
        try:
            lines = [(reader.line_num, row) for row in reader if any(row)]
        except csv.Error as error:
            raise self.problem(reader.line_num, f"{error}; expected numbers between commas.") from error
        header = [cell.strip() for cell in lines[0][1]] if lines else []
        if len(header) == 1 and re.search("[;\t]", header[0]):
            raise self.problem(1, f"\"{header[0]}\": expected commas between columns, and decimal points in the "
                               "numbers. Save the table in that form.")
        wanted = ("strain", "volume", "axial", "radial") if plan.test == "drained" else ("strain", "p", "q")
        self.names = [self.in_header(vars(plan)[f"columns.{name}"], header) for name in wanted]
        self.lines = [number for number, _ in lines[1:]]
        if len(self.lines) < 2:
            raise self.problem(1, "holds fewer than two rows; a curve needs more.")
        self.cells = np.array([[self.cell(number, row, header, name) for name in self.names]
                               for number, row in lines[1:]])
        factors = [self.factor(name, k == 0 or wanted[k] == "volume") for k, name in enumerate(self.names)]
        self.values = (self.cells * factors).T
        for k in range(2 if plan.test == "drained" else 1, len(self.names)):
            self.check(~(np.abs(self.values[k]) <= GREATEST_STRESS), k,
                       lambda _: "is not a stress of soil. Correct the number, or the unit in the header.")

    def problem(self, line: int, what: str) -> _core.InputError:
        """To be raised."""
        return _core.InputError(f"{self.plan.path}:{line}: {what}")

    def check(self, wrong: np.ndarray, column: int, what: Any) -> None:
        """Refuses the first row that is wrong, for what(row)."""
        if wrong.any():
            row = int(np.argmax(wrong))
            raise self.problem(self.lines[row], f"{self.names[column]} = {self.cells[row, column]:g}; {what(row)}")

    def in_header(self, name: str, header: list[str]) -> str:
        alike = [column for column in header if split_name(column)[0] == split_name(name)[0]]
        if name in header or len(alike) == 1:
            return name if name in header else alike[0]
        raise self.problem(1, f"no column \"{name}\"; the file has {', '.join(header) or 'none'}. Correct the header, "
                           f"or curve.columns in {self.plan.where}.")

    def cell(self, line: int, row: list[str], header: list[str], name: str) -> float:
        if len(row) != len(header):
            raise self.problem(line, f"{len(row)} values; the header names {len(header)} columns. Is the file cut off?")
        text = row[header.index(name)]
        try:
            number = math.nan if "_" in text else float(text)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise self.problem(line, f"{name} = \"{text}\"; expected a finite number with a decimal point")
        return number

    def factor(self, column: str, is_strain: bool) -> float:
        units, unit = STRAIN_UNITS if is_strain else STRESS_UNITS, split_name(column)[1]
        if unit in units:
            return units[unit]
        what, given = "strain" if is_strain else "stress", f"the unit is {unit}" if unit else "no unit"
        names = ", ".join(f"[{name}]" for name in units)
        raise self.problem(1, f"column \"{column}\": {given}; a {what} must be in one of {names}, at the end of the "
                           f"column's name. Correct the header, or curve.columns in {self.plan.where}.")


def check_strains(table: Table, strain: np.ndarray) -> None:
    plan, last = table.plan, np.arange(len(strain)) == len(strain) - 1
    table.check(np.abs(strain) >= 1, 0,
                lambda _: "is not a strain: 1 is 100 percent. Is it given in percent? Correct the unit in the header.")
    table.check(np.diff(strain, prepend=-np.inf) <= 0, 0, lambda row: f"goes back from {table.cells[row - 1, 0]:g} in "
                f"the row before; must advance from row to row in {plan.direction}. Remove unloading, or correct "
                f"direction in {plan.where}.")
    table.check(last & (strain < plan.strain_end * (1 - 1e-9)), 0, lambda row:
                f"ends the curve at {100 * strain[row]:g} %, before strain_end = {plan.strain_end:g} "
                f"({100 * plan.strain_end:g} %) of {plan.where}. Lower strain_end, or correct the unit in the header.")
    table.check(strain[:1] > 0.5 * plan.strain_end, 0, lambda _:
                f"is more than half of strain_end = {plan.strain_end:g} of {plan.where}: the curve has no beginning.")


def check_volumes(table: Table, strain: np.ndarray, volume: np.ndarray) -> None:
    plan = table.plan
    table.check(np.abs(volume) >= 1, 1,
                lambda _: "is not a volumetric strain: 1 is 100 percent. Correct the unit in the header.")
    first = (strain > 0) & (strain <= FIRST_STRAIN)
    table.check(first & (direction(plan) * volume < -0.1 * strain), 1, lambda row:
                f"at an axial strain of {100 * strain[row]:g} %: a drained test "
                f"{'contracts' if direction(plan) > 0 else 'expands'} at first, and compression is positive here. Is "
                "dilation positive in this file? Then change the sign of the column.")
    largest = np.arange(len(volume)) == np.argmax(np.abs(volume))
    table.check(largest & (np.abs(volume) < LEAST_VOLUME * plan.strain_end) & (plan.strain_end >= SHORT), 1, lambda _:
                f"is the largest up to strain_end = {plan.strain_end:g} of {plan.where}: less than {LEAST_VOLUME:g} of "
                "it. Is the column a fraction under a header in percent? Correct the unit.")


def check_stresses(table: Table, q: np.ndarray, p: np.ndarray) -> None:
    plan, sign = table.plan, direction(table.plan)
    axial, radial = p + 2 * q / 3, p - q / 3
    ratio = np.maximum(axial, radial) / np.minimum(axial, radial)
    remedy = ("Are the columns of axial and radial stress swapped, or their units wrong?" if plan.test == "drained" else
              "Correct the sign of q (axial minus radial stress), or its unit.")
    table.check(np.abs(q[:1]) > ISOTROPY * p[:1], 2, lambda _:
                f"makes q = {q[0] / 1e3:g} kPa at the start, with p' = {p[0] / 1e3:g} kPa; |q| must be within "
                f"{100 * ISOTROPY:g} % of p' because the tests begin isotropic. {remedy}")
    table.check(~((ratio > 0) & (ratio <= GREATEST_RATIO)) & (p > 0.02 * p[0]), 2, lambda row:
                f"makes q = {q[row] / 1e3:g} kPa with p' = {p[row] / 1e3:g} kPa, which no sand bears: a ratio of "
                f"principal stresses above {GREATEST_RATIO:g}. {remedy}")
    largest = np.arange(len(q)) == np.argmax(np.abs(q))
    table.check(largest & (sign * q < 0), 2, lambda row:
                f"makes q = {q[row] / 1e3:g} kPa, the largest of the curve; must be {'> 0' if sign > 0 else '< 0'} in "
                f"{plan.direction}. {remedy}")
    table.check(largest & (ratio < LEAST_RATIO) & (plan.strain_end >= SHORT), 2, lambda row:
                f"makes q = {q[row] / 1e3:g} kPa, the largest of the curve, with p' = {p[row] / 1e3:g} kPa; principal "
                f"stresses must come to a ratio of {LEAST_RATIO:g} because any sand does. {remedy}")


def read_laboratory(plan: Any, pressure: float) -> Curve:
    """Reads a laboratory file. A column is found by its name without the unit; the unit is that of the file's header.

    Besides the numbers it checks what a test of this kind cannot do, so that swapped columns, wrong signs and wrong
    units do not become parameters: it begins at the pressure and nearly isotropic, q has the sign of the direction, the
    ratio of principal stresses stays possible and leaves 1, a drained test keeps its lateral stress and contracts at
    first in compression (expands in extension), and its volume changes by more than nothing.

    pressure  effective, before the test, Pa
    Raises InputError with file:line, value, what is possible, and remedy
    """
    with np.errstate(all="ignore"):
        table = Table(plan)
        drained = plan.test == "drained"
        strain, other = direction(plan) * table.values[0], table.values[1]
        q = table.values[2] - table.values[3] if drained else table.values[2]
        p = (table.values[2] + 2 * table.values[3]) / 3 if drained else other
        check_strains(table, strain)
        n = int(np.searchsorted(strain, plan.strain_end, "right")) + 1  # rows that are compared
        kept = table.values[3][:n] if drained else p[:1]
        table.check(np.abs(kept - pressure) > PRESSURE * pressure, 3 if drained else 1, lambda row:
                    f"is {kept[row] / 1e3:g} kPa{' at the start' * (row == 0)}, but the test of {plan.where} "
                    f"{'has a lateral stress of' if drained else 'begins at'} {pressure / 1e3:g} kPa; must be within "
                    f"{100 * PRESSURE:g} %. Correct pressure there, the unit in the header, or swapped columns.")
        check_stresses(table, q[:n], p[:n])
        if drained:
            check_volumes(table, strain[:n], other[:n])
    return Curve(strain, q, other)
