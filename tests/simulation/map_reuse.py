#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Saved maps over many seeds: localising from random starts, with all ids equal, too; two halves by extend, and by merge.

RUNS is the folder of a scenario that deploy/sweep.sh has run (DIR/corridor, with seed-1, seed-2, ...). The log of each seed is

  localise  replayed from random moments in the map of another seed: 60 s from each, pose unknown at the start;
  equal     the same where every marker has the same id, in the map of such a drive;
  extend    cut in two: the second half extends the map of the first;
  merge     cut in two that overlap by 10 m: each draws a map of its own, and waymark-map merges them.

Errors are against the truth in the frame of the map, without alignment; of localise from 2 s after the first pose. Wrong:
farther off than half a metre while the health is tracking or degenerate. Prints a line for each part; fails when one misses
its goal in docs/maps.md. Maps that DIR already has are used again. Twenty seeds with twenty starts take ten minutes on two
cores: no part of tests/run.sh.

usage: tests/simulation/map_reuse.py RUNS [--starts N] [--parts localise,equal,extend,merge] --out DIR
"""
import argparse
import collections
import csv
import json
import math
import multiprocessing
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys

from poses import compose, inverse, trajectory

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build/release"
sys.path.insert(0, str(BUILD / "python"))
HEALTHY = ("2", "3")  # tracking, degenerate
WINDOW_S, SETTLED_S = 60.0, 2.0
WRONG_M = 0.5
MIDDLE_S, OVERLAP_S = 240.0, 50.0  # 10 m at 0.1 m/s are 100 s
ATE_M, FIX_S, LENGTH_PX, TOLERANCE_PX = 0.03, 1.0, 1000, 1


def run(*command, fine=(0,)):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True)
    if done.returncode not in fine:
        raise RuntimeError(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def replay(log, out, *options, fine=(0,)):
    run(SOURCE / "deploy/replay.sh", log, "--estimator", "waymark", "--out", out, *options, fine=fine)
    return out / "waymark"


def position_errors(row, truth, start):
    """[m] by time [us], of the poses at whose times there is a true one, in the frame with its origin at `start`."""
    off = {}
    for time_us, (x, y, _) in trajectory(row / "trajectory.tum").items():
        if time_us in truth:
            true_x, true_y, _ = compose(inverse(start), truth[time_us])
            off[time_us] = math.hypot(x - true_x, y - true_y)
    return off


def rms(values):
    values = list(values)
    return math.sqrt(sum(value * value for value in values) / len(values)) if values else math.nan


def times_with_markers_s(log):
    from waymark import marker_detections_t
    from waymark_log import LogReader

    with LogReader(log) as reader:
        seen = [marker_detections_t.decode(event.data) for event in reader if event.channel == "MARKERS"]
    return [1e-6 * frame.utime for frame in seen if frame.num_detections > 0]


def num_wrong(off, row):
    """How many of the errors [m] by time [us] are large while the health is good."""
    with open(row / "covariance.csv", newline="") as file:
        health = {round(1e6 * float(line["t"])): line["health"] for line in csv.DictReader(file)}
    return sum(error > WRONG_M and health.get(t) in HEALTHY for t, error in off.items())


def num_markers(markers_csv):
    with open(markers_csv, newline="") as file:
        return sum(1 for _ in csv.DictReader(file))


def length_px(map_yaml):
    return json.loads(run(BUILD / "waymark-evaluate", "length", map_yaml, "--json"))["length_px"]


class Seed:
    """One recorded run, and what was made of it."""

    def __init__(self, runs, out, number):
        self.recorded, self.out = runs / f"seed-{number}", out / f"seed-{number}"
        self.truth = trajectory(self.recorded / "truth.tum")
        self.start = self.truth[min(self.truth)]
        self.end_s = 1e-6 * max(self.truth)
        self.number = number
        self.out.mkdir(parents=True, exist_ok=True)

    def log(self, ids):
        if ids == "equal":
            faulty = self.out / "equal_ids"
            if not (faulty / "run.lcm").exists():
                run(BUILD / "waymark-faults", self.recorded, "--variants", SOURCE / "deploy/faults/messages.toml",
                    "--variant", "ids_equal", "--out", faulty)
            return faulty / "run.lcm"
        return self.recorded / "run.lcm"

    def map(self, ids):
        saved = self.out / f"{ids}.map.lcm"
        if not saved.exists():
            replay(self.log(ids), self.out / f"map_{ids}", "--save-map", saved)
        return saved


def localise(seed, other, starts, ids):
    """In the map of the seed `other`. A line for each start: ATE, delay of the first pose, share of wrong poses."""
    saved, rng, lines = other.map(ids), random.Random(seed.number), []
    with_markers_s = times_with_markers_s(seed.log(ids))
    for number in range(starts):
        skip_s = rng.uniform(0.0, seed.end_s - WINDOW_S)
        row = replay(seed.log(ids), seed.out / f"{ids}_{number}", "--load-map", saved, "--mode", "localise",
                     "--start", "anywhere", "--skip-s", f"{skip_s:.1f}", "--until-s", f"{skip_s + WINDOW_S:.1f}",
                     fine=(0, 1))  # 1: no pose
        off = position_errors(row, seed.truth, other.start) if (row / "trajectory.tum").exists() else {}
        if not off:
            lines.append({"from": skip_s, "ate": math.nan, "fix": math.inf, "wrong": 0})
            continue
        first = min(off)
        lines.append({
            "from": skip_s, "ate": rms(error for t, error in off.items() if t >= first + 1e6 * SETTLED_S),
            "fix": 1e-6 * first - next((t for t in with_markers_s if t >= skip_s), math.inf),
            "wrong": num_wrong(off, row)})
    return lines


def extend(seed):
    half = seed.out / "half.map.lcm"
    replay(seed.log("own"), seed.out / "first_half", "--until-s", MIDDLE_S, "--save-map", half)
    row = replay(seed.log("own"), seed.out / "extended", "--skip-s", MIDDLE_S - OVERLAP_S, "--load-map", half, "--mode",
                 "extend", "--start", "anywhere")
    return {"ate": rms(position_errors(row, seed.truth, seed.start).values()), "px": length_px(row / "map.yaml"),
            "markers": num_markers(row / "markers.csv")}


def merge(seed):
    maps = [seed.out / name for name in ("west.map.lcm", "east.map.lcm", "both.map.lcm")]
    replay(seed.log("own"), seed.out / "west", "--until-s", MIDDLE_S + OVERLAP_S, "--save-map", maps[0])
    replay(seed.log("own"), seed.out / "east", "--skip-s", MIDDLE_S - OVERLAP_S, "--save-map", maps[1])
    maps[2].unlink(missing_ok=True)
    shutil.rmtree(seed.out / "both", ignore_errors=True)
    run(BUILD / "waymark-map", "merge", maps[0], maps[1], "--out", maps[2])
    run(BUILD / "waymark-map", "export", maps[2], "--out", seed.out / "both")
    return {"px": length_px(seed.out / "both/map.yaml"), "markers": num_markers(seed.out / "both/markers.csv")}


def draw_map(runs, out, seed, ids):
    Seed(runs, out, seed).map(ids)


def parts_of(job):
    runs, out, number, other, starts, parts = job
    seed, map_of = Seed(runs, out, number), Seed(runs, out, other)
    work = {"localise": lambda: localise(seed, map_of, starts, "own"),
            "equal": lambda: localise(seed, map_of, starts, "equal"),
            "extend": lambda: extend(seed), "merge": lambda: merge(seed)}
    return number, {part: work[part]() for part in parts}


def say_localised(name, by_seed):
    lines = [line | {"seed": seed} for seed, starts in sorted(by_seed.items()) for line in starts]
    fixed = [line for line in lines if not math.isnan(line["ate"])]
    wrong = [line for line in lines if line["wrong"]]
    print(f"{name}: {len(lines)} starts, {len(fixed)} found, wrong in {len(wrong)}")
    if fixed:
        ates, fixes = sorted(line["ate"] for line in fixed), sorted(line["fix"] for line in fixed)
        worst = max(fixed, key=lambda line: line["ate"])
        print(f"  ATE median {statistics.median(ates):.4f}, worst {ates[-1]:.4f} m "
              f"(seed {worst['seed']} from {worst['from']:.1f} s); first pose after the first marker: "
              f"median {statistics.median(fixes):.1f}, worst {fixes[-1]:.1f} s; later than {FIX_S:.0f} s: "
              f"{sum(fix > FIX_S for fix in fixes)}")
    for line in wrong:
        print(f"  wrong: seed {line['seed']} from {line['from']:.1f} s, {line['wrong']} poses, ATE {line['ate']:.3f} m")
    return not wrong and (name == "equal" or len(fixed) == len(lines) and
                          all(line["ate"] <= ATE_M and line["fix"] <= FIX_S for line in fixed))


def say_whole(name, by_seed, markers):
    pixels = [result["px"] for result in by_seed.values()]
    counts = collections.Counter(result["markers"] for result in by_seed.values())
    ates = [result["ate"] for result in by_seed.values() if "ate" in result]
    said = f"; ATE worst {max(ates):.4f} m" if ates else ""
    print(f"{name}: {len(pixels)} seeds, {min(pixels)} to {max(pixels)} px, markers {dict(counts)}{said}")
    return all(abs(px - LENGTH_PX) <= TOLERANCE_PX for px in pixels) and set(counts) == {markers} and \
        all(ate <= ATE_M for ate in ates)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=pathlib.Path, metavar="RUNS")
    parser.add_argument("--starts", type=int, default=20, help="of each seed (20)")
    parser.add_argument("--parts", default="localise,equal,extend,merge", help="separated by commas (all)")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    parts = options.parts.split(",")
    seeds = sorted(int(folder.name.removeprefix("seed-")) for folder in options.runs.glob("seed-*") if folder.is_dir())
    if len(seeds) < 2 or not set(parts) <= {"localise", "equal", "extend", "merge"}:
        parser.error("RUNS needs two seeds or more, and --parts known names")
    jobs = [(options.runs, options.out, seed, other, options.starts, parts)
            for seed, other in zip(seeds, seeds[1:] + seeds[:1])]
    results = collections.defaultdict(dict)
    ids_used = [ids for part, ids in (("localise", "own"), ("equal", "equal")) if part in parts]
    with multiprocessing.Pool(os.cpu_count()) as pool:
        pool.starmap(draw_map, [(options.runs, options.out, seed, ids) for seed in seeds for ids in ids_used])
        for done, (seed, result) in enumerate(pool.imap_unordered(parts_of, jobs), 1):
            print(f"{done} of {len(jobs)} seeds", flush=True)
            for part in parts:
                results[part][seed] = result[part]
    markers = num_markers(options.runs / f"seed-{seeds[0]}" / "truth_markers.csv")
    hits = [say_localised(part, results[part]) if part in ("localise", "equal") else
            say_whole(part, results[part], markers) for part in parts]
    sys.exit(0 if all(hits) else 1)


if __name__ == "__main__":
    main()
