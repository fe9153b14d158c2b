# SPDX-License-Identifier: BSD-3-Clause
"""LCM event logs, with nothing but the standard library.

An event is, big-endian, {u32 0xEDA1DA01, i64 event number, i64 time us, i32 channel length, i32 data length}, then the
channel without a terminating zero, then the data. What is no whole event is skipped and counted, as by the C++ reader
(procs/common/log/log_file.cpp): same events, same number of bytes.
"""

import os
import struct
from dataclasses import dataclass
from pathlib import Path

_SYNC = struct.pack(">I", 0xEDA1DA01)
_HEADER = struct.Struct(">IqqII")
_MAX_CHANNEL_BYTES = 999  # as liblcm
_MAX_DATA_BYTES = 64 << 20  # raw images of other robots fit
_WINDOW_BYTES = 1 << 20


@dataclass(frozen=True)
class Event:
    """One message as it was recorded."""

    channel: str
    time_us: int
    data: bytes


class LogReader:
    """Iterates over the events of a log in the order of the file.

    `skipped_bytes` counts what belonged to no whole event, `first_skipped_offset` says where it began.
    Raises OSError when the file cannot be read.
    """

    def __init__(self, path):
        self.path = Path(path)
        if self.path.exists() and not self.path.is_file():
            raise OSError(f"{path}: is a folder or a device, not an LCM log")
        self._file = open(self.path, "rb")
        self._size = os.fstat(self._file.fileno()).st_size
        self._offset = 0
        self.skipped_bytes = 0
        self.first_skipped_offset = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._file.close()

    def __iter__(self):
        while self._offset < self._size:
            header = self._header_at(self._offset)
            if header is None:
                self._skip_to(self._next_event(self._offset + 1))
                continue
            time_us, channel_bytes, data_bytes = header
            self._file.seek(self._offset + _HEADER.size)
            channel = self._file.read(channel_bytes).decode("utf-8", "surrogateescape")
            data = self._file.read(data_bytes)
            self._offset += _HEADER.size + channel_bytes + data_bytes
            yield Event(channel, time_us, data)

    def _header_at(self, offset):
        """(time, channel length, data length) where a whole event starts, else None."""
        left = self._size - offset - _HEADER.size
        if left < 0:
            return None
        self._file.seek(offset)
        sync, _, time_us, channel_bytes, data_bytes = _HEADER.unpack(self._file.read(_HEADER.size))
        is_event = (
            sync == 0xEDA1DA01
            and 1 <= channel_bytes <= _MAX_CHANNEL_BYTES
            and data_bytes <= _MAX_DATA_BYTES
            and channel_bytes + data_bytes <= left
        )
        return (time_us, channel_bytes, data_bytes) if is_event else None

    def _next_event(self, offset):
        """Where the next whole event at or behind `offset` starts; the end of the file when there is none."""
        while self._size - offset >= _HEADER.size:
            self._file.seek(offset)
            window = self._file.read(_WINDOW_BYTES)
            at = window.find(_SYNC)
            while at >= 0:
                if self._header_at(offset + at) is not None:
                    return offset + at
                at = window.find(_SYNC, at + 1)
            offset += max(1, len(window) - (len(_SYNC) - 1))
        return self._size

    def _skip_to(self, offset):
        if self.skipped_bytes == 0:
            self.first_skipped_offset = self._offset
        self.skipped_bytes += offset - self._offset
        self._offset = offset


class LogWriter:
    """Writes events to NAME.part, which gets its name when it is closed: a log that is there is whole.

    Used as a context manager it keeps the name .part when an exception leaves the block.
    """

    def __init__(self, path):
        self.path = Path(path)
        if self.path.exists() and not self.path.is_file():
            raise OSError(f"{path}: is a folder or a device; give the name of a file for the log")
        self.part_path = Path(str(path) + ".part")
        self._file = open(self.part_path, "wb")
        self._next_number = 0

    def __enter__(self):
        return self

    def __exit__(self, exception_type, *_):
        if exception_type is None:
            self.close()
        else:
            self._file.close()

    def write(self, event):
        channel = event.channel.encode("utf-8", "surrogateescape")
        if not 1 <= len(channel) <= _MAX_CHANNEL_BYTES:
            raise ValueError(f"{event.channel!r}: a channel's name has 1 to {_MAX_CHANNEL_BYTES} bytes")
        if len(event.data) > _MAX_DATA_BYTES:
            raise ValueError(f"{event.channel}: a message of {len(event.data)} bytes is too large for a log")
        header = _HEADER.pack(0xEDA1DA01, self._next_number, event.time_us, len(channel), len(event.data))
        self._file.write(header + channel + event.data)
        self._next_number += 1

    def close(self):
        self._file.close()
        os.replace(self.part_path, self.path)


def messages(events, message_type, channel, rejected=None):
    """Decodes the events of one channel; yields (time_us, message).

    What is not a message of that type is left out, and its event appended to the list `rejected` if there is one.
    """
    for event in events:
        if event.channel != channel:
            continue
        try:
            message = message_type.decode(event.data)
        except (ValueError, IndexError, MemoryError, OverflowError, struct.error):
            if rejected is not None:
                rejected.append(event)
            continue
        yield event.time_us, message
