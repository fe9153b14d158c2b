# SPDX-License-Identifier: BSD-3-Clause
"""Logs as numpy arrays, and errors, on small cases with known answers."""

import unittest

from support import InFolder, need

need("numpy")

import numpy as np
import waymark
from waymark_log import Event, LogWriter, arrays, errors


def tile(x, y, occupancy):
    message = waymark.map_tile_t()
    message.tile_x, message.tile_y = x, y
    message.num_cells = len(occupancy)
    message.occupancy = occupancy
    message.marker_ids = [7 if percent == 100 else -1 for percent in occupancy]
    return message


def tiles(utime, *parts, map_id=1):
    message = waymark.map_tiles_t()
    message.utime, message.map_id, message.num_parts = utime, map_id, 1
    message.origin_x_m, message.origin_y_m, message.resolution_m = -1.0, 2.0, 0.5
    message.tile_size_cells = 2
    message.tiles = list(parts)
    message.num_tiles = len(parts)
    return message


def landmark(id, sigma):
    message = waymark.marker_landmark_t()
    message.id, message.x_m, message.sightings = id, float(id), 3
    message.covariance = [sigma**2 if i % 4 == 0 else 0.0 for i in range(9)]
    return message


def marker_map(utime, part, num_parts, *landmarks):
    message = waymark.marker_map_t()
    message.utime, message.part, message.num_parts = utime, part, num_parts
    message.landmarks = list(landmarks)
    message.num_landmarks = len(landmarks)
    return message


class Arrays(InFolder):
    def log(self, *channels_and_messages):
        path = self.folder / "run.lcm"
        with LogWriter(path) as writer:
            for channel, message in channels_and_messages:
                writer.write(Event(channel, message.utime, message.encode()))
        return path

    def test_the_grid_is_the_newest_map_cropped_to_what_is_known(self):
        log = self.log(
            ("SLAM_MAP", tiles(1, tile(5, 5, [9, 9, 9, 9]), map_id=9)),  # of another map
            ("SLAM_MAP", tiles(2, tile(0, 0, [-1, 50, -1, 50]))),
            ("SLAM_MAP", tiles(3, tile(0, 0, [-1, 0, -1, 100]), tile(1, 0, [-1, -1, 10, -1]))),
        )
        grid = arrays.grid(log)
        np.testing.assert_array_equal(grid.occupancy, [[0, -1], [100, 10]])
        np.testing.assert_array_equal(grid.marker_ids, [[-1, -1], [7, -1]])
        self.assertEqual(grid.origin_m, (-0.5, 2.0))
        self.assertEqual(grid.extent_m, (-0.5, 0.5, 2.0, 3.0))

    def test_there_is_no_grid_without_a_map(self):
        self.assertIsNone(arrays.grid(self.log()))
        self.assertIsNone(arrays.grid(self.log(("SLAM_MAP", tiles(1, tile(0, 0, [-1] * 4))))))

    def test_the_trajectory_has_covariances_and_leaves_out_what_has_no_pose(self):
        estimate, unplaced = waymark.slam_estimate_t(), waymark.slam_estimate_t()
        estimate.utime, estimate.has_pose, estimate.x_m, estimate.health = 7, 1, 1.5, estimate.HEALTH_TRACKING
        estimate.covariance = [float(i) for i in range(9)]
        way = arrays.trajectory(self.log(("SLAM_ESTIMATE", unplaced), ("SLAM_ESTIMATE", estimate)))
        self.assertEqual(list(way.time_us), [7])
        np.testing.assert_array_equal(way.pose, [[1.5, 0, 0]])
        np.testing.assert_array_equal(way.covariance[0], [[0, 1, 2], [3, 4, 5], [6, 7, 8]])
        self.assertEqual(list(way.health), [waymark.slam_estimate_t.HEALTH_TRACKING])

    def test_markers_are_those_of_the_newest_complete_map(self):
        log = self.log(
            ("SLAM_MARKERS", marker_map(1, 0, 1, landmark(3, 0.5))),
            ("SLAM_MARKERS", marker_map(2, 1, 2, landmark(1, 0.1))),
            ("SLAM_MARKERS", marker_map(2, 0, 2, landmark(2, 0.2))),
            ("SLAM_MARKERS", marker_map(3, 0, 2, landmark(9, 0.9))),  # its second part is missing
        )
        found = arrays.markers(log)
        self.assertEqual(list(found["id"]), [1, 2])
        np.testing.assert_allclose(found["sigma_x_m"], [0.1, 0.2])
        self.assertEqual(found.dtype, arrays.MARKER_FIELDS)


class Errors(unittest.TestCase):
    def way(self, poses, sigma=0.1, start_us=0):
        poses = np.array(poses, float)
        count = len(poses)
        covariance = np.tile(np.eye(3) * sigma**2, (count, 1, 1))
        return arrays.Trajectory(start_us + 1000 * np.arange(count), poses, covariance, np.zeros(count, np.int8))

    def test_poses_compose_as_matrices_do(self):
        dice = np.random.default_rng(1)

        def matrix(p):
            cos, sin = np.cos(p[2]), np.sin(p[2])
            return np.array([[cos, -sin, p[0]], [sin, cos, p[1]], [0, 0, 1]])

        for a, b in dice.uniform(-3, 3, (20, 2, 3)):
            np.testing.assert_allclose(matrix(errors.compose(a, b)), matrix(a) @ matrix(b), atol=1e-12)
            np.testing.assert_allclose(matrix(errors.inverse(a)), np.linalg.inv(matrix(a)), atol=1e-12)

    def test_a_known_error_has_its_ate_and_nees(self):
        truth = self.way([[5, 5, np.pi / 2], [5, 6, np.pi / 2], [5, 7, np.pi / 2]])
        estimate = self.way([[0, 0, 0], [1, 0, 0], [2, 0.3, 0]])
        found = errors.errors(estimate, truth)
        np.testing.assert_allclose(found.error, [[0, 0, 0], [0, 0, 0], [0, 0.3, 0]], atol=1e-12)
        self.assertAlmostEqual(found.ate_m, 0.3 / np.sqrt(3))
        self.assertAlmostEqual(found.nees_mean, 9.0 / 3)  # (0.3 / 0.1)^2 in one pose of three
        self.assertAlmostEqual(found.nees_share_in_band, 1 / 3)  # 9 lies in the band, 0 below it

    def test_a_covariance_that_cannot_be_inverted_has_no_nees(self):
        found = errors.errors(self.way([[0, 0, 0], [1, 0, 0]], sigma=0.0), self.way([[0, 0, 0], [1, 0, 0]]))
        self.assertTrue(np.isnan(found.nees).all())
        self.assertTrue(np.isnan(found.nees_mean))

    def test_nothing_in_common_is_an_error(self):
        with self.assertRaises(ValueError):
            errors.errors(self.way([[0, 0, 0]], start_us=10**9), self.way([[0, 0, 0]]))

    def test_the_scale_of_odometry_is_found(self):
        estimate = self.way([[0.1 * i, 0, 0] for i in range(100)])
        odometry = self.way([[0.1 * i / 1.02, 0, 0] for i in range(100)])
        distance, turn = errors.odometry_scales(estimate, odometry)
        self.assertAlmostEqual(distance, 1.02)
        self.assertTrue(np.isnan(turn))


if __name__ == "__main__":
    unittest.main()
