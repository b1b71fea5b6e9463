# SPDX-License-Identifier: BSD-3-Clause
"""docs/file_formats.md against the files that the programs write: every dataset with its unit and number of dimensions,
every attribute, every column of history.csv is in the section of its format."""
import csv
import re

import h5py

from biaxial_test import ELASTIC
from column_support import SCENES, settings
from grain_column_test import GrainColumnTest
from plate_test import BOX as PLATE
from support import CYCLIC, ROOT, tiny_scene

PAGE = ROOT / "docs/file_formats.md"
ROOT = {"format", "schema_version", "units", "program", "program_version"}
CELL = 'domain = "periodic-cell"\npreparation_friction = "10 deg"'
SHEAR = '[[stage]]\nkind = "undrained-simple-shear"\nstrain = 0.02\nmax_steps = 500\n'


def described():
    """{section: {name: (shape, unit)}} of the tables of the page; the section is the first `name` of its heading."""
    sections, here = {}, {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            name = re.search(r"`([^`]+)`", line)
            here = sections.setdefault(name[1] if name else line[3:], {})
        elif line.startswith("| `"):
            names, shape, unit = (cell.strip() for cell in line.split("|")[1:4])
            here.update({name: (shape, unit) for name in re.findall(r"`([^`]+)`", names)})
    return sections


def version(section):
    """The schema_version that the page names for a format: 1 where it names none."""
    text = PAGE.read_text(encoding="utf-8").split(f"\n## `{section}`\n")[1].split("\n## ")[0]
    named = re.search(r"\bVersion (\d+)\.", text)
    return int(named[1]) if named else 1


def general(name):
    """Names of repeated items as the page has them: dK_gamma_xz, drive/servo@step_k, ENTRY/snapshot/..."""
    name = re.sub(r"^(s\d{4}|i[0-9a-f]{16})(?=/|@|$)", "ENTRY", name)
    name = re.sub(r"(?<=losses/)\d+(?=/|@|$)|(?<=drive/ends/)\d+(?=/|@|$)", "N", name)
    name = re.sub(r"(?<=history/expansion_)\d+$", "K", name)
    name = re.sub(r"(?<=control/)(sigma_[xyz]|tau_xy|indicator|losses/N/deviation)(?=@)", "Q", name)
    name = re.sub(r"^(drive/.*@\w+?)((?:_[xyz])+)$", lambda m: m[1] + "_k" * (len(m[2]) // 2), name)
    name = re.sub(r"^(assembly@(?:wall_\w+|virial)_)(\d+)$", lambda m: m[1] + "K" * len(m[2]), name)
    return re.sub(r"(?<=history/)([dp])\d+_", r"\1K_", name)


def packing_of(name):
    """The name within a packing, or None."""
    found = re.match(r"(?:ENTRY/)?(?:snapshot|state)(?:/|(?=@))(.+)", name)
    return found and found[1]


class FileFormats(GrainColumnTest):
    def check(self, path, page):
        with h5py.File(path) as file:
            self.assertLessEqual(ROOT, set(file.attrs), path)
            section = file.attrs["format"]
            self.assertIn(section, page, f"{path}: its format is not in {PAGE.name}")
            self.assertEqual(file.attrs["schema_version"], version(section), f"{path}: version of {section}")
            items = {"": file}
            file.visititems(lambda name, item: items.__setitem__(name, item))
            for name, item in items.items():
                name = general(name)
                if isinstance(item, h5py.Dataset):
                    shape, unit = self.row(page, section, name, path)
                    self.assertIn(item.attrs["unit"], unit.split(" or "), f"{path}: {name}")
                    self.assertEqual(item.ndim, shape.count(",") + 1, f"{path}: {name} has the shape {item.shape}")
                for attribute in set(item.attrs) - {"unit"} - (set() if name else ROOT | {"scene"}):
                    self.row(page, section, general(f"{name}@{attribute}"), path)

    def row(self, page, section, name, path):
        inner = packing_of(name)
        table = page["packing"] if inner else page[section]
        if "provenance@" in name or "numbers@" in name and "specimen" in section:
            table, inner = page["isostat-specimen"], name.removeprefix("ENTRY/")
        if section == "isostat-checkpoint" and name.startswith("specimen@"):
            table, inner = page["isostat-specimen"], name.replace("specimen@", "numbers@")
        if name.startswith("history/dK_") and name not in table:
            inner = name.replace("dK_", "")
        self.assertIn(inner or name, table, f"{path}: not in {PAGE.name}, section {section}")
        return table[inner or name]

    def test_every_item_is_listed(self):
        page = described()
        self.make_files()
        files = [path for place in (self.folder, self.cache) for path in place.rglob("*.h5") if path.is_file()]
        for path in files:
            self.check(path, page)
        formats = set()
        for path in files:
            with h5py.File(path) as file:
                formats.add(file.attrs["format"])
        self.assertEqual(formats, {name for name in page if name.startswith("isostat-")})
        for path in self.folder.rglob("history.csv"):
            with open(path, encoding="utf-8") as file:
                for column in next(csv.reader(file)):
                    name, unit = re.fullmatch(r"(\S+) \((.*)\)", column).groups()
                    listed = self.row(page, "isostat-history", general("history/" + name), path)
                    self.assertIn(unit, listed[1].split(" or "), f"{path}: {name}")

    def make_files(self):
        every = "checkpoint = \"1e-9 min\"\nenergy = true"
        for name, scene in (("box", tiny_scene(stages=CYCLIC.format(steps=600), output=every)),
                            ("cell", tiny_scene(specimen=CELL, stages=SHEAR, output=every))):
            self.assert_done(self.run_test(self.write(f"{name}.toml", scene), "-o", name, "-q"))
        self.whole()
        for name, change in (("terzaghi", {}), ("uniform_layer", {"analysis__duration": "0.1 s"}),
                             ("silt_cap", {"analysis__duration": "0.1 s"})):
            self.assert_done(self.run_column(SCENES / f"{name}.toml", "-o", name, "-q", *settings(**change)))
        self.assert_done(self.run_column(self.write("plate.toml", PLATE), "-o", "plate", "-q"))
        block = self.write("block.toml", ELASTIC.format(degree=1))
        self.assert_done(self.run_column(block, "-o", "block", "-q"))
