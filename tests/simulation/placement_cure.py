#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Takes the advice of waymark-evaluate placement, and measures what it was worth.

Runs a scenario of one straight corridor in which markers are missing, asks where new ones should hang, hangs them there,
and runs it again. Then: is the worst sigma under the target, with no more markers than the full set, and is it within 20 %
of what was predicted? Prints a line for each; exit code 0 all hold, 1 one does not, 2 wrong usage or a failed run.

Two runs, six minutes for 50 m: no part of tests/run.sh. The simulator hangs markers in a raster along the walls, so that
places are rounded to it: by a third of a metre at most.

usage: tests/simulation/placement_cure.py [--scenario FILE] [--seed N] [--target-sigma-m S] [--full N] --out DIR
"""
import argparse
import csv
import json
import math
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EVALUATE = ROOT / "build/release/waymark-evaluate"
SPACING_M = 2.0 / 3.0  # a plate is 0.6 m wide, and the markers that hang stand in a raster of 2 m
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


def value(scenario, section, key):
    """Of an effective scenario, which has every key."""
    text = re.search(rf"^\[{section}\]\n(.*?)(?=^\[|\Z)", scenario, re.M | re.S).group(1)
    return re.search(rf"^{key} = ([^#\n]+)", text, re.M).group(1).strip()


def start_pose(truth):
    t, x, y, z, qx, qy, qz, qw = map(float, truth.read_text().split("\n", 1)[0].split())
    return x, y, 2.0 * math.atan2(qz, qw)


def hung_markers(out):
    """(x, is left, id) in the world."""
    with open(out / "truth_markers.csv", newline="") as file:
        return [(float(row["x_m"]), float(row["y_m"]) > 0.0, int(row["id"])) for row in csv.DictReader(file)]


def advised_markers(advice, start):
    x0, y0, yaw = start
    for place in advice["places"]:
        if place["wall"] not in ("left", "right"):
            sys.exit(f"id {place['id']} hangs on an end wall, where the simulator has no place")
        x = x0 + math.cos(yaw) * place["x_m"] - math.sin(yaw) * place["y_m"]
        y = y0 + math.sin(yaw) * place["x_m"] + math.cos(yaw) * place["y_m"]
        yield x, y > 0.0, place["id"]


def with_markers(scenario, markers):
    """The scenario with just these, each in the nearest place of the raster."""
    length_m = float(value(scenario, "world", "length_m"))
    first_m = min(x for x, _, _ in markers) % SPACING_M
    while first_m < 0.5:  # half a plate from the end wall
        first_m += SPACING_M
    stations = int((length_m - 0.5 - first_m) / SPACING_M)
    ids = [0] * (2 * (stations + 1))
    hung = set()
    for x, is_left, marker in markers:
        station = min(max(round((x - first_m) / SPACING_M), 0), stations)
        place = 2 * station + (0 if is_left else 1)
        assert place not in hung, f"two markers within {SPACING_M:.2f} m"
        hung.add(place)
        ids[place] = marker
    missing = [place for place in range(len(ids)) if place not in hung]
    layout = f"""[markers]
layout = "opposite"
first_m = {first_m:.6f}
spacing_m = {SPACING_M:.9f}
last_m = {first_m + stations * SPACING_M + 1e-6:.6f}
centre_height_m = {value(scenario, "markers", "centre_height_m")}
quiet_zone_modules = {value(scenario, "markers", "quiet_zone_modules")}
ids = {ids}
missing = {missing}

"""
    # What the scenario expects of its own markers goes.
    text = re.sub(r"^\[expect\]\n.*?(?=^\[|\Z)", "", scenario, flags=re.M | re.S)
    return re.sub(r"^\[markers\]\n.*?(?=^\[|\Z)", layout, text, flags=re.M | re.S)


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
    markers = hung_markers(before) + list(advised_markers(advice, start_pose(before / "truth.tum")))
    scenario = arguments.out / "cured.toml"
    scenario.write_text(with_markers((before / "scenario.toml").read_text(), markers))
    run(scenario, arguments.seed, after)
    result = placement(after, target_m)

    was, predicted, shown = (advice["worst_sigma_run_m"], advice["worst_sigma_then_m"], result["worst_sigma_run_m"])
    off = predicted / shown - 1.0
    all_hold = [
        check(f"worst sigma {was:.4f} m before, {shown:.4f} m after; target {target_m} m", shown <= target_m),
        check(f"{len(markers)} markers, {len(advice['places'])} of them new; the full set has {arguments.full}",
              len(markers) <= arguments.full),
        check(f"predicted {predicted:.4f} m, {100.0 * off:+.0f} % of what the run shows", abs(off) <= TOLERANCE),
    ]
    return 0 if all(all_hold) else 1


if __name__ == "__main__":
    sys.exit(main())
