# SPDX-License-Identifier: BSD-3-Clause
"""A strict reader of MCAP files, written from https://mcap.dev/spec alone: checks every record, length, offset and CRC."""

import json
import struct
import zlib
from dataclasses import dataclass, field

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F


class Malformed(Exception):
    pass


def expect(holds, what):
    if not holds:
        raise Malformed(what)


class Cursor:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        expect(self.at + count <= len(self.data), "a record is shorter than its fields")
        self.at += count
        return self.data[self.at - count : self.at]

    def numbers(self, layout):
        layout = "<" + layout
        values = struct.unpack(layout, self.take(struct.calcsize(layout)))
        return values[0] if len(values) == 1 else values

    def block(self, length="I"):
        return self.take(self.numbers(length))

    def text(self):
        return self.block().decode()

    def pairs(self, layout):
        inner = Cursor(self.block())
        found = []
        while inner.at < len(inner.data):
            found.append(inner.numbers(layout))
        return found

    def done(self):
        expect(self.at == len(self.data), "a record is longer than its fields")


def records(data, start, end):
    """(offset, opcode, content) of every record from start to exactly end."""
    while start < end:
        expect(start + 9 <= end, "a record's head is cut off")
        opcode, length = struct.unpack_from("<BQ", data, start)
        expect(start + 9 + length <= end, f"record {opcode:#x} at {start} is longer than the file")
        yield start, opcode, data[start + 9 : start + 9 + length]
        start += 9 + length


@dataclass
class Mcap:
    schemas: dict = field(default_factory=dict)  # id -> (name, encoding, data)
    channels: dict = field(default_factory=dict)  # id -> (topic, schema id, encoding)
    messages: list = field(default_factory=list)  # (topic, log time ns, decoded)

    def topic(self, name):
        return [(time, message) for topic, time, message in self.messages if topic == name]


def read(data):
    """The content of a file. Raises Malformed."""
    expect(data[:8] == MAGIC and data[-8:] == MAGIC, "no magic at both ends")
    footer_at = len(data) - 8 - 29
    expect(data[footer_at] == FOOTER, "no footer before the last magic")
    summary_start, offsets_start, summary_crc = struct.unpack_from("<QQI", data, footer_at + 9)
    expect(struct.unpack_from("<Q", data, footer_at + 1) == (20,), "a footer has 20 bytes")
    expect(summary_crc == zlib.crc32(data[summary_start : footer_at + 25]), "the CRC of the summary")
    mcap = Mcap()
    chunks = _data_section(mcap, data, summary_start)
    _summary(mcap, data, summary_start, offsets_start, footer_at, chunks)
    return mcap


def _definition(mcap, opcode, content):
    cursor = Cursor(content)
    if opcode == SCHEMA:
        id = cursor.numbers("H")
        value = (cursor.text(), cursor.text(), cursor.block())
        expect(id != 0, "a schema with id 0")
        expect(mcap.schemas.setdefault(id, value) == value, "two schemas with one id")
    else:
        id, schema = cursor.numbers("HH")
        topic, encoding = cursor.text(), cursor.text()
        cursor.block()
        expect(schema in mcap.schemas, "a channel before its schema")
        expect(mcap.channels.setdefault(id, (topic, schema, encoding)) == (topic, schema, encoding), "two channels with one id")
    cursor.done()


def _data_section(mcap, data, end):
    """Reads it up to the DataEnd right before the summary; returns what the chunk indices must say."""
    chunks, last = [], None
    for offset, opcode, content in records(data, 8, end):
        expect((opcode == HEADER) == (offset == 8), "a header comes first, and once")
        expect(last != DATA_END, "something behind the end of the data")
        last = opcode
        if opcode == CHUNK:
            chunks.append(_chunk(mcap, offset, content))
        elif opcode == MESSAGE_INDEX:
            expect(chunks, "an index before any chunk")
            _message_index(chunks[-1], offset, content)
        elif opcode == DATA_END:
            expect(Cursor(content).numbers("I") == zlib.crc32(data[:offset]), "the CRC of the data")
        else:
            expect(opcode == HEADER, f"record {opcode:#x} in the data section")
    expect(last == DATA_END, "the data does not end")
    for chunk in chunks:
        expect(chunk["indexed"] == chunk["messages"], "an index that is not that of its chunk")
    return chunks


def _chunk(mcap, offset, content):
    cursor = Cursor(content)
    first, last, size, crc = cursor.numbers("QQQI")
    expect(cursor.text() == "", "compressed")
    inside = cursor.block("Q")
    cursor.done()
    expect(len(inside) == size, "the size of a chunk")
    expect(zlib.crc32(inside) == crc, "the CRC of a chunk")
    messages = {}
    times = []
    for at, opcode, record in records(inside, 0, len(inside)):
        if opcode != MESSAGE:
            expect(opcode in (SCHEMA, CHANNEL), f"record {opcode:#x} in a chunk")
            _definition(mcap, opcode, record)
            continue
        message = Cursor(record)
        channel, _, log_time, _ = message.numbers("HIQQ")
        expect(channel in mcap.channels, "a message before its channel")
        mcap.messages.append((mcap.channels[channel][0], log_time, json.loads(record[message.at :])))
        messages.setdefault(channel, []).append((log_time, at))
        times.append(log_time)
    expect((min(times, default=0), max(times, default=0)) == (first, last), "the times of a chunk")
    return {
        "start": offset,
        "bytes": 9 + len(content),
        "times": (first, last),
        "size": size,
        "messages": messages,
        "indexed": {},
        "offsets": {},
        "index_bytes": 0,
    }


def _message_index(chunk, offset, content):
    cursor = Cursor(content)
    channel = cursor.numbers("H")
    chunk["indexed"][channel] = cursor.pairs("QQ")
    chunk["offsets"][channel] = offset
    chunk["index_bytes"] += 9 + len(content)
    cursor.done()


def _summary(mcap, data, start, offsets_start, end, chunks):
    groups, indices, statistics = {}, [], None
    schemas, channels = dict(mcap.schemas), dict(mcap.channels)
    repeated = Mcap()
    for offset, opcode, content in records(data, start, offsets_start):
        group = groups.setdefault(opcode, [offset, 0])
        expect(group[0] + group[1] == offset, "a group of the summary in pieces")
        group[1] += 9 + len(content)
        cursor = Cursor(content)
        if opcode == CHUNK_INDEX:
            indices.append(cursor)
        elif opcode == STATISTICS:
            statistics = cursor
        else:
            expect(opcode in (SCHEMA, CHANNEL), f"record {opcode:#x} in the summary")
            _definition(repeated, opcode, content)
    expect((repeated.schemas, repeated.channels) == (schemas, channels), "the summary repeats all definitions")
    for cursor, chunk in zip(indices, chunks, strict=True):
        expect(cursor.numbers("QQQQ") == (*chunk["times"], chunk["start"], chunk["bytes"]), "where a chunk is")
        expect(dict(cursor.pairs("HQ")) == chunk["offsets"], "where a chunk's indices are")
        expect(cursor.numbers("Q") == chunk["index_bytes"], "how long a chunk's indices are")
        expect(cursor.text() == "" and cursor.numbers("QQ") == (chunk["size"], chunk["size"]), "the sizes of a chunk")
        cursor.done()
    expect(statistics is not None, "no statistics")
    times = [time for _, time, _ in mcap.messages]
    counts = {id: sum(topic == mcap.channels[id][0] for topic, _, _ in mcap.messages) for id in mcap.channels}
    counts = {id: count for id, count in counts.items() if count}
    expected = (len(mcap.messages), len(schemas), len(channels), 0, 0, len(chunks), min(times, default=0), max(times, default=0))
    expect(statistics.numbers("QHIIIIQQ") == expected, "the statistics")
    expect(dict(statistics.pairs("HQ")) == counts, "the counts of the statistics")
    found = {}
    for _, opcode, content in records(data, offsets_start, end):
        expect(opcode == SUMMARY_OFFSET, "something else among the summary's offsets")
        group, group_start, length = Cursor(content).numbers("BQQ")
        found[group] = [group_start, length]
    expect(found == groups, "where the groups of the summary are")
