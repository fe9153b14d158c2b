# SPDX-License-Identifier: BSD-3-Clause
"""The report as a script and as a notebook: the same figures, pictures, and one sentence for bad input."""

import json
import math
import subprocess
import sys
import unittest

from support import InFolder, need, package_dir

need("numpy", "matplotlib")

import matplotlib
import waymark
from waymark_log import Event, LogWriter

matplotlib.use("Agg")


def pose(channel, utime, x, y):
    message = waymark.pose2D_t()
    message.utime, message.x, message.y = utime, x, y
    return Event(channel, utime, message.encode())


def estimate(utime, x, y, sigma):
    message = waymark.slam_estimate_t()
    message.utime, message.has_pose, message.x_m, message.y_m = utime, 1, x, y
    message.covariance = [sigma**2 if i % 4 == 0 else 0.0 for i in range(9)]
    return Event("SLAM_ESTIMATE", utime, message.encode())


def run(*arguments):
    return subprocess.run([sys.executable, "-B", package_dir / "report.py", *arguments], capture_output=True, text=True)


class Report(InFolder):
    def setUp(self):
        super().setUp()
        self.log = self.folder / "run.lcm"
        with LogWriter(self.log) as writer:
            for i in range(100):
                utime, x = 100_000 * i, 0.1 * i
                writer.write(pose("TRUE_POSE", utime, x, 0.0))
                writer.write(pose("ODOMETRY", utime, 0.99 * x, 0.0))
                writer.write(estimate(utime, x, 0.02 * math.sin(i), 0.02))

    def expect_figures(self, numbers):
        self.assertEqual(numbers["estimates"], 100)
        self.assertAlmostEqual(numbers["ate_origin_m"], 0.02 / math.sqrt(2), delta=0.0005)
        self.assertAlmostEqual(numbers["nees_mean"], 0.5, delta=0.01)  # the mean of sin^2
        self.assertAlmostEqual(numbers["odometry_distance_scale"], 1 / 0.99, delta=0.03)
        self.assertIsNone(numbers["odometry_turn_scale"])

    def test_the_script_has_figures_and_pictures(self):
        done = run(self.log, "--out", self.folder / "report")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.expect_figures(json.loads(done.stdout))
        self.expect_figures(json.loads((self.folder / "report/report.json").read_text()))
        for name in ("map", "error", "nees", "calibration"):
            self.assertGreater((self.folder / "report" / f"{name}.png").stat().st_size, 5000, name)

    def test_the_notebook_has_the_same(self):
        """Its cells, one after the other, as a notebook's kernel runs them."""
        import os

        os.environ["WAYMARK_LOG"] = str(self.log)
        names = {}
        cells = json.loads((package_dir / "report.ipynb").read_text())["cells"]
        for number, cell in enumerate(cells):
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
        self.expect_figures(names["numbers"])
        self.assertGreaterEqual(len(names["plt"].get_fignums()), 4)

    def test_bad_input_is_one_sentence(self):
        (self.folder / "nonsense.lcm").write_text("no log")
        damaged = self.folder / "damaged.lcm"
        damaged.write_bytes(self.log.read_bytes()[:-5])
        (self.folder / "file").write_text("")
        for code, arguments, words in (
            (2, ["/no/such.lcm"], "no readable file"),
            (2, [self.log, "--out", self.folder / "file" / "folder"], "cannot write"),
            (1, [self.folder / "nonsense.lcm"], "no SLAM_ESTIMATE"),
            (1, [damaged], "are no events"),
        ):
            done = run(*arguments)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
