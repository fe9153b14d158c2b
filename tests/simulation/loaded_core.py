#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Detector and slam in real time on one core that they share with a program that takes all it gets.

A drive is simulated with its camera images and played by lcm-logplayer from the other core: 10 Hz camera, 5 Hz LiDAR.
Without and with the load it prints the processor time per second of messages, how late poses come behind their scans,
what was dropped (oldest first, and counted), and the memory at half and at the end. It fails when a process does, when
a pose of the last ten seconds is later than the limit, or when memory grows from half to end. It takes six minutes:
no part of tests/run.sh.

usage: tests/simulation/loaded_core.py [--limit-s S] [--competitors N]
"""
import argparse
import os
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build/release"
sys.path.insert(0, str(BUILD / "python"))
LOADED, OTHER = "0", "1"
SCENARIO = """[world]
length_m = 20.0
[markers]
last_m = 18.0
[route]
end_x_m = 18.0
"""


def cpu_and_memory(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    resident_kb = int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), resident_kb / 1024


def on(core, command, **options):
    return subprocess.Popen(["taskset", "-c", core, *map(str, command)], stdin=subprocess.DEVNULL, **options)


def play(folder, name, competitors, seconds):
    """One real-time run of the recorded drive. Returns what it cost and how late poses came."""
    url = f"udpm://239.255.76.67:{8900 + os.getpid() % 50}?ttl=0"
    logs = {program: folder / f"{name}-{program}.txt" for program in ("detector", "slam")}
    heard = folder / f"{name}.lcm"
    busy = [on(LOADED, [sys.executable, "-c", "while True: pass"]) for _ in range(competitors)]
    logger = on(OTHER, ["lcm-logger", "--quiet", f"--lcm-url={url}", heard])
    programs = {
        program: on(LOADED, [BUILD / f"waymark-{program}", "--real-time", "--lcm-url", url, "--config", folder / "run/robot.toml"],
                    stdout=log.open("w"), stderr=subprocess.STDOUT)
        for program, log in logs.items()
    }
    time.sleep(3 + competitors)
    player = on(OTHER, ["lcm-logplayer", f"--lcm-url={url}", "--regexp=CAMERA|LIDAR|ODOMETRY", folder / "run/run.lcm"],
                stdout=subprocess.DEVNULL)
    start, half = time.monotonic(), {}
    while player.poll() is None:
        time.sleep(0.2)
        if not half and time.monotonic() - start > 0.5 * seconds:
            half = {program: cpu_and_memory(process.pid) for program, process in programs.items()}
    time.sleep(2)
    end = {program: cpu_and_memory(process.pid) for program, process in programs.items()}
    for process in programs.values():
        process.send_signal(signal.SIGINT)
    codes = {program: process.wait(60) for program, process in programs.items()}
    logger.send_signal(signal.SIGINT)
    logger.wait(10)
    for process in busy:
        process.kill()
        process.wait()
    return codes, half, end, *lateness(heard), logs


def lateness(heard):
    """[s] of each pose behind the arrival of its scan, with the time of the scan; frames and detections that came."""
    import waymark
    from waymark_log import LogReader

    scans, late, counts = {}, [], {"LIDAR": 0, "SLAM_POSE": 0, "CAMERA": 0, "MARKERS": 0}
    with LogReader(heard) as reader:
        for event in reader:
            if event.channel in counts:
                counts[event.channel] += 1
            if event.channel == "LIDAR":
                scans[waymark.planar_lidar_t.decode(event.data).utime] = event.time_us
            elif event.channel == "SLAM_POSE":
                utime = waymark.pose2D_t.decode(event.data).utime
                if utime in scans:
                    late.append((event.time_us / 1e6, (event.time_us - scans[utime]) / 1e6))
    return late, counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limit-s", type=float, default=1.0, help="how late a pose may be at the end (1.0)")
    parser.add_argument("--competitors", type=int, default=1, help="programs that take all they get (1)")
    options = parser.parse_args()
    os.environ.pop("LCM_DEFAULT_URL", None)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="waymark-loaded-"))
    (folder / "drive.toml").write_text(SCENARIO)
    launch = [SOURCE / "deploy/launch.sh", folder / "drive.toml", "--record-only", "--out", folder / "run"]
    subprocess.run(launch, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    seconds = float(re.search(r"simulated ([0-9.]+) s", (folder / "run/logs/sim.log").read_text())[1])
    failed = False
    for name, competitors in (("alone", 0), ("loaded", options.competitors)):
        codes, half, end, late, counts, logs = play(folder, name, competitors, seconds)
        delays = sorted(delay for _, delay in late)
        at_end = max((delay for when, delay in late if when > late[-1][0] - 10), default=float("inf"))
        print(f"{name}: {counts['SLAM_POSE']} poses for {counts['LIDAR']} scans, {counts['MARKERS']} detections for {counts['CAMERA']} frames")
        if delays:
            print(f"  poses late by {statistics.median(delays):.3f} s (median), {delays[int(0.95 * len(delays))]:.3f} s (95 %), "
                  f"{delays[-1]:.3f} s (most), {at_end:.3f} s (most of the last 10 s)")
        for program, (cpu_s, memory_mb) in end.items():
            print(f"  {program}: {cpu_s / seconds:.3f} s of processor time per second, {half[program][1]:.1f} MB at half, "
                  f"{memory_mb:.1f} MB at the end, exit code {codes[program]}")
            losses = [line.split("] ")[-1].strip() for line in logs[program].read_text().splitlines() if "dropped" in line or "skipped" in line]
            for line in losses[-4:]:
                print(f"    {line}")
            failed |= codes[program] != 0 or memory_mb > 1.1 * half[program][1] + 10
        failed |= at_end > options.limit_s
    print("FAILED" if failed else "poses came on time, and nothing grew")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
