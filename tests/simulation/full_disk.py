#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Live runs of a short corridor on disks that fill up at random places.

Each run writes into a file system of its own (tmpfs in a user namespace) that is too small by a random amount, in
pages of 4 kB; every second one begins with an old map that --save-map is to replace. Afterwards no process of it
lives, the exit code is 0, 1, 2 or 3, something says that the disk is full when the code is not 0, every file that has
its name is whole, and the map is the old one or a whole new one. A run takes 3 to 10 s: no part of tests/run.sh.

usage: tests/simulation/full_disk.py [--runs N] [--seed N]
"""
import argparse
import collections
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from kill_runs import SCENARIO, TAG, half_files, map_faults, processes_of

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PAGE = 4096
FULL = ("No space left", "disk full", "disk is full")
LONGEST_S = 60


def in_namespace():
    """Where file systems may be mounted without being root: this script again, in there."""
    if os.environ.get("WAYMARK_FULL_DISK") == "1":
        return
    os.environ["WAYMARK_FULL_DISK"] = "1"
    os.execvp("unshare", ["unshare", "--map-root-user", "--mount", sys.executable, "-B", *sys.argv])


def launch(disk, name, output):
    command = [SOURCE / "deploy/launch.sh", disk.parent / "short.toml", "--out", disk / "run", "--save-map", disk / "saved.map.lcm"]
    with output.open("w") as file:
        return subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                              env=os.environ | {TAG: name}, timeout=LONGEST_S).returncode


def used(disk):
    return sum(-(-path.stat().st_size // PAGE) * PAGE for path in disk.rglob("*") if path.is_file())


def faults_of(disk, name, code, output, old_map):
    faults = [] if code in (0, 1, 2, 3) else [f"exit code {code}"]
    if left := processes_of(name):
        faults.append(f"left over: {left}")
    said = output.read_text(errors="replace") + "".join(log.read_text(errors="replace") for log in disk.glob("run/logs/*.log"))
    if code != 0 and not any(words in said for words in FULL):
        faults.append(f"code {code}, but nothing says that the disk is full")
    faults += half_files(disk)
    saved = disk / "saved.map.lcm"
    if old_map and not saved.exists():
        faults.append("the old map is gone")
    if saved.exists():
        faults += map_faults(SOURCE / "build/release/waymark-map", saved, old_map)
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=50, help="how many (50)")
    parser.add_argument("--seed", type=int, default=1, help="of the sizes (1)")
    options = parser.parse_args()
    in_namespace()
    os.environ.pop("LCM_DEFAULT_URL", None)
    generator = random.Random(options.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="waymark-full-disk-"))
    shutil.copy(SCENARIO, folder / "short.toml")
    disk = folder / "disk"
    disk.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "none", disk], check=True)
    if launch(disk, "undisturbed", folder / "undisturbed.output") != 0:
        sys.exit(f"the undisturbed run fails: see {folder}/undisturbed.output")
    enough, old_map = used(disk), (disk / "saved.map.lcm").read_bytes()
    subprocess.run(["umount", disk], check=True)
    print(f"an undisturbed run takes {enough / 1e6:.2f} MB", flush=True)
    outcomes, failed = collections.Counter(), 0
    for index in range(options.runs):
        name, has_map = f"run_{index:04d}", index % 2 == 1
        size = generator.randrange(1, enough // PAGE) * PAGE + has_map * -(-len(old_map) // PAGE) * PAGE
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", disk], check=True)
        if has_map:
            (disk / "saved.map.lcm").write_bytes(old_map)
        output = folder / f"{name}.output"
        try:
            code = launch(disk, name, output)
            faults = faults_of(disk, name, code, output, old_map if has_map else None)
        except subprocess.TimeoutExpired:
            code, faults = "none", [f"goes on after {LONGEST_S} s"]
        outcomes[code] += 1
        failed += bool(faults)
        for fault in faults:
            print(f"{name}: {size} bytes: {fault}; see {output}", flush=True)
        if faults:
            shutil.copytree(disk, folder / name, dirs_exist_ok=True)
        subprocess.run(["umount", "--lazy", disk], check=True)
    for code, count in sorted(outcomes.items(), key=str):
        print(f"exit code {code}, {count} times")
    print(f"{options.runs - failed} of {options.runs} runs ended as they should (seed {options.seed})")
    if not failed:
        shutil.rmtree(folder)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
