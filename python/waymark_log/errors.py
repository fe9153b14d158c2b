# SPDX-License-Identifier: BSD-3-Clause
"""How far an estimate is from the truth, and whether its covariance says so: the figures of waymark-evaluate."""

from dataclasses import dataclass

import numpy as np

CHI2_3_LOW, CHI2_3_HIGH = 0.2158, 9.3484  # quantiles 0.025 and 0.975 for three degrees of freedom
_SMALLEST_VARIANCE = 1e-12  # below, a sigma is rounding: 1 um, 1 urad


def wrapped(angle):
    """The same angle in (-pi, pi]."""
    return np.pi - np.mod(np.pi - np.asarray(angle, float), 2 * np.pi)


def compose(a, b):
    """a * b for poses (x, y, theta), rows of arrays or single ones."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    cos, sin = np.cos(a[..., 2]), np.sin(a[..., 2])
    return np.stack(
        [
            a[..., 0] + cos * b[..., 0] - sin * b[..., 1],
            a[..., 1] + sin * b[..., 0] + cos * b[..., 1],
            wrapped(a[..., 2] + b[..., 2]),
        ],
        axis=-1,
    )


def inverse(a):
    a = np.asarray(a, float)
    cos, sin = np.cos(a[..., 2]), np.sin(a[..., 2])
    return np.stack([-cos * a[..., 0] - sin * a[..., 1], sin * a[..., 0] - cos * a[..., 1], -a[..., 2]], axis=-1)


def pose_at(time_us, poses, at_us):
    """Poses at other times, interpolated."""
    heading = np.unwrap(poses[:, 2])
    return np.stack(
        [np.interp(at_us, time_us, poses[:, 0]), np.interp(at_us, time_us, poses[:, 1]), np.interp(at_us, time_us, heading)],
        axis=-1,
    )


@dataclass(frozen=True)
class Errors:
    """Of each estimate within the time of the truth, in the map that is aligned on the first pose."""

    time_us: np.ndarray
    estimate: np.ndarray  # [N, 3] map_from_base
    truth: np.ndarray  # [N, 3] the same, true
    error: np.ndarray  # [N, 3] estimate - truth
    nees: np.ndarray  # [N], NaN where the covariance cannot be inverted

    @property
    def ate_m(self):
        """Root mean square distance."""
        return float(np.sqrt(np.mean(np.sum(self.error[:, :2] ** 2, axis=1))))

    @property
    def nees_mean(self):
        """3 when the covariances are right."""
        return float(np.nanmean(self.nees)) if np.isfinite(self.nees).any() else float("nan")

    @property
    def nees_share_in_band(self):
        """0.95 when the covariances are right."""
        known = self.nees[np.isfinite(self.nees)]
        return float(np.mean((known >= CHI2_3_LOW) & (known <= CHI2_3_HIGH))) if len(known) else float("nan")


def errors(estimate, truth):
    """Of a Trajectory against the true one. Raises ValueError when they have no time in common."""
    if len(estimate) == 0 or len(truth) == 0:
        raise ValueError("there is no estimate, or no truth, to compare")
    inside = (estimate.time_us >= truth.time_us[0]) & (estimate.time_us <= truth.time_us[-1])
    if not inside.any():
        raise ValueError("estimate and truth have no time in common")
    time_us, poses = estimate.time_us[inside], estimate.pose[inside]
    true_poses = pose_at(truth.time_us, truth.pose, time_us)
    map_from_world = compose(poses[0], inverse(true_poses[0]))
    in_map = compose(map_from_world, true_poses)
    error = poses - in_map
    error[:, 2] = wrapped(error[:, 2])
    nees = np.array([_nees(e, c) for e, c in zip(error, estimate.covariance[inside])])
    return Errors(time_us, poses, in_map, error, nees)


def _nees(error, covariance):
    if not np.isfinite(covariance).all() or np.diag(covariance).min() < _SMALLEST_VARIANCE:
        return np.nan
    try:
        np.linalg.cholesky(covariance)
    except np.linalg.LinAlgError:
        return np.nan
    return float(error @ np.linalg.solve(covariance, error))


def odometry_scales(estimate, odometry):
    """What odometry's metres and turns have to be multiplied with to become those of the estimate: (distance, turn).

    A turn scale needs turns: it is NaN below half a turn.
    """
    inside = (estimate.time_us >= odometry.time_us[0]) & (estimate.time_us <= odometry.time_us[-1])
    counted = pose_at(odometry.time_us, odometry.pose, estimate.time_us[inside])
    poses = estimate.pose[inside]

    def travel(path):
        return np.sum(np.hypot(*np.diff(path[:, :2], axis=0).T))

    def turned(path):
        return np.sum(np.abs(np.diff(np.unwrap(path[:, 2]))))

    distance = travel(poses) / travel(counted) if travel(counted) > 0 else float("nan")
    turn = turned(poses) / turned(counted) if turned(counted) > np.pi else float("nan")
    return float(distance), float(turn)
