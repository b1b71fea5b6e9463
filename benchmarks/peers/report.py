# SPDX-License-Identifier: BSD-3-Clause
"""Lines and the page of results of a side-by-side comparison."""
import dataclasses
import datetime
import os
import pathlib
import re
import statistics
import subprocess
import tempfile


@dataclasses.dataclass
class Round:
    ours: object   # Figures
    peer: object

    def ratio(self):
        return self.ours.steps_per_s / self.peer.steps_per_s

    def differences(self):
        """The peer's p', q and number of contacts less ours, relative: q to the larger of our p' and |q|."""
        ours, peer = self.ours, self.peer
        return [(peer.p - ours.p) / ours.p, (peer.q - ours.q) / max(ours.p, abs(ours.q)),
                (peer.contacts - ours.contacts) / ours.contacts]


@dataclasses.dataclass
class Comparison:
    """All rounds of one peer on one packing."""
    code: object
    specimen: str
    grains: int
    threads: int
    time_step: float
    steps: int  # after which the states are compared
    rounds: list = dataclasses.field(default_factory=list)

    def ratio(self):
        return statistics.median(r.ratio() for r in self.rounds)

    def is_same_test(self):
        worst = [statistics.median(abs(r.differences()[k]) for r in self.rounds) for k in range(3)]
        return all(w <= self.code.tolerance for w in worst)

    def median(self, side, figure):
        values = [getattr(getattr(r, side), figure) for r in self.rounds]
        return statistics.median(v() if callable(v) else v for v in values)


def round_line(number, n_rounds, c, r):
    dp, dq, dc = (f"{100 * d:+.2f} %" for d in r.differences())
    return (f"round {number}/{n_rounds} {c.code.name} {c.grains} grains, {c.threads} thread{'s' * (c.threads > 1)}: "
            f"isostat {r.ours.steps_per_s:.1f} steps/s ({r.ours.nanoseconds():.1f} ns per contact and step), "
            f"{c.code.name} {r.peer.steps_per_s:.2f} steps/s ({r.peer.nanoseconds():.1f} ns), ratio {r.ratio():.2f}; "
            f"after {c.steps} steps p' {r.ours.p:.2f} / {r.peer.p:.2f} kPa ({dp}), "
            f"q {r.ours.q:.2f} / {r.peer.q:.2f} kPa ({dq}), "
            f"contacts {r.ours.contacts:.0f} / {r.peer.contacts:.0f} ({dc})")


def warnings(c, r):
    """What makes the figures of a round doubtful."""
    for name, f in (("isostat", r.ours), (c.code.name, r.peer)):
        if f.cores < 0.9 and c.threads == 1:
            yield f"  {name} had {100 * f.cores:.0f} % of its core: other programs run there, speeds are too low"


def ratio_lines(c):
    yield f"ratio {c.code.name} {c.grains} {c.threads} {c.ratio():.2f}"
    if not c.is_same_test():
        yield (f"  not the same test within {100 * c.code.tolerance:.0f} %: p', q or contacts of {c.code.name} and "
               "isostat differ by more")


def digits(speed):
    return f"{speed:,.0f}" if speed >= 1000 else f"{speed:.1f}"


def table(comparisons):
    lines = ["| peer | specimen | grains | threads | isostat, steps/s (ns per contact and step) | peer, steps/s (ns) | "
             "ratio: median (range) | p', kPa | q, kPa | contacts | agreement |", "|---" * 11 + "|"]
    for c in comparisons:
        ratios = [r.ratio() for r in c.rounds]
        state = [f"{c.median('ours', k):.{d}f} / {c.median('peer', k):.{d}f}"
                 for k, d in (("p", 2), ("q", 2), ("contacts", 0))]
        speeds = [f"{digits(c.median(side, 'steps_per_s'))} ({c.median(side, 'nanoseconds'):.1f})"
                  for side in ("ours", "peer")]
        judged = "within" if c.is_same_test() else "**not within**"
        lines.append(" | ".join(
            [f"| {c.code.name}", c.specimen, f"{c.grains:,}", str(c.threads), *speeds,
             f"**{c.ratio():.2f}** ({min(ratios):.2f} to {max(ratios):.2f})", *state,
             f"{judged} {100 * c.code.tolerance:.0f} % |"]))
    return lines


def printed_by(*command):
    return subprocess.run(command, capture_output=True, text=True).stdout


def machine(build):
    """Lines on processor, system and compiler; none of them names a person or a path."""
    cpu = dict(re.findall(r"^([^:\n]+):\s+(.+)$", printed_by("lscpu"), re.M))
    caches = ", ".join(f"{k} {cpu[k]}" for k in ("L1d cache", "L2 cache", "L3 cache") if k in cpu)
    settings = pathlib.Path(build) / "CMakeCache.txt"
    found = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.+)$", settings.read_text(), re.M) if settings.exists() else None
    first = printed_by(found[1], "--version").splitlines()[:1] if found else []
    return [f"- processor: {cpu.get('Model name', 'unknown')}, {os.cpu_count()} logical cores; {caches}"
            + (", virtual machine" if "Hypervisor vendor" in cpu else ""),
            f"- system: Linux {os.uname().release}, {os.uname().machine}",
            f"- compiler of isostat: {first[0] if first else 'unknown'}"]


def page(comparisons, command, build, versions, rounds):
    codes = {c.code.name: c.code for c in comparisons}
    dts = ", ".join(f"{dt:g} s ({n:,} grains)"
                    for n, dt in sorted({(c.grains, c.time_step) for c in comparisons}))
    return "\n".join([
        "# Side by side with other codes", "",
        f"Written by `benchmarks/side_by_side.py` on {datetime.date.today().isoformat()}; do not edit. The same "
        "packing, rate, time step and cores; rounds alternate, isostat before and after each run of the peer; medians "
        f"of {rounds} rounds. Ratio: steps per second of isostat over those of the peer. Stresses and contacts: "
        f"isostat / peer after {comparisons[0].steps} steps from the same start; agreement: p', q (of the larger of p' "
        f"and q) and contacts are no further apart. Time steps: {dts}. A number of threads is one of MPI ranks in "
        "LAMMPS and LIGGGHTS.", "",
        "```sh", command, "```", "", *table(comparisons), "",
        "## What differs", "", *(f"- {name}: {code.differs}" for name, code in codes.items()), "",
        "## Machine and versions", "", *machine(build), *(f"- {v}" for v in versions), ""])


def write_replacing(path, text):
    """Written aside, then renamed: a reader never sees half a page."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=path.name + ".", delete=False) as out:
        out.write(text)
    os.chmod(out.name, 0o644)
    os.replace(out.name, path)
