# SPDX-License-Identifier: BSD-3-Clause
"""Makes results folders as soil_column writes them, from closed forms: an elastic layer in the frequency domain, a
consolidation by the eigenvectors of finite differences, and a made-up liquefaction, with grains if requested. For tests
of the figures."""
import json
import re

import h5py
import numpy as np

from support import ROOT

SCENES = ROOT / "apps/scenes"
HEIGHT, VELOCITY, DENSITY = 20.0, 200.0, 1900.0
ROCK = {"density": 2300.0, "velocity": 800.0}
UNITS = {"time": "s", "step": "-", "settlement": "m", "max_ru": "-", "max_ru_depth": "m", "min_p_ratio": "-"}


def unit_of(name):
    if name in UNITS:
        return UNITS[name]
    first = name.split("_", 1)[1][0]
    return {"a": "m/s2", "g": "-", "e": "-", "r": "-"}.get(first, "Pa")


def write(folder, scene, history, profiles=None):
    folder.mkdir(parents=True)
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    (folder / "summary.json").write_text(json.dumps({"title": folder.name}), encoding="utf-8")
    names = ["step", *history]
    rows = np.column_stack([np.arange(len(history["time"])), *history.values()])
    header = ",".join(f"{name} ({unit_of(name)})" for name in names)
    np.savetxt(folder / "history.csv", rows, fmt="%.10g", delimiter=",", header=header, comments="")
    write_spectra(folder, history)
    if profiles:
        with h5py.File(folder / "profiles.h5", "w") as file:
            for name, values in profiles.items():
                file[name] = values
    return folder


def write_spectra(folder, history):
    """Of what moves; PGA at every period is enough for a curve."""
    moving = [axis for axis in "xyz" if np.abs(history.get(f"input_a{axis}", 0)).max() > 0]
    if moving:
        periods = np.geomspace(0.02, 5, 160)
        columns = {f"{where}_{axis}_SA": np.full_like(periods, np.abs(history[f"{where}_a{axis}"]).max())
                   for axis in moving for where in ("input", "surface")}
        header = ",".join(["period (s)", *(f"{name} (m/s2)" for name in columns)])
        np.savetxt(folder / "spectra.csv", np.column_stack([periods, *columns.values()]), fmt="%.10g", delimiter=",",
                   header=header, comments="")


def scene(name):
    return (SCENES / f"column/{name}.toml").read_text(encoding="utf-8")


def ricker(t, amplitude, f):
    b = (np.pi * f * (t - 1.5 / f)) ** 2
    return amplitude * (1 - 2 * b) * np.exp(-b)


# --- elastic layer ---------------------------------------------------------------------------------------------------


def layer_motion(a, dt, depths, damping, rock=None):
    """Absolute acceleration and shear strain at the depths, from the base's motion or, over rock, the outcrop's.

    Written with travelling waves exp(+-i k (H - z)), reflected at the surface: not as the formula under test.
    """
    size = 2 ** int(np.ceil(np.log2(4 * len(a))))
    w = 2 * np.pi * np.fft.rfftfreq(size, dt)
    w[0] = 1e-6
    spectrum = np.fft.rfft(a, size)
    wave = np.sqrt(w**2 - 1j * w * damping)
    k = wave / VELOCITY
    up, down = np.exp(1j * k * HEIGHT), np.exp(-1j * k * HEIGHT)
    accelerations, strains = [], []
    for z in depths:
        shape, slope = np.exp(1j * k * z) + np.exp(-1j * k * z), 1j * k * (np.exp(1j * k * z) - np.exp(-1j * k * z))
        if rock is None:  # the damping acts on the motion relative to the base
            ratio = (w / wave) ** 2
            accelerations.append(np.fft.irfft(spectrum * (1 + ratio * (shape / (up + down) - 1)), size))
            gradient = ratio * slope / (up + down)
        else:  # displacement and stress continuous at the base, outcrop = twice the upgoing wave in the rock
            alpha = DENSITY * VELOCITY**2 * k / (w * rock["density"] * rock["velocity"])
            gradient = slope / ((1 + alpha) * up + (1 - alpha) * down)
            accelerations.append(np.fft.irfft(spectrum * shape / ((1 + alpha) * up + (1 - alpha) * down), size))
        strains.append(np.fft.irfft(-gradient * spectrum / -w**2, size))
    n = len(a)
    return np.array([x[:n] for x in accelerations]), np.array([x[:n] for x in strains])


def sine(t, amplitude, f):
    """Forty periods with soft ends, then rest."""
    return amplitude * np.sin(2 * np.pi * f * t) * np.sin(np.pi * np.clip(f * t / 40, 0, 1)) ** 2


def elastic(folder, rock=None, end=20.0, motion=ricker):
    """The scene uniform_layer, or the same layer over rock."""
    dt, damping = 0.005, np.pi / 2
    t = dt * np.arange(int(end / dt) + 1)
    a = motion(t, 0.981, 4.0)
    accelerations, _ = layer_motion(a, dt, [0.0, HEIGHT], damping, rock)
    depths = np.linspace(0, HEIGHT, 41)
    _, gamma = layer_motion(a, dt, depths, damping, rock)
    modulus = DENSITY * VELOCITY**2
    history = {"time": t, "input_ax": a, "input_ay": 0 * a, "input_az": 0 * a, "base_ax": accelerations[1],
               "surface_ax": accelerations[0]}
    for k, point in enumerate((10, 20)):  # 5 m and 10 m
        history |= {f"d{k}_gamma_xz": gamma[point], f"d{k}_tau_xz": modulus * gamma[point],
                    f"d{k}_sigma_v": np.full(len(t), DENSITY * 9.81 * depths[point])}
    rows = slice(0, None, 10)
    profiles = {"depth": depths, "time": t[rows], "sigma_v0": DENSITY * 9.81 * depths, "gamma_xz": gamma.T[rows],
                "tau_xz": modulus * gamma.T[rows]}
    text = scene("uniform_layer")
    if rock:
        text = text.replace('kind = "rigid"', 'kind = "compliant"\ndensity = "2.3 g/cm3"\nshear_velocity = "800 m/s"')
    return write(folder, text, history, profiles)


# --- consolidation ---------------------------------------------------------------------------------------------------


def consolidation(folder, rows=200):
    """The scene terzaghi: 200 cells of finite differences, exact in time."""
    n, height, load, modulus, storage = 200, 10.0, 100e3, 100e6, 0.33 / 2.2e9
    p0, c = load / (1 + storage * modulus), 1e-6 / 9810 / (1 / modulus + storage)
    h = height / n
    matrix = np.diag(np.full(n, 2.0)) - np.eye(n, k=1) - np.eye(n, k=-1)
    matrix[0, 0], matrix[-1, -1] = 3.0, 1.0  # drained at the surface, half a cell away; no flow at the base
    values, vectors = np.linalg.eigh(matrix * c / h**2)
    t = np.geomspace(1, 20000, rows)
    u = p0 * np.exp(-np.outer(t, values)) * (vectors.T @ np.ones(n)) @ vectors.T
    depth = h * (np.arange(n) + 0.5)
    history = {"time": t, "settlement": h / modulus * (load - u).sum(axis=1), "d0_u": u[:, n // 2], "d1_u": u[:, -1]}
    profiles = {"depth": depth, "time": t, "u": u, "sigma_v0": 1000 * 9.81 * depth}
    return write(folder, scene("terzaghi"), history, profiles)


# --- liquefaction ----------------------------------------------------------------------------------------------------


def record(component):
    lines = (SCENES / f"motions/simulated_m6.5_20km_{component}.at2").read_text(encoding="ascii").splitlines()
    return 9.80665 * np.array(" ".join(lines[4:]).split(), dtype=float)


def liquefaction(folder):
    """Nothing but the look of it: shear of an elastic layer that grows as the pore pressure does."""
    dt, step = 0.005, 2
    inputs = {axis: 2.0 * record(axis) for axis in "xy"}
    t = dt * np.arange(len(inputs["x"]))
    depth = np.linspace(0.25, 14.75, 30)
    sigma0 = 9.81 * 950 * depth
    loose = np.exp(-(((depth - 5) / 3.0) ** 4))
    energy = np.cumsum(inputs["x"] ** 2 + inputs["y"] ** 2)
    ru = np.outer(1 - np.exp(-5 * energy / energy[-1]), 0.99 * loose + 0.15 * (depth > 2))
    ru = np.minimum(ru, 0.99)
    history = {"time": t, "settlement": 0.02 * energy / energy[-1], "max_ru": ru.max(axis=1)}
    profiles = {"depth": depth, "time": t[::20], "sigma_v0": sigma0, "shear_velocity": 60 * sigma0**0.1,
                "ru": ru[::20], "u": (ru * sigma0)[::20]}
    points = [int(np.argmin(np.abs(depth - z))) for z in (3, 5, 7, 11)]
    for axis, a in inputs.items():
        accelerations, gamma = layer_motion(a, dt, [0.0, *depth], 3.0)
        history |= {f"input_a{axis}": a, f"surface_a{axis}": accelerations[0]}
        tau = gamma[1:].T * 50e6 * (1 - 0.9 * ru)
        gamma = np.roll(gamma[1:].T, 6, axis=0) * (1 + 30 * ru**4)
        profiles |= {f"gamma_{axis}z": gamma[::20], f"tau_{axis}z": tau[::20]}
        for k, point in enumerate(points):
            history |= {f"d{k}_gamma_{axis}z": gamma[:, point], f"d{k}_tau_{axis}z": tau[:, point]}
    for k, point in enumerate(points):
        history |= {f"d{k}_sigma_v": sigma0[point] * (1 - ru[:, point]), f"d{k}_ru": ru[:, point],
                    f"d{k}_p": sigma0[point] * (1 - ru[:, point]) * 2 / 3, f"d{k}_u": sigma0[point] * ru[:, point]}
    return write(folder, scene("recorded_motion"), {name: values[::step] for name, values in history.items()}, profiles)


def capped(folder):
    """The liquefaction below a cap: the uppermost point below 2 m expands, all others compress."""
    liquefaction(folder)
    (folder / "scene.toml").write_text(scene("silt_cap"), encoding="utf-8")
    header, *rows = (folder / "history.csv").read_text(encoding="utf-8").splitlines()
    time = np.array([float(row.split(",")[1]) for row in rows])
    rows = [f"{row},{1e-3 * t:.10g}" for row, t in zip(rows, time)]
    (folder / "history.csv").write_text("\n".join([f"{header},expansion_0 (m)", *rows]) + "\n", encoding="utf-8")
    with h5py.File(folder / "profiles.h5", "r+") as file:
        depth, t = (file[name][()] for name in ("depth", "time"))
        strain = np.where(depth < 2, 0.0, 1e-5)
        strain[np.argmax(depth > 2)] = -1e-3
        file["eps_zz"] = np.outer(t, strain)
    return folder


# --- grains ----------------------------------------------------------------------------------------------------------


def table(folder, columns):
    folder.mkdir()
    units = ["s" if name == "time" else "m" if name.endswith("depth") else "-" for name in columns]
    header = ",".join(f"{name} ({unit})" for name, unit in zip(columns, units))
    rows = np.column_stack(np.broadcast_arrays(*columns.values()))
    np.savetxt(folder / "history.csv", rows, fmt="%.10g", delimiter=",", header=header, comments="")


def of_packing(prefix, depth, ru):
    """I_R crosses 1 when r_u reaches 0.9; what follows from the few contacts then left is noise."""
    share = np.clip(ru, 0, 1)
    noise = np.sin(np.arange(len(ru)) * (1 + depth))
    values = {"depth": depth, "IR": 2.1 - 1.1 * (share / 0.9) ** 4, "Z": 4.2 - 3.0 * share**4,
              "F_yx": 0.02 + np.where(share > 0.9, 0.5, 0.005) * noise, "f_S": 0.5 * share, "f_R": 0.02 * share,
              "f_SR": 0.3 * share**2}
    return {f"{prefix}_{name}": value for name, value in values.items()}


def grains(folder):
    """The liquefaction in packings of grains, of which the scene has no shear modulus."""
    liquefaction(folder)
    text = (folder / "scene.toml").read_text(encoding="utf-8")
    layers = re.compile(r"^\[\[layer\]\]\n(?:(?!\[).*\n)*", re.MULTILINE)
    text = layers.sub(lambda part: re.sub(r"(?m)^shear_.*\n", "", part[0]), text)
    (folder / "scene.toml").write_text(re.sub(r'(?m)^material = .*', 'material = "grains"', text), encoding="utf-8")
    with h5py.File(folder / "profiles.h5") as file:
        depth, time, ru = (file[name][()] for name in ("depth", "time", "ru"))
    both = {"step": np.arange(len(time)), "time": time}
    profiles, history = dict(both), dict(both)
    for k, z in enumerate(depth):
        profiles |= of_packing(f"p{k}", z, ru[:, k])
    for k, z in enumerate((3, 5, 7, 11)):
        point = int(np.argmin(np.abs(depth - z)))
        history |= of_packing(f"d{k}", depth[point], ru[:, point])
    table(folder / "grain_profiles", profiles)
    table(folder / "grain_history", history)
    return folder


def packings(folder):
    """The same with a packing of three grains at a depth, whose chain of two contacts, one of them through a face of
    the cell, is gone at the end."""
    grains(folder)
    with (folder / "scene.toml").open("a", encoding="utf-8") as scene:
        scene.write('[grains]\nsnapshot_depths = ["5 m"]\n')
    (folder / "grains").mkdir()
    rows = [f'<DataSet timestep="{time}" part="0" file="d0_{k}.vtp" />\n' for k, time in enumerate((0, 20))]
    (folder / "grains/d0.pvd").write_text("".join(rows), encoding="utf-8")
    for k, n in enumerate((2, 0)):
        with h5py.File(folder / f"grains/d0_{k}.h5", "w") as file:
            file["snapshot/grains/position"] = [[1e-3 * x, 0, 0, 5e-4] for x in range(3)]
            for name, values in {"first": [0, 2], "second": [1, 0], "normal_force": [1.0, 2.0], "overlap": [0.0, 0.0],
                                 "normal": [[1.0, 0, 0], [1.0, 0, 0]]}.items():
                file[f"snapshot/contacts/{name}"] = np.array(values)[:n]
    return folder
