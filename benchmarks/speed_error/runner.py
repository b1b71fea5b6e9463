# SPDX-License-Identifier: BSD-3-Clause
"""Runs what is not there yet, several runs side by side, each on its own core; keeps a record of each.

    WORK/scenes/NAME.toml    the scene of a run            WORK/runs/NAME/     what element_test left
    WORK/records/NAME.json   exit code, CPU and wall time  WORK/logs/NAME.log  its output

A run is finished when its record says so for the very scene; an interrupted one goes on from its checkpoint.
"""
import argparse
import csv
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

DONE, FAILED, INTERRUPTED = "done", "failed", "interrupted"


def digest(data):
    return hashlib.sha256(data).hexdigest()[:16]


def clock(seconds):
    minutes = int(round(seconds / 60))
    return f"{minutes // 60} h {minutes % 60:02d} min" if minutes >= 60 else f"{seconds / 60:.1f} min"


class Store:
    """Scenes and records in the work folder."""

    def __init__(self, work):
        self.work = pathlib.Path(work)

    def folder(self, run):
        return self.work / "runs" / run.name

    def path(self, run, part, ending):
        return self.work / part / (run.name + ending)

    def record(self, run):
        """The record of this run with this scene; an empty one if there is none."""
        try:
            record = json.loads(self.path(run, "records", ".json").read_text())
        except (OSError, ValueError):
            return {}
        return record if record.get("scene") == digest(run.scene().encode()) else {}

    def is_done(self, run):
        if run.kind != "prepare" and not (self.folder(run) / "history.csv").exists():
            return False
        return self.record(run).get("state") == DONE

    def save(self, run, record):
        path = self.path(run, "records", ".json")
        path.parent.mkdir(parents=True, exist_ok=True)
        aside = path.with_suffix(".new")
        aside.write_text(json.dumps(record, indent=1) + "\n")
        aside.replace(path)

    def write_scene(self, run):
        path = self.path(run, "scenes", ".toml")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(run.scene())
        return path


def add_arguments(parser, root, work):
    """What every campaign takes on its command line."""
    parser.add_argument("--work", default=str(root / "results" / work), help="folder of runs and records")
    parser.add_argument("--build", default=str(root / "build/release"), help="build tree with bin/element_test")
    parser.add_argument("--jobs", type=int, default=2, help="runs side by side, each on a core of its own")
    parser.add_argument("--minutes", type=float, default=0, help="stop after so many minutes; 0: no limit")
    parser.add_argument("--dry-run", action="store_true")


def run_campaign(options, runs):
    """Says what is to do, and does it. @return (store, whether all is done); (store, None) of a dry run."""
    store = Store(options.work)
    left = [run for run in runs if not store.is_done(run)]
    print(f"{len(runs)} runs, {len(left)} to do, some {sum(r.estimated_seconds() for r in left) / 60:.0f} CPU minutes")
    if options.dry_run:
        return store, None
    return store, Campaign(store, pathlib.Path(options.build) / "bin/element_test", runs, options.jobs).run_all(
        options.minutes)


def run_study(name, description, runs_of, results_of, draw):
    """The command of a study: runs what is missing, writes tables and figures to docs/results, or beside the runs while
    some are missing. @return exit code"""
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser, root, name)
    parser.add_argument("--seeds", type=int, default=20)
    options = parser.parse_args()
    runs = runs_of(options.seeds)
    store, complete = run_campaign(options, runs)
    if complete is None:
        return 0
    folder = root / "docs/results" / name if complete else store.work / "incomplete"
    results = results_of(store, runs)
    write_tables(folder, results.tables())
    draw(results, folder)
    return 0 if complete else 1


def write_tables(folder, tables):
    """Each table as CSV, for readers of data, and all of them as Markdown, for the page."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, (header, rows) in tables.items():
        rows = [[f"{v:.4g}" if isinstance(v, float) else str(v) for v in row] for row in rows]
        with open(folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows([header, *rows])
        print(f"\n{name}\n\n| " + " | ".join(header) + " |\n|" + "---|" * len(header))
        print("\n".join("| " + " | ".join(row) + " |" for row in rows))


def speed(store, runs):
    """Measured over estimated CPU time of the runs that are done; 1 without any."""
    done = [(store.record(run).get("cpu", 0), run.estimated_seconds()) for run in runs if store.is_done(run)]
    estimated = sum(e for _, e in done)
    return sum(m for m, _ in done) / estimated if estimated > 0 else 1.0


class Campaign:
    """The runs that are left, given out to `jobs` threads."""

    def __init__(self, store, binary, runs, jobs):
        self.store, self.binary, self.runs = store, str(pathlib.Path(binary).resolve()), runs
        self.binary_digest = digest(pathlib.Path(binary).read_bytes())
        self.cores = sorted(os.sched_getaffinity(0))
        self.jobs = jobs
        self.left = [run for run in runs if not store.is_done(run)]
        self.prepared = {run.specimen for run in runs if run.kind == "prepare" and store.is_done(run)}
        self.lock = threading.Condition()
        self.processes, self.busy = {}, {}
        self.stopping = False
        self.failures = []

    def run_all(self, minutes):
        """@return True when all is done, False after an interrupt, a failure or the end of `minutes`."""
        self.begin = time.monotonic()
        for name in (signal.SIGINT, signal.SIGTERM):
            signal.signal(name, lambda *_: self.stop("interrupted: writing checkpoints"))
        threads = [threading.Thread(target=self.work, args=(self.cores[k % len(self.cores)],))
                   for k in range(self.jobs)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            time.sleep(0.2)
            if minutes and time.monotonic() - self.begin > 60 * minutes:
                self.stop(f"{minutes:g} minutes are over: writing checkpoints")
        return not self.left and not self.failures and not self.stopping

    def stop(self, why):
        if self.stopping:
            return
        self.stopping = True
        print(why, flush=True)
        for process in list(self.processes.values()):
            process.send_signal(signal.SIGTERM)  # element_test finishes its step and keeps a checkpoint

    def work(self, core):
        while True:
            run = self.take()
            if run is None:
                return
            record = self.execute(run, core)
            self.give_back(run, record)

    def take(self):
        """The next run whose specimen is there; waits while another thread prepares the last one missing."""
        with self.lock:
            while True:
                if self.stopping or not self.left:
                    return None
                for run in self.left:
                    if run.kind == "prepare" or run.specimen in self.prepared:
                        self.left.remove(run)
                        self.busy[run.name] = run
                        return run
                if not self.busy:
                    return None  # a preparation failed
                self.lock.wait(1)

    def give_back(self, run, record):
        with self.lock:
            del self.busy[run.name]
            if record["state"] == DONE:
                if run.kind == "prepare":
                    self.prepared.add(run.specimen)
            elif record["state"] == FAILED:
                self.failures.append(run)
            self.progress(run, record)
            self.lock.notify_all()

    def progress(self, run, record):
        n_done = sum(self.store.is_done(r) for r in self.runs)
        waiting = sum(r.estimated_seconds() for r in self.left) + 0.5 * sum(
            r.estimated_seconds() for r in self.busy.values())
        eta = waiting * speed(self.store, self.runs) * self.contention() / min(self.jobs, len(self.cores))
        print(f"[{n_done}/{len(self.runs)}] {run.name}: {record['state']}, {record['cpu']:.1f} s CPU, "
              f"{record['wall']:.1f} s; {clock(time.monotonic() - self.begin)} gone, {clock(eta)} left", flush=True)
        if record["state"] == FAILED:
            print(f"  see {self.store.path(run, 'logs', '.log')}", file=sys.stderr, flush=True)

    def contention(self):
        """Wall over CPU time of the runs done: above 1 where others use the cores too."""
        records = [self.store.record(run) for run in self.runs]
        cpu = sum(r.get("cpu", 0) for r in records)
        wall = sum(r.get("wall", 0) for r in records)
        ours = max(1.0, self.jobs / len(self.cores))  # our own sharing is in the wall time already
        return max(1.0, wall / cpu / ours) if cpu > 0 else 1.0

    def execute(self, run, core):
        store = self.store
        before = store.record(run)
        scene, folder = store.write_scene(run), store.folder(run)
        # fair go for a run that failed: from the start; for an interrupted one from its checkpoint
        resume = before.get("state") == INTERRUPTED and (folder / "checkpoint" / "last.h5").exists()
        if not resume:
            before = {}
            if folder.exists():
                shutil.rmtree(folder)
        command = [self.binary, str(scene), "--output", str(folder), "--quiet", "--no-figures"]
        command += ["--resume"] if resume else []
        log = store.path(run, "logs", ".log")
        log.parent.mkdir(parents=True, exist_ok=True)
        started = time.monotonic()
        with open(log, "a" if resume else "w") as out:
            # a group of its own: Ctrl-C reaches us first, and we tell the runs
            process = subprocess.Popen(["taskset", "-c", str(core), *command], stdin=subprocess.DEVNULL, stdout=out,
                                       stderr=subprocess.STDOUT, start_new_session=True)
            self.processes[run.name] = process
            if self.stopping:
                process.send_signal(signal.SIGTERM)
            _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        del self.processes[run.name]
        state = {0: DONE, 130: INTERRUPTED}.get(process.returncode, FAILED)
        if state == FAILED and self.stopping and process.returncode < 0:
            state = INTERRUPTED
        record = {"scene": digest(run.scene().encode()), "state": state, "code": process.returncode,
                  "binary": self.binary_digest,
                  "cpu": before.get("cpu", 0) + usage.ru_utime + usage.ru_stime,
                  "wall": before.get("wall", 0) + time.monotonic() - started,
                  "attempts": before.get("attempts", 0) + 1}
        store.save(run, record)
        if state == DONE:
            shutil.rmtree(folder / "checkpoint", ignore_errors=True)
        return record
