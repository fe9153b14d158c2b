# SPDX-License-Identifier: BSD-3-Clause
"""The reader and writer of LCM logs: their format, and damage, against the C++ reader."""

import random
import struct
import subprocess
import unittest

from support import InFolder, build_dir

import waymark
from waymark_log import Event, LogReader, LogWriter, messages

SYNC = bytes.fromhex("eda1da01")


def some_events(count=30):
    dice = random.Random(1)
    return [Event(dice.choice(["LIDAR", "ODOMETRY", "X"]), 1000 * i, dice.randbytes(dice.randrange(200))) for i in range(count)]


def fnv(events):
    value = 2166136261
    for event in events:
        for byte in event.channel.encode("utf-8", "surrogateescape") + event.data + struct.pack("<q", event.time_us):
            value = ((value ^ byte) * 16777619) & 0xFFFFFFFF
    return value


def damaged(dice, good):
    """A copy with bytes changed, cut out, put in, or cut off."""
    data = bytearray(good)
    for _ in range(dice.randrange(1, 4)):
        at = dice.randrange(len(data))
        kind = dice.randrange(5)
        if kind == 0:
            data[at] = dice.randrange(256)
        elif kind == 1:
            del data[at : at + dice.randrange(1, 60)]
        elif kind == 2:
            data[at:at] = dice.choice([SYNC, b"garbage", dice.randbytes(40)])
        elif kind == 3:
            del data[max(1, at) :]
        else:  # the lengths of an event
            event = data.find(SYNC, at)
            if event >= 0:
                data[event + 20 : event + 28] = dice.choice([b"\x7f\xff\xff\xff" * 2, b"\xff" * 8, b"\0" * 8])
    return bytes(data)


class Log(InFolder):
    def write(self, events, name="test.lcm"):
        with LogWriter(self.folder / name) as writer:
            for event in events:
                writer.write(event)
        return self.folder / name

    def test_what_is_written_is_read(self):
        events = some_events()
        with LogReader(self.write(events)) as reader:
            self.assertEqual(list(reader), events)
            self.assertEqual(reader.skipped_bytes, 0)

    def test_it_has_the_format_of_lcm(self):
        path = self.write([Event("ODD", 1000, b"\x01")])
        self.assertEqual(path.read_bytes(), SYNC + struct.pack(">qqii", 0, 1000, 3, 1) + b"ODD\x01")

    def test_only_a_closed_log_has_its_name(self):
        with self.assertRaises(RuntimeError):
            with LogWriter(self.folder / "cut.lcm") as writer:
                writer.write(Event("A", 0, b""))
                raise RuntimeError
        self.assertFalse((self.folder / "cut.lcm").exists())
        self.assertTrue((self.folder / "cut.lcm.part").exists())

    def test_damage_is_skipped_as_the_cpp_reader_does(self):
        dice = random.Random(2)
        good = self.write(some_events()).read_bytes()
        paths = []
        for i in range(1000):
            paths.append(self.folder / f"{i}.lcm")
            paths[-1].write_bytes(damaged(dice, good))
        listed = subprocess.run(
            [build_dir / "tests/python/list_events", *paths], capture_output=True, text=True, check=True
        ).stdout.splitlines()
        self.assertEqual(len(listed), len(paths))
        num_with_skips = 0
        for path, line in zip(paths, listed):
            with LogReader(path) as reader:
                events = list(reader)
                first = reader.first_skipped_offset or 0
                self.assertEqual(f"{len(events)} {fnv(events)} {reader.skipped_bytes} {first}", line, path)
                num_with_skips += reader.skipped_bytes > 0
        self.assertGreater(num_with_skips, 500)

    def test_what_is_no_file_is_refused(self):
        for path in ("/no/such.lcm", "/tmp", "/dev/null"):
            with self.assertRaises(OSError):
                LogReader(path)

    def test_messages_are_decoded_and_others_are_rejected(self):
        pose = waymark.pose2D_t()
        pose.utime, pose.x = 5, 1.5
        events = [Event("ODOMETRY", 5, pose.encode()), Event("ODOMETRY", 6, b"nonsense"), Event("ODOMETRY", 7, pose.encode()[:-1])]
        rejected = []
        decoded = list(messages(events, waymark.pose2D_t, "ODOMETRY", rejected))
        self.assertEqual([(time_us, m.x) for time_us, m in decoded], [(5, 1.5)])
        self.assertEqual(rejected, events[1:])


if __name__ == "__main__":
    unittest.main()
