# SPDX-License-Identifier: BSD-3-Clause
"""waymark-export mcap: the file against the specification, its content against the log that it was made of."""

import base64
import json
import math
import random
import subprocess
import unittest

from support import InFolder, build_dir

import mcap_reader
import waymark
from waymark_log import Event, LogWriter

SECOND = 1_000_000


def pose(channel, utime, x, y, theta):
    message = waymark.pose2D_t()
    message.utime, message.x, message.y, message.theta = utime, x, y, theta
    return Event(channel, utime, message.encode())


def estimate(utime, x, y, theta):
    message = waymark.slam_estimate_t()
    message.utime, message.has_pose = utime, 1
    message.x_m, message.y_m, message.theta_rad = x, y, theta
    message.covariance = [0.04, 0, 0, 0, 0.01, 0, 0, 0, 0.01]
    return Event("SLAM_ESTIMATE", utime, message.encode())


def scan(utime):
    message = waymark.annotated_scan_t()
    message.utime, message.x_m = utime, 1.0
    message.num_beams = 3
    message.ranges, message.angles, message.marker_ids = [1.5, math.inf, 2.5], [0.0, 0.5, 1.0], [-1] * 3
    return Event("SLAM_SCAN", utime, message.encode())


def image(utime, content):
    message = waymark.image_t()
    message.utime, message.width, message.height = utime, 4, 4
    message.pixelformat, message.size, message.data = message.PIXEL_FORMAT_MJPEG, len(content), content
    return Event("CAMERA", utime, message.encode())


def tiles(utime, percent):
    tile = waymark.map_tile_t()
    tile.tile_x, tile.num_cells = 1, 16
    tile.occupancy, tile.marker_ids = [percent, -1, 100, 0] * 4, [-1] * 16
    message = waymark.map_tiles_t()
    message.utime, message.num_parts, message.resolution_m, message.tile_size_cells = utime, 1, 0.5, 4
    message.tiles, message.num_tiles = [tile], 1
    return Event("SLAM_MAP", utime, message.encode())


def markers(utime, *ids):
    message = waymark.marker_map_t()
    message.utime, message.num_parts = utime, 1
    for id in ids:
        landmark = waymark.marker_landmark_t()
        landmark.id, landmark.x_m, landmark.yaw_rad = id, float(id), math.pi / 2
        landmark.covariance = [0.01 if i % 4 == 0 else 0.0 for i in range(9)]
        message.landmarks.append(landmark)
    message.num_landmarks = len(ids)
    return Event("SLAM_MARKERS", utime, message.encode())


def a_run():
    dice = random.Random(1)
    for i in range(60):
        utime = i * SECOND // 10
        yield pose("ODOMETRY", utime, 0.1 * i, 0.0, 0.01 * i)
        yield pose("TRUE_POSE", utime, 10.0, 0.1 * i, math.pi / 2)
        yield image(utime, dice.randbytes(30_000))
        if i % 2 == 0:
            yield estimate(utime, 0.2 * i, 1.0, 0.02 * i)
            yield scan(utime)
        if i % 10 == 0:
            yield tiles(utime, i)
            yield markers(utime, 3, 5)


def yaw(rotation):
    return 2 * math.atan2(rotation["z"], rotation["w"])


def compose(a, b):
    cos, sin = math.cos(a[2]), math.sin(a[2])
    return (a[0] + cos * b[0] - sin * b[1], a[1] + sin * b[0] + cos * b[1], a[2] + b[2])


def export(log, out):
    return subprocess.run([build_dir / "waymark-export", "mcap", log, "--out", out], capture_output=True, text=True)


class Export(InFolder):
    def setUp(self):
        super().setUp()
        self.log, self.out = self.folder / "run.lcm", self.folder / "run.mcap"
        with LogWriter(self.log) as writer:
            for event in a_run():
                writer.write(event)

    def exported(self):
        done = export(self.log, self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        return mcap_reader.read(self.out.read_bytes())

    def test_every_record_is_as_specified(self):
        mcap = self.exported()
        self.assertGreater(self.out.stat().st_size, 2 << 20)  # so that there are several chunks
        for name, encoding, schema in mcap.schemas.values():
            self.assertTrue(name.startswith("foxglove."), name)
            self.assertEqual(encoding, "jsonschema")
            self.assertEqual(json.loads(schema)["type"], "object")
        self.assertEqual({encoding for _, _, encoding in mcap.channels.values()}, {"json"})

    def test_messages_have_the_fields_of_their_schemas(self):
        mcap = self.exported()
        schema_of = {topic: json.loads(mcap.schemas[schema][2]) for topic, schema, _ in mcap.channels.values()}

        def check(value, schema, path):
            kinds = {"object": dict, "array": list, "number": (int, float), "integer": int, "string": str, "boolean": bool}
            self.assertIsInstance(value, kinds[schema["type"]], path)
            if "properties" in schema:
                self.assertEqual(set(value), set(schema["properties"]), path)
                for name, inner in schema["properties"].items():
                    check(value[name], inner, f"{path}.{name}")
            for element in value if "items" in schema else ():
                check(element, schema["items"], f"{path}[]")

        for topic, _, message in mcap.messages:
            check(message, schema_of[topic], topic)
        self.assertEqual({topic for topic, _, _ in mcap.messages}, set(schema_of))

    def test_frames_lead_from_the_map_to_the_base(self):
        mcap = self.exported()
        frames = {}
        for time, message in mcap.topic("/tf"):
            for t in message["transforms"]:
                where = (t["translation"]["x"], t["translation"]["y"], yaw(t["rotation"]))
                frames[t["parent_frame_id"], t["child_frame_id"], time] = where
        poses = mcap.topic("/pose")
        self.assertEqual(len(poses), 30)
        for time, message in poses:
            found = compose(frames["map", "odom", time], frames["odom", "base", time])
            position = message["pose"]["position"]
            expected = (position["x"], position["y"], yaw(message["pose"]["orientation"]))
            for a, b in zip(found, expected):
                self.assertAlmostEqual(a, b, places=5)
        world_from_map = next(frames[key] for key in frames if key[:2] == ("world", "map"))
        for a, b in zip(compose(world_from_map, (0.0, 1.0, 0.0)), (10.0, 0.0, math.pi / 2)):
            self.assertAlmostEqual(a, b, places=5)

    def test_the_content_is_that_of_the_log(self):
        mcap = self.exported()
        images = [event for event in a_run() if event.channel == "CAMERA"]
        self.assertEqual(
            [(time, base64.b64decode(m["data"])) for time, m in mcap.topic("/camera")],
            [(1000 * e.time_us, waymark.image_t.decode(e.data).data) for e in images],
        )
        _, grid = mcap.topic("/map")[-1]
        self.assertEqual(list(base64.b64decode(grid["data"])), [50, 255, 100, 0] * 4)  # -1 is 255
        self.assertEqual((grid["column_count"], grid["pose"]["position"]["x"]), (4, 2.0))
        _, last_scan = mcap.topic("/scan")[-1]
        self.assertEqual(last_scan["ranges"], [1.5, 0, 2.5])
        _, scene = mcap.topic("/markers")[-1]
        self.assertEqual([entity["id"] for entity in scene["entities"]], ["marker 3", "marker 5"])
        self.assertEqual(scene["deletions"][0]["type"], 1)
        _, ellipse = mcap.topic("/pose_ellipse")[0]
        points = ellipse["entities"][0]["lines"][0]["points"]
        self.assertAlmostEqual(max(p["x"] for p in points), 0.0 + 2 * 0.2, places=3)
        self.assertAlmostEqual(max(p["y"] for p in points), 1.0 + 2 * 0.1, places=3)

    def test_damaged_logs_give_what_is_left_and_no_crash(self):
        dice = random.Random(3)
        good = self.log.read_bytes()
        for _ in range(20):
            data = bytearray(good)
            for _ in range(50):
                data[dice.randrange(len(data))] = dice.randrange(256)
            self.log.write_bytes(data)
            done = export(self.log, self.out)
            self.assertIn(done.returncode, (0, 1), done.stderr)
            mcap_reader.read(self.out.read_bytes())

    def test_bad_input_is_one_sentence_and_no_file(self):
        nonsense = self.folder / "nonsense.lcm"
        nonsense.write_text("no log")
        for code, log, out, words in (
            (2, "/no/such.lcm", self.out, "cannot be read"),
            (1, nonsense, self.out, "is it an LCM log?"),
            (2, self.log, "/no/such/folder/run.mcap", "cannot be created"),
            (2, self.log, self.log, "would overwrite"),
        ):
            done = export(log, out)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertEqual(list(self.folder.glob("*.mcap*")), [])


if __name__ == "__main__":
    unittest.main()
