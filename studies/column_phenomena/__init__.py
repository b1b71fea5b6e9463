# SPDX-License-Identifier: BSD-3-Clause
"""Phenomena of a shaken deposit of Iwan sand, each with a number: air, drainage, dilation, softening, wave speed."""
import numpy as np
from scipy import signal

from figures.common import BLACK, BLUE, GREY, ORANGE, RED, panel_letter, plt
from studies.columns import Run, histories
from studies.drawing import save
from studies.history import parsed
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
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
material = "{material}"{pressure}
k0 = 0.5
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


SATURATIONS = 1, 0.999, 0.995, 0.99, 0.98
AIR = {"constant": "", "Boyle": 'air = "boyle"', "Boyle, Henry": 'air = "boyle"\nhenry = 0.02'}
DRAINAGE = ("1e-5", 1), ("1e-4", 1), ("1e-3", 1), ("1e-2", 1), ("1e-2", 10), ("1e-2", 100)
DILATION = {"elastic": {"material": "elastic", "layer": ""},
            "Iwan sand without dilatancy": {"layer": "dilation = 0\ncontraction = 0"}, "Iwan sand": {"layer": ""}}
NOISE = 0.001, 0.1, 0.2, 0.5  # root of mean square, m/s2


def text(*, k="1e-5", water="", layer="", motion=SHAKE, base="", duration=10, drainage="coupled", material="iwan",
         viscosity=0.1, interval=10, safety=0.8):
    pressure = '\nreference_pressure = "100 kPa"' if material == "iwan" else ""
    return SCENE.format(**locals())


def velocity(z):
    """Of shear waves under 20 kPa."""
    return 160 * ((20e3 + 9.81 * 900 * z) * 2 / 3 / 100e3) ** 0.25


def noise_file(folder, amplitude):
    return folder / f"noise_{amplitude}.txt"


def prepare(options, _executor):
    """Motions with all frequencies below 15 Hz, the same each time: 20 s, 10 ms."""
    for amplitude in NOISE:
        a = np.random.default_rng(7).standard_normal(2001)
        a = signal.sosfiltfilt(signal.butter(4, [0.5, 15], "bandpass", fs=100, output="sos"), a)
        a *= amplitude / a.std() * np.clip(np.arange(2001) / 100, 0, 1)
        np.savetxt(noise_file(options.output, amplitude), np.column_stack([0.01 * np.arange(2001), a]))


def runs(options):
    cases = {("air", s, law): {"layer": f"saturation = {s}", "water": water} for s in SATURATIONS
             for law, water in AIR.items() if (s, law) != (1, "Boyle")}
    cases |= {("cavitation", name): {
        "k": "0", "water": AIR[law], "duration": 4,
        "layer": 'contraction = 0\ndilation = 1\ncritical_pressure = "2 MPa"',
        "motion": SHAKE.replace("0.1 g", "0.6 g").replace("8 s", "4 s"), "safety": 0.4}
        for name, law in (("no air", "constant"), ("air dissolved", "Boyle, Henry"))}
    cases |= {("drainage", k, viscosity): {"k": k, "water": f"relative_viscosity = {viscosity}", "duration": 30}
              for k, viscosity in DRAINAGE}
    cases |= {("dilation", name): {**keys, "layer": keys["layer"] + "\nsaturation = 0.99"}
              for name, keys in DILATION.items()}
    cases["wave speed",] = {
        "motion": WEAK, "duration": 1, "viscosity": 0, "interval": 1, "drainage": "undrained",
        "base": '[base]\nkind = "compliant"\n'
                f'density = "1900 kg/m3"\nshear_velocity = "{velocity(12)} m/s"\n[load]\nsurcharge = "20 kPa"\n'}
    found = [Run(case, text(**keys)) for case, keys in cases.items()]
    for amplitude in NOISE:
        file = noise_file(options.output, amplitude)
        motion = f'[[motion]]\nkind = "record"\nfile = "{file}"\nunit = "m/s2"\n'
        found += [Run(("softening", amplitude, water), text(motion=motion, duration=20, drainage=water), needs=(file,))
                  for water in ("coupled", "dry")]
    return found


def at(rows, name, time):
    return float(np.interp(time, rows["time"], rows[name]))


def part(results, name):
    """(rest of the case, history) of the runs of a part that are done."""
    return [(case[1:], h) for case, h in results.items() if case[0] == name]


def air(results, times):
    """r_u with more and more air, by both laws and with dissolution."""
    rows = []
    for (s, law), h in part(results, "air"):
        rows.append([s, "no air" if (s, law) == (1, "constant") else law,
                     ", ".join(f"{at(h, 'd0_ru', t):.3f}" for t in (3, 6)),
                     ", ".join(f"{at(h, 'd2_ru', t):.3f}" for t in (3, 6, 9)), f"{1e3 * h['settlement'][-1]:.1f} mm",
                     f"{1e6 * times[s, law]['solver'] / times[s, law]['steps']:.0f}"])
    return ["S", "law", "r_u at 2 m: 3 s, 6 s", "at 10 m: 3 s, 6 s, 9 s", "settlement at 10 s", "us per step"], rows


def draw_air(results, path):
    figure, panels = plt.subplots(1, 2, figsize=(7.2, 3.1), layout="constrained", sharey=True)
    colours = dict(zip(SATURATIONS, (BLACK, BLUE, GREY, ORANGE, RED)))
    for axes, point, depth in zip(panels, ("d0_ru", "d2_ru"), (2, 10)):
        for (s, law), h in part(results, "air"):
            if law != "Boyle, Henry":
                axes.plot(h["time"], h[point], color=colours[s], linewidth=1.1 if law == "Boyle" else 0.9,
                          linestyle="-" if law == "Boyle" or s == 1 else (0, (3, 1.5)),
                          label=f"S = {s}" if law == "Boyle" or s == 1 else None)
        axes.set_xlabel("Time (s)")
        axes.set_title(f"depth {depth} m", fontsize=9)
        axes.set_ylim(bottom=0)
    panels[0].set_ylabel("Pore pressure ratio $r_u$")
    panels[1].plot([], [], color=BLACK, linewidth=0.9, linestyle=(0, (3, 1.5)), label="constant stiffness")
    panels[1].legend(fontsize=8)
    panel_letter(panels[0], "a")
    panel_letter(panels[1], "b")
    save(figure, path)


def cavitation(results):
    """Sand that dilates without drainage: how far its pore pressure falls."""
    rows = []
    for (name,), h in part(results, "cavitation"):
        lowest = [1e-3 * h[f"d{k}_u"].min() for k in range(3)]
        rows.append([name, ", ".join(f"{x:.0f}" for x in lowest),
                     f"{lowest[2] + 101.3 + 9.81 * h['d2_depth'][0]:.0f}"])
    return ["water", "lowest excess pressure at 2, 6, 10 m (kPa)", "absolute, at 10 m (kPa)"], rows


def drainage(results):
    """Water that flows while the ground is shaken, and a pore fluid that flows more slowly."""
    return ["k (m/s)", "viscosity over water", "r_u at 6 m at 8 s, at 30 s", "settlement at 8 s, at 30 s"], [
        [*case, ", ".join(f"{at(h, 'd1_ru', t):.3f}" for t in (8, 30)),
         ", ".join(f"{1e3 * at(h, 'settlement', t):.1f} mm" for t in (8, 30))] for case, h in part(results, "drainage")]


def dilation(results):
    """Vertical motion of a surface whose base moves along x alone."""
    return ["material", "peak acceleration of the surface along z", "along x"], [
        [name, *(f"{np.abs(h[f'surface_a{axis}']).max():.2e} m/s2" for axis in "zx")]
        for (name,), h in part(results, "dilation")]


def resonance(rows, start):
    """Frequency of the largest ratio of the spectra of surface and input after a time, below 12 Hz."""
    inside = rows["time"] >= start
    dt = rows["time"][1] - rows["time"][0]
    f, upper = signal.welch(rows["surface_ax"][inside], 1 / dt, nperseg=512, nfft=4096)
    _, lower = signal.welch(rows["input_ax"][inside], 1 / dt, nperseg=512, nfft=4096)
    kept = (f > 0.5) & (f < 12)
    found = f[kept][np.argmax(upper[kept] / lower[kept])]
    return f"{found:.1f} Hz" if found > 0.6 else "below 0.6 Hz, where the noise ends"


def softening(results):
    """The resonance of a deposit of sand under noise, weak and strong, wet and dry."""
    rows = []
    for amplitude in NOISE:
        wet, dry = (results.get(("softening", amplitude, water)) for water in ("coupled", "dry"))
        if wet is not None and dry is not None:
            rows.append([f"{amplitude} m/s2", f"{at(wet, 'd1_ru', 20):.3f}", *(resonance(x, 5) for x in (wet, dry))])
    return ["noise, root of mean square", "r_u at 6 m at 20 s", "resonance, 5 to 20 s", "of dry sand"], rows


def wave_speed(results):
    """Time of a weak wave from a base of the same impedance to the surface, against the integral of dz/V_s."""
    rows = []
    for _, h in part(results, "wave speed"):
        exact = np.mean(1 / velocity((np.arange(100000) + 0.5) * 12 / 100000)) * 12
        dt = h["time"][1] - h["time"][0]
        a, b = (signal.resample(h[name], 50 * len(h["time"])) for name in ("input_ax", "surface_ax"))
        lag = (np.argmax(signal.correlate(b, a)) - len(a) + 1) * dt / 50
        ratio = np.abs(h["surface_ax"]).max() / np.abs(h["input_ax"]).max()
        rows.append([f"{velocity(12):.1f}, {velocity(0):.1f}", f"{lag:.4f}", f"{exact:.4f}", f"{12 / velocity(12):.4f}",
                     f"{ratio:.3f}", f"{np.sqrt(velocity(12) / velocity(0)):.3f}"])
    return ["V_s at 12 m, at the surface (m/s)", "travel time (s)", "integral of dz/V_s (s)",
            "at V_s of 12 m throughout (s)", "peak of the surface over the outcrop's",
            "root of the ratio of velocities"], rows


def report(store, planned, folder):
    results = histories(store, planned)
    times = {run.case[1:]: parsed(store.folder(run), "times") for run in planned if run.case in results}
    write_tables(folder, {"air": air(results, times), **{
        table.__name__: table(results) for table in (cavitation, drainage, dilation, softening, wave_speed)}})
    draw_air(results, folder / "air.png")
