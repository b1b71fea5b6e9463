# SPDX-License-Identifier: BSD-3-Clause
"""A drained test of 500 grains from Python, with its figure: what the packages are tried with."""
import isostat

SCENE = {
    "title": "Drained compression",
    "grading": {"curve": "karlsruhe-fine-sand", "grains": 500, "cloud_edge": "3.684 mm"},
    "contact": {"young": "1 GPa", "stiffness_ratio": 0.3, "friction": "18 deg",
                "rolling": {"stiffness": 0.3, "limit": 0.5}, "twisting": {"stiffness": 0.3}},
    "specimen": {"pressure": "200 kPa", "preparation_friction": "5 deg"},
    "stage": [{"kind": "drained", "strain": 0.02}],
}
run = isostat.run(isostat.Scene(SCENE), output="results/drained", overwrite=True)
print(run.history["q"][-1], "Pa")
isostat.draw("results/drained", "fig_stress_path")[0].figure.savefig("drained.png")
print("drained.png")
