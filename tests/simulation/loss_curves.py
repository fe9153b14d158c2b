#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a network that loses, doubles, delays, mixes up and corrupts messages costs in real time.

Simulator and detector are on one network, slam and viewer on another, and tests/support/chaos.py carries the messages
from one to the other. Prints a row per fault: exit codes of slam and viewer, scans used, error of the path on line,
measured length of the map (6 m). A fault takes 20 s: no part of tests/run.sh.

usage: tests/simulation/loss_curves.py [--build DIR] [--out DIR] [FAULT...]
  FAULT  options of chaos.py as one word, e.g. "--channels LIDAR --drop 0.3" (default: the list in this script)
"""
import argparse
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CHAOS = SOURCE / "tests/support/chaos.py"
SCENARIO = """[world]
length_m = 6.0
[markers]
first_m = 2.0
spacing_m = 2.0
last_m = 4.0
[route]
end_x_m = 5.0
speed_mps = 0.5
"""
PORTS = (8890, 8891)
LONGEST_END_S = 15
FAULTS = (
    ["--drop 0"]
    + [f"--channels {name} {fault}" for name in ("LIDAR", "ODOMETRY", "MARKERS")
       for fault in [f"--drop {share}" for share in (0.01, 0.05, 0.1, 0.3, 0.5)] + ["--burst 4 1"]]
    + ["--drop 0.1", "--drop 0.5", "--burst 10 5", "--duplicate 1", "--delay 1 --delay-s 0.1", "--delay 0.3 --delay-s 1",
       "--channels MARKERS --delay 1 --delay-s 1", "--corrupt 0.1", "--stamp 0.05", "--stamp 0.05 --stamp-s 2"])


class Drive:
    def __init__(self, build, folder):
        self.build, self.folder = build, folder
        self.row = folder / "waymark"
        self.row.mkdir(parents=True, exist_ok=True)
        self.scenario = folder / "short.toml"
        self.scenario.write_text(SCENARIO)

    def dump(self, program, file, *options):
        command = [self.build / f"waymark-{program}", *options]
        file.write_bytes(subprocess.run(command, check=True, capture_output=True).stdout)

    def start(self, name, *command):
        log = (self.folder / f"{name}.log").open("w")
        return subprocess.Popen([str(word) for word in command], stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    def program(self, name, port, *options):
        return self.start(name, self.build / f"waymark-{name}", "--real-time", "--lcm-url",
                          f"udpm://239.255.76.67:{port}?ttl=0", *options)

    def stop(self, process):
        process.send_signal(signal.SIGINT)
        try:
            return process.wait(LONGEST_END_S)
        except subprocess.TimeoutExpired:
            process.kill()
            return "none"

    def run(self, fault):
        robot = self.folder / "robot.toml"
        self.dump("sim", self.folder / "scenario.toml", "--config", self.scenario, "--dump-config")
        self.dump("sim", robot, "--config", self.scenario, "--dump-robot-config")
        self.dump("slam", self.row / "config.toml", "--config", robot, "--dump-config")
        chaos = self.start("chaos", sys.executable, "-B", CHAOS, *PORTS, 3600, *fault.split())
        viewer = self.program("viewer", PORTS[1], "--out", self.row)
        slam = self.program("slam", PORTS[1], "--config", robot)
        detector = self.program("detector", PORTS[0], "--config", robot)
        time.sleep(1.5)
        self.program("sim", PORTS[0], "--config", self.scenario, "--out", self.folder).wait()
        time.sleep(1.5)  # what is delayed arrives
        self.stop(detector)
        codes = self.stop(slam), self.stop(viewer)
        chaos.kill()
        return codes

    def figures(self):
        subprocess.run([self.build / "waymark-evaluate", "run", self.folder], capture_output=True)
        scans = re.findall(r"scans processed (\d+)", (self.folder / "slam.log").read_text())
        metrics = self.row / "metrics.json"
        found = json.loads(metrics.read_text()) if metrics.exists() else {}
        return scans[-1] if scans else "0", found.get("ate_origin_m"), found.get("length_m")


def rounded(value, digits):
    return "none" if value is None else f"{value:.{digits}f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("faults", nargs="*", default=FAULTS, metavar="FAULT")
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build/release")
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in a shell's background, and so by children
    out = options.out or pathlib.Path(tempfile.mkdtemp(prefix="waymark-loss-"))
    print("| fault | slam, viewer end with | scans used | path error [m] | length [m] |\n|---|---|---|---|---|", flush=True)
    for index, fault in enumerate(options.faults):
        drive = Drive(options.build.resolve(), out.resolve() / f"fault_{index:02d}")
        codes = drive.run(fault)
        scans, error_m, length_m = drive.figures()
        print(f"| `{fault}` | {codes[0]}, {codes[1]} | {scans} | {rounded(error_m, 3)} | {rounded(length_m, 2)} |", flush=True)


if __name__ == "__main__":
    main()
