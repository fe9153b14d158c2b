#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Live runs of a short corridor, and replays of one, that are killed or stopped at random times.

Each live run does one thing: SIGKILL to one of its five processes, or SIGTERM, SIGINT or SIGHUP to deploy/launch.sh, once
or twice within 0.6 s (twice within 0.3 s counts as once). Each replay, one run in four: SIGKILL to slam or viewer, SIGTERM
to deploy/replay.sh, or SIGINT or SIGHUP to all of it, as a terminal does. Afterwards no process of it lives (nor holds its
port, which is locked by a file that processes inherit), the exit code is one that docs/reference.md names for it, every
file is whole, and the map that --save-map was to replace is the old one or a whole new one. A run takes 3 to 10 s: no part
of tests/run.sh.

usage: tests/simulation/kill_runs.py [--runs N] [--seed N] [--deploy DIR] [--out DIR] [--keep]
"""
import argparse
import collections
import json
import os
import pathlib
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

SCENARIO = pathlib.Path(__file__).resolve().parents[1] / "data/scenarios/smallest.toml"
PROGRAMS = ("sim", "recorder", "viewer", "slam", "detector")
STOPS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
SHARE_OF_REPLAYS = 0.25
LONGEST_LEFT_S = {"launch": 0.2, "replay": 5.0}  # until what has been killed, or has lost its script, is gone
LONGEST_END_S = 40  # from the signal: launch.sh gives its processes 15 s, then 7 s, then kills them
EVENT_MAGIC = 0xEDA1DA01
TAG = "WAYMARK_KILL_RUNS"  # in the environment of every process of a run


def processes_of(tag):
    found = {}
    for folder in pathlib.Path("/proc").iterdir():
        try:
            if folder.name.isdigit() and f"{TAG}={tag}\0".encode() in (folder / "environ").read_bytes():
                found[int(folder.name)] = (folder / "cmdline").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue  # it has ended meanwhile, or is another user's
    return found


def log_is_whole(path):
    data = path.read_bytes()
    at = 0
    while at < len(data):
        if len(data) < at + 28:
            return False
        magic, _, _, channel, payload = struct.unpack_from(">Iqqii", data, at)
        at += 28 + channel + payload
        if magic != EVENT_MAGIC or channel < 1 or payload < 0 or at > len(data):
            return False
    return True


def picture_is_whole(path):
    data = path.read_bytes()
    header = data.split(b"\n", 3)
    fields = b" ".join(line for line in header[:3] if not line.startswith(b"#")).split()
    return data.startswith(b"P5") and len(fields) >= 4 and len(data) >= int(fields[1]) * int(fields[2])


def is_whole(path):
    if path.suffix == ".lcm":
        return log_is_whole(path)
    if path.suffix == ".pgm":
        return picture_is_whole(path)
    if path.suffix == ".png":
        return path.read_bytes().endswith(b"IEND\xaeB`\x82")
    text = path.read_text()
    if path.suffix == ".json":
        return isinstance(json.loads(text), (dict, list))
    if path.suffix == ".tum":
        return text.endswith("\n") and all(len(line.split()) == 8 for line in text.splitlines() if line[0] != "#")
    if path.suffix == ".csv":
        lines = text.splitlines()
        return text.endswith("\n") and all(line.count(",") == lines[0].count(",") for line in lines)
    return path.suffix not in {".toml", ".yaml", ".g2o"} or text.endswith("\n")


def half_files(folder):
    """Faults: files in the folder that have their name and are not whole."""
    faults = []
    for path in folder.rglob("*"):
        if path.is_file() and path.stat().st_size > 0 and path.suffix not in {".part", ".log"}:
            try:
                whole = is_whole(path)
            except (ValueError, IndexError) as error:
                whole, path = False, f"{path} ({error})"
            faults += [] if whole else [f"not whole: {path}"]
    return faults


def map_faults(map_tool, saved_map, old_map):
    """Faults of a map that is neither the old one, whose bytes are given, nor a whole new one."""
    if saved_map.read_bytes() == old_map:
        return []
    checked = subprocess.run([map_tool, "check", saved_map], capture_output=True, text=True)
    return [] if checked.returncode == 0 else [f"the map: {checked.stderr or checked.stdout}"]


class Runs:
    def __init__(self, options, folder):
        self.deploy = options.deploy
        self.random = random.Random(options.seed)
        self.folder = folder
        self.scenario = folder / "short.toml"
        self.scenario.write_text(SCENARIO.read_text().replace("speed_mps = 0.5", "speed_mps = 0.1"))
        self.map_tool = self.deploy.parent / "build/release/waymark-map"
        if not self.map_tool.exists():
            self.map_tool = self.deploy.parents[2] / "bin/waymark-map"
        self.old_map = folder / "old.map.lcm"

    def start(self, script, name, saved_map):
        output = (self.folder / f"{name}.output").open("w")
        what = {"launch": [self.scenario, "--no-images"],
                "replay": [self.folder / "undisturbed/run.lcm", "--estimator", "waymark"]}[script]
        command = [self.deploy / f"{script}.sh", *what, "--out", self.folder / name, "--save-map", saved_map]
        return subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                env=os.environ | {TAG: name}, restore_signals=True, start_new_session=True)

    def time_both(self):
        self.duration_s = {}
        for script, name in (("launch", "undisturbed"), ("replay", "undisturbed_replay")):
            begin = time.monotonic()
            if self.start(script, name, self.old_map).wait() != 0:
                sys.exit(f"{script}.sh fails undisturbed: see {self.folder}/{name}.output")
            self.duration_s[script] = time.monotonic() - begin

    def strike(self, script, name, run):
        """One random thing at a random time. Returns its name and the exit codes that may come of it."""
        at_s = self.random.uniform(0.0, 1.1 * self.duration_s[script])
        number = self.random.choice((signal.SIGKILL,) * len(STOPS) + STOPS)
        victim = self.random.choice(PROGRAMS if script == "launch" else ("slam", "viewer"))
        twice_s = self.random.choice([None, self.random.uniform(0.0, 0.6)])
        try:
            run.wait(at_s)
        except subprocess.TimeoutExpired:
            pass
        if number != signal.SIGKILL:
            to_all = script == "replay" and number != signal.SIGTERM
            for pause_s in [0.0] if twice_s is None else [0.0, twice_s]:
                time.sleep(pause_s)
                if run.poll() is None:
                    os.killpg(run.pid, number) if to_all else run.send_signal(number)
            times = "once" if twice_s is None else "twice"
            return f"{script} {number.name} {times}", {0, 128 + number}
        runs = {"launch": "--lcm-url", "replay": "--report"}[script]
        pids = [pid for pid, words in processes_of(name).items()
                if words[0].endswith(f"/waymark-{victim}") and runs in words and "--check" not in words]
        for pid in pids:
            os.kill(pid, number)
        codes = {128 + number} if script == "replay" else {0, 1} if victim in ("viewer", "detector") else {1, 3}
        return f"{script} SIGKILL {victim}", codes if pids else {0}

    def faults_of(self, script, name, saved_map, code, codes):
        faults = [] if code in codes else [f"exit code {code}, not one of {sorted(codes)}"]
        end = time.monotonic() + LONGEST_LEFT_S[script]
        while (left := processes_of(name)) and time.monotonic() < end:
            time.sleep(0.05)
        if left:
            faults.append(f"left over: {left}")
        return faults + half_files(self.folder / name) + map_faults(self.map_tool, saved_map, self.old_map.read_bytes())

    def one(self, name):
        saved_map = self.folder / f"{name}.map.lcm"
        shutil.copy(self.old_map, saved_map)
        script = "replay" if self.random.random() < SHARE_OF_REPLAYS else "launch"
        run = self.start(script, name, saved_map)
        what, codes = self.strike(script, name, run)
        try:
            code = run.wait(LONGEST_END_S)
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            return what, "none", [f"goes on after {LONGEST_END_S} s"]
        code = 128 - code if code < 0 else code
        return what, code, self.faults_of(script, name, saved_map, code, codes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=100, help="how many (100)")
    parser.add_argument("--seed", type=int, default=1, help="of times, signals and victims (1)")
    parser.add_argument("--deploy", type=pathlib.Path, default=pathlib.Path(__file__).parents[2] / "deploy",
                        help="the scripts, of a source tree that is built or installed")
    parser.add_argument("--out", type=pathlib.Path, help="a temporary folder, deleted if all is well")
    parser.add_argument("--keep", action="store_true", help="the files of runs that were as they should be, too")
    options = parser.parse_args()
    options.deploy = options.deploy.resolve()
    os.environ.pop("LCM_DEFAULT_URL", None)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background of a shell it is ignored, and so by children
    signal.signal(signal.SIGHUP, lambda *_: None)  # not of nohup, for the same reason
    folder = options.out or pathlib.Path(tempfile.mkdtemp(prefix="waymark-kill-"))
    folder.mkdir(parents=True, exist_ok=True)
    runs = Runs(options, folder.resolve())
    runs.time_both()
    print("undisturbed: " + ", ".join(f"{name} {s:.1f} s" for name, s in runs.duration_s.items()), flush=True)
    outcomes = collections.Counter()
    failed = 0
    for index in range(options.runs):
        name = f"run_{index:04d}"
        what, code, faults = runs.one(name)
        outcomes[what, code] += 1
        failed += bool(faults)
        for fault in faults:
            print(f"{name}: {what}: {fault}; see {folder}/{name}.output", flush=True)
        if not faults and not options.keep:
            shutil.rmtree(folder / name, ignore_errors=True)
            for suffix in (".output", ".map.lcm"):
                (folder / f"{name}{suffix}").unlink()
    for (what, code), count in sorted(outcomes.items(), key=str):
        print(f"{what}: exit code {code}, {count} times")
    print(f"{options.runs - failed} of {options.runs} runs ended as they should (seed {options.seed})")
    if not failed and not options.out:
        shutil.rmtree(folder)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
