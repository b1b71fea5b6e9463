# SPDX-License-Identifier: BSD-3-Clause
"""Scenes of the tests that several studies run: packings of one sand, with the contacts of the paper."""

RESISTANCE = {"friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}, "twisting": {"stiffness": 0.3}}
CONTACT = {"young": "10 GPa", "stiffness_ratio": 0.3} | RESISTANCE


def cloud_edge(grains, form=".15g"):
    """Of a cloud whose grains are as large as 10,000 of them in 10 mm."""
    return f"{10 * (grains / 10000) ** (1 / 3):{form}} mm"


def scene_of(title, grains, seed, specimen, stages=(), *, edge=".15g", contact=CONTACT, grading=None, motion=None,
             **output):
    """Sections of a scene that leaves tables alone.   edge: digits of the cloud's edge   output: more of [output]"""
    cloud = {"curve": "karlsruhe-fine-sand", "grains": grains, "cloud_edge": cloud_edge(grains, edge), "seed": seed}
    return {"title": title, "grading": cloud | (grading or {}), "contact": contact, "specimen": specimen,
            "motion": motion or {}, **({"stage": list(stages)} if stages else {}),
            "output": {"snapshots": "none", "paraview": False, **output}}


def cyclic(amplitude="60 kPa", **until):
    """The undrained cyclic stage of the paper."""
    return {"kind": "undrained-cyclic", "deviator_amplitude": amplitude, "until": until}
