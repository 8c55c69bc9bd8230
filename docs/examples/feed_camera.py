#!/usr/bin/env python3
"""A driver for `evit feed` in twenty lines: half a second of made-up events and IMU samples.

feed_camera.py | evit feed ...      or, after `evit feed --tcp 7700`:      feed_camera.py 7700
"""
import socket
import struct
import sys

if len(sys.argv) > 1:
    out = socket.create_connection(("127.0.0.1", int(sys.argv[1]))).makefile("wb")
else:
    out = sys.stdout.buffer


def event(t_us, x, y, polarity):  # 16 bytes, little-endian
    return struct.pack("<BBHHHq", 1, polarity, x, y, 0, t_us)


def imu_sample(t_us, gyro, accel):  # 64 bytes: rad/s, m/s^2 (at rest: +9.81 upwards)
    return struct.pack("<B7xq6d", 2, t_us, *gyro, *accel)


for t in range(0, 500_000, 100):  # us; replace this loop by what your camera's library calls you with
    out.write(event(t, t // 1000 % 346, 100, t // 100 % 2))
    if t % 5_000 == 0:
        out.write(imu_sample(t, (0.0, 0.0, 0.1), (0.0, 0.0, 9.81)))
out.flush()
