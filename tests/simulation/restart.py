#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills slam in mid-run, in real time, starts it again, and looks how soon its poses are right again.

RUNS is the folder of a scenario that deploy/sweep.sh has run (DIR/corridor, with seed-1, seed-2, ...). Of the log of each
seed half a minute from a random moment on is played by lcm-logplayer, at the speed of the clock. slam localises in the map
of another seed with --start last; it is killed (SIGKILL) in the middle, and started again as soon as deploy/launch.sh and
systemd do (1 s). Errors are against the truth in the frame of the map, without alignment. Prints for each restart: when the
first right pose (within 0.1 m) came, after the kill and after the first frame with markers that the new process heard; the
error of the poses from then on; and how many poses pretended: farther off than half a metre, while the health was tracking
or degenerate. Fails when one is later than a second after its marker, or pretends. Maps that DIR already has are used again
(map_reuse.py makes the same). Twenty seeds take four minutes: no part of tests/run.sh.

usage: tests/simulation/restart.py RUNS [--jobs N] --out DIR
"""
import argparse
import math
import multiprocessing
import pathlib
import random
import signal
import statistics
import subprocess
import sys
import time

from map_reuse import BUILD, WRONG_M, Seed, rms
from poses import compose, inverse

sys.path.insert(0, str(BUILD / "python"))
SENSORS = ("LIDAR", "ODOMETRY", "MARKERS")
BEFORE_S, AFTER_S, PAUSE_S = 18.0, 14.0, 1.0
STARTS_S, ENDS_S = 1.5, 1.0  # until everybody listens; until everything has arrived
RIGHT_M, GOAL_S = 0.1, 1.0
PORT = 18900  # and one for each seed


def part_of(log, begin_s, end_s, path):
    from waymark_log import LogReader, LogWriter

    with LogReader(log) as reader, LogWriter(path) as writer:
        for event in reader:
            if event.channel in SENSORS and begin_s <= 1e-6 * event.time_us < end_s:
                writer.write(event)


def start(out, name, command):
    with open(out / f"{name}.txt", "w") as log:
        return subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=log, stderr=log)


def play(seed, saved, out):
    """What was heard, and when slam was killed (wall clock [s])."""
    begin_s = random.Random(seed.number).uniform(0.0, seed.end_s - BEFORE_S - AFTER_S)
    part, heard, state = out / "part.lcm", out / "heard.lcm", out / "state"
    part_of(seed.log("own"), begin_s, begin_s + BEFORE_S + AFTER_S, part)
    for old in (heard, state / "last_pose.toml"):
        old.unlink(missing_ok=True)
    state.mkdir(exist_ok=True)
    url = f"udpm://239.255.76.67:{PORT + seed.number}?ttl=0"
    slam = [BUILD / "waymark-slam", "--real-time", "--lcm-url", url, "--config", seed.recorded / "robot.toml", "--load-map",
            saved, "--mode", "localise", "--start", "last", "--set", f"slam.state_folder={state}"]
    logger = start(out, "logger", ["lcm-logger", "--quiet", f"--lcm-url={url}", heard])
    process = start(out, "slam_before", slam)
    time.sleep(STARTS_S)
    player = start(out, "player", ["lcm-logplayer", f"--lcm-url={url}", part])
    time.sleep(BEFORE_S)
    process.kill()
    killed_s = time.time()
    process.wait()
    time.sleep(PAUSE_S)
    process = start(out, "slam_after", slam)
    player.wait()
    time.sleep(ENDS_S)
    process.send_signal(signal.SIGINT)
    code = process.wait()
    logger.send_signal(signal.SIGINT)
    logger.wait()
    if code != 0:
        raise RuntimeError(f"seed {seed.number}: slam ends with {code}; its log is {out}/slam_after.txt")
    return heard, killed_s


def listen(heard, killed_s, seed, map_start):
    """Since slam was started again: (arrival [s], error [m], whether confident) of poses, and arrivals of frames with markers."""
    from waymark import marker_detections_t, slam_estimate_t
    from waymark_log import LogReader

    poses, frames, begun_s = [], [], math.inf
    with LogReader(heard) as reader:
        for event in reader:
            at_s = 1e-6 * event.time_us
            if at_s < killed_s + PAUSE_S:
                continue
            if event.channel == "MARKERS" and marker_detections_t.decode(event.data).num_detections > 0:
                frames.append(at_s)
            if event.channel != "SLAM_ESTIMATE":
                continue
            begun_s = min(begun_s, at_s)
            estimate = slam_estimate_t.decode(event.data)
            if not estimate.has_pose or estimate.utime not in seed.truth:
                continue
            x, y, _ = compose(inverse(map_start), seed.truth[estimate.utime])
            confident = estimate.health in (slam_estimate_t.HEALTH_TRACKING, slam_estimate_t.HEALTH_DEGENERATE)
            poses.append((at_s, math.hypot(estimate.x_m - x, estimate.y_m - y), confident))
    return poses, [at_s for at_s in frames if at_s >= begun_s]


def restart(job):
    runs, folder, number, other = job
    seed, map_of = Seed(runs, folder, number), Seed(runs, folder, other)
    out = seed.out / "restart"
    out.mkdir(exist_ok=True)
    heard, killed_s = play(seed, map_of.map("own"), out)
    poses, frames = listen(heard, killed_s, seed, map_of.start)
    right_s = next((at_s for at_s, off_m, _ in poses if off_m <= RIGHT_M), math.inf)
    marker_s = frames[0] if frames else math.inf
    return {"seed": number, "after_kill": right_s - killed_s,
            "after_marker": max(0.0, right_s - marker_s) if right_s < math.inf else math.inf,
            "ate": rms(off_m for at_s, off_m, _ in poses if at_s >= right_s),
            "pretend": sum(off_m > WRONG_M and confident for _, off_m, confident in poses)}


def draw_map(job):
    runs, folder, number = job
    Seed(runs, folder, number).map("own")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=pathlib.Path, metavar="RUNS")
    parser.add_argument("--jobs", type=int, default=4, help="at the same time (4)")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    seeds = sorted(int(folder.name.removeprefix("seed-")) for folder in options.runs.glob("seed-*") if folder.is_dir())
    if len(seeds) < 2:
        parser.error("RUNS needs two seeds or more")
    folder = options.out.resolve()
    with multiprocessing.Pool(options.jobs) as pool:
        pool.map(draw_map, [(options.runs, folder, seed) for seed in seeds])
        lines = []
        jobs = [(options.runs, folder, seed, other) for seed, other in zip(seeds, seeds[1:] + seeds[:1])]
        for line in pool.imap(restart, jobs):
            print("seed {seed:2}: right {after_kill:.1f} s after the kill, {after_marker:.1f} s after the first marker; from then "
                  "on {ate:.4f} m; poses that pretend: {pretend}".format(**line), flush=True)
            lines.append(line)
    worst = {key: max(line[key] for line in lines) for key in ("after_kill", "after_marker", "ate")}
    pretend = sum(line["pretend"] > 0 for line in lines)
    print(f"{len(lines)} restarts: right after the kill in {statistics.median(line['after_kill'] for line in lines):.1f} s (median), "
          f"{worst['after_kill']:.1f} s (worst), after the first marker in {worst['after_marker']:.1f} s (worst); "
          f"error from then on {worst['ate']:.4f} m (worst); pretending in {pretend}")
    sys.exit(0 if worst["after_marker"] <= GOAL_S and pretend == 0 else 1)


if __name__ == "__main__":
    main()
