#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Report on a run: error, NEES, calibration, map. report.ipynb is the same as a notebook.

usage: report.py RUN.lcm [--slam SLAM.lcm] [--map NAME.map.lcm] [--out DIR]

RUN.lcm has the truth (simulation); SLAM.lcm, of a replay, the estimate, else it is that of the run. The figures go to
standard output, and with --out into DIR/report.json beside pictures, where matplotlib is there. Exit codes: 0 fine,
1 no report can be made of these logs, 2 bad usage.
"""

import argparse
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

try:
    import numpy as np
except ImportError:
    sys.exit("report: numpy is missing: apt-get install python3-numpy, and use Debian's /usr/bin/python3")

from waymark_log import LogReader, arrays, errors


class Run:
    """Everything that the report shows."""

    def __init__(self, log, slam_log=None, map_file=None):
        slam_log = slam_log or log
        self.log, self.slam_log = Path(log), Path(slam_log)
        self.estimate = arrays.trajectory(slam_log)
        self.final = arrays.trajectory(slam_log, "SLAM_TRAJECTORY")
        self.odometry = arrays.trajectory(log, "ODOMETRY")
        self.truth = arrays.trajectory(log, "TRUE_POSE")
        self.grid = arrays.grid(slam_log)
        self.markers = arrays.markers(slam_log)
        self.calibration = arrays.calibration(map_file) if map_file else None
        self.errors = errors.errors(self.estimate, self.truth) if len(self.truth) and len(self.estimate) else None


def figures(run):
    """The numbers, by name."""
    numbers = {"estimates": len(run.estimate), "markers": len(run.markers)}
    if run.errors is not None:
        across = np.sqrt(np.mean(run.errors.error**2, axis=0))
        numbers["ate_origin_m"] = run.errors.ate_m
        numbers["rms_x_m"], numbers["rms_y_m"], numbers["rms_heading_rad"] = (float(v) for v in across)
        numbers["nees_mean"] = run.errors.nees_mean
        numbers["nees_share_in_95_band"] = run.errors.nees_share_in_band
        numbers["nees_poses"] = int(np.isfinite(run.errors.nees).sum())
    if len(run.odometry) > 1 and len(run.estimate) > 1:
        numbers["odometry_distance_scale"], numbers["odometry_turn_scale"] = errors.odometry_scales(run.estimate, run.odometry)
    for name, unit, mean, sigma in run.calibration or ():
        numbers[f"map: {name} [{unit}]"] = [mean, float(sigma)]
    return {name: _number(value) for name, value in numbers.items()}


def _number(value):
    """JSON has no NaN."""
    return None if isinstance(value, float) and not np.isfinite(value) else value


def plot_errors(run, axes):
    """Errors over time with the band of two sigmas that the estimate gives itself."""
    seconds = run.errors.time_us / 1e6
    inside = np.isin(run.estimate.time_us, run.errors.time_us)
    sigmas = np.sqrt(np.maximum(np.diagonal(run.estimate.covariance[inside], axis1=1, axis2=2), 0.0))
    for axis, column, name in zip(axes, range(3), ("x [m]", "y [m]", "heading [rad]")):
        axis.fill_between(seconds, -2 * sigmas[:, column], 2 * sigmas[:, column], color="0.85", label="2 sigma")
        axis.plot(seconds, run.errors.error[:, column], color="tab:blue", lw=1)
        axis.set_ylabel(name)
    axes[0].legend(loc="upper right")
    axes[-1].set_xlabel("time [s]")


def plot_nees(run, axis):
    """NEES over time with its 95 % band."""
    axis.axhspan(errors.CHI2_3_LOW, errors.CHI2_3_HIGH, color="0.9", label="95 %")
    axis.plot(run.errors.time_us / 1e6, run.errors.nees, color="tab:blue", lw=1)
    axis.axhline(3.0, color="0.5", lw=1)
    axis.set(yscale="log", xlabel="time [s]", ylabel="NEES", title=f"mean {run.errors.nees_mean:.2f}; 3 is right")
    axis.legend(loc="upper right")


def plot_map(run, axis):
    """Walls, the way, markers with two sigmas."""
    if run.grid is not None:
        shade = np.where(run.grid.occupancy < 0, 0.8, 1.0 - run.grid.occupancy / 100.0)
        axis.imshow(shade, cmap="gray", vmin=0, vmax=1, origin="lower", extent=run.grid.extent_m, interpolation="nearest")
    axis.plot(*run.estimate.pose[:, :2].T, color="tab:blue", lw=1, label="estimate")
    if run.errors is not None:
        axis.plot(*run.errors.truth[:, :2].T, color="tab:green", lw=1, ls="--", label="truth")
    for marker in run.markers:
        axis.errorbar(
            marker["x_m"], marker["y_m"], 2 * marker["sigma_y_m"], 2 * marker["sigma_x_m"], color="tab:red", marker="s", ms=3
        )
        axis.annotate(str(marker["id"]), (marker["x_m"], marker["y_m"]), fontsize=7, color="tab:red")
    axis.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axis.legend(loc="upper right")


def plot_calibration(run, axis):
    """What odometry counted against what was driven."""
    counted = errors.pose_at(run.odometry.time_us, run.odometry.pose, run.estimate.time_us)
    steps = [np.hypot(*np.diff(path[:, :2], axis=0).T) for path in (counted, run.estimate.pose)]
    distances = [np.concatenate([[0.0], np.cumsum(step)]) for step in steps]
    axis.plot(distances[0], distances[1] - distances[0], color="tab:blue", lw=1)
    scale = figures(run)["odometry_distance_scale"]
    axis.set(xlabel="odometry [m]", ylabel="estimate - odometry [m]", title=f"distance scale {scale:.4f}")


def draw(run, folder):
    """Writes the pictures; says so when there is no matplotlib."""
    try:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
    except ImportError:
        print("report: no pictures: matplotlib is missing (apt-get install python3-matplotlib)", file=sys.stderr)
        return
    pictures = [("map", plot_map, 1)]
    if run.errors is not None:
        pictures += [("error", plot_errors, 3), ("nees", plot_nees, 1)]
    if len(run.odometry) > 1 and len(run.estimate) > 1:
        pictures.append(("calibration", plot_calibration, 1))
    for name, plot, rows in pictures:
        figure, axes = plt.subplots(rows, 1, figsize=(10, 3 + 2 * (rows - 1)), sharex=rows > 1, layout="constrained")
        plot(run, axes)
        figure.savefig(folder / f"{name}.png", dpi=120)
        plt.close(figure)


def main():
    parser = argparse.ArgumentParser(prog="report", description="Error, NEES, calibration and map of a run.")
    parser.add_argument("log", help="run.lcm")
    parser.add_argument("--slam", help="what slam published, if it is in a log of its own (ROW/slam.lcm)")
    parser.add_argument("--map", help="map file of the run, for its calibration")
    parser.add_argument("--out", help="folder for report.json and pictures")
    options = parser.parse_args()
    for log in (options.log, options.slam, options.map):
        if log is not None and not Path(log).is_file():
            parser.exit(2, f"report: no readable file '{log}'\n")
    try:
        run = Run(options.log, options.slam, options.map)
    except ValueError as error:
        parser.exit(1, f"report: {options.log}: {error}\n")
    if len(run.estimate) == 0:
        parser.exit(1, f"report: {run.slam_log} has no SLAM_ESTIMATE with a pose; is it the log of a run?\n")
    numbers = figures(run)
    print(json.dumps(numbers, indent=1))
    if options.out:
        folder = Path(options.out)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "report.json").write_text(json.dumps(numbers, indent=1) + "\n")
            draw(run, folder)
        except OSError as error:
            parser.exit(2, f"report: cannot write to '{folder}': {error.strerror}\n")
    with LogReader(options.log) as reader:
        for _ in reader:
            pass
        if reader.skipped_bytes:
            where = f"{reader.skipped_bytes} bytes from offset {reader.first_skipped_offset} on"
            parser.exit(1, f"report: {options.log}: {where} are no events; skipped\n")


if __name__ == "__main__":
    main()
