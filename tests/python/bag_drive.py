# SPDX-License-Identifier: BSD-3-Clause
"""A short drive as messages of ROS; as a program: small bags of it, in a folder.

usage: bag_drive.py FOLDER
"""

import math
import sys
from pathlib import Path

import bags

SCAN, ODOMETRY, TRANSFORMS = "sensor_msgs/LaserScan", "nav_msgs/Odometry", "tf2_msgs/TFMessage"
IMAGE, COMPRESSED, INFO = "sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/CameraInfo"
START_NS = 1_600_000_000 * 10**9
QUARTER_LEFT = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
# Optical axes (right, down, forward) in a body that looks ahead.
OPTICAL = (-0.5, 0.5, -0.5, 0.5)


def a_drive(cdr, time_increment=0.0, count=40):
    yield "/tf_static", TRANSFORMS, START_NS, bags.transforms(
        cdr,
        ("base_footprint", "base_link", 0.0, 0.0, 0.01, (0, 0, 0, 1)),
        ("base_link", "laser", -0.064, 0.02, 0.122, QUARTER_LEFT),
        ("base_link", "camera", 0.076, 0.0, 0.093, OPTICAL),
    )
    for i in range(count):
        now = START_NS + i * 10**8
        yield "/odom", ODOMETRY, now, bags.odometry(cdr, now, 0.02 * i, 0.5, 0.1)
        if i % 2 == 0:
            ranges = [1.0 + 0.01 * i, math.inf, 0.05, 12.0, math.nan, 2.5]
            yield "/scan", SCAN, now, bags.laser_scan(cdr, now, ranges, time_increment)


def camera(cdr):
    pixels = bytes((x * 3 + y * 5) % 256 for y in range(48) for x in range(64))
    for i in range(3):
        now = START_NS + i * 10**9
        yield "/camera/info", INFO, now, bags.camera_info(cdr, now, 64, 48, 55.5, 31.0, 23.0)
        yield "/camera/image", IMAGE, now, bags.image(cdr, now, 64, 48, pixels)


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    drive = {cdr: sorted([*a_drive(cdr, count=8), *camera(cdr)], key=lambda m: m[2]) for cdr in (False, True)}
    bags.write_ros1(folder / "plain.bag", drive[False], per_chunk=5)
    bags.write_ros1(folder / "bz2.bag", drive[False], "bz2")
    bags.write_mcap(folder / "plain.mcap", drive[True], per_chunk=5)
    bags.write_mcap(folder / "ros1.mcap", drive[False], encoding="ros1")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
