#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Takes the advice of waymark-evaluate placement, and measures what it was worth.

Runs a scenario in which markers are missing, asks where new ones should hang, hangs them there,
and runs it again. Then: is the worst sigma under the target, with no more markers than the full set, and is it within 20 %
of what was predicted? Prints a line for each; exit code 0 all hold, 1 one does not, 2 wrong usage or a failed run.

Two runs, six minutes for 50 m: no part of tests/run.sh.

usage: tests/simulation/placement_cure.py [--scenario FILE] [--seed N] [--target-sigma-m S] [--full N] --out DIR
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EVALUATE = ROOT / "build/release/waymark-evaluate"
TOLERANCE = 0.2


def run(scenario, seed, out):
    """A finished run in that folder stays."""
    if (out / "waymark/covariance.csv").exists() and (out / "truth.tum").exists():
        return
    command = [ROOT / "deploy/launch.sh", scenario, "--seed", str(seed), "--no-images", "--out", out]
    if subprocess.run(command, check=False).returncode != 0:
        sys.exit(2)


def placement(out, target_m):
    result = out / "placement.json"
    command = [EVALUATE, "placement", out, "--target-sigma-m", str(target_m), "--json", result]
    said = subprocess.run(command, check=False, capture_output=True, text=True)
    print(said.stdout + said.stderr)
    if said.returncode == 2:
        sys.exit(2)
    return json.loads(result.read_text())


def start_pose(truth):
    t, x, y, z, qx, qy, qz, qw = map(float, truth.read_text().split("\n", 1)[0].split())
    return x, y, 2.0 * math.atan2(qz, qw)


def num_hung(out):
    with open(out / "truth_markers.csv", newline="") as file:
        return sum(1 for _ in csv.DictReader(file))


def with_added(scenario, places, start):
    """The scenario with the advised markers, each on the wall that is nearest to its place in the world."""
    x0, y0, yaw = start
    for place in places:
        x = x0 + math.cos(yaw) * place["x_m"] - math.sin(yaw) * place["y_m"]
        y = y0 + math.sin(yaw) * place["x_m"] + math.cos(yaw) * place["y_m"]
        scenario += f"\n[[markers.added]]\nid = {place['id']}\nx_m = {x:.3f}\ny_m = {y:.3f}\n"
    return scenario


def check(what, holds):
    print(f"{'hit ' if holds else 'MISS'}  {what}")
    return holds


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scenario", type=pathlib.Path,
                        default=ROOT / "deploy/scenarios/hard/missing_three_of_four.toml")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--target-sigma-m", type=float, default=0.02)
    parser.add_argument("--full", type=int, default=24, help="markers of the full set")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    target_m = arguments.target_sigma_m
    before, after = arguments.out / "before", arguments.out / "after"
    arguments.out.mkdir(parents=True, exist_ok=True)

    run(arguments.scenario, arguments.seed, before)
    advice = placement(before, target_m)
    num_markers = num_hung(before) + len(advice["places"])
    scenario = arguments.out / "cured.toml"
    scenario.write_text(with_added(arguments.scenario.read_text(), advice["places"], start_pose(before / "truth.tum")))
    run(scenario, arguments.seed, after)
    result = placement(after, target_m)

    was, predicted, shown = (advice["worst_sigma_run_m"], advice["worst_sigma_then_m"], result["worst_sigma_run_m"])
    off = predicted / shown - 1.0
    all_hold = [
        check(f"worst sigma {was:.4f} m before, {shown:.4f} m after; target {target_m} m", shown <= target_m),
        check(f"{num_markers} markers, {len(advice['places'])} of them new; the full set has {arguments.full}",
              num_markers <= arguments.full),
        check(f"predicted {predicted:.4f} m, {100.0 * off:+.0f} % of what the run shows", abs(off) <= TOLERANCE),
    ]
    return 0 if all(all_hold) else 1


if __name__ == "__main__":
    sys.exit(main())
