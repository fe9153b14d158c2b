#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How accurate poses are in the coordinates of a survey, and whether a wrong entry of the survey is named.

RUNS is the folder of a scenario that deploy/sweep.sh has run (DIR/camera_drawn, with seed-1, seed-2, ...). The markers of
each seed at the given places along the corridor are surveyed, with normal errors drawn from the seed. Its log is replayed

  right  with that survey;
  wrong  with the same, but one entry, drawn from the seed, is half a metre off in a direction that is drawn, too.

Errors are against the truth in the survey's coordinates, without alignment: root mean square of the seed over the path as it
is known at the end (final), and as it was given while driving (on line: along x, y). A pose pretends that is farther off than
half a metre while the health is tracking or degenerate. Prints a line for each seed and part, and the worst of each part; fails
when one misses its goal in docs/maps.md. Twenty seeds take three minutes on two cores: no part of tests/run.sh.

usage: tests/simulation/surveyed.py RUNS [--places X,X] [--sigma-m S] [--yaw-sigma-rad S] [--parts right,wrong] --out DIR
"""
import argparse
import csv
import math
import multiprocessing
import os
import pathlib
import random
import statistics
import sys

from map_reuse import num_wrong, position_errors, replay, rms
from poses import trajectory

PARTS = ("right", "wrong")
WRONG_BY_M = 0.5
GOAL_M = {"right": 0.015, "wrong": 0.03}  # of the final path


def survey_of(seed_folder, options, number):
    """Rows of the survey, and the id of the entry that will be wrong, with its error."""
    rng, rows = random.Random(number), []
    with open(seed_folder / "truth_markers.csv", newline="") as file:
        for marker in csv.DictReader(file):
            if float(marker["x_m"]) not in options.places:
                continue
            row = {"id": int(marker["id"]), "sigma_x_m": options.sigma_m, "sigma_y_m": options.sigma_m}
            for axis in ("x_m", "y_m"):
                row[axis] = float(marker[axis]) + rng.gauss(0.0, options.sigma_m)
            if options.yaw_sigma_rad:
                row["yaw_rad"] = float(marker["yaw_rad"]) + rng.gauss(0.0, options.yaw_sigma_rad)
                row["sigma_yaw_rad"] = options.yaw_sigma_rad
            rows.append(row)
    direction = rng.uniform(-math.pi, math.pi)
    return rows, rng.randrange(len(rows)), (WRONG_BY_M * math.cos(direction), WRONG_BY_M * math.sin(direction))


def write_survey(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def rms_xy(poses, truth):
    """Along x and y."""
    return [rms(pose[axis] - truth[t][axis] for t, pose in poses.items() if t in truth) for axis in (0, 1)]


def replay_with_survey(job):
    folder, number, part, options = job
    rows, wrong, off = survey_of(folder, options, number)
    if part == "wrong":
        rows[wrong]["x_m"] += off[0]
        rows[wrong]["y_m"] += off[1]
    out = options.out.resolve() / f"seed-{number}"
    out.mkdir(parents=True, exist_ok=True)
    survey = out / f"{part}.csv"
    write_survey(survey, rows)
    replay(folder / "run.lcm", out, "--row", part, "--set", f'robot.markers.survey_file="{survey}"')
    row, truth = out / part, trajectory(folder / "truth.tum")
    with open(row / "changes.csv", newline="") as file:
        named = {int(change["id"]) for change in csv.DictReader(file) if change["change"] == "survey_off"}
    on_line = rms_xy(trajectory(row / "trajectory.tum"), truth)
    pretend = num_wrong(position_errors(row, truth, (0.0, 0.0, 0.0)), row)
    return {"seed": number, "part": part, "final": math.hypot(*rms_xy(trajectory(row / "trajectory_final.tum"), truth)),
            "on_line": math.hypot(*on_line), "x": on_line[0], "y": on_line[1], "pretend": pretend, "named": sorted(named),
            "to_be_named": [rows[wrong]["id"]] if part == "wrong" else []}


def say(part, lines):
    """@return whether the goal is reached."""
    worst = max(line["final"] for line in lines)
    median = statistics.median(line["final"] for line in lines)
    right = sum(line["named"] == line["to_be_named"] for line in lines)
    named = sum(set(line["to_be_named"]) <= set(line["named"]) for line in lines)
    print(f"{part}: {len(lines)} seeds, final worst {worst:.4f}, median {median:.4f} m (goal {GOAL_M[part]} m); on line worst "
          f"{max(line['on_line'] for line in lines):.4f}, median {statistics.median(line['on_line'] for line in lines):.4f} m; "
          f"what is wrong is named in {named}, and nothing else in {right}; poses pretend in "
          f"{sum(line['pretend'] > 0 for line in lines)}")
    return worst <= GOAL_M[part] and named == len(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=pathlib.Path, metavar="RUNS")
    parser.add_argument("--places", default="4,48", help="of the surveyed markers along the corridor [m] (4,48)")
    parser.add_argument("--sigma-m", type=float, default=0.005, help="of the survey's positions (0.005)")
    parser.add_argument("--yaw-sigma-rad", type=float, help="of the survey's directions (there are none in it)")
    parser.add_argument("--parts", default=",".join(PARTS), help="separated by commas (both)")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    options.places = [float(place) for place in options.places.split(",")]
    parts = options.parts.split(",")
    seeds = {int(folder.name.removeprefix("seed-")): folder for folder in options.runs.glob("seed-*") if folder.is_dir()}
    if not seeds or not set(parts) <= set(PARTS):
        parser.error("RUNS needs seeds, and --parts known names")
    jobs = [(folder, number, part, options) for number, folder in sorted(seeds.items()) for part in parts]
    results = []
    with multiprocessing.Pool(os.cpu_count()) as pool:
        for line in pool.imap(replay_with_survey, jobs):
            print(f"seed {line['seed']:2} {line['part']}: final {line['final']:.4f}, on line {line['on_line']:.4f} m (x "
                  f"{line['x']:.4f}, y {line['y']:.4f}), named {line['named']} of {line['to_be_named']}, {line['pretend']} "
                  "poses pretend", flush=True)
            results.append(line)
    hits = [say(part, [line for line in results if line["part"] == part]) for part in parts]
    sys.exit(0 if all(hits) else 1)


if __name__ == "__main__":
    main()
