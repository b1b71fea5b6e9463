#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do two builds give the same bits? Runs some twenty short scenes of every program and hashes what they leave.

    same_bits.py BIN_FOLDER --store digests.json            # of the build before a change; continues where it stopped
    same_bits.py BIN_FOLDER --against digests.json          # of the build after it; returns 1 if a digest differs

Hashed (SHA-256) are the bytes of history.csv and, of every HDF5 file with numbers (snapshots, profiles, maps, strain
paths, specimens), the values of its datasets with their names and shapes; attributes, texts and checkpoints are left
out, because what describes a result may improve while the result stays. Both builds run on the same machine: another
instruction set rounds differently. Some ten minutes on one core.
"""
import argparse
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = ROOT / "apps/scenes"
COLUMNS = ROOT / "tests/regression/columns"
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
FEW = ("--set", "grading.grains=300", "--set", "grading.cloud_edge=3.107 mm")
TINY = ("--set", "grading.grains=150", "--set", "grading.cloud_edge=2.45 mm", "--set", "grading.truncate=[20, 80]")

OTHER_STAGES = """title = "stages that no ready scene has"
[grading]
curve = "karlsruhe-fine-sand"
grains = 300
cloud_edge = "3.1 mm"
[contact]
young = "1 GPa"
stiffness_ratio = 0.3
friction = "20 deg"
rolling = { stiffness = 0.3, limit = 0.2 }
[specimen]
domain = "DOMAIN"
pressure = "100 kPa"
preparation_friction = "8 deg"
[[stage]]
kind = "friction"
friction = "25 deg"
[[stage]]
kind = "rebalance"
[[stage]]
kind = "compress"
pressure = "150 kPa"
[[stage]]
kind = "constant-p"
direction = "extension"
strain = 0.001
[[stage]]
kind = "hold"
max_steps = 500
[[stage]]
kind = "drained"
strain = 0.001
[output]
energy = true
"""

# name -> program, arguments; {work} is the folder of all runs. In order: later ones may use the results of earlier
# ones.
RUNS = {
    "box, cyclic, liquefies": ("element_test", SCENES / "quick_cyclic_liquefies.toml", *FEW,
                               "--set", "stage.0.until.reversals_after_liquefaction=1"),
    "box, cyclic, killed and resumed": ("element_test", SCENES / "quick_cyclic_liquefies.toml", *FEW,
                               "--set", "stage.0.until.reversals_after_liquefaction=1"),
    "box, loose, compression": ("element_test", SCENES / "monotonic_compression_dr30.toml", *FEW,
                                "--set", "specimen.relative_density=0.45", "--set", "specimen.density_tolerance=0.2",
                                "--set", "stage.0.strain=0.003"),
    "box, drained": ("element_test", SCENES / "drained_dr64.toml", *FEW,
                     "--set", "specimen.preparation_friction=6 deg",
                     "--set", "stage.0.strain=0.003"),
    "box, 2,600 grains, two threads": ("element_test", SCENES / "monotonic_compression_dr64.toml",
                                       "--set", "grading.grains=2600", "--set", "grading.cloud_edge=6.38 mm",
                                       "--set", "specimen.preparation_friction=6 deg", "--set", "stage.0.strain=0.0003",
                                       "--set", "contact.young=20 MPa", "-t", 2),
    "box, other stages": ("element_test", "{work}/box.toml"),
    "cell, other stages": ("element_test", "{work}/cell.toml"),
    "cell, compression": ("element_test", SCENES / "monotonic_compression_dr64_periodic.toml", *FEW,
                          "--set", "specimen.preparation_friction=6 deg", "--set", "stage.0.strain=0.003"),
    "cell, simple shear": ("element_test", SCENES / "undrained_simple_shear.toml", *FEW,
                           "--set", "specimen.preparation_friction=8 deg", "--set", "stage.0.strain=0.01"),
    "cell, K0, cyclic simple shear": ("element_test", SCENES / "quick_k0_undrained_cyclic_simple_shear.toml", *FEW,
                                      "--set", "stage.0.until.cycles=2"),
    "imported packing": ("element_test", ROOT / "tests/regression/medium_cyclic.toml",
                         "--set", "specimen.file={work}/medium.h5"),
    "library": ("isostat", "library", SCENES / "rve_library.toml", "--pressures", "20 kPa,50 kPa", "-n", "2", *TINY,
                "--set", "contact.young=500 MPa", "--set", "specimen.density_tolerance=0.06"),
    "column, elastic": ("soil_column", SCENES / "column/uniform_layer.toml", "--set", "analysis.duration=2 s"),
    "column, compliant base": ("soil_column", SCENES / "column/two_layers_compliant.toml",
                               "--set", "analysis.duration=2 s"),
    "column, Iwan": ("soil_column", SCENES / "column/recorded_motion.toml"),
    "column, Iwan, u-p": ("soil_column", SCENES / "column/recorded_motion.toml", "--set", "water.drainage=coupled",
                          "--set", "analysis.duration=3 s"),
    "column, Terzaghi": ("soil_column", SCENES / "column/terzaghi.toml"),
    "column, grains, undrained": ("soil_column", COLUMNS / "undrained.toml"),
    "column, grains, undrained, two ranks": ("mpirun", "soil_column", COLUMNS / "undrained.toml"),
    "column, grains, u-p": ("soil_column", COLUMNS / "drained.toml"),
    "column, grains, layered, two ranks": ("mpirun", "soil_column", COLUMNS / "layered.toml"),
    "biaxial, Iwan": ("soil_column", SCENES / "biaxial/iwan.toml", "--set", "analysis.axial_strain=0.002",
                      "--set", "analysis.load_steps=4"),
    "biaxial, grains": ("soil_column", "{work}/block.toml"),
}

BLOCK = """title = "two elements of grains"
[mesh]
dimension = 2
cells_across = 1
degree = 1
[water]
drainage = "dry"
[[layer]]
thickness = "2 m"
cells = 2
material = "grains"
relative_density = 0.5
[grains]
library = "{columns}/specimens.h5"
inertial_number = 1e-3
[analysis]
kind = "biaxial"
confinement = "50 kPa"
axial_strain = 0.002
load_steps = 2
tolerance = 0.01
map_every = 1
"""


def digest_of_hdf5(path):
    sums = {}

    def add(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu" and item.dtype != np.uint8:
            values = np.asarray(item)
            sums[name] = hashlib.sha256(str((name, values.dtype, values.shape)).encode() + values.tobytes()).hexdigest()

    with h5py.File(path) as file:
        file.visititems(add)
    return hashlib.sha256(json.dumps(sums, sort_keys=True).encode()).hexdigest()[:16] if sums else None


def digests_of(folder):
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.name == "history.csv":
            found[name] = hashlib.sha256(path.read_bytes()).hexdigest()[:16]
        elif path.suffix == ".h5" and "checkpoint" not in name and path.name != "packing.h5":
            digest = digest_of_hdf5(path)
            if digest:
                found[name] = digest
    return found


def run(command, log, stop_after=None):
    """Exit code of a run; one to stop gets SIGINT once three files are in the folder `stop_after`."""
    process = subprocess.Popen([str(c) for c in command], cwd=ROOT, env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                               stdout=log, stderr=subprocess.STDOUT)
    if stop_after:
        while process.poll() is None and len(list(stop_after.glob("*"))) < 3:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
    return process.wait()


def run_all(binaries, work, chosen, keep):
    """Digests of the runs whose names are chosen; keep(digests) after each, so that an interrupted list continues."""
    (work / "box.toml").write_text(OTHER_STAGES.replace("DOMAIN", "rigid-box"))
    (work / "cell.toml").write_text(OTHER_STAGES.replace("DOMAIN", "periodic-cell"))
    (work / "block.toml").write_text(BLOCK.format(columns=COLUMNS))
    subprocess.run([binaries / "isostat", "convert", ROOT / "tests/reference/n1000/medium", work / "medium.h5"],
                   check=True, stdout=subprocess.DEVNULL)
    digests = {}
    for name, (program, *arguments) in RUNS.items():
        if name not in chosen:
            continue
        folder = work / "".join(c if c.isalnum() else "_" for c in name)
        folder.mkdir()
        arguments = [str(a).replace("{work}", str(work)) for a in arguments]
        launcher = []
        if program == "mpirun":
            launcher, program, arguments = ["mpirun", "--oversubscribe", "-n", 2], arguments[0], arguments[1:]
        output = ("--output", folder / "run", "-q", "--no-figures")
        if arguments[0] == "library":
            output = ("--output", folder / "library.h5")
        command = [*launcher, binaries / program, *arguments, *output]
        begin = time.time()
        with open(folder / "log.txt", "w") as log:
            if "resumed" in name:
                stopped = run(command, log, stop_after=folder / "run/snapshots")
                code = run([*command, "--resume"], log) if stopped == 130 else 1
            else:
                code = run(command, log)
        if code:
            print((folder / "log.txt").read_text()[-2000:], file=sys.stderr)
            raise SystemExit(f"{name}: exit code {code}")
        digests[name] = digests_of(folder)
        assert digests[name], f"{name}: left nothing to compare"
        keep(digests)
        print(f"{name:40s} {len(digests[name]):3d} files {time.time() - begin:6.1f} s", flush=True)
    return digests


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries", type=pathlib.Path)
    parser.add_argument("--only", help="runs whose name contains this")
    group = parser.add_mutually_exclusive_group(required=True)
    group.add_argument("--store", type=pathlib.Path)
    group.add_argument("--against", type=pathlib.Path)
    options = parser.parse_args()
    file = options.store or options.against
    before = json.loads(file.read_text()) if file.exists() else {}
    chosen = {name for name in RUNS if options.only is None or options.only in name}
    if options.store:
        chosen -= before.keys()  # stored already

    def keep(digests):
        if options.store:
            file.write_text(json.dumps(before | digests, indent=1))

    with tempfile.TemporaryDirectory() as folder:
        digests = run_all(options.binaries.resolve(), pathlib.Path(folder), chosen, keep)
    if options.store:
        return 0
    different = [f"{run}: {file}" for run, files in before.items() if run in digests
                 for file in sorted(files.keys() | digests[run].keys()) if files.get(file) != digests[run].get(file)]
    print(*different, sep="\n")
    compared = sum(len(before[run]) for run in digests if run in before)
    print(f"same_bits: {len(digests)} runs, {compared} files, {len(different)} differ")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
