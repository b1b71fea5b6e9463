# SPDX-License-Identifier: BSD-3-Clause
"""What is run: specimens by relative density or preparation friction, and the scene of each test."""
import dataclasses

from studies.scenes import CONTACT, cyclic as cyclic_stage, scene_of
from studies.speed_error.plan import TENTH

P0 = 200  # kPa, of the paper
FRICTION = 18  # degrees
AMPLITUDE = "60 kPa"  # of its cyclic test
PAPER = (0.30, 0.64, 0.88)  # its relative densities
# (e_min, e_max): the paper's, and those of boxes of this few grains, which walls loosen (study void_ratio_limits);
# at the paper's limits no box of 2,000 grains is as dense as D_r = 0.88
PAPER_LIMITS, OWN_LIMITS = (0.568, 0.841), {2000: (0.630, 0.893)}
CELL_LIMITS = (0.518, 0.802)  # of 2,000 grains, the loosest away from walls
LABORATORY = {0.21: "TMD3", 0.51: "TMD8", 0.83: "TMD18"}  # drained tests at 200 kPa
PREPARATIONS = range(7, 12)  # friction, degrees
AFTER_ONSET = 8  # reversals: four cycles
LARGE = 5000  # grains
# Preparation friction, degrees, of large boxes of the paper's densities, instead of a search, whose trials take half an
# hour each: the loosest that keep their pressure when friction is set (those of D_r = 0.30 do not), nearly the densest
LARGE_DEGREES = {0.30: FRICTION, 0.88: 0.5}

# the default I = 4e-5 to 0.5 % of strain, ten times that behind it
FIRST_STRAIN, FAST = 0.005, 4e-4
DENSITY_OF_GRAINS, D50 = 2650, 0.45e-3


def strain_rate(inertial_number, pressure):
    """I sqrt(p0'/rho)/d50, 1/s."""
    return inertial_number * (pressure * 1e3 / DENSITY_OF_GRAINS) ** 0.5 / D50


CELL, SAME_E = "periodic cell", "periodic cell, void ratio of the boxes"  # ways to make a specimen without walls
DEFAULT, SLOW = "default", "tenth"  # paces; what happens after the onset needs the slow one
PACES = {DEFAULT: {"damping": 0.1}, SLOW: {"damping": 0.1} | TENTH}  # keys of [motion]
LARGE_MOTION = {"damping": 0.02, "load_per_wave": 0.02}  # nearer to slow tests than the default
LARGE_PACES = {DEFAULT: LARGE_MOTION, SLOW: LARGE_MOTION | {"inertial_number": 7e-5}}  # with 10,000 grains
PACE_DEGREES = 9  # preparation friction of specimens of slow tests


@dataclasses.dataclass(frozen=True)
class Packing:
    """One specimen. Either density or friction says how dense it is."""

    grains: int
    seed: int
    relative_density: float = 0
    degrees: float = 0
    young: float = 10  # GPa
    way: str = ""  # in a box, CELL or SAME_E

    @property
    def density(self):
        return f"D_r {self.relative_density:.2f}" if self.relative_density else f"{self.degrees:g} deg"

    @property
    def limits(self):
        """By which its relative density is meant."""
        return CELL_LIMITS if self.way == CELL else OWN_LIMITS.get(self.grains, PAPER_LIMITS)

    @property
    def label(self):
        more = [self.density, f"{P0} kPa"]
        more += [f"E {self.young:g} GPa"] if self.young != 10 else []
        more += [self.way] if self.way else []
        return ", ".join(more)

    def sections(self):
        """Of the scene: how it is made."""
        hard_to_find = self.grains >= LARGE and self.young == 10 and not self.way
        degrees = self.degrees or (hard_to_find and LARGE_DEGREES.get(self.relative_density))
        specimen = {"domain": "periodic-cell" if self.way else "rigid-box", "pressure": f"{P0} kPa"}
        if degrees:
            specimen["preparation_friction"] = f"{degrees:g} deg"
        else:
            e_min, e_max = self.limits
            # a search costs more than a test, and small boxes scatter; the loosest give way when friction is raised
            tolerance = 0.01 if self.grains > 2000 else 0.03 if self.relative_density > 0.25 else 0.10
            specimen |= {"relative_density": self.relative_density, "e_min": e_min, "e_max": e_max,
                         "density_tolerance": tolerance}
        specimen |= {"compaction_rate": "10 1/s"} if self.young < 1 else {}  # at the default some soft packings explode
        return {"specimen": specimen,
                "contact": CONTACT | {"young": f"{self.young:g} GPa", "friction": f"{FRICTION} deg"}}


@dataclasses.dataclass(frozen=True)
class Run:
    """One run, as isostat study takes it."""

    kind: str  # prepare, compression, extension, drained, cyclic
    packing: Packing
    strain: float = 0.05
    max_cycles: int = 100
    pace: str = DEFAULT  # of PACES
    after: int = AFTER_ONSET  # reversals, of tests that look behind the onset

    @property
    def seed(self):
        return self.packing.seed

    @property
    def specimen(self):
        return self.packing

    @property
    def name(self):
        how = f"_{100 * self.strain:g}%" if self.kind in ("compression", "extension", "drained") else ""
        how += f"_{self.pace}" if self.pace != DEFAULT else ""
        p = self.packing
        name = f"{self.kind}{how}_{p.label}_n{p.grains}_s{p.seed}"
        return name.replace(", ", "_").replace(" ", "")

    @property
    def looks_behind_onset(self):
        """The test of the paper: through four cycles after the onset. At the default's rate only the cycles to
        liquefaction are asked."""
        return self.pace == SLOW

    def scene(self):
        p, is_cyclic = self.packing, self.kind == "cyclic"
        motion = LARGE_PACES.get(self.pace) if p.grains >= LARGE and is_cyclic else None
        return scene_of(self.name, p.grains, p.seed, stages=self.stages(), motion=motion or PACES[self.pace],
                        record_stress="1 kPa", record_strain=1e-4 if is_cyclic else 2e-4, **p.sections())

    def stages(self):
        if self.kind == "prepare":
            return []
        if self.kind == "cyclic":
            after = self.after if self.looks_behind_onset else 0
            return [cyclic_stage(AMPLITUDE, cycles=self.max_cycles, reversals_after_liquefaction=after, strain=0.15)]
        stage = {"kind": "drained" if self.kind == "drained" else "undrained-monotonic",
                 "direction": "extension" if self.kind == "extension" else "compression"}
        if self.strain <= FIRST_STRAIN:
            return [stage | {"strain": self.strain}]
        rate = strain_rate(FAST, P0)
        return [stage | {"strain": FIRST_STRAIN},
                stage | {"strain": float(f"{self.strain - FIRST_STRAIN:g}"), "strain_rate": f"{rate:.3g} 1/s"}]

    def estimated_seconds(self):
        first = 1e5 * min(self.strain, FIRST_STRAIN) / FIRST_STRAIN
        fast = 2e4 * (self.strain - FIRST_STRAIN) / 0.01
        search = 1.5e5 if self.packing.relative_density else 5e4
        cyclic = 2.5e6 if self.looks_behind_onset else 8e4
        steps = {"prepare": search, "cyclic": cyclic}.get(self.kind, first + max(0, fast))
        return 1.2e-4 * steps * self.packing.grains / 2000


def ends(whole):
    """When cyclic tests end."""
    return {"max_cycles": 100 if whole else 50, "after": AFTER_ONSET if whole else AFTER_ONSET // 2}


def figure_1(grains, seeds, whole):
    """Monotonic tests at the three densities of the paper; the dense one with softer contacts, too."""
    runs = []
    for seed in seeds:
        for density in PAPER:
            for kind in ("compression", "extension"):
                strain = (0.20 if whole else 0.10) if density == PAPER[0] else (0.05 if whole else 0.03)
                runs.append(Run(kind, Packing(grains, seed, density), strain))
        if whole or seed == seeds[0]:
            runs += [Run("compression", Packing(grains, seed, PAPER[2], young=young), 0.05 if whole else 0.03)
                     for young in (1, 0.1)]
    return runs


def drained(grains, seeds, whole):
    return [Run("drained", Packing(grains, seed, density), 0.15 if whole else 0.10)
            for seed in seeds for density in LABORATORY]


def cyclic(grains, seeds, whole):
    """Figure 2: the density of the paper with two more seeds, and a row of preparations, in boxes; the density and the
    void ratio of the paper in cells."""
    packings = [Packing(grains, seed, PAPER[1]) for seed in range(1, len(seeds) + 3)]
    packings += [Packing(grains, seed, degrees=d) for seed in seeds for d in PREPARATIONS
                 if whole or d % 2 or d == 10]
    if grains < LARGE:
        packings += [Packing(grains, seed, PAPER[1], way=way) for seed in seeds for way in (CELL, SAME_E)]
    return [Run("cyclic", packing, **ends(whole)) for packing in packings]


def onset(grains, seeds, whole):
    """Figures 3 and 4: one of these preparations slowly, for what happens around and after the onset; and the same
    specimens at the default's rate, for what the rate does to the number of cycles."""
    return [Run("cyclic", Packing(grains, seed, degrees=PACE_DEGREES), pace=pace, **ends(whole))
            for pace in (SLOW, DEFAULT) for seed in seeds]


PARTS = {"monotonic": figure_1, "cyclic": cyclic, "onset": onset, "drained": drained}


def runs_of(grains, n_seeds, whole=False, parts=tuple(PARTS)):
    """All runs, each once, specimens first. Not the whole: fewer states, for half an hour."""
    tests = list(dict.fromkeys(run for part in parts for run in PARTS[part](grains, range(1, n_seeds + 1), whole)))
    packings = list(dict.fromkeys(run.packing for run in tests))
    return [Run("prepare", packing) for packing in packings] + tests
