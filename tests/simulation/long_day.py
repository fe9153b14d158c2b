#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Replays a drive up and down a corridor again and again, for a day of message time: does slam grow, or slow down?

RUN is a run of tests/simulation/soak.py --lockstep (its folder run). Its sensors' messages between two moments at which
the robot passes the same place in the same direction are joined end to end, with odometry that goes on. The day is
mapped; and the map of RUN itself is localised in. Prints, after every tenth of the day, resident memory and processor
time per hour of messages. Fails when localising grows by more than 1 MB after two hours, when mapping does by more
than 1 %, 1 MB and the way (5 MB an hour), or when the last tenth takes 1.2 times as long as the second one. A day takes
twenty minutes and 2 GB in the folder for temporary files: no part of tests/run.sh.

usage: tests/simulation/long_day.py RUN [--hours H] [--keep DIR]
"""
import argparse
import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

from loaded_core import cpu_and_memory
from poses import compose, inverse, trajectory

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build/release"
sys.path.insert(0, str(BUILD / "python"))
SENSORS = ("LIDAR", "ODOMETRY", "MARKERS")
ODOMETRY = struct.Struct(">qqfff")  # fingerprint, utime, x, y, theta
WAY_MB_PER_HOUR = 5.0
MARGIN_S = 120.0  # of the run's two ends


def same_place(truth):
    """Two times, far apart, at which the robot was at nearly one place and looked the same way."""
    times = sorted(truth)
    early = next(t for t in times if t > times[0] + 1e6 * MARGIN_S and abs(truth[t][2]) < 0.05)
    x, y, _ = truth[early]
    late = [t for t in times if times[-1] - 600e6 < t < times[-1] - 1e6 * MARGIN_S and abs(truth[t][2]) < 0.05]
    return early, min(late, key=lambda t: math.hypot(truth[t][0] - x, truth[t][1] - y))


def write_day(run, hours, path):
    from waymark_log import LogReader, LogWriter
    from waymark_log.events import Event

    truth = trajectory(run / "truth.tum")
    begin, end = same_place(truth)
    with LogReader(run / "run.lcm") as reader:
        events = [event for event in reader if event.channel in SENSORS and begin <= event.time_us < end]
    poses = [ODOMETRY.unpack(event.data)[2:] for event in events if event.channel == "ODOMETRY"]
    # From the last pose to the first one of the next time around, as the robot really was.
    seam = compose(inverse(truth[end]), truth[begin])
    one_round = compose(compose(inverse(poses[0]), poses[-1]), seam)
    start = (0.0, 0.0, 0.0)
    with LogWriter(path) as writer:
        for number in range(max(1, round(3600e6 * hours / (end - begin)))):
            later_us = number * (end - begin)
            for event in events:
                data = bytearray(event.data)
                utime = struct.unpack_from(">q", data, 8)[0] + later_us
                struct.pack_into(">q", data, 8, utime)
                if event.channel == "ODOMETRY":
                    fingerprint, _, *pose = ODOMETRY.unpack(event.data)
                    data = ODOMETRY.pack(fingerprint, utime, *compose(start, compose(inverse(poses[0]), pose)))
                writer.write(Event(event.channel, event.time_us + later_us, bytes(data)))
            start = compose(start, one_round)


def replay(run, day, options, out_log):
    """Memory [MB] and processor time [s] at every tenth of the log: (message time, memory, processor time)."""
    command = [BUILD / "waymark-slam", "--config", run / "robot.toml", "--log", day, "--out-log", out_log, *options]
    slam = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    tenths, said = [], []
    for line in slam.stdout:
        said.append(line)
        match = re.match(r"replay +[0-9]+ % +([0-9.]+) s", line)
        if not match:
            continue
        cpu_s, memory_mb = cpu_and_memory(slam.pid)
        tenths.append((float(match[1]), memory_mb, cpu_s))
    if slam.wait() != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: exit code {slam.returncode}\n{''.join(said[-20:])}")
    print("".join(line for line in said if "estimator:" in line or "replayed" in line or "found:" in line), end="")
    return tenths


def settled(tenths):
    """The first look after two hours: after one slam keeps no more keyframes of the corridor."""
    return next((tenth for tenth in tenths if tenth[0] >= 7200), tenths[-1])


def judge(name, tenths, may_grow_mb):
    print(f"{name}: after h {', '.join(f'{t / 3600:.1f}' for t, _, _ in tenths[1:])}:")
    print(f"  MB {', '.join(f'{memory:.1f}' for _, memory, _ in tenths[1:])}")
    paces = [3600 * (b[2] - a[2]) / (b[0] - a[0]) for a, b in zip(tenths, tenths[1:])]
    print(f"  processor s per h {', '.join(f'{pace:.1f}' for pace in paces)}")
    faults = []
    begin = settled(tenths)
    grown_mb = tenths[-1][1] - begin[1]
    if grown_mb > may_grow_mb(begin, tenths[-1]):
        faults.append(f"{name} grows by {grown_mb:.1f} MB")
    if paces[-1] > 1.2 * paces[1]:
        faults.append(f"{name} slows down from {paces[1]:.1f} to {paces[-1]:.1f} s per h")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path, metavar="RUN")
    parser.add_argument("--hours", type=float, default=24.0, help="of message time (24)")
    parser.add_argument("--keep", type=pathlib.Path, help="keep the day and the map there")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="waymark-day-") as temporary:
        folder = options.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        day, saved, out_log = folder / "day.lcm", folder / "run.map.lcm", folder / "slam.lcm"
        write_day(options.run, options.hours, day)
        replay(options.run, options.run / "run.lcm", ["--save-map", saved, "--until-s", "600"], out_log)
        localising = replay(options.run, day, ["--load-map", saved, "--set", "slam.mode=localise", "--set",
                                               "slam.start=anywhere"], out_log)
        faults = judge("localising", localising, lambda *_: 1.0)
        mapping = replay(options.run, day, [], out_log)
        faults += judge("mapping", mapping, lambda begin, end: 0.01 * begin[1] + 1.0
                        + WAY_MB_PER_HOUR * (end[0] - begin[0]) / 3600)
    print("FAILED: " + "; ".join(faults) if faults else "nothing grew, and nothing slowed down")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
