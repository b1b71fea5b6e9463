# SPDX-License-Identifier: BSD-3-Clause
"""Reads the results folder of a soil column: histories, profiles, the resolved scene."""
import re
import tomllib

import h5py
import numpy as np

from .common import BadInput, note, read_history
from .files import Damaged, read_parsed

SI = {"m": 1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "1/s": 1, "kg/m3": 1,
      "g/cm3": 1e3, "m/s": 1, "cm/s": 1e-2, "mm/s": 1e-3, "m/s2": 1, "cm/s2": 1e-2, "g": 9.80665, "Hz": 1, "kHz": 1e3,
      "s": 1, "ms": 1e-3, "min": 60, "h": 3600, "d": 86400}


def quantity(value, default=None):
    """A quantity of a scene in SI: "5 m" or a plain number."""
    if value is None:
        return default
    if isinstance(value, (int, float)):
        return float(value)
    text, _, unit = value.strip().partition(" ")
    return float(text) * SI[unit.strip()]


def of_layer(table):
    density = quantity(table.get("density"), 2000.0)
    velocity, modulus = quantity(table.get("shear_velocity")), quantity(table.get("shear_modulus"))
    if velocity is None and modulus is not None:
        velocity = float(np.sqrt(modulus / density))
    elif velocity is None and table["material"] in ("elastic", "iwan", "mohr_coulomb"):
        raise KeyError("shear_modulus")
    return {"height": quantity(table["thickness"]), "density": density, "velocity": velocity,
            "poisson_ratio": table.get("poisson_ratio", 0.3), "porosity": table.get("porosity", 0.4),
            "permeability": quantity(table.get("permeability"), 0.0), "material": table["material"],
            "saturation": float(table.get("saturation", 1)),
            "permeability_law": table.get("permeability_law", "constant")}


def table_if_there(path, otherwise):
    """Columns by name, none if there is no such table; of one that cannot be read a note says what comes of it."""
    try:
        return read_history(path) if path.exists() else {}
    except BadInput as error:
        note(f"{error}; {otherwise}")
        return {}


def broken(boundaries, depth, values):
    """Both with not-a-number between points of two layers, so that no line joins them."""
    cuts = np.flatnonzero(np.diff(np.searchsorted(boundaries, depth))) + 1
    return np.insert(depth, cuts, np.nan), np.insert(np.asarray(values, dtype=float), cuts, np.nan)


class Grains:
    """What the packings of a column left: `points` of its grain_history with their prefix, `profiles` by name."""

    def __init__(self, folder):
        self.columns = table_if_there(folder / "grain_history/history.csv", "its figures are left out")
        self.points = [(float(self.columns[f"{prefix}_depth"][0]), prefix) for prefix in self._prefixes(self.columns)]
        rows = table_if_there(folder / "grain_profiles/history.csv", "its figures are left out")
        prefixes = self._prefixes(rows)
        self.profiles = {"time": rows["time"]} if prefixes else {}
        if prefixes:
            self.profiles["depth"] = np.array([rows[f"{prefix}_depth"][0] for prefix in prefixes])
            for name in [cell[3:] for cell in rows if cell.startswith("p0_") and cell != "p0_depth"]:
                self.profiles[name] = np.array([rows[f"{prefix}_{name}"] for prefix in prefixes]).T  # [time x depth]

    @staticmethod
    def _prefixes(columns):
        return sorted((name[:-6] for name in columns if name.endswith("_depth")), key=lambda prefix: int(prefix[1:]))


class Column:
    """A run of soil_column. `moving` are the axes with motion; `points` the output depths with their column
    prefix; `peaks` the largest accelerations of all steps, m/s^2, of which the history has a part only."""

    def __init__(self, folder):
        self.folder = folder
        self.columns = {name: values for name, values in read_history(folder / "history.csv").items()
                        if np.isfinite(values).any()}
        if "time" not in self.columns:
            raise BadInput("history.csv: column `time` is missing or empty")
        self.time = self.columns["time"]
        if len(self.time) < 2 or not (np.diff(self.time) > 0).all():
            raise BadInput("history.csv: needs two rows at least, and times that rise")
        self.scene = self._read(folder / "scene.toml", tomllib.loads)
        profiles, maps = (self._read_profiles(folder / name) for name in ("profiles.h5", "maps.h5"))
        self.velocities = {name: profiles[name] for name in ("depth", "shear_velocity")
                           if "shear_velocity" in profiles}  # also of a run without profiles in time
        self.profiles, self.maps = (table if {"depth", "time"} <= table.keys() and table["time"].size else {}
                                    for table in (profiles, maps))  # maps: of a box
        self.plate = table_if_there(folder / "plate/history.csv", "its figure is left out")
        self.grains = Grains(folder)
        self._read_scene()
        summary = self._read(folder / "summary.json")
        self.summary = summary
        self.title = summary.get("title") or self.scene.get("title") or folder.resolve().name
        self.moving = [axis for axis in "xyz" if self.peak(f"input_a{axis}") > 0]
        self.horizontal = [axis for axis in "xy" if axis in self.moving]
        self.mesh_frequency = (summary.get("mesh_check") or {}).get("frequency") or np.inf  # of --check-mesh, Hz
        one = len(self.moving) == 1  # else the summary's are those of vectors
        self.peaks = {f"{where}_a{axis}": summary.get(f"peak_{where}") if one else None
                      for axis in self.moving for where in ("input", "surface")}
        prefixes = sorted({match[1] for match in map(re.compile(r"(d\d+)_").match, self.columns) if match},
                          key=lambda prefix: int(prefix[1:]))
        self.points = [(self._depth(prefix, k, summary), prefix) for k, prefix in enumerate(prefixes)]
        self.motion_depths = [float(self[f"{prefix}_node_depth"][0]) if self.has(f"{prefix}_node_depth") else None
                              for _, prefix in self.points]
        self.peak_profile = table_if_there(folder / "profile.csv", "figures of largest values are left out")
        self.spectra = table_if_there(folder / "spectra.csv", "response spectra are those of the rows of the history")

    @property
    def shaken(self):
        """Whether its time is one of motion: not that of a consolidation, nor the steps of a plate."""
        return not self.consolidation and not self.plate

    def _depth(self, prefix, k, summary):
        """Where the data of an output depth are, m: of the point nearest to what was asked for. None: not known."""
        if self.has(f"{prefix}_depth"):
            return float(self[f"{prefix}_depth"][0])
        depths = summary.get("depths") or []
        return depths[k] if k < len(depths) else None

    @staticmethod
    def _read(path, *parse):
        try:
            return read_parsed(path, *parse)
        except OSError as error:
            note(f"{path.name} cannot be read ({error}); what needs it is left out")
        except Damaged as error:
            note(f"{error} Until then what needs it is left out")
        return {}

    @staticmethod
    def _read_profiles(path):
        if not path.exists():
            return {}
        try:
            with h5py.File(path) as file:
                return {name: np.asarray(item) for name, item in file.items() if isinstance(item, h5py.Dataset)}
        except OSError as error:
            note(f"{path.name} cannot be read ({error}); figures over the depth are left out")
            return {}

    def _ground_scale(self):
        """Height of the ground of a box at the vertical of the histories over that of the layers."""
        mesh, height = self.scene.get("mesh", {}), sum(layer["height"] for layer in self.layers)
        xs, zs = ([quantity(value) for value in mesh.get(key, [])] for key in ("ground_x", "ground_z"))
        if not xs or not height:
            return 1.0
        middle = quantity(mesh.get("width"), 1.0) / 2
        return float(np.interp(quantity(self.scene.get("output", {}).get("x"), middle), xs, zs)) / height

    def _read_scene(self):
        scene = self.scene
        self.layers = [of_layer(table) for table in scene.get("layer", [])]
        self.is_drawn = bool(scene.get("mesh", {}).get("file"))  # layers lie anywhere
        scale = self._ground_scale()
        for layer in self.layers:
            layer["height"] *= scale
        self.consolidation = scene.get("analysis", {}).get("kind") == "consolidation"
        analysis = scene.get("analysis", {})
        self.damping = {"mass_damping": quantity(analysis.get("mass_damping"), 0.0),
                        "viscosity": quantity(analysis.get("viscosity"), 0.0),
                        "viscous_above": quantity(analysis.get("highest_frequency"), 25.0)}
        self.spectrum_damping = float(scene.get("output", {}).get("spectrum_damping", 0.05))
        base = scene.get("base", {})
        self.base = None
        if base.get("kind") == "compliant":
            self.base = {"density": quantity(base["density"]), "velocity": quantity(base["shear_velocity"])}
        water = scene.get("water", {})
        self.water = {"density": quantity(water.get("density"), 1000.0), "table": quantity(water.get("table"), 0.0),
                      "gravity": quantity(water.get("gravity"), 9.81),
                      "bulk_modulus": quantity(water.get("bulk_modulus"), 2.2e9),
                      "relative_viscosity": float(water.get("relative_viscosity", 1)),
                      "henry": float(water.get("henry", 0)), "base": water.get("base", "closed")}

    def has(self, name):
        return name in self.columns

    def __getitem__(self, name):
        return self.columns[name]

    def peak(self, name):
        return float(np.nanmax(np.abs(self[name]))) if self.has(name) else 0.0

    def profile(self, name):
        """[time x depth] or None; rows are as many as the run has written times."""
        values = self.profiles.get(name)
        return values if values is not None and np.isfinite(values).any() else None

    def bottom(self, depth):
        """Of the layers, m; of a scene that cannot be read the largest depth."""
        return (0 if self.is_drawn else sum(layer["height"] for layer in self.layers)) or float(depth.max())

    def boundaries(self):
        """Depths between layers, m."""
        return [] if self.is_drawn else list(np.cumsum([layer["height"] for layer in self.layers])[:-1])

    def layer_at(self, depth):
        """The number of the layer at each depth."""
        return np.searchsorted(self.boundaries(), depth)

    def shares(self, depth):
        """Top and bottom of what each of the points stands for, from the surface down, m: half the way to its
        neighbours in the same layer, and to the boundaries of its layer. Layers without points are left out."""
        layer, ends = self.layer_at(depth), [0.0, *self.boundaries(), self.bottom(depth)]
        apart = np.diff(layer) > 0
        middle = 0.5 * (depth[1:] + depth[:-1])
        top = np.concatenate([[ends[layer[0]]], np.where(apart, np.take(ends, layer[1:]), middle)])
        bottom = np.concatenate([np.where(apart, np.take(ends, layer[:-1] + 1), middle), [ends[layer[-1] + 1]]])
        return top, bottom

    def broken(self, depth, values):
        return broken(self.boundaries(), depth, values)

    def capped_boundaries(self):
        """Of those, the ones below the water table and layers that are less permeable than the layer beneath."""
        pairs = zip(self.layers, self.layers[1:])
        return [depth for depth, (above, below) in zip(self.boundaries(), pairs)
                if above["permeability"] < below["permeability"] and depth > self.water["table"] + 1e-6]

    def uniform_elastic(self):
        """The one layer if all are elastic and alike, and level between tied sides; else None."""
        mesh = self.scene.get("mesh", {})
        if "file" in mesh or mesh.get("sides", "tied") != "tied":
            return None
        if not self.layers or any(layer["material"] != "elastic" for layer in self.layers):
            return None
        first = {**self.layers[0], "height": sum(layer["height"] for layer in self.layers)}
        alike = all({**layer, "height": first["height"]} == first for layer in self.layers)
        return first if alike else None

    def step_load(self):
        """The sudden vertical load, Pa, or None."""
        load = self.scene.get("load", {})
        vertical = load.get("kind") == "step" and load.get("direction", "z") == "z"
        return quantity(load["amplitude"]) if vertical and quantity(load.get("ramp"), 0.0) == 0 else None

    def motion(self, name):
        """A history at equal intervals, the mean one of the run: values and interval."""
        n = len(self.time)
        even = np.linspace(self.time[0], self.time[-1], n)
        return np.interp(even, self.time, np.nan_to_num(self[name])), (self.time[-1] - self.time[0]) / (n - 1)
