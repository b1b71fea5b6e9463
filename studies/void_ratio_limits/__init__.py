# SPDX-License-Identifier: BSD-3-Clause
"""e_min and e_max of Karlsruhe fine sand over seeds, in a box and in a periodic cell."""
import dataclasses
import json
import subprocess

from isostat.campaign.runs import program
from studies import APPS
from studies.ensembles import ensemble
from studies.scenes import cloud_edge
from studies.tables import write_csv

DEFAULTS, QUICK = {"seeds": 3, "grains": 2000}, {"seeds": 1, "grains": 200}
DOMAINS = ("rigid-box", "periodic-cell")
LIMITS = ("e_min", "e_min_inside", "e_max", "e_max_inside")


def limits(results, scene, keys):
    """What the program void_ratio_limits finds, by name."""
    words = [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]
    subprocess.run(["setpriv", "--pdeathsig", "TERM", "--", program("void_ratio_limits"), scene, "--output",
                    results / "limits", "--overwrite", *words], check=True)
    written = json.loads((results / "limits/limits.json").read_text(encoding="utf-8"))
    return {name: item["value"] for name, item in written.items()}


@dataclasses.dataclass(frozen=True)
class Run:
    """Both limits of one cloud."""

    domain: str
    grains: int
    seed: int
    kind = "limits"
    function = staticmethod(limits)

    @property
    def name(self):
        return f"{self.domain}_n{self.grains}_s{self.seed}"

    def arguments(self):
        return {"scene": str(APPS / "scenes/void_ratio_limits.toml"),
                "keys": {"grading.grains": self.grains, "grading.seed": self.seed,
                         "grading.cloud_edge": cloud_edge(self.grains), "specimen.domain": self.domain}}

    def estimated_seconds(self):
        return 60 * self.grains / 2000


def add_options(line):
    line.add_argument("--grains", type=int, help="of a cloud (default 2000; the paper has 10000)")


def runs(options):
    return [Run(domain, options.grains, seed) for domain in DOMAINS for seed in range(1, options.seeds + 1)]


def report(store, planned, folder):
    rows = []
    for domain in DOMAINS:
        found = [store.run(run).result for run in planned if run.domain == domain and store.is_done(run)]
        for limit in LIMITS if found else ():
            mean, _, error, n = ensemble([limits_of_one[limit] for limits_of_one in found])
            rows.append({"domain of e_min": domain, "grains": planned[0].grains, "limit": limit, "mean": f"{mean:.4f}",
                         "standard error": f"{error:.4f}", "seeds": n})
    write_csv(folder / "limits.csv", rows)
