#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Drives up and down one corridor for hours, and watches what the processes hold: memory, file descriptors, threads.

The corridor is 10 m long and is mapped all the time, in real time or in lockstep (--lockstep). After an hour slam keeps no
more keyframes of it. In the second half of the time the resident memory of each process may grow by 1 % and 1 MB, and by
the way that it keeps: 5 MB an hour in slam, 30 MB in the viewer until its paths are full. No descriptor and no thread may be
added, no file may appear in the run's folder, and /tmp must be as before at the end. The live page is read at every look.
No part of tests/run.sh.

usage: tests/simulation/soak.py [--hours H] [--lockstep] [--camera-hz R] [--every-s S] [--out DIR]
"""
import argparse
import collections
import contextlib
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

from first_hour import free_port
from kill_runs import TAG, processes_of
from loaded_core import cpu_and_memory

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LAP_S = 92
SCENARIO = """[world]
length_m = 10.0
[markers]
first_m = 2.0
last_m = 8.0
[route]
speed_mps = 0.2
waypoints = [{{ x_m = 9.0 }}, {{ x_m = 1.0 }}]
laps = {laps}
[lidar_noise]
dropout_probability = 0.02
[robot.camera]
rate_hz = {camera_hz}
"""
WAY_MB_PER_HOUR = {"waymark-slam": 5.0, "waymark-viewer": 30.0}

Held = collections.namedtuple("Held", "memory_mb descriptors threads")


def programs_of(tag):
    """Name and what it holds, for each program of the run."""
    held = {}
    for pid, command in processes_of(tag).items():
        program = command[0].rpartition("/")[2]
        with contextlib.suppress(OSError, TypeError):  # it has ended meanwhile
            if program.startswith("waymark-"):
                held[program] = Held(cpu_and_memory(pid)[1], len(os.listdir(f"/proc/{pid}/fd")),
                                     len(os.listdir(f"/proc/{pid}/task")))
    return held


def read_page(address):
    for path in ("/", "/map.png"):
        try:
            urllib.request.urlopen(f"http://{address}{path}", timeout=5).read()
        except OSError:
            pass


def growth(samples, hours):
    """What each process held more at the end than after the first half. Prints a line per process, and returns the faults."""
    faults = []
    for program in sorted(samples[-1]):
        rows = [row[program] for row in samples if program in row]
        first = rows[len(rows) // 2 :][: max(1, len(rows) // 10)]
        last = rows[-max(1, len(rows) // 10) :]
        memory = [max(row.memory_mb for row in part) for part in (first, last)]
        print(f"{program}: {memory[0]:.1f} MB at half, {memory[1]:.1f} MB at the end, "
              f"descriptors {first[-1].descriptors} and {last[-1].descriptors}, threads {first[-1].threads} and {last[-1].threads}")
        if memory[1] > 1.01 * memory[0] + 1 + 0.5 * hours * WAY_MB_PER_HOUR.get(program, 0.0):
            faults.append(f"{program} grew by {memory[1] - memory[0]:.1f} MB")
        if max(row.descriptors for row in last) > max(row.descriptors for row in first):
            faults.append(f"{program} holds more descriptors")
        if max(row.threads for row in last) > max(row.threads for row in first):
            faults.append(f"{program} has more threads")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=2.0, help="of message time (2.0)")
    parser.add_argument("--lockstep", action="store_true", help="as fast as the machine can")
    parser.add_argument("--camera-hz", type=float, default=10.0, help="frames a second; fewer make a long run of lockstep short (10)")
    parser.add_argument("--every-s", type=float, default=60.0, help="between two looks at the processes (60)")
    parser.add_argument("--out", type=pathlib.Path, help="of the run, with soak.json (default: a temporary folder)")
    options = parser.parse_args()
    os.environ.pop("LCM_DEFAULT_URL", None)
    folder = options.out or pathlib.Path(tempfile.mkdtemp(prefix="waymark-soak-"))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "soak.toml").write_text(SCENARIO.format(
        laps=max(1, round(options.hours * 3600 / LAP_S)), camera_hz=options.camera_hz))
    before = set(os.listdir("/tmp"))
    address = f"127.0.0.1:{free_port(socket.SOCK_STREAM)}"
    command = [SOURCE / "deploy/launch.sh", folder / "soak.toml", "--out", folder / "run", "--no-images", "--http", address]
    samples, files, tag = [], [], str(os.getpid())
    start = time.monotonic()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    with (folder / "launch.log").open("w") as log:
        launch = subprocess.Popen(command + ([] if options.lockstep else ["--real-time"]), stdout=log, stderr=log,
                                  stdin=subprocess.DEVNULL, env=os.environ | {TAG: tag})
        try:
            while launch.poll() is None:
                time.sleep(options.every_s)
                held = programs_of(tag)
                if len(held) < 5:
                    continue
                samples.append(held)
                files.append(sum(1 for path in (folder / "run").rglob("*")))
                read_page(address)
                (folder / "soak.json").write_text(json.dumps(
                    [{program: row._asdict() for program, row in sample.items()} for sample in samples], indent=1))
        finally:
            launch.terminate()
            launch.wait()
    print(f"{(time.monotonic() - start) / 3600:.2f} h, {len(samples)} looks, exit code {launch.returncode}")
    if len(samples) < 8:
        print(f"too few looks, see {folder}/launch.log: more --hours or less --every-s")
        return 1
    faults = growth(samples, options.hours) + ([] if launch.returncode == 0 else [f"launch.sh ends with {launch.returncode}"])
    if max(files[len(files) // 2 :]) > files[len(files) // 2]:
        faults.append(f"files in the run's folder: {files[len(files) // 2]}, then {max(files)}")
    left = [name for name in sorted(set(os.listdir("/tmp")) - before) if name.startswith(("waymark", "lcm"))]
    faults += [f"left in /tmp: {' '.join(left)}"] if left else []
    print("FAILED: " + "; ".join(faults) if faults else "nothing grew")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
