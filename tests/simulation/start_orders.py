#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Starts the five programs in random orders, up to 3 s apart: every run in lockstep has to come to its end.

Each run drives 2 m of a corridor of 5 m; all exit codes are 0, and the trajectory is the same, byte for byte, every time.
A run takes 5 s: no part of tests/run.sh.

usage: tests/simulation/start_orders.py [--runs N] [--seed N] [--build DIR]
"""
import argparse
import pathlib
import random
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PORT = 8892
LONGEST_RUN_S = 60
SCENARIO = SOURCE / "tests/data/scenarios/smallest.toml"


def run(build, folder, rng):
    """One run: what went wrong (empty: nothing) and the trajectory."""
    robot, row = folder / "robot.toml", folder / "row"
    row.mkdir(parents=True)
    dumped = subprocess.run([build / "waymark-sim", "--config", SCENARIO, "--dump-robot-config"], check=True,
                            capture_output=True)
    robot.write_bytes(dumped.stdout)
    options = {"sim": ["--config", SCENARIO, "--out", folder], "recorder": ["--out-log", folder / "run.lcm"],
               "viewer": ["--out", row], "slam": ["--config", robot], "detector": ["--config", robot]}
    order = list(options)
    rng.shuffle(order)
    started = {}
    for name in order:
        command = [build / f"waymark-{name}", "--lcm-url", f"udpm://239.255.76.67:{PORT}?ttl=0", *options[name]]
        log = (folder / f"{name}.log").open("w")
        started[name] = subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        time.sleep(rng.choice([0.0, rng.uniform(0.0, 3.0)]))
    end = time.monotonic() + LONGEST_RUN_S
    wrong = []
    for name, process in started.items():
        try:
            code = process.wait(max(0.1, end - time.monotonic()))
        except subprocess.TimeoutExpired:
            process.kill()
            code = "none"
        wrong += [] if code == 0 else [f"{name} ends with {code}"]
    trajectory = row / "trajectory.tum"
    return order, wrong, trajectory.read_bytes() if trajectory.exists() else b""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build/release")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    good, first = 0, None
    with tempfile.TemporaryDirectory(prefix="waymark-orders-") as folder:
        for index in range(options.runs):
            order, wrong, trajectory = run(options.build.resolve(), pathlib.Path(folder) / f"run_{index}", rng)
            first = first or trajectory
            if trajectory != first or not trajectory:
                wrong.append("another trajectory")
            good += not wrong
            if wrong:
                print(f"run {index}: {', '.join(order)}: {'; '.join(wrong)}", flush=True)
    print(f"{good} of {options.runs} start orders came to the same end (seed {options.seed})")
    return 0 if good == options.runs else 1


if __name__ == "__main__":
    sys.exit(main())
