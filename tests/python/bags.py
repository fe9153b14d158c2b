# SPDX-License-Identifier: BSD-3-Clause
"""Writers of small bags of ROS, from the formats' descriptions: .bag, .db3, .mcap, and messages in both encodings."""

import bz2
import math
import sqlite3
import struct
import subprocess
import zlib


class Encoder:
    """Fields of a message: packed as by ROS 1, or aligned as in CDR."""

    def __init__(self, cdr):
        self.cdr = cdr
        self.data = bytearray(b"\x00\x01\x00\x00" if cdr else b"")

    def number(self, kind, *values):
        for value in values:
            size = struct.calcsize("<" + kind)
            if self.cdr:
                self.data += bytes(-(len(self.data) - 4) % size)
            self.data += struct.pack("<" + kind, value)
        return self

    def text(self, text):
        raw = text.encode() + (b"\0" if self.cdr else b"")
        self.number("I", len(raw))
        self.data += raw
        return self

    def block(self, data):
        self.number("I", len(data))
        self.data += data
        return self

    def list(self, kind, values):
        return self.number("I", len(values)).number(kind, *values)

    def header(self, time_ns, frame):
        if not self.cdr:
            self.number("I", 7)  # sequence
        return self.number("I", time_ns // 10**9, time_ns % 10**9).text(frame)

    def done(self):
        return bytes(self.data)


def laser_scan(cdr, time_ns, ranges, time_increment=0.0, frame="laser"):
    e = Encoder(cdr).header(time_ns, frame)
    e.number("f", -1.0, -1.0 + 0.5 * (len(ranges) - 1), 0.5, time_increment, 0.1, 0.1, 10.0)
    return e.list("f", ranges).list("f", []).done()


def odometry(cdr, time_ns, x, y, yaw, child="base_footprint"):
    e = Encoder(cdr).header(time_ns, "odom").text(child)
    e.number("d", x, y, 0.0, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2), *[0.0] * 36, *[0.0] * 42)
    return e.done()


def compressed_image(cdr, time_ns, data, frame="camera"):
    return Encoder(cdr).header(time_ns, frame).text("jpeg").block(data).done()


def image(cdr, time_ns, width, height, pixels, encoding="mono8", frame="camera"):
    e = Encoder(cdr).header(time_ns, frame).number("I", height, width).text(encoding).number("B", 0)
    return e.number("I", len(pixels) // height).block(pixels).done()


def camera_info(cdr, time_ns, width, height, fx, cx, cy):
    e = Encoder(cdr).header(time_ns, "camera").number("I", height, width).text("plumb_bob")
    e.list("d", [0.1, -0.2, 0.0, 0.0, 0.01]).number("d", fx, 0, cx, 0, fx, cy, 0, 0, 1)
    return e.number("d", *[0.0] * 9, *[0.0] * 12).number("I", 0, 0).number("I", 0, 0, 0, 0).number("B", 0).done()


def transforms(cdr, *links):
    """Each (parent, child, x, y, z, (qx, qy, qz, qw))."""
    e = Encoder(cdr).number("I", len(links))
    for parent, child, x, y, z, rotation in links:
        e.header(0, parent).text(child).number("d", x, y, z, *rotation)
    return e.done()


def _record(fields, data):
    header = b"".join(struct.pack("<I", len(n) + 1 + len(v)) + n.encode() + b"=" + v for n, v in sorted(fields.items()))
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def write_ros1(path, messages, compression="none", per_chunk=50):
    """messages: (topic, type, time_ns, data)."""
    ids, chunks = {}, []
    for first in range(0, len(messages), per_chunk):
        chunk = b""
        for topic, kind, time_ns, data in messages[first : first + per_chunk]:
            if topic not in ids:
                ids[topic] = len(ids)
                about = {"topic": topic.encode(), "type": kind.encode(), "md5sum": b"*", "message_definition": b""}
                inner = b"".join(struct.pack("<I", len(n) + 1 + len(v)) + n.encode() + b"=" + v for n, v in about.items())
                chunk += _record({"op": b"\x07", "conn": struct.pack("<I", ids[topic]), "topic": topic.encode()}, inner)
            time = struct.pack("<II", time_ns // 10**9, time_ns % 10**9)
            chunk += _record({"op": b"\x02", "conn": struct.pack("<I", ids[topic]), "time": time}, data)
        packed = {"none": lambda d: d, "bz2": bz2.compress, "lz4": lambda d: _pack(["lz4", "-z", "-c"], d)}[compression](chunk)
        fields = {"op": b"\x05", "compression": compression.encode(), "size": struct.pack("<I", len(chunk))}
        chunks.append(_record(fields, packed))
        chunks.append(_record({"op": b"\x04", "ver": struct.pack("<I", 1), "conn": struct.pack("<I", 0), "count": struct.pack("<I", 0)}, b""))
    head = _record({"op": b"\x03", "index_pos": struct.pack("<Q", 0), "conn_count": struct.pack("<I", 0), "chunk_count": struct.pack("<I", 0)}, b" " * 4000)
    path.write_bytes(b"#ROSBAG V2.0\n" + head + b"".join(chunks))


def _ros2_type(kind):
    package, name = kind.split("/")
    return f"{package}/msg/{name}"


def write_db3(path, messages, compress=False):
    path.unlink(missing_ok=True)
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, offered_qos_profiles TEXT)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)")
    ids = {}
    for topic, kind, time_ns, data in messages:
        if topic not in ids:
            ids[topic] = len(ids) + 1
            database.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (ids[topic], topic, _ros2_type(kind)))
        blob = _pack(["zstd", "-c"], data, size_known=True) if compress else data
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (ids[topic], time_ns, blob))
    database.commit()
    database.close()


def _mcap(op, *parts):
    content = b"".join(parts)
    return struct.pack("<BQ", op, len(content)) + content


def _text(text):
    raw = text.encode()
    return struct.pack("<I", len(raw)) + raw


def write_mcap(path, messages, compression="", encoding="cdr", per_chunk=50):
    ids, chunks = {}, b""
    for first in range(0, len(messages), per_chunk):
        records = b""
        times = [time for _, _, time, _ in messages[first : first + per_chunk]]
        for topic, kind, time_ns, data in messages[first : first + per_chunk]:
            if topic not in ids:
                ids[topic] = len(ids) + 1
                name = _ros2_type(kind) if encoding == "cdr" else kind
                records += _mcap(3, struct.pack("<H", ids[topic]), _text(name), _text("ros2msg"), struct.pack("<I", 0))
                records += _mcap(4, struct.pack("<HH", ids[topic], ids[topic]), _text(topic), _text(encoding), struct.pack("<I", 0))
            records += _mcap(5, struct.pack("<HIQQ", ids[topic], 0, time_ns, time_ns), data)
        packed = {"": lambda d: d, "zstd": lambda d: _pack(["zstd", "-c"], d), "lz4": lambda d: _pack(["lz4", "-z", "-c"], d)}[compression](records)
        head = struct.pack("<QQQI", min(times), max(times), len(records), zlib.crc32(records))
        chunks += _mcap(6, head, _text(compression), struct.pack("<Q", len(packed)), packed)
    magic = b"\x89MCAP0\r\n"
    path.write_bytes(magic + _mcap(1, _text("ros2"), _text("test")) + chunks + _mcap(15, struct.pack("<I", 0)) + _mcap(2, bytes(20)) + magic)


def _pack(command, data, size_known=False):
    if size_known:
        command = [*command, f"--stream-size={len(data)}"]
    return subprocess.run(command, input=data, capture_output=True, check=True).stdout
