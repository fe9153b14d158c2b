# SPDX-License-Identifier: BSD-3-Clause
"""waymark-import rosbag, on bags of all formats that the test writes."""

import json
import math
import os
import random
import re
import shutil
import subprocess
import unittest

from support import InFolder, build_dir

import bags
import waymark
from bag_drive import COMPRESSED, IMAGE, INFO, ODOMETRY, OPTICAL, QUARTER_LEFT, SCAN, START_NS, TRANSFORMS, a_drive, camera
from waymark_log import LogReader

TRIALS = int(os.environ.get("WAYMARK_BAG_TRIALS", 250))
ROLLED_OVER = (1.0, 0.0, 0.0, 0.0)


def ros_classes():
    """Debian's rosbag, its time, and the classes of our messages; nothing where they are not installed."""
    try:
        import genpy
        import rosbag
        from nav_msgs.msg import Odometry
        from sensor_msgs.msg import CameraInfo, Image, LaserScan
        from tf2_msgs.msg import TFMessage
    except ImportError:
        return None
    return rosbag, genpy.Time, {ODOMETRY: Odometry, INFO: CameraInfo, IMAGE: Image, SCAN: LaserScan, TRANSFORMS: TFMessage}


class Rosbag(InFolder):
    def run_import(self, bag, *options, out=None):
        self.out = out or self.folder / f"{bag.name}.out" / "run.lcm"
        command = [build_dir / "waymark-import", "rosbag", bag, "--out", self.out, *options]
        return subprocess.run(command, capture_output=True, text=True)

    def imported(self, bag, *options):
        done = self.run_import(bag, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        with LogReader(self.out) as reader:
            return list(reader)

    def robot(self, key):
        """The number of a key of robot.toml, of whichever section has it."""
        section, name = key.split(".")
        text = (self.out.parent / "robot.toml").read_text().split(f"[robot.{section}]")[1].split("\n[")[0]
        return float(re.search(rf"^{name} = (\S+)", text, re.M).group(1))

    def expect_drive(self, events):
        odometry = [waymark.pose2D_t.decode(e.data) for e in events if e.channel == "ODOMETRY"]
        self.assertEqual(len(odometry), 40)
        self.assertEqual(odometry[3].utime, START_NS // 1000 + 300_000)
        self.assertAlmostEqual(odometry[3].x, 0.06, places=6)
        self.assertAlmostEqual(odometry[3].theta, 0.1, places=6)
        self.assertAlmostEqual(self.robot("lidar.x_m"), -0.064)
        self.assertAlmostEqual(self.robot("lidar.y_m"), 0.02)
        self.assertAlmostEqual(self.robot("lidar.yaw_rad"), math.pi / 2)
        self.assertAlmostEqual(self.robot("lidar.range_min_m"), 0.1, places=6)

    def expect_planar(self, events):
        scans = [waymark.planar_lidar_t.decode(e.data) for e in events if e.channel == "LIDAR"]
        self.assertEqual(len(scans), 20)
        self.assertAlmostEqual(scans[1].ranges[0], 1.02, places=6)
        self.assertEqual(scans[1].ranges[1], math.inf)  # no return
        self.assertTrue(math.isnan(scans[1].ranges[2]))  # below the shortest range
        self.assertEqual(scans[1].ranges[3], math.inf)  # beyond the longest
        self.assertTrue(math.isnan(scans[1].ranges[4]))
        self.assertEqual((scans[1].rad0, scans[1].radstep), (-1.0, 0.5))

    def bags_of_all_formats(self):
        ros1, ros2 = list(a_drive(False)), list(a_drive(True))
        bags.write_ros1(self.folder / "plain.bag", ros1)
        bags.write_ros1(self.folder / "bz2.bag", ros1, "bz2")
        bags.write_db3(self.folder / "plain.db3", ros2)
        bags.write_mcap(self.folder / "plain.mcap", ros2)
        bags.write_mcap(self.folder / "ros1.mcap", ros1, encoding="ros1")
        if shutil.which("lz4"):
            bags.write_ros1(self.folder / "lz4.bag", ros1, "lz4")
            bags.write_mcap(self.folder / "lz4.mcap", ros2, "lz4")
        if shutil.which("zstd"):
            bags.write_db3(self.folder / "zstd.db3", ros2, compress=True)
            bags.write_mcap(self.folder / "zstd.mcap", ros2, "zstd")
        return sorted(p for p in self.folder.iterdir() if p.is_file())

    def test_every_format_gives_the_same_log(self):
        contents = set()
        for bag in self.bags_of_all_formats():
            with self.subTest(bag.name):
                events = self.imported(bag)
                self.expect_drive(events)
                self.expect_planar(events)
                contents.add(self.out.read_bytes())
        self.assertEqual(len(contents), 1)

    @unittest.skipIf(ros_classes() is None, "no python3-rosbag with its messages here")
    def test_a_bag_that_ros_itself_has_written_gives_the_same_log(self):
        drive = sorted([*a_drive(False), *camera(False)], key=lambda m: m[2])
        bags.write_ros1(self.folder / "ours.bag", drive)
        self.imported(self.folder / "ours.bag")
        expected = self.out.read_bytes()
        rosbag, time_class, classes = ros_classes()
        for compression in ("none", "bz2", "lz4"):
            bag = self.folder / f"{compression}.bag"
            with rosbag.Bag(str(bag), "w", compression=compression, chunk_threshold=5000) as writer:
                for topic, kind, time_ns, data in drive:
                    message = classes[kind]().deserialize(data)
                    writer.write(topic, message, time_class(*divmod(time_ns, 10**9)))
            with self.subTest(compression):
                self.imported(bag)
                self.assertEqual(self.out.read_bytes(), expected)

    def test_beams_of_a_turning_lidar_keep_their_times(self):
        bag = self.folder / "turning.db3"
        bags.write_db3(bag, list(a_drive(True, time_increment=0.001)))
        scans = [waymark.lidar_t.decode(e.data) for e in self.imported(bag) if e.channel == "LIDAR"]
        self.assertEqual(len(scans), 20)
        self.assertEqual([t - scans[0].utime for t in scans[0].times], [0, 1000, 2000, 3000, 4000, 5000])
        for theta, expected in zip(scans[0].thetas, (1.0, 0.5, 0.0, -0.5, -1.0, -1.5)):
            self.assertAlmostEqual(theta, expected, places=6)  # clockwise

    def test_images_become_jpegs_and_the_camera_is_described(self):
        for cdr, write, name in ((False, bags.write_ros1, "camera.bag"), (True, bags.write_mcap, "camera.mcap")):
            bag = self.folder / name
            write(bag, sorted([*a_drive(cdr), *camera(cdr)], key=lambda m: m[2]))
            frames = [waymark.image_t.decode(e.data) for e in self.imported(bag) if e.channel == "CAMERA"]
            self.assertEqual(len(frames), 3)
            self.assertEqual((frames[0].width, frames[0].height), (64, 48))
            self.assertEqual(frames[0].pixelformat, waymark.image_t.PIXEL_FORMAT_MJPEG)
            self.assertEqual(frames[0].data[:2], b"\xff\xd8")
            self.assertAlmostEqual(self.robot("camera.fx_px"), 55.5)
            self.assertAlmostEqual(self.robot("camera.x_m"), 0.076)
            self.assertAlmostEqual(self.robot("camera.z_m"), 0.103)
            for angle in ("roll_rad", "pitch_rad", "yaw_rad"):
                self.assertAlmostEqual(self.robot(f"camera.{angle}"), 0.0)
            # A JPEG that fits stays as it is.
            again = self.folder / f"again-{name}"
            jpegs = [("/image", COMPRESSED, START_NS, bags.compressed_image(cdr, START_NS, frames[0].data))]
            write(again, [*a_drive(cdr), *jpegs])
            kept = [waymark.image_t.decode(e.data) for e in self.imported(again) if e.channel == "CAMERA"]
            self.assertEqual([frame.data for frame in kept], [frames[0].data])

    def test_a_lidar_that_hangs_upside_down_is_turned_round(self):
        for time_increment in (0.0, 0.001):
            bag = self.folder / f"hanging{time_increment}.bag"
            drive = [m for m in a_drive(False, time_increment) if m[0] != "/tf_static"]
            link = ("base_footprint", "laser", 0.1, 0.0, 0.3, ROLLED_OVER)
            bags.write_ros1(bag, [*drive, ("/tf_static", TRANSFORMS, START_NS, bags.transforms(False, link))])
            events = self.imported(bag)
            self.assertAlmostEqual(self.robot("lidar.yaw_rad"), 0.0)
            payload = next(e.data for e in events if e.channel == "LIDAR")
            if time_increment == 0.0:
                scan = waymark.planar_lidar_t.decode(payload)
                self.assertEqual((scan.rad0, scan.radstep), (1.0, -0.5))
            else:
                self.assertAlmostEqual(waymark.lidar_t.decode(payload).thetas[0], -1.0)  # clockwise

    def test_fixed_transforms_of_an_old_tf_are_used_and_moving_ones_are_not(self):
        bag = self.folder / "old.bag"
        drive = [m for m in a_drive(False) if m[0] != "/tf_static"]
        for i in range(5):
            links = [
                ("/odom", "/base_footprint", 0.02 * i, 0.0, 0.0, (0, 0, 0, 1)),
                ("/base_footprint", "/laser", 0.25, 0.0, 0.1, QUARTER_LEFT),
                ("/base_footprint", "/camera", 0.01 * i, 0.0, 0.1, OPTICAL),  # on a rail
            ]
            drive.append(("/tf", "tf/tfMessage", START_NS + i, bags.transforms(False, *links)))
        bags.write_ros1(bag, [*drive, *camera(False)])
        done = self.run_import(bag)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertAlmostEqual(self.robot("lidar.x_m"), 0.25)
        self.assertAlmostEqual(self.robot("lidar.yaw_rad"), math.pi / 2)
        self.assertIn("no fixed transforms lead from base_footprint to camera", done.stderr)

    def test_what_does_not_fit_is_said(self):
        bag = self.folder / "odd.bag"
        drive = [m for m in [*a_drive(False), *camera(False)] if m[0] not in ("/tf_static", "/camera/info")]
        info = ("/camera/info", INFO, START_NS, bags.camera_info(False, START_NS, 640, 480, 500.0, 320.0, 240.0))
        late_ns = START_NS + 3600 * 10**9
        late = ("/camera/image", IMAGE, START_NS, bags.image(False, late_ns, 8, 8, bytes(64)))
        unstamped = ("/scan", SCAN, START_NS + 5, bags.laser_scan(False, 0, [0.0, 2.0]))
        bags.write_ros1(bag, [*drive, info, late, unstamped])
        done = self.run_import(bag)
        self.assertEqual(done.returncode, 1)
        for words in (
            "no fixed transforms lead from base_footprint to laser: the LiDAR counts as mounted at the origin",
            "CameraInfo is of images of 640x480, but they have 64x48",
            "skipped: no odometry at its time: an image at 1600003600.000000 s",
            "1 messages of /scan have no stamp",
            "ranges of 0 m (1 of 122, 0.82 %)",
        ):
            self.assertIn(words, done.stderr)

    def test_the_doctor_reads_bags(self):
        bag = self.folder / "drive.mcap"
        bags.write_mcap(bag, list(a_drive(True)))
        done = subprocess.run([build_dir / "waymark-doctor", bag, "--json"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        checks = {check["name"]: check for check in json.loads(done.stdout)["checks"]}
        self.assertEqual(checks["records"]["verdict"], "PASS")
        self.assertEqual(checks["lidar_x"]["verdict"], "UNCHECKED")

    def test_several_topics_of_a_type_are_listed(self):
        bag = self.folder / "two.bag"
        other = [("/rear/scan", *message[1:]) for message in a_drive(False) if message[0] == "/scan"]
        bags.write_ros1(bag, [*a_drive(False), *other])
        done = self.run_import(bag)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"--scan-topic.*/rear/scan \(20 .*/scan \(20 ")
        self.expect_planar(self.imported(bag, "--scan-topic", "/rear/scan"))

    def test_bad_input_is_one_sentence(self):
        bags.write_db3(self.folder / "empty.db3", [])
        bags.write_ros1(self.folder / "no_scan.bag", [m for m in a_drive(False) if m[0] != "/scan"])
        (self.folder / "text.bag").write_text("no bag at all")
        (self.folder / "nothing.mcap").write_bytes(b"")
        (self.folder / "folder").mkdir()
        for name, words in (
            ("/no/such.bag", "cannot be read as a bag"),
            ("empty.db3", "the bag has no topic with sensor_msgs/LaserScan; it holds nothing"),
            ("no_scan.bag", "no topic with sensor_msgs/LaserScan; it holds /odom"),
            ("text.bag", "is no bag of ROS"),
            ("nothing.mcap", "is no bag of ROS"),
            ("folder", "is a folder; name the .db3 or .mcap file in it"),
        ):
            done = self.run_import(self.folder / name)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertFalse(self.out.exists())

    def test_damaged_bags_end_with_a_sentence(self):
        dice = random.Random(4)
        codes = {0: 0, 1: 0, 2: 0}
        drive = {cdr: sorted([*a_drive(cdr, count=12), *camera(cdr)], key=lambda m: m[2]) for cdr in (False, True)}
        bags.write_ros1(self.folder / "a.bag", drive[False], per_chunk=5)
        bags.write_ros1(self.folder / "b.bag", drive[False], "bz2")
        bags.write_db3(self.folder / "c.db3", drive[True])
        bags.write_mcap(self.folder / "d.mcap", drive[True], per_chunk=5)
        good = {p.suffix + p.stem: p.read_bytes() for p in self.folder.iterdir()}
        for number in range(TRIALS):
            name = dice.choice(sorted(good))
            data = bytearray(good[name])
            at = dice.randrange(len(data))
            if number % 3 == 0:
                del data[at : at + dice.randrange(1, 40)]
            else:
                data[at : at + 4] = dice.choice([b"\xff\xff\xff\xff", b"\0\0\0\0", dice.randbytes(4)])
            bag = self.folder / "damaged"
            bag.write_bytes(data)
            shutil.rmtree(self.folder / "damaged.out", ignore_errors=True)
            done = self.run_import(bag)
            self.assertIn(done.returncode, codes, f"{name} at {at}: {done.stderr}")
            if done.returncode:
                self.assertRegex(done.stderr, "skipped|is no bag|cannot be|no topic|there is no|no scan|no odometry|say with|damaged")
            codes[done.returncode] += 1
        self.assertGreater(codes[0] + codes[1], 0.3 * TRIALS)
        self.assertGreater(codes[1], 0.1 * TRIALS)


if __name__ == "__main__":
    unittest.main()
