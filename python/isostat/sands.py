# SPDX-License-Identifier: BSD-3-Clause
"""isostat sands: what the files of sands say of themselves (dem/scene/sand.hpp).   tested: tests/apps/sands_test.py"""
import pathlib

from isostat import _core
from isostat.campaign import command
from isostat.scene import Scene

FOLDER = command.SCENES / "scenes/sands"


def described(file: pathlib.Path) -> str:
    """Range, misfits and origin of a sand in a few lines.   Raises InputError"""
    own = file.suffix == ".toml"
    scene = Scene({"sand": str(file.absolute() if own else file), "specimen": {"preparation_friction": "10 deg"}}).to_dict()
    sand, limits = scene["sand"], (scene["specimen"].get(name, "unknown") for name in ("e_min", "e_max"))

    def span(low, high):
        if low in sand and high in sand:
            return f"{sand[low]} to {sand[high]}"
        return f"from {sand[low]}" if low in sand else f"up to {sand[high]}" if high in sand else "any"

    return (f"{sand['name']}\n"
            f"  misfit           fitted {sand.get('misfit', 'unknown')}, not fitted {sand.get('blind_misfit', 'unknown')}\n"
            f"  p0'              {span('lowest_pressure', 'highest_pressure')}\n"
            f"  void ratio       {span('lowest_void_ratio', 'highest_void_ratio')}\n"
            f"  e_min, e_max     {', '.join(map(str, limits))}\n"
            f"  axial strain     to {sand.get('largest_strain', 'any')}\n"
            f"  tests            {sand.get('tests', 'unknown')}\n"
            f"  source           {sand.get('source', 'unknown')}\n"
            f"  file             {file if own else FOLDER / f'{file}.toml'}\n")


def list_sands(files: list[pathlib.Path]) -> None:
    files = files or sorted(FOLDER.glob("*.toml"))
    if not files:
        raise _core.InputError(f"{FOLDER}: there are no sands in this installation. Give a file: isostat sands my_sand.toml.")
    print("\n".join(described(file) for file in files), end="")


def main(words: list[str]) -> int:
    line = command.line_of("sands", "The sands that scenes can take (sand = \"NAME\"), with the range in which each was compared "
                           "with tests and its misfits")
    line.add_argument("files", metavar="SAND", nargs="*", type=pathlib.Path, help="names of sands, or files of your own (default: the installed)")
    options = line.parse_args(words)
    return command.run(lambda: list_sands(options.files))
