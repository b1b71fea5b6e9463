#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Phenomena of a shaken deposit of Iwan sand, each with a number: docs/results/column_phenomena.md.

    column_phenomena.py BIN FOLDER [--docs docs]

BIN      folder of soil_column
FOLDER   runs, made anew
--docs   where results/column_phenomena/*.png go (default: FOLDER); tables go to standard output as Markdown
"""
import argparse
import json
import pathlib
import subprocess
import sys

import h5py
import numpy as np
from scipy import signal

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "apps"))
from figures.common import BLACK, BLUE, GREY, ORANGE, RED, STYLE, panel_letter, plt  # noqa: E402  (path first)

SHAKE = '[[motion]]\nkind = "harmonic"\namplitude = "0.1 g"\nfrequency = "2 Hz"\nduration = "8 s"\nramp = "1 s"\n'
WEAK = '[[motion]]\nkind = "ricker"\namplitude = "0.0001 g"\nfrequency = "20 Hz"\n'
SCENE = """[water]
drainage = "{drainage}"
{water}
[[layer]]
name = "sand"
thickness = "12 m"
cells = 24
density = "1900 kg/m3"
porosity = 0.42
permeability = "{k} m/s"
{layer}
material = "{material}"
shear_velocity = "160 m/s"
{motion}
{base}
[analysis]
duration = "{duration} s"
viscosity = "{viscosity} ms"
safety = {safety}
[output]
depths = ["2 m", "6 m", "10 m"]
history_interval = "{interval} ms"
"""


class Runs:
    def __init__(self, binary, folder):
        self.binary, self.folder, self.n = binary, folder, 0

    def __call__(self, *, k="1e-5", water="", layer="", motion=SHAKE, base="", duration=10, drainage="coupled",
                 material="iwan", viscosity=0.1, interval=10, safety=0.8):
        """History, summary and times of a run."""
        scene, out = self.folder / f"{self.n}.toml", self.folder / f"{self.n}"
        self.n += 1
        scene.write_text(SCENE.format(**{name: value for name, value in locals().items() if name != "self"}),
                         encoding="utf-8")
        subprocess.run([self.binary, scene, "-o", out, "--overwrite", "--quiet", "--no-figures"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with h5py.File(out / "history.h5") as file:
            rows = {name: np.asarray(values) for name, values in file["history"].items()}
        return rows, *(json.loads((out / f"{name}.json").read_text(encoding="utf-8")) for name in ("summary", "times"))


def at(rows, name, time):
    return float(np.interp(time, rows["time"], rows[name]))


def row(*cells):
    print("| " + " | ".join(cells) + " |", flush=True)


def air(run, where):
    """r_u with more and more air, by both laws and with dissolution."""
    print("\n| S | law | r_u at 2 m: 3 s, 6 s | at 10 m: 3 s, 6 s, 9 s | settlement at 10 s | us per step |")
    print("|---|---|---|---|---|---|")
    kept = {}
    for s in (1, 0.999, 0.995, 0.99, 0.98):
        for name, water in (("constant", ""), ("Boyle", 'air = "boyle"'),
                            ("Boyle, Henry", 'air = "boyle"\nhenry = 0.02')):
            if s == 1 and name == "Boyle":
                continue
            rows, _, times = run(layer=f"saturation = {s}", water=water)
            kept[s, name] = rows
            row(f"{s}", name if s < 1 or water else "no air", ", ".join(f"{at(rows, 'd0_ru', t):.3f}" for t in (3, 6)),
                ", ".join(f"{at(rows, 'd2_ru', t):.3f}" for t in (3, 6, 9)), f"{1e3 * rows['settlement'][-1]:.1f} mm",
                f"{1e6 * times['solver'] / times['steps']:.0f}")
    figure, panels = plt.subplots(1, 2, figsize=(7.2, 3.1), layout="constrained", sharey=True)
    colours = dict(zip((1, 0.999, 0.995, 0.99, 0.98), (BLACK, BLUE, GREY, ORANGE, RED)))
    for axes, point, depth in zip(panels, ("d0_ru", "d2_ru"), (2, 10)):
        for (s, name), rows in kept.items():
            if name != "Boyle, Henry":
                axes.plot(rows["time"], rows[point], color=colours[s], linewidth=1.1 if name == "Boyle" else 0.9,
                          linestyle="-" if name == "Boyle" or s == 1 else (0, (3, 1.5)),
                          label=f"S = {s}" if name == "Boyle" or s == 1 else None)
        axes.set_xlabel("Time (s)")
        axes.set_title(f"depth {depth} m", fontsize=9)
        axes.set_ylim(bottom=0)
    panels[0].set_ylabel("Pore pressure ratio $r_u$")
    panels[1].plot([], [], color=BLACK, linewidth=0.9, linestyle=(0, (3, 1.5)), label="constant stiffness")
    panels[1].legend(fontsize=8)
    panel_letter(panels[0], "a")
    panel_letter(panels[1], "b")
    figure.savefig(where / "air.png")


def cavitation(run):
    """Sand that dilates without drainage: how far its pore pressure falls."""
    print("\n| water | lowest excess pressure at 2, 6, 10 m (kPa) | absolute, at 10 m (kPa) |\n|---|---|---|")
    for name, water in (("no air", ""), ("air dissolved", 'air = "boyle"\nhenry = 0.02')):
        rows, _, _ = run(k="0", water=water, layer='contraction = 0\ndilation = 1\ncritical_pressure = "2 MPa"',
                         motion=SHAKE.replace("0.1 g", "0.6 g").replace("8 s", "4 s"), duration=4, safety=0.4)
        lowest = [1e-3 * rows[f"d{k}_u"].min() for k in range(3)]
        row(name, ", ".join(f"{x:.0f}" for x in lowest), f"{lowest[2] + 101.3 + 9.81 * rows['d2_depth'][0]:.0f}")


def drainage(run):
    """Water that flows while the ground is shaken, and a pore fluid that flows more slowly."""
    print("\n| k (m/s) | viscosity over water | r_u at 6 m at 8 s, at 30 s | settlement at 8 s, at 30 s |")
    print("|---|---|---|---|")
    for k, viscosity in (("1e-5", 1), ("1e-4", 1), ("1e-3", 1), ("1e-2", 1), ("1e-2", 10), ("1e-2", 100)):
        rows, _, _ = run(k=k, water=f"relative_viscosity = {viscosity}", duration=30)
        row(k, f"{viscosity}", ", ".join(f"{at(rows, 'd1_ru', t):.3f}" for t in (8, 30)),
            ", ".join(f"{1e3 * at(rows, 'settlement', t):.1f} mm" for t in (8, 30)))


def dilation(run):
    """Vertical motion of a surface whose base moves along x alone."""
    print("\n| material | peak acceleration of the surface along z | along x |\n|---|---|---|")
    for name, keys in (("elastic", {"material": "elastic", "layer": ""}),
                       ("Iwan sand without dilatancy", {"layer": "dilation = 0\ncontraction = 0"}),
                       ("Iwan sand", {"layer": ""})):
        rows, _, _ = run(**{**keys, "layer": keys["layer"] + "\nsaturation = 0.99"})
        row(name, *(f"{np.abs(rows[f'surface_a{axis}']).max():.2e} m/s2" for axis in "zx"))


def resonance(rows, start):
    """Frequency of the largest ratio of the spectra of surface and input after a time, below 12 Hz."""
    inside = rows["time"] >= start
    dt = rows["time"][1] - rows["time"][0]
    f, upper = signal.welch(rows["surface_ax"][inside], 1 / dt, nperseg=512, nfft=4096)
    _, lower = signal.welch(rows["input_ax"][inside], 1 / dt, nperseg=512, nfft=4096)
    kept = (f > 0.5) & (f < 12)
    found = f[kept][np.argmax(upper[kept] / lower[kept])]
    return f"{found:.1f} Hz" if found > 0.6 else "below 0.6 Hz, where the noise ends"


def noise(folder, amplitude):
    """A motion with all frequencies below 15 Hz, the same each time: 20 s, 10 ms."""
    a = np.random.default_rng(7).standard_normal(2001)
    a = signal.sosfiltfilt(signal.butter(4, [0.5, 15], "bandpass", fs=100, output="sos"), a)
    a *= amplitude / a.std() * np.clip(np.arange(2001) / 100, 0, 1)
    path = folder / f"noise_{amplitude}.txt"
    np.savetxt(path, np.column_stack([0.01 * np.arange(2001), a]))
    return f'[[motion]]\nkind = "record"\nfile = "{path.resolve()}"\nunit = "m/s2"\n'


def softening(run, folder):
    """The resonance of a deposit of sand under noise, weak and strong, wet and dry."""
    print("\n| noise, root of mean square | r_u at 6 m at 20 s | resonance, 5 to 20 s | of dry sand |")
    print("|---|---|---|---|")
    for amplitude in (0.001, 0.1, 0.2, 0.5):
        rows, _, _ = run(motion=noise(folder, amplitude), duration=20)
        dry, _, _ = run(motion=noise(folder, amplitude), duration=20, drainage="dry")
        row(f"{amplitude} m/s2", f"{at(rows, 'd1_ru', 20):.3f}", *(resonance(x, 5) for x in (rows, dry)))


def wave_speed(run):
    """Time of a weak wave from a base of the same impedance to the surface, against the integral of dz/V_s."""
    def velocity(z):
        return 160 * ((20e3 + 9.81 * 900 * z) * 2 / 3 / 100e3) ** 0.25

    z = (np.arange(100000) + 0.5) * 12 / 100000
    exact = np.mean(1 / velocity(z)) * 12
    rows, _, _ = run(motion=WEAK, duration=1, viscosity=0, interval=1, drainage="undrained",
                     base='[base]\nkind = "compliant"\n'
                     f'density = "1900 kg/m3"\nshear_velocity = "{velocity(12)} m/s"\n[load]\nsurcharge = "20 kPa"\n')
    dt = rows["time"][1] - rows["time"][0]
    a, b = (signal.resample(rows[name], 50 * len(rows["time"])) for name in ("input_ax", "surface_ax"))
    lag = (np.argmax(signal.correlate(b, a)) - len(a) + 1) * dt / 50
    ratio = np.abs(rows["surface_ax"]).max() / np.abs(rows["input_ax"]).max()
    print(f"\nV_s {velocity(12):.1f} m/s at 12 m, {velocity(0):.1f} m/s at the surface: travel time {lag:.4f} s, "
          f"integral of dz/V_s {exact:.4f} s, at {velocity(12):.0f} m/s throughout {12 / velocity(12):.4f} s; peak of "
          f"the surface over the outcrop's {ratio:.3f}, root of the ratio of velocities "
          f"{np.sqrt(velocity(12) / velocity(0)):.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--docs", type=pathlib.Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    where = options.docs / "results/column_phenomena" if options.docs else options.folder
    where.mkdir(parents=True, exist_ok=True)
    plt.rcParams.update(STYLE)
    run = Runs(options.bin / "soil_column", options.folder)
    air(run, where)
    cavitation(run)
    drainage(run)
    dilation(run)
    softening(run, options.folder)
    wave_speed(run)


if __name__ == "__main__":
    main()
