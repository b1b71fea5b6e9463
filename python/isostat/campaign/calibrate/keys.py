# SPDX-License-Identifier: BSD-3-Clause
"""The keys of a plan, and plans as text.   tested: tests/python/calibration_test.py"""
import dataclasses
import decimal
import difflib
import json
import math
import textwrap
from collections.abc import Iterable
from typing import Any

SECTIONS = {
    "specimens": "The packings. All trials have the same seeds, so that they differ by their parameters alone.",
    "budget": "When the search ends. May be changed, and the same command then continues.",
    "optimiser": "Where to look next. First the start, then a design, then the method from the best of these.",
    "misfit": "How far a model curve is from that of the laboratory (docs/campaigns/calibrate.md).",
    "parameter": "A number of the scene to be found. Which curves it can be found from is up to you.",
    "curve": "A laboratory curve and the test that it comes from. Strains and stresses as the direction has them: "
             "compression positive."}
ARRAYS = ("parameter", "curve")
TESTS = ("drained", "undrained")


@dataclasses.dataclass(frozen=True)
class Key:
    """A key of a plan. `value` is its default, or an example where there is none."""

    path: str
    value: Any
    text: str = ""
    allowed: str = ""  # "in [50, 1000000]", "> 0"
    need: str = ""  # "required", "optional"; else it has a default
    choices: tuple[str, ...] = ()
    reads_as: str = ""  # the key of a scene whose unit and range a quantity has
    test: str = ""  # of the only test that it belongs to
    reason: str = ""  # of the range

    @property
    def section(self) -> str:
        return self.path.rpartition(".")[0].partition(".")[0]

    @property
    def name(self) -> str:
        return self.path.removeprefix(f"{self.section}.")

    @property
    def range(self) -> str:
        return self.allowed or " or ".join(", ".join(map(json.dumps, self.choices)).rsplit(", ", 1))


KEYS = (
    Key("title", "", "Heads tables and figures."),
    Key("scene", "drained_dr64.toml", "Scene file that the trials vary: grading, contact law, specimen. Its "
        "stages give way to the tests of the curves.", need="required"),

    Key("specimens.grains", 1000, "Grains of a trial's specimens; their size is that of the scene.", "in [50, 1000000]",
        reason="because fewer are no specimen"),
    Key("specimens.seeds", 2, "Specimens per curve and trial; their mean is compared with the laboratory.",
        "in [1, 1000]"),
    Key("specimens.first_seed", 1, "grading.seed of the first; the others follow.", ">= 0"),
    Key("specimens.full_grains", 10000, "Grains of the final scenes, which are ready to run.", "in [50, 100000000]"),
    Key("specimens.inertial_number", 4e-4, "Inertial number of the trials' tests; left out: as the scene says. The "
        "scenes that are left ready to run keep theirs.", "in (0, 1)", "optional"),

    Key("budget.trials", 60, "Largest number of trials, start and design included.", "in [1, 1000000]"),
    Key("budget.time", "8 h", "No trial is begun after this wall-clock time of a call.", "> 0 min", "optional",
        reads_as="output.checkpoint"),

    Key("optimiser.method", "bobyqa", "bobyqa: quadratic models, few trials; sbplx: simplex in subspaces, for noisy "
        "misfits; crs2: random search, for several minima. Left out with one parameter alone: sbplx.",
        choices=("bobyqa", "sbplx", "crs2")),
    Key("optimiser.design", 8, "Trials spread evenly over the bounds before the method begins; their runs go side by "
        "side.", "in [0, 1000000]"),
    Key("optimiser.first_step", 0.15, "First step of the method as a share of the bounds.", "in (0, 0.5]",
        reason="because the bounds are 1 apart"),
    Key("optimiser.tolerance", 0.005, "The method ends when its steps are this share of the bounds.", "in (0, 1)"),

    Key("misfit.points", 40, "Strains at which curves are compared.", "in [2, 10000]"),
    Key("misfit.spacing", "even", "even, or quadratic: closer at the start, where the stiffness shows.",
        choices=("even", "quadratic")),
    Key("misfit.penalty", 1.0, "Misfit of a curve one of whose runs failed.", "> 0"),

    Key("parameter.key", "contact.friction", "Key of the scene.", need="required"),
    Key("parameter.bounds", ["10 deg", "35 deg"], "Between these, in the form of the key.", need="required"),
    Key("parameter.start", "18 deg", "Left out: what the scene has if that is within the bounds, else the middle.",
        need="optional"),
    Key("parameter.scale", "linear", "log: equal steps are equal ratios; for moduli over decades.",
        choices=("linear", "log")),
    Key("parameter.curve", "dense", "Name of the only curve, or group of curves, that it belongs to (a density, say); "
        "left out: all.", need="optional"),

    Key("curve.file", "TMD3.csv", "Table with a header, columns between commas, next to the plan.", need="required"),
    Key("curve.test", "drained", need="required", choices=TESTS),
    Key("curve.name", "loose", "Names it in tables and folders; left out: the file without its ending.",
        need="optional"),
    Key("curve.group", "loose", "Of curves that share parameters, blind ones among them: those of specimens made "
        "alike.", need="optional"),
    Key("curve.direction", "compression", "Of the axial strain.", choices=("compression", "extension")),
    Key("curve.relative_density", 0.64, "specimen.relative_density of its runs.", "in [0, 1]", "optional",
        reason="because D_r is 0 at e_max and 1 at e_min"),
    Key("curve.void_ratio", 0.67, "specimen.void_ratio of its runs.", "in (0, 3]", "optional",
        reason="because a packing of spheres in contact has no other"),
    Key("curve.preparation_friction", "10 deg", "specimen.preparation_friction of its runs. It takes one compression "
        "where a density takes several.", "in [0 deg, 90 deg)", "optional", reads_as="specimen.preparation_friction"),
    Key("curve.pressure", "200 kPa", "Effective pressure before the test; left out: that of the scene.",
        "in [0.001 kPa, 1e9 kPa]", "optional", reads_as="specimen.pressure"),
    Key("curve.strain_end", 0.1, "Amount of axial strain up to which curves are compared.", "in (0, 0.9]",
        reason="because this is a strain, not percent"),
    Key("curve.strains", "linear", "Strains of the file: linear, change over first height or volume; or logarithmic.",
        choices=("linear", "logarithmic")),
    Key("curve.weight", 1.0, "In the misfit of a trial.", "> 0"),
    Key("curve.blind", False, "Not fitted: only computed for the start and for the best set."),
    Key("curve.columns", None, "Names of the columns, each with its unit in brackets or parentheses at the end: %, -, "
        "Pa, kPa or MPa."),
    Key("curve.columns.strain", "eps_a[%]", "Axial strain."),
    Key("curve.columns.volume", "eps_v[%]", "Volumetric strain.", test="drained"),
    Key("curve.columns.axial", "sigma_v[kPa]", "Axial effective stress.", test="drained"),
    Key("curve.columns.radial", "sigma_r[kPa]", "Radial effective stress.", test="drained"),
    Key("curve.columns.p", "p[kPa]", "Mean effective stress p'.", test="undrained"),
    Key("curve.columns.q", "q[kPa]", "Axial minus radial stress.", test="undrained"))

DENSITIES = ("relative_density", "void_ratio", "preparation_friction")  # of which a curve has one at most


def keys_of(section: str, test: str | None = None) -> list[Key]:
    return [key for key in KEYS if key.section == section and (test is None or key.test in ("", test))]


def unknown_text(key: str, known: Iterable[str], remedy: str) -> str:
    near = difflib.get_close_matches(key, known, 1)
    return f"unknown key. {f'Did you mean {near[0]}?' if near else remedy}"


def number_text(value: float, shift: int = 0) -> str:
    """A number over 10^shift as scenes write it: with the fewest digits that read back to the same number."""
    sign, digits, exponent = decimal.Decimal(repr(float(value))).normalize().as_tuple()
    first = len(digits) + exponent - 1 - shift  # exponent of the first digit
    if value == 0 or -3 <= first <= 8:
        return f"{decimal.Decimal((sign, digits, exponent - shift if value else 0)):f}"
    text = "".join(map(str, digits))
    return f"{'-' * sign}{text[0]}{'.' * (len(text) > 1)}{text[1:]}e{first}"


def value_text(value: Any) -> str:
    """A value as TOML; numbers that are kept as text have no quotes, as parameters have them."""
    if isinstance(value, list):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, str | bool):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return number_text(value) if isinstance(value, float) and math.isfinite(value) else str(value)


def heading(section: str) -> str:
    return f"[[{section}]]" if section in ARRAYS else f"[{section}]"


def plan_text(plan: Any) -> str:
    """A plan with every key. It reads back to the same plan."""
    def table(section, values):
        return "".join(f"{key.name} = {value_text(vars(values)[key.name])}\n"
                       for key in keys_of(section) if vars(values).get(key.name) is not None)
    text = table("", plan)
    for section in SECTIONS:
        values = getattr(plan, section)
        text += "".join(f"\n{heading(section)}\n{table(section, each)}"
                        for each in (values if section in ARRAYS else [values]))
    return text


def comment(text: str) -> str:
    return "".join(f"# {line}\n" for line in textwrap.wrap(text, 98, break_on_hyphens=False))


def default_entry(key: Key, test: str | None) -> str:
    """Sentence, allowed values and the line of the key itself."""
    if key.value is None:  # a table, whose keys follow
        return comment(f"{key.name}: {key.text}")
    if key.path == "curve.test":
        return f'test = "{test}"\n'
    need = {"required": "Required.", "optional": "No default."}.get(key.need)
    text = " ".join(filter(None, (key.text, key.range and f"Allowed: {key.range}.", need)))
    return f"{comment(text)}{'# ' * (key.need == 'optional')}{key.name} = {value_text(key.value)}\n"


def default_plan() -> str:
    """Every key with its default, unit and range."""
    def table(section, test=None):
        entries = "".join(default_entry(key, test) for key in keys_of(section, test))
        return f"{heading(section)}\n{entries}" if section else entries
    text = comment('A calibration plan with the defaults of every key. A line "# key = value" is a key without '
                   "default, with an example.") + "\n" + table("")
    for section, words in SECTIONS.items():
        text += f"\n{comment(words)}{table(section, TESTS[0])}"
    return text + "\n" + "".join(line if line.startswith("#") else f"# {line}"
                                 for line in table("curve", TESTS[1]).splitlines(keepends=True))
