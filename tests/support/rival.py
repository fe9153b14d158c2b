#!/usr/bin/env python3
"""Publishes nonsense on an LCM network: wrong copies of the sensors' messages, well formed and in real time.

usage: rival.py PORT SECONDS [--rate N] [--seed N] [--ahead SECONDS] [--channels A,B]

Each copy is stamped up to --ahead later than what it copies, and a few of its bytes are replaced: by random ones, or by
the doubles 1e308, -1e308, 1e6. Prints how many it has sent. Only the standard library, none of our code.
"""
import argparse
import collections
import random
import socket
import struct
import time

GROUP = "239.255.76.67"
MAGIC = b"LC02"
UTIME = slice(8, 16)  # of a payload, behind its fingerprint


def listening_socket(port):
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind((GROUP, port))
    listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + bytes(4))
    listener.setblocking(False)
    return listener


def changed(payload, ahead_us, rng):
    wrong = bytearray(payload)
    utime = struct.unpack(">q", payload[UTIME])[0]
    wrong[UTIME] = struct.pack(">q", utime + rng.randint(0, ahead_us))
    for _ in range(rng.randint(0, 3)):
        if len(wrong) < 32:
            break
        at = rng.randrange(16, len(wrong) - 8)
        wrong[at : at + 8] = rng.choice([
            struct.pack(">d", 1e308), struct.pack(">d", -1e308), struct.pack(">d", 1e6), rng.randbytes(8)])
    return bytes(wrong)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("port", type=int)
    parser.add_argument("seconds", type=float)
    parser.add_argument("--rate", type=int, default=1500, help="messages per second (1500)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--ahead", type=float, default=30.0, help="[s] largest lead of a stamp (30)")
    parser.add_argument("--channels", default="LIDAR,ODOMETRY,MARKERS")
    options = parser.parse_args()
    channels = {name.encode() for name in options.channels.split(",")}
    rng = random.Random(options.seed)
    listener = listening_socket(options.port)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    sender.bind(("", 0))
    own_port = sender.getsockname()[1]
    heard = collections.deque(maxlen=200)
    sent = collections.Counter()
    begin = time.monotonic()
    first_heard = None
    while time.monotonic() - begin < options.seconds:
        try:
            while True:
                datagram, (_, port) = listener.recvfrom(65536)
                channel, zero, payload = datagram[8:].partition(b"\0")
                if port != own_port and datagram[:4] == MAGIC and zero and channel in channels and len(payload) >= 16:
                    heard.append((channel, payload))
        except BlockingIOError:
            pass
        due = int((time.monotonic() - begin) * options.rate) - sum(sent.values())
        if heard and first_heard is None:
            first_heard = time.monotonic()
        due = int((time.monotonic() - first_heard) * options.rate) - sum(sent.values()) if heard else 0
        for _ in range(due):
            channel, payload = rng.choice(heard)
            wrong = changed(payload, int(options.ahead * 1e6), rng)
            header = MAGIC + struct.pack(">I", sum(sent.values()) & 0xFFFFFFFF)
            sender.sendto(header + channel + b"\0" + wrong, (GROUP, options.port))
            sent[channel.decode()] += 1
        time.sleep(0.002)
    print("sent:", ", ".join(f"{name} {count}" for name, count in sorted(sent.items())) or "nothing")


if __name__ == "__main__":
    main()
