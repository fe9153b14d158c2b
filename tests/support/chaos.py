#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Carries the messages of one LCM network to another one, and corrupts some of them: the network between two processes.

usage: chaos.py FROM_PORT TO_PORT SECONDS [--seed N] [--channels A,B] [--drop SHARE] [--duplicate SHARE]
                [--delay SHARE --delay-s SECONDS] [--corrupt SHARE] [--burst EVERY_S LENGTH_S] [--stamp SHARE --stamp-s SECONDS]

Shares are of the messages of each of --channels (default: all that a sensor or the detector sends); other channels are
carried as they are. A delayed message comes up to --delay-s late, and so behind later ones. A burst loses everything on
these channels for LENGTH_S in each EVERY_S. Stamped ones have a utime up to --stamp-s too late, or as much too early.
The same seed and input give the same faults. Prints what it did. Only the standard library, none of our code.
"""
import argparse
import collections
import heapq
import itertools
import random
import socket
import struct
import time

GROUP = "239.255.76.67"
MAGIC = b"LC02"


def listening_socket(port):
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
    listener.bind((GROUP, port))
    listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + bytes(4))
    return listener


class Chaos:
    def __init__(self, options):
        self.options = options
        self.channels = options.channels.encode().split(b",")
        self.counts = collections.Counter()

    def corrupt(self, channel, payload, now_s):
        """Copies of the message to send, each with its delay."""
        options, name = self.options, channel.decode(errors="replace")
        if channel not in self.channels:
            return [(0.0, payload)]
        rng = random.Random(f"{options.seed} {name} {self.counts[name]}")
        self.counts[name] += 1
        drop, duplicate, delay, corrupt, stamp = (rng.random() for _ in range(5))
        in_burst = options.burst and now_s % options.burst[0] > options.burst[0] - options.burst[1]
        if in_burst or drop < options.drop:
            self.counts[f"{name} dropped"] += 1
            return []
        if corrupt < options.corrupt and payload:
            corrupted = bytearray(payload)
            for _ in range(rng.randint(1, 4)):
                corrupted[rng.randrange(len(corrupted))] = rng.randrange(256)
            payload = bytes(corrupted)
            self.counts[f"{name} corrupted"] += 1
        if stamp < options.stamp and len(payload) >= 16:
            utime = struct.unpack(">q", payload[8:16])[0] + int(1e6 * rng.uniform(-options.stamp_s, options.stamp_s))
            payload = payload[:8] + struct.pack(">q", utime) + payload[16:]
            self.counts[f"{name} stamped wrong"] += 1
        wait_s = 0.0
        if delay < options.delay:
            wait_s = rng.uniform(0.0, options.delay_s)
            self.counts[f"{name} delayed"] += 1
        copies = [(wait_s, payload)]
        if duplicate < options.duplicate:
            copies.append((wait_s, payload))
            self.counts[f"{name} duplicated"] += 1
        return copies


def carry(options):
    chaos = Chaos(options)
    listener = listening_socket(options.from_port)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    waiting, order, sequence = [], itertools.count(), itertools.count()
    begin = time.monotonic()
    while time.monotonic() - begin < options.seconds:
        now = time.monotonic()
        while waiting and waiting[0][0] <= now:
            _, _, channel, payload = heapq.heappop(waiting)
            header = MAGIC + struct.pack(">I", next(sequence) & 0xFFFFFFFF)
            sender.sendto(header + channel + b"\0" + payload, (GROUP, options.to_port))
        listener.settimeout(min(0.05, max(0.0005, waiting[0][0] - now)) if waiting else 0.05)
        try:
            datagram = listener.recv(65536)
        except (TimeoutError, BlockingIOError):
            continue
        channel, zero, payload = datagram[8:].partition(b"\0")
        if datagram[:4] != MAGIC or not zero:
            continue
        now = time.monotonic()
        for wait_s, copy in chaos.corrupt(channel, payload, now - begin):
            heapq.heappush(waiting, (now + wait_s, next(order), channel, copy))
    print("carried:", ", ".join(f"{name} {count}" for name, count in sorted(chaos.counts.items())) or "nothing")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("from_port", type=int)
    parser.add_argument("to_port", type=int)
    parser.add_argument("seconds", type=float)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--channels", default="LIDAR,ODOMETRY,CAMERA,MARKERS")
    for name in ("drop", "duplicate", "delay", "corrupt", "stamp"):
        parser.add_argument(f"--{name}", type=float, default=0.0)
    parser.add_argument("--delay-s", type=float, default=0.2)
    parser.add_argument("--stamp-s", type=float, default=3600.0)
    parser.add_argument("--burst", type=float, nargs=2)
    carry(parser.parse_args())


if __name__ == "__main__":
    main()
