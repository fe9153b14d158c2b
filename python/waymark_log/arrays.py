# SPDX-License-Identifier: BSD-3-Clause
"""What is in a log as numpy arrays. Every function takes the path of a log."""

from dataclasses import dataclass

import numpy as np
import waymark

from .events import LogReader, messages

NO_MARKER = -1


@dataclass(frozen=True)
class Grid:
    """The map: row 0 is the lowest y. Cell [r, c] covers origin_m + resolution_m * (c..c+1, r..r+1)."""

    occupancy: np.ndarray  # int8 [%] 0..100, -1 = unknown
    marker_ids: np.ndarray  # int16, -1 = none
    origin_m: tuple  # (x, y) of the lower left corner
    resolution_m: float

    @property
    def extent_m(self):
        """(left, right, bottom, top), as matplotlib's imshow(origin="lower") wants it."""
        rows, columns = self.occupancy.shape
        left, bottom = self.origin_m
        return (left, left + columns * self.resolution_m, bottom, bottom + rows * self.resolution_m)


@dataclass(frozen=True)
class Trajectory:
    """Poses of the base, one row each."""

    time_us: np.ndarray  # int64
    pose: np.ndarray  # [N, 3]: x m, y m, theta rad
    covariance: np.ndarray  # [N, 3, 3], NaN where the log has none
    health: np.ndarray  # int8, slam_estimate_t.HEALTH_*

    def __len__(self):
        return len(self.time_us)


MARKER_FIELDS = np.dtype(
    [
        ("id", "i4"),
        ("instance", "i4"),
        ("x_m", "f8"),
        ("y_m", "f8"),
        ("yaw_rad", "f8"),
        ("sigma_x_m", "f8"),
        ("sigma_y_m", "f8"),
        ("sigma_yaw_rad", "f8"),
        ("sightings", "i4"),
        ("state", "i1"),
    ]
)


def _read(log, message_type, channel):
    with LogReader(log) as reader:
        for _, message in messages(reader, message_type, channel):
            yield message


def grid(log):
    """The newest map in the log, cropped to what is known; None when there is none."""
    tiles = {}
    frame = None
    for message in _read(log, waymark.map_tiles_t, "SLAM_MAP"):
        new_frame = (message.map_id, message.origin_x_m, message.origin_y_m, message.resolution_m, message.tile_size_cells)
        if new_frame != frame:  # another map
            frame, tiles = new_frame, {}
        for tile in message.tiles:
            tiles[tile.tile_x, tile.tile_y] = tile
    if not tiles:
        return None
    _, origin_x, origin_y, resolution, size = frame
    first_x = min(x for x, _ in tiles)
    first_y = min(y for _, y in tiles)
    shape = (
        (max(y for _, y in tiles) - first_y + 1) * size,
        (max(x for x, _ in tiles) - first_x + 1) * size,
    )
    occupancy = np.full(shape, -1, np.int8)
    marker_ids = np.full(shape, NO_MARKER, np.int16)
    for (x, y), tile in tiles.items():
        cells = np.s_[(y - first_y) * size : (y - first_y + 1) * size, (x - first_x) * size : (x - first_x + 1) * size]
        occupancy[cells] = np.reshape(np.array(tile.occupancy, np.int8), (size, size))
        marker_ids[cells] = np.reshape(np.array(tile.marker_ids, np.int16), (size, size))
    known = occupancy >= 0
    if not known.any():
        return None
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    inside = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    origin = (
        origin_x + resolution * (first_x * size + columns[0]),
        origin_y + resolution * (first_y * size + rows[0]),
    )
    return Grid(occupancy[inside], marker_ids[inside], origin, resolution)


def trajectory(log, channel="SLAM_ESTIMATE"):
    """The way of the base.

    SLAM_ESTIMATE has covariance and health; SLAM_POSE, ODOMETRY and TRUE_POSE have the pose alone. SLAM_TRAJECTORY
    is the whole way as it is known at the end.
    """
    if channel == "SLAM_ESTIMATE":
        return _estimates(log)
    if channel == "SLAM_TRAJECTORY":
        poses = [pose for part in _read(log, waymark.trajectory_t, channel) for pose in part.poses]
    else:
        poses = list(_read(log, waymark.pose2D_t, channel))
    count = len(poses)
    return Trajectory(
        np.array([p.utime for p in poses], np.int64),
        np.reshape(np.array([(p.x, p.y, p.theta) for p in poses], float), (count, 3)),
        np.full((count, 3, 3), np.nan),
        np.zeros(count, np.int8),
    )


def _estimates(log):
    estimates = [m for m in _read(log, waymark.slam_estimate_t, "SLAM_ESTIMATE") if m.has_pose]
    count = len(estimates)
    return Trajectory(
        np.array([m.utime for m in estimates], np.int64),
        np.reshape(np.array([(m.x_m, m.y_m, m.theta_rad) for m in estimates], float), (count, 3)),
        np.reshape(np.array([m.covariance for m in estimates], float), (count, 3, 3)),
        np.array([m.health for m in estimates], np.int8),
    )


def markers(log):
    """The newest complete marker map as an array of MARKER_FIELDS, by id and instance."""
    newest, parts, utime = [], {}, None
    for message in _read(log, waymark.marker_map_t, "SLAM_MARKERS"):
        if message.utime != utime:
            parts, utime = {}, message.utime
        parts[message.part] = message.landmarks
        if len(parts) == message.num_parts:
            newest = [landmark for part in sorted(parts) for landmark in parts[part]]
    rows = sorted(
        (
            m.id,
            m.instance,
            m.x_m,
            m.y_m,
            m.yaw_rad,
            *np.sqrt(np.maximum([m.covariance[0], m.covariance[4], m.covariance[8]], 0.0)),
            m.sightings,
            m.state,
        )
        for m in newest
    )
    return np.array(rows, MARKER_FIELDS)


def calibration(map_file):
    """Names, means and sigmas of what a saved map knows about the robot that drew it; None when it says nothing."""
    names = ("odometry scale", "odometry drift", "turn scale", "lidar ahead", "camera yaw", "focal length", "marker standoff")
    units = ("1", "rad/m", "1", "m", "rad", "1", "m")
    newest = None
    for newest in _read(map_file, waymark.calibration_t, "MAP_CALIBRATION"):
        pass
    if newest is None:
        return None
    sigmas = np.sqrt(np.maximum(np.diag(np.reshape(newest.covariance, (7, 7))), 0.0))
    return [(name, unit, mean, sigma) for name, unit, mean, sigma in zip(names, units, newest.mean, sigmas)]
