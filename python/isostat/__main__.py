# SPDX-License-Identifier: BSD-3-Clause
"""isostat: the one name to remember. Many runs, results, packings, and the programs that compute one run.

    isostat calibrate PLAN                            parameters of a scene from laboratory curves
    isostat resistance SCENE --ratios 0.1,0.15,0.2    tests at several amplitudes: a resistance curve
    isostat soil-test SCENE                           element tests of a column's material: G/G_max, damping, CRR
    isostat ensemble SCENE -n 8                       a soil column with eight sets of packings: bands
    isostat compare results/one results/other         two runs side by side in compare.html
    isostat element_test SCENE                        the program of this name, with everything that follows
"""
import importlib
import os
import sys
import warnings

from isostat import _core
from isostat.campaign import command
from isostat.campaign.runs import program
from isostat.figures.command_line import meant

CAMPAIGNS = {"calibrate": "parameters of a scene from laboratory curves, by small element tests",
             "resistance": "cyclic stress ratio against cycles to liquefaction, from many tests",
             "soil-test": "element tests of the material of a column's layer: G/G_max, damping, CRR",
             "ensemble": "a soil column with many sets of packings or many records: bands of all",
             "library": "periodic specimens at several pressures and densities, in one file",
             "study": "NAME: the runs, tables and figures behind a page of results"}
VIEWS = {"compare": "A B [-o FILE]: two runs of one kind side by side, in one HTML file (default: compare.html)",
         "animate": "RESULTS [-o FILE.gif]: packings and their forces during the run, also as .mp4",
         "motion": "RESULTS [--at surface|input|within|DEPTH] [-o FILE.at2]: a motion of a soil column as PEER AT2",
         "view": "RESULTS [--picture FILE.png]: grains, force chains and mesh to look at and turn, with a slider for time",
         "vtkhdf": "RESULTS: grains, force chains and mesh over time for ParaView, one file each",
         "report": "RESULTS: draw figures and report.html of a results folder again, also during its run"}
SANDS = {"sands": "[NAME or FILE ...]: the sands that scenes can take, with the range and the misfit of each"}
PACKINGS = {"convert": "IN OUT: a packing of LAMMPS, YADE, CSV, ParaView or Isostat as another of these"}
PROGRAMS = {"element_test": "one test on spheres: triaxial or simple shear, drained or undrained",
            "void_ratio_limits": "loosest and densest packing of a grading",
            "micromechanics": "forces, fabric and anisotropy of stored packings",
            "soil_column": "layers of soil that are shaken or consolidate, or a block in which a shear band may form, with "
                           "grains at the Gauss points on request",
            "rve_replay": "one packing of a column again, alone"}


def is_built(name):
    try:
        return bool(program(name))
    except _core.InputError:
        return False


def help_text():
    parts = (("many runs", CAMPAIGNS), ("results", VIEWS), ("sands", SANDS), ("packings", PACKINGS),
             ("programs, which can also be called without `isostat`; each has --help",
              {name: text for name, text in PROGRAMS.items() if is_built(name)}))
    text = ("Isostat: liquefaction of sand, grain by grain, alone or as the soil of a deposit that is shaken\n\n"
            "usage: isostat COMMAND ...\n")
    for title, entries in parts:
        text += f"\n{title}\n" + "".join(f"  {name:<25}{what}\n" for name, what in entries.items())
    return text + f"\n  --version                version and revision\n  --help\n\nscenes to start from: {command.SCENES / 'scenes'}"


def view(name, words):
    """Becomes the program that draws and reports."""
    os.environ["PYTHONPATH"] = os.path.dirname(__file__)
    module = {"animate": ["figures.animation"], "motion": ["figures.motion_file"]}.get(name, ["report", name])
    os.execv(sys.executable, [sys.executable, "-B", "-P", "-u", "-m", *module, *words])


def refuse(name):
    known = [*CAMPAIGNS, *VIEWS, *SANDS, *PACKINGS, *PROGRAMS]
    raise _core.InputError(f"{name}: unknown command of isostat. {meant(name, known, 'isostat --help lists them.')}")


def main(words=None):
    _core._speak_as_command()
    warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
    name, *rest = (sys.argv[1:] if words is None else words) or ["--help"]
    if name in CAMPAIGNS:
        return importlib.import_module(f"isostat.campaign.{name.replace('-', '_')}").main(rest)
    if name in PACKINGS:
        return importlib.import_module("isostat.convert_packing").main(rest)
    if name in ("view", "vtkhdf"):
        return importlib.import_module(f"isostat.{name}").main(rest)
    if name in SANDS:
        return importlib.import_module("isostat.sands").main(rest)
    if name in VIEWS:
        return view(name, rest)
    if name in ("--help", "-h"):
        return command.run(lambda: print(help_text()))
    elif name == "--version":
        print(f"isostat {_core.__version__}")
    elif name in PROGRAMS and is_built(name):
        os.execv(program(name), [program(name), *rest])
    else:
        return command.run(lambda: refuse(name))
    return 0


if __name__ == "__main__":
    sys.exit(main())
