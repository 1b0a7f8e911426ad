"""A peer of `motionfmu live --exchange` in Python: a spring and a damper that hold an axis.

    python peer.py PORT HOST HOST_PORT SECONDS

It does what peer.c does, with nothing but the standard library.
"""

import socket
import struct
import sys
import time

HEAD = struct.Struct("<4sIIQHH")  # MFX1, number, number heard last, time [ns], flags, count
STIFFNESS, DAMPING = 1e5, 1e3  # [N/m], [N s/m]


def main(port: int, host: str, host_port: int, seconds: float) -> int:
    """Answer position [m] and speed [m/s] with a force [N]; the number of datagrams taken."""
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.bind(("127.0.0.1", port))
    link.settimeout(0.1)
    taken, end = 0, time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            data = link.recv(2048)
        except TimeoutError:
            continue
        magic, number, _, at, _, count = HEAD.unpack_from(data)
        if magic != b"MFX1" or count != 2:
            continue
        taken += 1
        position, speed = struct.unpack_from("<2d", data, HEAD.size)
        force = -STIFFNESS * position - DAMPING * speed
        answer = HEAD.pack(b"MFX1", taken, number, at, 0, 1) + struct.pack("<d", force)
        link.sendto(answer, (host, host_port))
    return taken


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit("peer.py PORT HOST HOST_PORT SECONDS")
    print(main(int(sys.argv[1]), sys.argv[2], int(sys.argv[3]), float(sys.argv[4])), "taken")
