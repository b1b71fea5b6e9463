# SPDX-License-Identifier: BSD-3-Clause
"""A deposit of Hertz-Mindlin packings and its twin with the linear law: wave speed, r_u and strain over the depth."""
import dataclasses

import h5py
import numpy as np

import isostat
from isostat.figures.common import legend_below
from studies import APPS
from studies.drawing import BLUE, ORANGE, panels, save
from studies.scenes import cloud_edge
from studies.small_strain import published

DEFAULTS, QUICK = {"grains": 1000, "duration": 12.0}, {"grains": 300, "duration": 0.1}
DENSITY, K0, VOID_RATIO = 1970, 0.5, 0.705  # of the scene and its packings
LIBRARIES = {"quartz": ("rve_library_quartz.toml", "38 GPa"), "linear": ("rve_library.toml", "1 GPa")}
LABELS = {"quartz": "Hertz-Mindlin, 38 GPa", "linear": "linear, 1 GPa"}
SECONDS = {"quartz": 5000, "linear": 1800}  # of 12 s


def library(results, scene, keys, pressures):
    """Specimens of a column."""
    scenes = [isostat.Scene(scene, set={**keys, "specimen.pressure": pressure}) for pressure in pressures]
    specimens = [isostat.prepare(one, cache=results.parent / "specimens") for one in scenes]
    return {"entries": isostat.write_library(results / "library.h5", specimens, overwrite=True)}


@dataclasses.dataclass(frozen=True)
class Library:
    law: str
    grains: int
    kind = "prepare"
    function = staticmethod(library)

    @property
    def name(self):
        return f"library_{self.law}_n{self.grains}"

    @property
    def specimen(self):
        return self.law

    def arguments(self):
        scene, young = LIBRARIES[self.law]
        return {"scene": str(APPS / "scenes" / scene), "pressures": ["20 kPa", "100 kPa"],
                "keys": {"contact.young": young, "grading.grains": self.grains,
                         "grading.cloud_edge": cloud_edge(self.grains)}}

    def estimated_seconds(self):
        return 60 * self.grains / 1000


@dataclasses.dataclass(frozen=True)
class Deposit:
    law: str
    grains: int
    duration: float  # s
    output: str  # folder of the study
    kind = "deposit"
    program = "soil_column"

    @property
    def name(self):
        return f"{self.law}_n{self.grains}_{self.duration:g}s"

    @property
    def specimen(self):
        return self.law

    def scene(self):
        from isostat.column import ColumnScene  # only where Isostat has deal.II

        few = {"load.surcharge": "10 kPa"} if self.grains < 1000 else {}  # they may not come to rest at a few kPa
        return ColumnScene(APPS / "scenes/column/grains_20m_quartz.toml", set={
            "grains.library": f"{self.output}/runs/{Library(self.law, self.grains).name}/library.h5",
            "grains.cache": f"{self.output}/runs/in_situ.h5", "analysis.duration": f"{self.duration:g} s", **few})

    def estimated_seconds(self):
        return SECONDS[self.law] * self.duration / 12 * self.grains / 1000


def add_options(line):
    line.add_argument("--grains", type=int, help="of a packing (default 1000)")
    line.add_argument("--duration", type=float, help="of the motion, s (default 12)")


def runs(options):
    return [run for law in LIBRARIES for run in (Library(law, options.grains),
                                                 Deposit(law, options.grains, options.duration, str(options.output)))]


def profile(folder, end):
    """Over the depth: wave speed at the start, vertical stress, largest r_u and strain until a time."""
    with h5py.File(folder / "profiles.h5") as file:
        depth, velocity, vertical, time = (file[name][()] for name in ("depth", "shear_velocity", "sigma_v0", "time"))
        rows = time <= end
        return (depth, velocity, vertical, file["ru"][()][rows].max(axis=0),
                100 * np.abs(file["gamma_xz"][()][rows]).max(axis=0))


def report(store, planned, folder):
    folders = {run.law: store.folder(run) for run in planned if run.kind == "deposit" and store.is_done(run)}
    if not folders:
        return
    end = next(run.duration for run in planned if run.kind == "deposit")
    figure, axes = panels(1, 3, height=3.6, sharey=True)
    for (law, results), colour in zip(folders.items(), (BLUE, ORANGE)):
        depth, velocity, vertical, ru, gamma = profile(results, end)
        expected = np.sqrt(published.small_strain_modulus(VOID_RATIO, vertical * (1 + 2 * K0) / 3) / DENSITY)
        for panel, values in zip(axes.flat, (velocity, ru, gamma)):
            panel.plot(values, depth, color=colour, marker=".", markersize=4, linewidth=1, label=LABELS[law])
        print(LABELS[law], "until", f"{end:.3g} s;", "V_s over the correlation:",
              *(f"{z:g} m: {v / w:.2f}" for z, v, w in zip(depth, velocity, expected)))
        print(LABELS[law], "r_u above 0.95 at", *(f"{z:g}" for z in depth[ru > 0.95]), "m")
    axes[0, 0].plot(expected, depth, color="black", linestyle="--", linewidth=1, label="correlation for sand")
    axes[0, 0].fill_betweenx(depth, 0.85 * expected, 1.15 * expected, color="black", alpha=0.08, linewidth=0)
    axes[0, 0].set(xlabel="$V_s$ at the start (m/s)", ylabel="Depth (m)", xlim=(0, None), ylim=(20, 0))
    axes[0, 1].set(xlabel=f"Largest $r_u$ until {end:.3g} s")
    axes[0, 2].set(xlabel=rf"Largest $|\gamma|$ until {end:.3g} s (%)", xscale="log")
    legend_below(figure, axes[0, 0], 0.08, 3)
    save(figure, folder / "deposit.png")
