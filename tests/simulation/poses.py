# SPDX-License-Identifier: BSD-3-Clause
"""Poses in the plane, (x [m], y [m], heading [rad]), for the scripts of this folder."""
import math


def compose(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], math.remainder(a[2] + b[2], math.tau)


def inverse(a):
    c, s = math.cos(a[2]), math.sin(a[2])
    return -c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2]


def trajectory(tum):
    """The poses of a .tum file by time [us]."""
    poses = {}
    for line in tum.read_text().splitlines():
        t, x, y, _, _, _, qz, qw = map(float, line.split())
        poses[round(1e6 * t)] = (x, y, 2.0 * math.atan2(qz, qw))
    return poses
